// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>

namespace voxtact::app {

/// Returns the same surface with more triangles: halves edges longer than `longest` repeatedly, so that values at the
/// vertices describe the points between them. Neighbours stay neighbours: a shared edge is halved in both triangles.
/// Ends before there are more than `mostTriangles`. `longest` is above 0, in the mesh's units.
[[nodiscard]] MeshData halveLongEdges(MeshData mesh, double longest, std::size_t mostTriangles);

} // namespace voxtact::app
