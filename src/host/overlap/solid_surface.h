// SPDX-License-Identifier: MIT
#pragma once

#include "host/area/uv_polygon.h"
#include "host/scene/scene_impl.h"
#include "voxtact/overlap.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// Change of the solid across a triangle: 1 if its normal leaves the solid, -1 if it enters, 0 if both sides are inside
/// or outside.
using Jump = std::int8_t;
inline constexpr Jump kUnknownJump = 2;
/// Varies over the triangle: its pieces have their own.
inline constexpr Jump kInPieces = 3;

/// A part of a triangle.
struct SolidPiece {
    std::uint32_t place = 0; ///< of the triangle in the mesh's arrays
    Jump jump = 0;           ///< not 0
    UvPolygon polygon;
};

/// The surface of a mesh's solid, object space: made once for all poses. In the floats of MeshImpl, whose rounding
/// MeshPlace::error() has.
struct SolidSurface {
    explicit SolidSurface(const MeshImpl& mesh);

    /// Returns the pieces of a triangle with kInPieces.
    [[nodiscard]] std::span<const SolidPiece> piecesOf(std::uint32_t place) const noexcept;

    SolidFacts facts;               ///< holes only
    std::vector<Jump> jumps;        ///< by a triangle's place in the mesh's arrays; padding: 0
    std::vector<SolidPiece> pieces; ///< by place
    double volume = 0;              ///< object units^3, of the solid
    double volumeError = 0;         ///< it is not off by more, but for MeshOrigin::rounding
    double area = 0;                ///< object units^2, of all triangles
};

} // namespace voxtact::cpu
