// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>

namespace voxtact::app {

/// The same surface with more triangles: edges longer than `longest` are halved, and again, so that what is known of
/// the vertices says something of the places in between. Neighbours stay neighbours: an edge that two triangles share
/// is halved in both. Ends before there would be more than `mostTriangles`. `longest` is above 0, in the mesh's units.
[[nodiscard]] MeshData halveLongEdges(MeshData mesh, double longest, std::size_t mostTriangles);

} // namespace voxtact::app
