// SPDX-License-Identifier: MIT
#pragma once

#include "host/scene/scene_impl.h"

#include <memory>

namespace voxtact::cpu {

/// Largest relative deviation caused by subdivision, of the mesh's largest coordinate.
inline constexpr double kDividedError = 0x1p-20;

/// Returns the mesh with its large triangles subdivided, in object space; null if none is large. A search that rotates
/// a mesh about its origin bounds the motion of a triangle by that of its farthest corner, a weak bound for a triangle
/// that is large relative to its distance from the origin. The pieces have their own indices. Throws if memory runs
/// out.
[[nodiscard]] std::unique_ptr<MeshImpl> dividedMesh(const MeshImpl& mesh);

} // namespace voxtact::cpu
