// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <cstdint>

namespace voxtact {

/// Object space. `vertex` is one of the mesh.
[[nodiscard]] inline Vec3 vertexOf(const MeshView& mesh, std::uint32_t vertex) noexcept {
    const float* at = mesh.positions.data() + std::size_t{3} * vertex;
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

} // namespace voxtact
