// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxtact {

/// Maximum poses of a measurement: all are in memory at once.
inline constexpr std::uint32_t kMostPoses = 10'000'000;

/// Returns `count` rigid poses: random rotations that put a random vertex of the mesh at a random point of the volume's
/// box, enlarged by a tenth on each side. Equal arguments give equal poses, bit for bit, on every machine with IEEE
/// arithmetic. The mesh must have a vertex, and checkGrid() must accept the grid.
[[nodiscard]] std::vector<Mat4> randomPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                            std::uint64_t seed);
/// Calls `take` with each pose of randomPoses(), without storing them. Stops when `take` returns false.
void forRandomPoses(const Grid& grid, const MeshView& mesh, std::uint64_t count, std::uint64_t seed,
                    const std::function<bool(const Mat4&)>& take);

/// Rounds the elements of poses to float, so that all engines get the poses that a device stores.
[[nodiscard]] std::vector<Mat4> asFloats(std::vector<Mat4> poses);

/// Range around the onset of contact, in voxels (the smallest spacing).
inline constexpr double kOnsetInside = 0.75;
inline constexpr double kOnsetOutside = 0.25;

/// Returns `count` rigid poses around the onset of contact. Moves a touching pose of randomPoses() in a random
/// direction to the onset (bisection), then by a uniformly random length from kOnsetInside back to kOnsetOutside on.
/// `touches` returns true if a pose touches. InvalidArgument if too few random poses touch.
[[nodiscard]] Result<std::vector<Mat4>> onsetPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                                   std::uint64_t seed,
                                                   const std::function<Result<bool>(const Mat4&)>& touches);

/// Number of poses per stroke of movingPoses().
inline constexpr std::uint32_t kTicksPerStroke = 500;

/// Returns `count` rigid poses, one per tick, of a hand-held instrument. Each stroke goes from 10 voxels (the smallest
/// spacing) outside a pose of onsetPoses() to 2 voxels inside, back, and to the start of the next stroke. Outside is
/// away from the middle of the volume. Fails like onsetPoses().
[[nodiscard]] Result<std::vector<Mat4>> movingPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                                    std::uint64_t seed,
                                                    const std::function<Result<bool>(const Mat4&)>& touches);

} // namespace voxtact
