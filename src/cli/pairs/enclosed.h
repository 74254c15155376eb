// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

/// What a closed mesh encloses, which its surface does not touch.
namespace voxtact::app {

/// Centres of opaque voxels, world mm. Null: none are known.
using OpaqueVoxels = std::shared_ptr<const std::vector<Vec3>>;

/// Of a volume, under opacity that is linear between `points`: some, from all of its parts.
[[nodiscard]] OpaqueVoxels someOpaqueVoxels(const VolumeView& volume, std::span<const ControlPoint> points,
                                            double threshold);

/// One of the voxels that is inside of a mesh at a pose; nothing where the mesh is open, or none of those that are
/// tried is. By rays, without bounds on rounding: for a note, not for an answer.
[[nodiscard]] std::optional<Vec3> enclosedVoxel(const MeshView& mesh, const Mat4& world_from_object,
                                                const std::vector<Vec3>& voxels);

} // namespace voxtact::app
