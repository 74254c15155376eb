// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace voxtact::cpu {

/// The space that distances are measured in: the world's axes and millimetres, from the middle of the volume. Voxel
/// space is measured from there, too: *centred* voxel coordinates are u - (n-1)/2, u being those of
/// src/exact/certified_triangle.h.
class VolumeSpace {
  public:
    explicit VolumeSpace(const Grid& grid);

    [[nodiscard]] glm::dvec3 toWorld(const glm::dvec3& voxel) const noexcept { return local_from_voxel * voxel; }
    [[nodiscard]] glm::dvec3 toVoxel(const glm::dvec3& local) const noexcept { return voxel_from_local * local; }

    glm::dmat3 local_from_voxel{1};
    glm::dmat3 voxel_from_local{1};
    /// The inverse of the metric: turns a gradient by voxel coordinates into a direction.
    glm::dmat3 direction_from_gradient{1};
    glm::dvec3 middle{};  ///< world, of the volume
    glm::dvec3 centre{};  ///< (n-1)/2
    glm::dvec3 reach{};   ///< half the domain, in voxels
    glm::dvec3 spacing{}; ///< times the maximum shrinkage of the grid's directions: a step of w voxels is at least as
                          ///< long as spacing * w
    double magnitude = 0; ///< mm: upper bound of the volume's coordinates and their terms
    double condition = 1; ///< growth of rounding by voxel_from_local
};

} // namespace voxtact::cpu
