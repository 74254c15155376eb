// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxtact::lab {

/// `count` rigid poses: a random rotation, and a random vertex of the mesh at a random point of the volume's box made
/// larger by a tenth on each side. The same arguments give the same poses, bit for bit, on every machine with IEEE
/// arithmetic. The mesh must have a vertex and the grid must be one that checkGrid() accepts.
[[nodiscard]] std::vector<Mat4> randomPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                            std::uint64_t seed);

/// How far around the onset of contact, in voxels (the smallest spacing).
inline constexpr double kOnsetInside = 0.75;
inline constexpr double kOnsetOutside = 0.25;

/// `count` rigid poses around the onset of contact: a pose as above that touches is moved in a random direction until
/// it no longer does (bisected), and from there by a uniformly random length, kOnsetInside back to kOnsetOutside on.
/// `touches` says whether a pose does. InvalidArgument where too few do to begin with.
[[nodiscard]] Result<std::vector<Mat4>> onsetPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                                   std::uint64_t seed,
                                                   const std::function<Result<bool>(const Mat4&)>& touches);

} // namespace voxtact::lab
