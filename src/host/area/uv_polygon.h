// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// A place in the plane of a triangle: its first corner, and u and v times the way from there to the two others.
struct Uv {
    double u = 0;
    double v = 0;
};

/// A convex part of a triangle. Areas are in units of the parallelogram of two of its sides: the triangle has 1/2.
struct UvPolygon {
    /// A triangle that is cut to a box has at most 9; the rest is for rounding.
    static constexpr std::size_t kMost = 12;

    std::array<Uv, kMost> corners{};
    std::uint32_t count = 0; ///< below 3: it is empty

    [[nodiscard]] static UvPolygon whole() noexcept { return {{Uv{0, 0}, Uv{1, 0}, Uv{0, 1}}, 3}; }
    [[nodiscard]] bool empty() const noexcept { return count < 3; }
    [[nodiscard]] std::uint32_t after(std::uint32_t corner) const noexcept {
        return corner + 1 == count ? 0 : corner + 1;
    }
    [[nodiscard]] std::uint32_t before(std::uint32_t corner) const noexcept {
        return corner == 0 ? count - 1 : corner - 1;
    }
    [[nodiscard]] double area() const noexcept;
    /// Upper bound of the error of a part's area.
    [[nodiscard]] double areaError() const noexcept;
};

/// Height of each corner of a polygon above a line in its plane.
using Heights = std::array<double, UvPolygon::kMost>;

/// Cuts a polygon along the line of height 0. Both parts share the ends of the cut, without gap or overlap. Corners may
/// be on the wrong side by `slack`, many roundings of a height. Returns false if there is no room for the corners.
[[nodiscard]] bool split(const UvPolygon& polygon, const Heights& heights, double slack, UvPolygon& below,
                         UvPolygon& above) noexcept;

/// The area of the part between two heights, which may be infinite.
[[nodiscard]] double areaBetween(const UvPolygon& polygon, const Heights& heights, double from, double to) noexcept;

} // namespace voxtact::cpu
