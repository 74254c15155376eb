// SPDX-License-Identifier: MIT
#include "host/search/cells/volume_space.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dmat3;
using glm::dvec3;
using glm::length;

/// The square root of the sum of squares of the elements: no less than the largest stretch.
double norm(const dmat3& m) {
    return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]));
}

/// Lower bound of the stretch of a vector by the matrix: by Gershgorin circles around the eigenvalues of its square, or
/// by the norm of its inverse.
double leastStretch(const dmat3& m, const dmat3& inverse) {
    double least = 1e300;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        least = std::min(least, dot(m[i], m[i]) - std::abs(dot(m[i], m[j])) - std::abs(dot(m[i], m[k])));
    }
    const double byInverse = 1 / norm(inverse);
    return std::max(least > 0 ? std::sqrt(least) : 0.0, byInverse) * (1 - 0x1p-40);
}

} // namespace

VolumeSpace::VolumeSpace(const Grid& grid) {
    dmat3 directions(1);
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        directions[axis] = {grid.direction[3 * at], grid.direction[3 * at + 1], grid.direction[3 * at + 2]};
        local_from_voxel[axis] = directions[axis] * grid.spacing[at];
        spacing[axis] = grid.spacing[at];
        centre[axis] = (static_cast<double>(grid.size[at]) - 1) / 2;
        reach[axis] = static_cast<double>(grid.size[at]) / 2;
        magnitude += std::abs(grid.origin[at]) + 2 * length(local_from_voxel[axis]) * reach[axis];
    }
    const dmat3 inverse = glm::inverse(directions);
    voxel_from_local = glm::inverse(local_from_voxel);
    direction_from_gradient = voxel_from_local * glm::transpose(voxel_from_local);
    middle = dvec3(grid.origin[0], grid.origin[1], grid.origin[2]) + local_from_voxel * centre;
    condition = std::max(1.0, norm(directions) * norm(inverse));
    spacing *= leastStretch(directions, inverse);
}

} // namespace voxtact::cpu
