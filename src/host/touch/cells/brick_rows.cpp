// SPDX-License-Identifier: MIT
#include "host/touch/cells/brick_rows.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

using Piece = BrickRows::Piece;

/// Returns the part of a piece on one side of a plane across an axis: `sign` times the coordinate is at most `most`.
Piece below(const Piece& piece, std::size_t axis, double sign, double most) noexcept {
    Piece out;
    for (std::size_t i = 0; i < piece.count; ++i) {
        const std::array<double, 3>& from = piece.corners[i];
        const std::array<double, 3>& to = piece.corners[(i + 1) % piece.count];
        const double a = sign * from[axis] - most;
        const double b = sign * to[axis] - most;
        if (a <= 0) {
            out.corners[out.count++] = from;
        }
        if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
            const double t = a / (a - b);
            std::array<double, 3>& at = out.corners[out.count++];
            for (std::size_t row = 0; row < 3; ++row) {
                at[row] = from[row] + t * (to[row] - from[row]);
            }
        }
    }
    return out;
}

} // namespace

BrickRows::BrickRows(const shader::CertifiedTriangle& triangle, const BrickBox& box) noexcept : box_(box) {
    constexpr double kRounding = 1.0 / 1024; // far above the rounding of these cuts, in double precision
    whole_.count = 3;
    const std::array corners{&triangle.corner0, &triangle.corner1, &triangle.corner2};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        whole_.corners[i] = {corners[i]->x, corners[i]->y, corners[i]->z};
    }
    margin_ = double{triangle.delta} + double{triangle.reach} * double{CERTIFIED_CLIP_ERROR} + kRounding;
}

BrickRows::Piece BrickRows::cut(const Piece& piece, std::size_t axis, std::int32_t number) const noexcept {
    const double first = (number << kBrickShift) - 1.0;
    return below(below(piece, axis, 1, first + kBrickSide + margin_), axis, -1, margin_ - first);
}

BrickRows::Span BrickRows::spanOf(const Piece& piece, std::size_t axis) const noexcept {
    if (piece.count == 0) {
        return {};
    }
    double lo = piece.corners[0][axis];
    double hi = lo;
    for (std::size_t i = 1; i < piece.count; ++i) {
        lo = std::min(lo, piece.corners[i][axis]);
        hi = std::max(hi, piece.corners[i][axis]);
    }
    const auto brickAt = [&](double at) {
        const double number = std::floor((at + 1) / kBrickSide);
        return static_cast<std::int32_t>(std::clamp(number, box_.lo[axis] - 1.0, box_.hi[axis] + 1.0));
    };
    return {std::max(brickAt(lo - margin_), box_.lo[axis]), std::min(brickAt(hi + margin_), box_.hi[axis])};
}

} // namespace voxtact::cpu
