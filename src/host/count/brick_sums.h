// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// A box of bricks, both ends inclusive.
struct BrickBox {
    std::array<std::int32_t, 3> lo{};
    std::array<std::int32_t, 3> hi{};

    /// Number of bricks in a box that is not empty.
    [[nodiscard]] std::int64_t volume() const noexcept {
        std::int64_t count = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            count *= std::int64_t{hi[axis]} - lo[axis] + 1;
        }
        return count;
    }
};

/// The sum over any box of bricks in eight look-ups: a summed-area table (Crow, "Summed-area tables for texture
/// mapping", 1984) in three dimensions. Sums are modulo the range of the unsigned `Sum`.
template <class Sum> class BrickSums {
  public:
    BrickSums() = default;
    /// `valueOf(brick)` for each brick, numbered x + count[0] * (y + count[1] * z).
    template <class ValueOf> BrickSums(const std::array<std::int32_t, 3>& count, const ValueOf& valueOf) {
        nx_ = static_cast<std::size_t>(count[0]) + 1;
        ny_ = static_cast<std::size_t>(count[1]) + 1;
        const auto nz = static_cast<std::size_t>(count[2]) + 1;
        sums_.assign(nx_ * ny_ * nz, 0);
        std::size_t brick = 0;
        for (std::size_t z = 1; z < nz; ++z) {
            for (std::size_t y = 1; y < ny_; ++y) {
                Sum row = 0;
                for (std::size_t x = 1; x < nx_; ++x, ++brick) {
                    row += valueOf(brick);
                    const std::size_t at = (z * ny_ + y) * nx_ + x;
                    sums_[at] = row + sums_[at - nx_] + sums_[at - nx_ * ny_] - sums_[at - nx_ * ny_ - nx_];
                }
            }
        }
    }

    [[nodiscard]] Sum within(const BrickBox& box) const noexcept {
        const auto corner = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
            return sums_[(static_cast<std::size_t>(z) * ny_ + static_cast<std::size_t>(y)) * nx_ +
                         static_cast<std::size_t>(x)];
        };
        const auto layer = [&](std::int32_t z) -> Sum {
            return corner(box.hi[0] + 1, box.hi[1] + 1, z) - corner(box.lo[0], box.hi[1] + 1, z) -
                   corner(box.hi[0] + 1, box.lo[1], z) + corner(box.lo[0], box.lo[1], z);
        };
        return layer(box.hi[2] + 1) - layer(box.lo[2]);
    }
    [[nodiscard]] Sum all() const noexcept { return sums_.back(); }

  private:
    std::size_t nx_ = 0;
    std::size_t ny_ = 0;
    std::vector<Sum> sums_;
};

} // namespace voxtact::cpu
