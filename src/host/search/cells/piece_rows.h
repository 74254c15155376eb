// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/cells/volume_space.h"
#include "host/search/label_part.h"
#include "host/search/opaque_part.h"
#include "host/search/placed.h"

#include <array>
#include <cstdint>

namespace voxtact::cpu {

/// Pieces of cells, row by row, for vectors: the vector form of CellPiece.
struct alignas(kRowAlignment) PieceRows {
    static constexpr std::size_t kMost = 64;
    using Row = std::array<double, kMost>;

    std::array<Row, 8> terms{};  ///< of their cells
    Row error{};                 ///< of these
    std::array<Row, 3> cell{};   ///< the cells' middles, centred voxel coordinates
    std::array<Row, 3> middle{}; ///< of the pieces, in their cells' coordinates
    std::array<Row, 3> half{};   ///< of their sides
    Row lo{};                    ///< of the interpolant in each, its error included
    Row hi{};
    Row hullLo{}; ///< OpaqueIntervals::meet()
    Row hullHi{};
    Row apart{};           ///< mm
    std::size_t count = 0; ///< of the pieces

    /// Adds a piece of a cell. Expects a free row.
    void add(const PartCell& cell, const PiecePlace& place) noexcept;
    /// Sets the position of a piece, in its cell's coordinates.
    void setPiece(std::size_t number, const glm::dvec3& pieceMiddle, const glm::dvec3& pieceHalf) noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            middle[static_cast<std::size_t>(axis)][number] = pieceMiddle[axis];
            half[static_cast<std::size_t>(axis)][number] = pieceHalf[axis];
        }
    }
};

/// Triangles to measure pieces against, by the closest one and all of their corners. Not swept.
struct PieceJob {
    const PlacedCluster& triangles;
    std::size_t nearest = 0; ///< of the triangles
    const PointList& corners;
    const VolumeSpace& space;
    double cut = 0;   ///< mm: no better precision is needed from this distance on
    double error = 0; ///< DistanceError::absolute
};

/// Computes the terms of whole cells and their errors, from the stored values at the corners. The same on every
/// processor, like the functions below.
void makeTerms(PieceRows& rows);
/// Sets `lo` and `hi`.
void findRanges(PieceRows& rows);
/// Sets how far each is apart from the triangles, by two directions. After the hulls are set.
void findApart(const PieceJob& job, PieceRows& rows);

} // namespace voxtact::cpu
