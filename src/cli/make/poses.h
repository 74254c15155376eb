// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxtact {

/// Poses of a measurement, at most: all are held at once.
inline constexpr std::uint32_t kMostPoses = 10'000'000;

/// `count` rigid poses: a random rotation, and a random vertex of the mesh at a random point of the volume's box made
/// larger by a tenth on each side. The same arguments give the same poses, bit for bit, on every machine with IEEE
/// arithmetic. The mesh must have a vertex and the grid must be one that checkGrid() accepts.
[[nodiscard]] std::vector<Mat4> randomPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                            std::uint64_t seed);
/// Calls `take` for the same poses, one after the other, without storing them. Ends if `take` returns false.
void forRandomPoses(const Grid& grid, const MeshView& mesh, std::uint64_t count, std::uint64_t seed,
                    const std::function<bool(const Mat4&)>& take);

/// Rounds the elements of poses to floats, so that all engines get the poses of an engine with poses on the device.
[[nodiscard]] std::vector<Mat4> asFloats(std::vector<Mat4> poses);

/// Range around the onset of contact, in voxels (the smallest spacing).
inline constexpr double kOnsetInside = 0.75;
inline constexpr double kOnsetOutside = 0.25;

/// `count` rigid poses around the onset of contact: a pose as above that touches is moved in a random direction until
/// it no longer does (bisected), and from there by a uniformly random length, kOnsetInside back to kOnsetOutside on.
/// `touches` says whether a pose does. InvalidArgument where too few do to begin with.
[[nodiscard]] Result<std::vector<Mat4>> onsetPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                                   std::uint64_t seed,
                                                   const std::function<Result<bool>(const Mat4&)>& touches);

/// Poses of a stroke of movingPoses().
inline constexpr std::uint32_t kTicksPerStroke = 500;

/// `count` rigid poses, a tick each, of an instrument that a hand moves: strokes one after the other, each from 10
/// voxels (the smallest spacing) outside of a pose around the onset of contact to 2 voxels inside, back, and on to
/// where the next begins. Outside is away from the middle of the volume. The poses around the onset are those of
/// onsetPoses(), and it refuses what they refuse.
[[nodiscard]] Result<std::vector<Mat4>> movingPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                                    std::uint64_t seed,
                                                    const std::function<Result<bool>(const Mat4&)>& touches);

} // namespace voxtact
