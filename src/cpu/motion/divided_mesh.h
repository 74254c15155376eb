// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scene/scene_impl.h"

#include <memory>

namespace voxtact::cpu {

/// What a mesh and the same one with its large triangles divided are off each other, of its largest coordinate.
inline constexpr double kDividedError = 0x1p-20;

/// The mesh with its large triangles divided; null where none is large. Where a mesh is
/// turned about its origin, no part of a triangle is taken to go less far than its farthest corner: of one that is
/// large for how far from the origin it is, that says little. Triangles have numbers of their own. Throws where memory
/// runs out.
[[nodiscard]] std::unique_ptr<MeshImpl> dividedMesh(const MeshImpl& mesh);

} // namespace voxtact::cpu
