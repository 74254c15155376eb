// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <cstdint>

namespace voxtact {

/// Object space. `vertex` is one of the mesh.
[[nodiscard]] inline Vec3 vertexOf(const MeshView& mesh, std::uint32_t vertex) noexcept {
    const double* at = mesh.positions.data() + std::size_t{3} * vertex;
    return {at[0], at[1], at[2]};
}

} // namespace voxtact
