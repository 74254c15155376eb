// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

/// Finds opaque regions that a closed mesh encloses without touching them.
namespace voxtact::app {

/// Centres of opaque voxels, world mm. Null: unknown.
using OpaqueVoxels = std::shared_ptr<const std::vector<Vec3>>;

/// Returns a sample of opaque voxels across a volume, with opacity linear between `points`.
[[nodiscard]] OpaqueVoxels someOpaqueVoxels(const VolumeView& volume, std::span<const ControlPoint> points,
                                            double threshold);

/// Returns a voxel inside a mesh at a pose; empty if the mesh is open, or no tested voxel is inside.
/// Uses rays without rounding bounds: for a note, not for an answer.
[[nodiscard]] std::optional<Vec3> enclosedVoxel(const MeshView& mesh, const Mat4& world_from_object,
                                                const std::vector<Vec3>& voxels);

} // namespace voxtact::app
