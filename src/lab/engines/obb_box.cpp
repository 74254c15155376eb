// SPDX-License-Identifier: MIT
#include "lab/engines/obb_tree.h"

#include <cmath>

namespace voxtact {

namespace {

/// Of the sums below, relative to the sum of the magnitudes of what goes into them: some thirty roundings of 2^-53.
constexpr double kError = 0x1p-46;
/// Beside what underflows.
constexpr double kTiny = 1e-290;

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A parallelepiped and a box along the axes, relative to the box's centre.
struct Meeting {
    Vec3 offset{};               ///< from the box's centre to the parallelepiped's
    std::array<Vec3, 3> edges{}; ///< half of them
    Vec3 half{};                 ///< of the box
    Vec3 magnitude{};            ///< along each axis, of everything that went into these

    Meeting(const ObbNode& node, const Mat4& texture_from_object, const Box& box) {
        for (std::size_t row = 0; row < 3; ++row) {
            double at = texture_from_object[12 + row];
            double size = std::abs(at) + std::abs(box.lo[row]) + std::abs(box.hi[row]);
            for (std::size_t column = 0; column < 3; ++column) {
                const double element = texture_from_object[4 * column + row];
                at += element * node.centre[column];
                size += std::abs(element * node.centre[column]);
                for (std::size_t i = 0; i < 3; ++i) {
                    const double term = element * (node.half[i] * node.axes[i][column]);
                    edges[i][row] += term;
                    size += std::abs(term);
                }
            }
            offset[row] = at - (box.lo[row] / 2 + box.hi[row] / 2);
            half[row] = box.hi[row] / 2 - box.lo[row] / 2;
            magnitude[row] = size;
        }
    }

    /// Whether a plane across `axis`, whose own rounding does not matter, is certainly between them.
    [[nodiscard]] bool separatedAlong(const Vec3& axis) const {
        double distance = 0;
        double reach = kTiny;
        for (std::size_t row = 0; row < 3; ++row) {
            distance += axis[row] * offset[row];
            reach += std::abs(axis[row]) * (half[row] + kError * magnitude[row]);
        }
        for (const Vec3& edge : edges) {
            reach += std::abs(axis[0] * edge[0] + axis[1] * edge[1] + axis[2] * edge[2]);
        }
        return std::abs(distance) > reach;
    }
};

} // namespace

bool obbMeetsBox(const ObbNode& node, const Mat4& texture_from_object, const Box& box) noexcept {
    constexpr std::array<Vec3, 3> kUnit{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const Meeting meeting(node, texture_from_object, box);
    for (std::size_t i = 0; i < 3; ++i) {
        if (meeting.separatedAlong(kUnit[i]) ||
            meeting.separatedAlong(cross(meeting.edges[(i + 1) % 3], meeting.edges[(i + 2) % 3]))) {
            return false;
        }
    }
    for (const Vec3& unit : kUnit) {
        for (const Vec3& edge : meeting.edges) {
            if (meeting.separatedAlong(cross(unit, edge))) {
                return false;
            }
        }
    }
    return true;
}

} // namespace voxtact
