// SPDX-License-Identifier: MIT
#pragma once

#include "host/overlap/solid_surface.h"
#include "host/overlap/solid_triangles.h"

#include <span>
#include <vector>

namespace voxtact::cpu {

/// Cuts a triangle along others that it may have points in common with, and adds the pieces across which the solid
/// changes. False: there are too many.
[[nodiscard]] bool addPieces(const SolidTriangles& triangles, std::size_t place, std::span<const std::size_t> others,
                             std::vector<SolidPiece>& pieces);

} // namespace voxtact::cpu
