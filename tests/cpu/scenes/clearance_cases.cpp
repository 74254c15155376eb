// SPDX-License-Identifier: MIT
#include "cpu/scenes/clearance_cases.h"
#include "cpu/scenes/random_scene.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"

#include <cmath>

namespace voxtact::test {

CertifiedCase makeClearanceCase(std::uint64_t seed, std::uint64_t number) {
    CertifiedCase c = makeCertifiedCase(seed, number);
    std::mt19937_64 random(seed ^ (number * 0x9e3779b97f4a7c15ULL));
    Grid& grid = c.scene.volume.grid;
    if (chance(random, 0.2)) {
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 + row] += uniform(random, -0.6, 0.6) * grid.direction[row];
            grid.direction[6 + row] += uniform(random, -0.6, 0.6) * grid.direction[3 + row];
        }
    }
    if (chance(random, 0.8)) {
        const Mat4 turn = randomRotation(random);
        const double by = std::pow(10, uniform(random, -2, 1));
        c.scene.world_from_object =
            multiply(translation({by * turn[0], by * turn[1], by * turn[2]}), c.scene.world_from_object);
    }
    return c;
}

} // namespace voxtact::test
