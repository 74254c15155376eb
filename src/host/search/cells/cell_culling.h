// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/placed.h"
#include "host/touch/cells/certified_bricks.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <limits>

namespace voxtact::cpu {

/// Cells of a brick in a box that may be opaque, numbered in the box.
struct CellCullingJob {
    const BrickCells& known;
    const CellBox& cells;
    glm::dvec3 along{}; ///< change of a normal's product with points from one cell to the next
    double base = 0;    ///< of the first cell of the brick, less the reach along the normal
    double inverse = 0; ///< Direction::inverse() of the normal
    double least = 0;   ///< mm: none is nearer
    double cut = 0;     ///< mm: pruned from this distance on
    double error = 0;   ///< DistanceError::absolute
};

/// Cells that remain after pruning.
struct alignas(kRowAlignment) RemainingCells {
    static constexpr std::size_t kRows = kBrickSide * kBrickSide;
    std::array<double, kRows * kBrickSide> lo{}; ///< mm, lower bounds of the remaining cells, row by row
    std::array<std::uint8_t, kRows> kept{};      ///< of the rows that are in the box, a bit for each
    double leastGone = 0;                        ///< mm: none of the others is nearer
};

/// Gives the same result on every processor, like the functions below.
void cullCells(const CellCullingJob& job, RemainingCells& out);

/// Cells of a brick in a box that may be opaque, by their distance from a point along each axis.
struct NearCellsJob {
    const BrickCells& known;
    const CellBox& cells;
    const std::array<std::array<double, kBrickSide>, 3>& squares; ///< mm^2
    double within = 0;                                            ///< mm^2: pruned from this distance on
};

/// `lo` is in mm^2 here, and there is no `leastGone`.
void cullNear(const NearCellsJob& job, RemainingCells& out);
/// Returns the minimum dot product of `along` with the position of a cell in the brick.
[[nodiscard]] double leastCell(const BrickCells& known, const CellBox& cells, const glm::dvec3& along);

} // namespace voxtact::cpu
