// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace voxtact::lab {

/// Poses of a stroke of movingPoses().
inline constexpr std::uint32_t kTicksPerStroke = 500;

/// `count` rigid poses, a tick each, of an instrument that a hand moves: strokes one after the other, each from 10
/// voxels (the smallest spacing) outside of a pose around the onset of contact to 2 voxels inside, back, and on to
/// where the next begins. Outside is away from the middle of the volume. The poses around the onset are those of
/// onsetPoses(), and it refuses what they refuse.
[[nodiscard]] Result<std::vector<Mat4>> movingPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                                    std::uint64_t seed,
                                                    const std::function<Result<bool>(const Mat4&)>& touches);

} // namespace voxtact::lab
