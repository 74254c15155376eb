// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>

namespace voxtact::app {

/// Returns the same surface with more triangles: repeatedly halves edges longer than `maxLength`, so that values at the
/// vertices describe the points between them. Halves a shared edge in both triangles. Stops before `maxTriangles` is
/// exceeded. `maxLength`: above 0, in the mesh's units.
[[nodiscard]] MeshData halveLongEdges(MeshData mesh, double maxLength, std::size_t maxTriangles);

} // namespace voxtact::app
