// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <vector>

namespace voxtact::app {

/// `count` rigid poses: a random rotation, and a random vertex of the mesh at a random point of the volume's box made
/// larger by a tenth on each side. The same arguments give the same poses, bit for bit, on every machine with IEEE
/// arithmetic. The mesh must have a vertex and the grid must be one that checkGrid() accepts.
[[nodiscard]] std::vector<Mat4> randomPoses(const Grid& grid, const MeshView& mesh, std::uint32_t count,
                                            std::uint64_t seed);

} // namespace voxtact::app
