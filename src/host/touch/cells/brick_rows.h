// SPDX-License-Identifier: MIT
#pragma once

#include "exact/certified_triangle.h"
#include "host/touch/cells/cell_box.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// The bricks that a large triangle may pass through: of each row along x those from one to another, found by cutting
/// the triangle to a layer of bricks, and to a row of that. A thin triangle passes through few of its box.
class BrickRows {
  public:
    /// For smaller boxes, testing each brick is as fast.
    static constexpr std::int32_t kLeastBricks = 28;

    /// The part of the triangle between two pairs of planes: at most seven corners while it is convex; kMost if
    /// rounding makes each plane cut as many sides as possible.
    struct Piece {
        static constexpr std::size_t kMost = 13;
        std::array<std::array<double, 3>, kMost> corners{};
        std::size_t count = 0;
    };
    /// Numbers of bricks along an axis, both ends inclusive; none: last < first.
    struct Span {
        std::int32_t first = 0;
        std::int32_t last = -1;
    };

    /// Expects a triangle whose cells are known, and the bricks of these.
    BrickRows(const shader::CertifiedTriangle& triangle, const BrickBox& box) noexcept;

    /// Returns the part of the triangle in the layer of bricks `z`.
    [[nodiscard]] Piece layer(std::int32_t z) const noexcept { return cut(whole_, 2, z); }
    /// The rows of that.
    [[nodiscard]] Span rows(const Piece& layer) const noexcept { return spanOf(layer, 1); }
    /// The bricks of the row `y`.
    [[nodiscard]] Span row(const Piece& layer, std::int32_t y) const noexcept { return spanOf(cut(layer, 1, y), 0); }

  private:
    /// Returns the part of a piece in or near the bricks with that index along an axis.
    [[nodiscard]] Piece cut(const Piece& piece, std::size_t axis, std::int32_t number) const noexcept;
    [[nodiscard]] Span spanOf(const Piece& piece, std::size_t axis) const noexcept;

    Piece whole_;
    BrickBox box_;
    double margin_; ///< voxels by which the triangle and its pieces may be displaced
};

} // namespace voxtact::cpu
