// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/cell_piece.h"
#include "host/search/found.h"
#include "host/search/label_part.h"
#include "host/search/mesh_place.h"
#include "host/search/opaque_part.h"

namespace voxtact::cpu {

/// The piece of a cell that is at a place.
[[nodiscard]] CellPiece pieceAt(const PartCell& cell, const PiecePlace& place) noexcept;

/// A piece along a direction.
struct PieceAlong {
    PieceAlong() = default;
    PieceAlong(const PieceBounds& piece, const VolumeSpace& space, const Direction& chosen)
        : direction(chosen), least(piece.least(space, chosen.normal())) {}

    /// Returns a lower bound, up to rounding, of its distance from a part of the mesh with this reach.
    [[nodiscard]] double from(double reach) const {
        return direction.length() > 0 ? (least - reach) / direction.length() : 0;
    }
    [[nodiscard]] double from(const PlacedTriangle& triangle) const { return from(direction.reach(triangle)); }

    Direction direction;
    double least = 0;
};

/// Distance of one triangle from one piece, which gives the search a direction and possibly a nearer point.
class PieceDistance {
  public:
    /// `worthwhile`: minimum gain in mm. `triangle` is the mesh's. All must outlive it.
    PieceDistance(const OpaquePart& part, const SearchedPart& searched, const PartCell& cell, const CellPiece& piece,
                  const MeshPlace& mesh, const PlacedTriangle& triangle, double worthwhile)
        : part_(part), searched_(searched), cell_(cell), piece_(piece), mesh_(mesh), triangle_(triangle),
          worthwhile_(worthwhile) {}

    /// Returns the direction from the triangle to about the closest opaque point. Offers certainly opaque points to
    /// `found`, for triangle `number`.
    [[nodiscard]] glm::dvec3 run(const PiecePlace& place, const DistanceError& error, std::uint32_t number,
                                 Found& found) const;

  private:
    void between(const DistanceError& error, std::uint32_t number, Found& found) const;

    const OpaquePart& part_;
    const SearchedPart& searched_;
    const PartCell& cell_;
    const CellPiece& piece_;
    const MeshPlace& mesh_;
    const PlacedTriangle& triangle_;
    double worthwhile_;
};

} // namespace voxtact::cpu
