// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/clusters.h"
#include "exact/certified.h"
#include "host/touch/cells/cell_box.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// Points in voxel space whose hull holds one triangle or several.
struct PointHull {
    const float* x = nullptr;
    const float* y = nullptr;
    const float* z = nullptr;
    std::size_t count = 0;
    shader::VoxelPoint lo{}; ///< the box around them
    shader::VoxelPoint hi{};
    float delta = 0; ///< voxels: not less than that of any of the triangles (CertifiedTriangle)
};

/// The vertices of a run in voxel space.
class RunPoints {
  public:
    static constexpr std::size_t kMost = 3 * std::size_t{kRunTriangles};

    /// Expects room. `triangle`: the index of one triangle with this vertex.
    void add(const shader::CertifiedVertex& vertex, std::uint32_t triangle) noexcept;
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::uint32_t triangle(std::size_t i) const noexcept { return triangles_[i]; }
    [[nodiscard]] shader::VoxelPoint point(std::size_t i) const noexcept { return {x_[i], y_[i], z_[i]}; }
    /// The cells that the run's triangles may pass through: those of certifiedBounds() of each are among them, and its
    /// delta is no larger. Expects some points.
    [[nodiscard]] shader::CertifiedBounds bounds(const shader::CertifiedItem& item) const noexcept;
    /// Valid as long as these.
    [[nodiscard]] PointHull hull(float delta) const noexcept {
        return {x_.data(), y_.data(), z_.data(), count_, lo_, hi_, delta};
    }

  private:
    std::array<float, kMost> x_;
    std::array<float, kMost> y_;
    std::array<float, kMost> z_;
    std::array<std::uint32_t, kMost> triangles_;
    std::size_t count_ = 0;
    shader::VoxelPoint lo_{};
    shader::VoxelPoint hi_{};
    float error_ = 0; ///< the greatest of theirs (CertifiedVertex)
};

/// A single triangle's.
class TriangleHull {
  public:
    TriangleHull(const shader::VoxelPoint& a, const shader::VoxelPoint& b, const shader::VoxelPoint& c,
                 float delta) noexcept
        : x_{a.x, b.x, c.x}, y_{a.y, b.y, c.y}, z_{a.z, b.z, c.z}, delta_(delta) {}

    explicit TriangleHull(const shader::CertifiedTriangle& of) noexcept
        : TriangleHull(of.corner0, of.corner1, of.corner2, of.delta) {}

    /// Valid as long as this.
    [[nodiscard]] PointHull hull() const noexcept {
        const auto least = [](const auto& of) { return std::min(of[0], std::min(of[1], of[2])); };
        const auto most = [](const auto& of) { return std::max(of[0], std::max(of[1], of[2])); };
        return {x_.data(),
                y_.data(),
                z_.data(),
                x_.size(),
                {least(x_), least(y_), least(z_)},
                {most(x_), most(y_), most(z_)},
                delta_};
    }

  private:
    std::array<float, 3> x_;
    std::array<float, 3> y_;
    std::array<float, 3> z_;
    float delta_;
};

/// Tests a cell once for all triangles in a hull, each of which may be far smaller than the cell: false if none of
/// their fragments there has an opaque point, as certifiedSettle() would find for each of them. `cell` is that of the
/// hull's delta, at (x, y, z).
[[nodiscard]] bool hullMayMeet(const shader::OpaqueValues& opaque, const PointHull& hull,
                               const shader::CertifiedCell& cell, std::int32_t x, std::int32_t y,
                               std::int32_t z) noexcept;
/// Second half of that test: by the interpolant's linear part, after certifiedPartMayBeOpaque().
[[nodiscard]] bool hullMayMeetLinearly(const shader::OpaqueValues& opaque, const PointHull& hull,
                                       const shader::CertifiedCell& cell, std::int32_t x, std::int32_t y,
                                       std::int32_t z) noexcept;

/// Some cells of a small box, a bit for each.
class CellSet {
  public:
    static constexpr std::int32_t kMost = 64;

    /// Returns true if a box is small enough.
    [[nodiscard]] bool begin(const CellBox& box) noexcept {
        box_ = box;
        bits_ = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            size_[axis] = box.hi[axis] - box.lo[axis] + 1;
        }
        return size_[0] <= kMost && size_[1] <= kMost && size_[2] <= kMost && size_[0] * size_[1] * size_[2] <= kMost;
    }
    /// Expects a cell of the box. Returns its place, below kMost.
    std::size_t add(std::int32_t x, std::int32_t y, std::int32_t z) noexcept {
        const std::int32_t at = place(x, y, z);
        bits_ |= std::uint64_t{1} << at;
        return static_cast<std::size_t>(at);
    }
    [[nodiscard]] bool empty() const noexcept { return bits_ == 0; }
    /// Calls `visit(place)` for all, in order.
    template <class Visit> void forPlaces(const Visit& visit) const {
        for (std::uint64_t left = bits_; left != 0; left &= left - 1) {
            visit(static_cast<std::size_t>(std::countr_zero(left)));
        }
    }
    /// Calls `visit(x, y, z, number)` for those that are in a box within that of begin(), as long as `goesOn()`;
    /// `number` is how many places before it are in the set.
    template <class GoesOn, class Visit>
    void forEach(const CellBox& box, const GoesOn& goesOn, const Visit& visit) const {
        const std::uint64_t columns = (std::uint64_t{2} << (box.hi[0] - box.lo[0])) - 1;
        for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
            for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
                const std::int32_t first = place(box.lo[0], y, z);
                for (std::uint64_t row = bits_ >> first & columns; row != 0 && goesOn(); row &= row - 1) {
                    const std::int32_t ahead = std::countr_zero(row);
                    const std::uint64_t before = (std::uint64_t{1} << (first + ahead)) - 1;
                    visit(box.lo[0] + ahead, y, z, static_cast<std::size_t>(std::popcount(bits_ & before)));
                }
            }
        }
    }

  private:
    [[nodiscard]] std::int32_t place(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
        return x - box_.lo[0] + size_[0] * (y - box_.lo[1] + size_[1] * (z - box_.lo[2]));
    }

    CellBox box_;
    std::array<std::int32_t, 3> size_{};
    std::uint64_t bits_ = 0;
};

} // namespace voxtact::cpu
