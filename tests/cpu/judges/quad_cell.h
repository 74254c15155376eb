// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/judges/quad_judge.h"
#include "cpu/judges/quad_place.h"

#include <cstdint>
#include <cstring>

namespace voxtact::test::quad {

inline double voxelAt(const VolumeView& volume, const std::array<std::int64_t, 3>& at) {
    std::size_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        const std::int64_t last = std::int64_t{volume.grid.size[axis]} - 1;
        index = index * volume.grid.size[axis] + static_cast<std::size_t>(std::clamp<std::int64_t>(at[axis], 0, last));
    }
    const auto load = [&](auto scalar) {
        std::memcpy(&scalar, volume.voxels.data() + index * sizeof scalar, sizeof scalar);
        return static_cast<double>(scalar);
    };
    switch (volume.type) {
    case ScalarType::UInt8:
        return load(std::uint8_t{});
    case ScalarType::Int16:
        return load(std::int16_t{});
    case ScalarType::UInt16:
        return load(std::uint16_t{});
    case ScalarType::Float32:
        break;
    }
    return load(float{});
}

/// The values that a piece has, and how far they may be off.
template <class Real> struct Range {
    std::array<Real, 3> atCorner;
    Real lo;
    Real hi;
    Real error;
};

/// The interpolant of a cell.
template <class Real> class Cell {
  public:
    Cell(const JudgedPair& pair, const std::array<std::int64_t, 3>& cell) : cell_(cell) {
        Real least = 0;
        Real most = 0;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const Real value = Real(
                voxelAt(pair.volume, {cell[0] + std::int64_t(corner & 1U), cell[1] + std::int64_t(corner >> 1U & 1U),
                                      cell[2] + std::int64_t(corner >> 2U & 1U)}));
            value_[corner] = value;
            least = corner == 0 ? value_[corner] : std::min(least, value_[corner]);
            most = corner == 0 ? value_[corner] : std::max(most, value_[corner]);
            error_ = std::max(error_, 8 * kRounding<Real> * size(value));
        }
        range_ = most - least;
    }

    [[nodiscard]] Real range() const { return range_; }

    /// Of a piece whose points may be displaced by `displaced` voxels along each axis.
    [[nodiscard]] Range<Real> over(const std::array<Place<Real>, 3>& piece, Real displaced) const {
        Place<Real> middle{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            middle[axis] = (piece[0][axis] + piece[1][axis] + piece[2][axis]) / 3;
        }
        const Polynomial about(value_, middle, cell_);
        Range<Real> out{};
        Place<Real> reach{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            Place<Real> step{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                step[axis] = piece[corner][axis] - middle[axis];
                reach[axis] = std::max(reach[axis], size(step[axis]));
            }
            const Real flat = about.flat(step);
            out.atCorner[corner] = flat + about.bend(step);
            out.lo = corner == 0 ? flat : std::min(out.lo, flat);
            out.hi = corner == 0 ? flat : std::max(out.hi, flat);
        }
        const Real bend = about.mostBend(reach);
        out.lo -= bend;
        out.hi += bend;
        out.error = error_ + 8 * range_ * displaced;
        return out;
    }

  private:
    /// The interpolant about a point: it ends with the third order.
    struct Polynomial {
        Polynomial(const std::array<Real, 8>& value, const Place<Real>& at, const std::array<std::int64_t, 3>& cell) {
            std::array<Real, 8> c = value;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Real t = at[axis] - Real(static_cast<double>(cell[axis]));
                for (std::size_t i = 0; i < 8; ++i) {
                    const std::size_t bit = std::size_t{1} << axis;
                    if ((i & bit) == 0) {
                        const Real slope = c[i | bit] - c[i];
                        c[i] += t * slope;
                        c[i | bit] = slope;
                    }
                }
            }
            coefficient = c;
        }
        [[nodiscard]] Real flat(const Place<Real>& step) const {
            return coefficient[0] + coefficient[1] * step[0] + coefficient[2] * step[1] + coefficient[4] * step[2];
        }
        [[nodiscard]] Real bend(const Place<Real>& step) const {
            return coefficient[3] * step[0] * step[1] + coefficient[5] * step[0] * step[2] +
                   coefficient[6] * step[1] * step[2] + coefficient[7] * step[0] * step[1] * step[2];
        }
        [[nodiscard]] Real mostBend(const Place<Real>& reach) const {
            return size(coefficient[3]) * reach[0] * reach[1] + size(coefficient[5]) * reach[0] * reach[2] +
                   size(coefficient[6]) * reach[1] * reach[2] + size(coefficient[7]) * reach[0] * reach[1] * reach[2];
        }
        std::array<Real, 8> coefficient{}; ///< of the product of the steps along the axes whose bits are set
    };

    std::array<std::int64_t, 3> cell_;
    std::array<Real, 8> value_{};
    Real range_ = 0;
    Real error_ = 0;
};

} // namespace voxtact::test::quad
