// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/placed.h"
#include "host/touch/cells/certified_bricks.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <limits>

namespace voxtact::cpu {

/// Those cells of a brick that may be opaque and are in a box, numbered within it.
struct CellSieveJob {
    const BrickCells& known;
    const CellBox& cells;
    glm::dvec3 along{}; ///< from one cell to the next one, what a normal's product with their points changes by
    double base = 0;    ///< of the first cell of the brick, less how far along the normal something reaches
    double inverse = 0; ///< Direction::inverse() of the normal
    double least = 0;   ///< mm: none is nearer
    double cut = 0;     ///< mm: what is not nearer is not kept
    double error = 0;   ///< DistanceError::absolute
};

/// What is left of them.
struct alignas(kRowAlignment) SievedCells {
    static constexpr std::size_t kRows = kBrickSide * kBrickSide;
    std::array<double, kRows * kBrickSide> lo{}; ///< mm, of those that are kept, row by row
    std::array<std::uint8_t, kRows> kept{};      ///< of the rows that are in the box, a bit for each
    double leastGone = 0;                        ///< mm: none of the others is nearer
};

/// The same on every processor, as what follows.
void sieveCells(const CellSieveJob& job, SievedCells& out);

/// Those cells of a brick that may be opaque and are in a box, by how far they are along each axis from a point.
struct NearCellsJob {
    const BrickCells& known;
    const CellBox& cells;
    const std::array<std::array<double, kBrickSide>, 3>& squares; ///< mm^2
    double within = 0;                                            ///< mm^2: what is not nearer is not kept
};

/// `lo` is in mm^2 here, and there is no `leastGone`.
void sieveNear(const NearCellsJob& job, SievedCells& out);
/// The least dot product of `along` with the place of one of them within the brick.
[[nodiscard]] double leastCell(const BrickCells& known, const CellBox& cells, const glm::dvec3& along);

} // namespace voxtact::cpu
