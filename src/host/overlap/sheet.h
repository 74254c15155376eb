// SPDX-License-Identifier: MIT
#pragma once

#include "host/overlap/solid_surface.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// A convex piece of the solid's surface, padded voxel coordinates: cell p of core/volume/bricks.h is from p to p + 1.
struct Sheet {
    /// A triangle that is cut to a box has 9 corners; the rest is for roundings.
    static constexpr std::uint32_t kMax = 16;

    std::array<glm::dvec3, kMax> corners; // uninitialised, to save time
    std::uint32_t count = 0;              ///< below 3: it is empty
    /// What the winding of the solid (1 inside, 0 outside) changes by behind it along +x, times the sign of its area in
    /// y and z; or kUnknownJump.
    Jump jump = 0;

    [[nodiscard]] bool empty() const noexcept { return count < 3; }
    /// Signed, by y and z.
    [[nodiscard]] double area() const noexcept;
    /// Returns the signed volume between the sheet and a plane across x.
    [[nodiscard]] double volumeTo(double x) const noexcept;
    void range(int axis, double& lo, double& hi) const noexcept;
    /// Moves parts before a plane across x onto it.
    void flatten(double x) noexcept;
    /// Moves all of it onto that plane.
    void setX(double x) noexcept {
        for (std::uint32_t i = 0; i < count; ++i) {
            corners[i].x = x;
        }
    }
};

/// Cuts a sheet at a plane across an axis; new corners are on the plane exactly. Without room for corners either half
/// is the box around it, with an unknown jump.
void cut(const Sheet& sheet, int axis, double at, Sheet& below, Sheet& above) noexcept;

/// Sheets one behind the other.
class SheetList {
  public:
    void clear() noexcept {
        corners_.clear();
        heads_.clear();
    }
    void add(const Sheet& sheet) {
        heads_.push_back(
            {static_cast<std::uint32_t>(corners_.size()), static_cast<std::uint8_t>(sheet.count), sheet.jump});
        corners_.insert(corners_.end(), sheet.corners.begin(), sheet.corners.begin() + sheet.count);
    }
    [[nodiscard]] std::size_t count() const noexcept { return heads_.size(); }
    void get(std::size_t number, Sheet& sheet) const noexcept {
        const Head& head = heads_[number];
        sheet.count = head.count;
        sheet.jump = head.jump;
        for (std::uint32_t i = 0; i < head.count; ++i) {
            sheet.corners[i] = corners_[head.first + i];
        }
    }

  private:
    struct Head {
        std::uint32_t first = 0;
        std::uint8_t count = 0;
        Jump jump = 0;
    };
    std::vector<glm::dvec3> corners_;
    std::vector<Head> heads_;
};

} // namespace voxtact::cpu
