// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/certified_bricks.h"
#include "host/touch/cells/triangle_cells.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

namespace voxtact::cpu {

/// Counts the fragments of a triangle in cells that are opaque all over (CertifiedBricks::allOpaqueAt()): there a
/// fragment is certain where certifiedClip() leaves something, and where that is clear, it is not cut. One thread's.
class CellCounter {
    using Place = std::array<std::int32_t, 3>;
    using Bits = TriangleCells::Bits;

  public:
    /// Some cells of a brick.
    struct Part {
        const Place& brick;
        const CellBox& within; ///< numbered within the brick
        const CellBits& mayBeOpaque;
        const CellBits& allOpaque;
    };

    /// Begins another triangle, which must outlive its queries.
    void begin(const shader::CertifiedTriangle& triangle) noexcept;
    /// Returns the number of certain fragments. Calls `open(cell, passes)` for cells of the volume that stay open;
    /// `passes`: the triangle certainly does through the cell (TriangleCells::Overlap). Expects a triangle that
    /// TriangleCells may be asked of.
    template <class Open> [[nodiscard]] unsigned count(const Part& part, const Open& open) {
        constexpr auto kSide = static_cast<std::int32_t>(TriangleCells::kSide);
        unsigned certain = 0;
        Place from{};
        for (from[2] = part.within.lo[2]; from[2] <= part.within.hi[2]; from[2] += kSide) {
            for (from[1] = part.within.lo[1]; from[1] <= part.within.hi[1]; from[1] += kSide) {
                for (from[0] = part.within.lo[0]; from[0] <= part.within.hi[0]; from[0] += kSide) {
                    const Cube cube = cubeOf(part, from);
                    const Left found = countCube(cube, certain);
                    for (Bits left = found.cells; left != 0; left &= left - 1) {
                        const std::int32_t number = std::countr_zero(left);
                        open(Place{cube.first[0] + number % kSide, cube.first[1] + number / kSide % kSide,
                                   cube.first[2] + number / (kSide * kSide)},
                             (found.passed >> static_cast<unsigned>(number) & 1U) != 0);
                    }
                }
            }
        }
        return certain;
    }

  private:
    struct Cube {
        Place first{}; ///< of the volume's cells
        Bits mayBeOpaque = 0;
        Bits allOpaque = 0;
    };

    [[nodiscard]] static Cube cubeOf(const Part& part, const Place& from) noexcept;
    /// Remaining cells, and those that the triangle passes through.
    struct Left {
        Bits cells = 0;
        Bits passed = 0;
    };
    /// Adds to `certain`.
    [[nodiscard]] Left countCube(const Cube& cube, unsigned& certain) noexcept;

    const shader::CertifiedTriangle* triangle_ = nullptr;
    std::optional<TriangleCells> overlap_; ///< of that, once it is of use
    std::array<Place, 3> corners_{};       ///< the cells that they are in
};

} // namespace voxtact::cpu
