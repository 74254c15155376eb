// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/certified/triangle_cells.h"

#include <array>
#include <cstdint>
#include <optional>

namespace voxtact::cpu {

/// Counts the fragments of a triangle in cells that are opaque all over (CertifiedBricks::allOpaqueAt()): there a
/// fragment is certain where certifiedClip() leaves something, and where that is clear, it is not cut. One thread's.
class RowCounter {
  public:
    struct Row {
        unsigned certain = 0; ///< fragments
        unsigned left = 0;    ///< a bit for each cell of the row that is still to be decided
    };

    /// Before another triangle.
    void begin() noexcept { cells_.reset(); }
    /// Of a row of cells from `first` on, a bit for each: those that may have an opaque point, and those that are
    /// opaque all over. Expects a triangle that TriangleCells may be asked of.
    [[nodiscard]] Row count(const shader::CertifiedTriangle& triangle, unsigned row, unsigned allOpaque,
                            const std::array<std::int32_t, 3>& first) noexcept;

  private:
    std::optional<TriangleCells> cells_; ///< once it is of use
};

} // namespace voxtact::cpu
