// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/overlap.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// Returns for each vertex the first vertex with the same coordinates; -0 and 0 are the same.
template <class Number> [[nodiscard]] std::vector<std::uint32_t> weldedVertices(std::span<const Number> positions);

/// A loop of vertices; the surface lies along the edges from each one to the next.
using HoleLoop = std::vector<std::uint32_t>;

/// The directed edges of a surface that do not cancel out.
struct SurfaceHoles {
    std::vector<HoleLoop> loops;
    std::uint32_t openEdges = 0;
    std::uint32_t nonManifold = 0; ///< edges of more than two triangles
};
/// `indices`: of welded vertices. The same triangles give the same loops.
[[nodiscard]] SurfaceHoles findHoles(std::span<const std::uint32_t> indices);

} // namespace voxtact
