// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>

namespace voxtact::app {

/// Connectivity of a mesh's triangles. An edge is a pair of vertices.
struct Closedness {
    std::uint64_t open = 0;   ///< edges of one triangle
    std::uint64_t many = 0;   ///< edges of more than two triangles
    std::uint64_t turned = 0; ///< edges whose two triangles have opposite winding
    std::uint32_t parts = 0;  ///< components that share no vertex

    [[nodiscard]] bool closed() const noexcept { return open == 0 && many == 0; }
};

/// Expects a mesh that checkMesh() accepts, with corners at equal positions merged.
[[nodiscard]] Closedness closednessOf(const MeshView& mesh);

} // namespace voxtact::app
