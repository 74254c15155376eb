// SPDX-License-Identifier: MIT
#pragma once

#include "exact/exact.h"

#include <cstdint>

namespace voxtact::cpu {

/// An edge function over whole pixels, exact: value + column * stepX + row * stepY, counted from a triangle's first
/// pixel. Covered where it plus the bias is not negative.
struct PixelEdge {
    std::int64_t value;
    std::int64_t stepX;
    std::int64_t stepY;
    std::int64_t bias;
};

/// Columns of a row that are covered, from the triangle's first; empty when last < first.
struct RowSpan {
    std::int32_t first;
    std::int32_t last;
};

/// The coverage of a triangle after exactSetUp(), row by row.
class RowSpans {
  public:
    explicit RowSpans(const shader::ExactTriangle& triangle) noexcept;

    [[nodiscard]] std::int32_t rows() const noexcept { return rows_; }
    [[nodiscard]] RowSpan span(std::int32_t row) const noexcept;
    /// Edges as exactFragment() numbers them.
    [[nodiscard]] const PixelEdge& edge(std::size_t number) const noexcept { return edges_[number]; }

  private:
    PixelEdge edges_[3];
    std::int32_t columns_;
    std::int32_t rows_;
};

} // namespace voxtact::cpu
