// SPDX-License-Identifier: MIT
#pragma once

#include "host/scene/scene_impl.h"

#include <memory>

namespace voxtact::cpu {

/// What a mesh and the same one with its large triangles divided are off each other, of its largest coordinate.
inline constexpr double kDividedError = 0x1p-20;

/// The mesh with its large triangles divided, in object space; null where none is large. A search that turns a mesh
/// about its origin takes all of a triangle to go as far as its farthest corner. That says little of a triangle which
/// is large for how far it is from the origin. The pieces have numbers of their own, not those of the mesh's triangles.
/// Throws where memory runs out.
[[nodiscard]] std::unique_ptr<MeshImpl> dividedMesh(const MeshImpl& mesh);

} // namespace voxtact::cpu
