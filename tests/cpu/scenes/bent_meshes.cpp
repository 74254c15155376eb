// SPDX-License-Identifier: MIT
#include "cpu/scenes/bent_meshes.h"

#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <cmath>

namespace voxtact::test {

std::vector<double> bent(std::mt19937_64& random, const MeshData& mesh, double size) {
    const double amount = uniform(random, 0, 0.6) * size;
    const double noise = chance(random, 0.3) ? 0.1 * size : 0;
    const double waves = uniform(random, 0.2, 3) / size;
    const bool flattened = chance(random, 0.1);
    std::vector<double> out = mesh.positions;
    for (std::size_t at = 0; at < out.size(); at += 3) {
        const double x = mesh.positions[at];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double moved = out[at + axis] + amount * std::sin(waves * x + static_cast<double>(axis)) +
                                 uniform(random, -noise, noise);
            out[at + axis] = flattened && axis == 2 ? 0.25 : static_cast<double>(static_cast<float>(moved));
        }
    }
    return out;
}

double bendSize(const Grid& grid) {
    double squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        squares += std::pow(grid.spacing[axis] * grid.size[axis], 2);
    }
    return std::sqrt(squares) / 4;
}

} // namespace voxtact::test
