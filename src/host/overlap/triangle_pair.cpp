// SPDX-License-Identifier: MIT
#include "host/overlap/triangle_pair.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// Relative to the product of the lengths: two cross products and a dot product round less.
constexpr double kAxisError = 0x1p-46;

/// A direction, and the product of the lengths that it was made of.
struct Axis {
    dvec3 along{};
    double scale = 0;

    /// Returns the certain sign of a point's product with it, or 0. `slack`: error of the product in addition to
    /// rounding.
    [[nodiscard]] int sign(const dvec3& point, double slack = 0) const noexcept {
        const double product = glm::dot(along, point);
        const double error = kAxisError * scale * glm::length(point) + slack;
        return product > error ? 1 : (product < -error ? -1 : 0);
    }
};

Axis crossed(const dvec3& a, const dvec3& b) noexcept {
    return {glm::cross(a, b), glm::length(a) * glm::length(b)};
}

Axis crossed(const Axis& a, const dvec3& b) noexcept {
    return {glm::cross(a.along, b), a.scale * glm::length(b)};
}

using CornersOf3 = std::array<dvec3, 3>;

/// Returns true if a plane perpendicular to the axis separates both.
bool separates(const Axis& axis, const CornersOf3& a, const CornersOf3& b) noexcept {
    std::array<double, 3> ofA{};
    std::array<double, 3> ofB{};
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        ofA[i] = glm::dot(axis.along, a[i]);
        ofB[i] = glm::dot(axis.along, b[i]);
        longest = std::max({longest, glm::length(a[i]), glm::length(b[i])});
    }
    const auto [leastA, greatestA] = std::ranges::minmax(ofA);
    const auto [leastB, greatestB] = std::ranges::minmax(ofB);
    return std::max(leastB - greatestA, leastA - greatestB) > 4 * kAxisError * axis.scale * longest;
}

CornersOf3 sidesOf(const CornersOf3& corners) noexcept {
    return {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
}

/// The separating axis theorem; the normals of sides in the plane are for triangles in one plane.
bool noneShared(const CornersOf3& a, const CornersOf3& b) noexcept {
    const CornersOf3 sidesA = sidesOf(a);
    const CornersOf3 sidesB = sidesOf(b);
    const Axis normalA = crossed(sidesA[0], sidesA[1]);
    const Axis normalB = crossed(sidesB[0], sidesB[1]);
    if (separates(normalA, a, b) || separates(normalB, a, b)) {
        return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (separates(crossed(sidesA[i], sidesB[j]), a, b)) {
                return true;
            }
        }
        if (separates(crossed(normalA, sidesA[i]), a, b) || separates(crossed(normalB, sidesB[i]), a, b)) {
            return true;
        }
    }
    return false;
}

/// Tests whether a plane through the origin separates two directions from two others, by a perceptron.
bool divides(const std::array<dvec3, 2>& a, const std::array<dvec3, 2>& b) noexcept {
    constexpr int kRounds = 64;
    constexpr double kClear = 0x1p-30;
    const std::array<dvec3, 4> directions{glm::normalize(a[0]), glm::normalize(a[1]), -glm::normalize(b[0]),
                                          -glm::normalize(b[1])};
    dvec3 normal = directions[0] + directions[1] + directions[2] + directions[3];
    for (int round = 0; round < kRounds; ++round) {
        std::size_t worst = 0;
        double least = glm::dot(normal, directions[0]);
        for (std::size_t i = 1; i < 4; ++i) {
            const double product = glm::dot(normal, directions[i]);
            if (product < least) {
                least = product;
                worst = i;
            }
        }
        if (least > kClear * glm::length(normal)) {
            return true;
        }
        normal += directions[worst];
    }
    return false;
}

/// Two cones from a common vertex, by their sides.
bool vertexShared(const std::array<dvec3, 2>& a, const std::array<dvec3, 2>& b) noexcept {
    const auto sameSide = [](const Axis& axis, const std::array<dvec3, 2>& of) {
        const int first = axis.sign(of[0]);
        return first != 0 && first == axis.sign(of[1]) ? first : 0;
    };
    const Axis normalA = crossed(a[0], a[1]);
    const Axis normalB = crossed(b[0], b[1]);
    if (sameSide(normalA, b) != 0 || sameSide(normalB, a) != 0) {
        return true;
    }
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            const Axis axis = crossed(a[i], b[j]); // both are in its plane
            if (axis.sign(a[1 - i]) * axis.sign(b[1 - j]) < 0) {
                return true;
            }
        }
        const Axis edgeNormalA = crossed(normalA, a[i]);
        const Axis edgeNormalB = crossed(normalB, b[i]);
        if (edgeNormalA.sign(a[1 - i]) * sameSide(edgeNormalA, b) < 0 ||
            edgeNormalB.sign(b[1 - i]) * sameSide(edgeNormalB, a) < 0) {
            return true;
        }
    }
    return divides(a, b);
}

/// Two triangles on a common side from the origin, by their other corners.
bool sideShared(const dvec3& side, const dvec3& a, const dvec3& b) noexcept {
    const Axis normal = crossed(side, a);
    if (normal.sign(b) != 0) {
        return true;
    }
    const Axis sideNormal = crossed(normal, side);
    return sideNormal.sign(a) * sideNormal.sign(b) < 0;
}

} // namespace

bool certainlyApart(const SolidTriangle& a, const SolidTriangle& b) noexcept {
    std::array<std::size_t, 3> sharedA{};
    std::array<std::size_t, 3> sharedB{};
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto at = std::ranges::find(b.vertices, a.vertices[i]);
        if (at != b.vertices.end()) {
            sharedA[shared] = i;
            sharedB[shared++] = static_cast<std::size_t>(at - b.vertices.begin());
        }
    }
    const dvec3 origin = a.corners[shared > 0 ? sharedA[0] : 0];
    CornersOf3 ofA{};
    CornersOf3 ofB{};
    for (std::size_t i = 0; i < 3; ++i) {
        ofA[i] = a.corners[i] - origin;
        ofB[i] = b.corners[i] - origin;
    }
    if (shared == 0) {
        return noneShared(ofA, ofB);
    }
    const std::size_t i = sharedA[0];
    const std::size_t j = sharedB[0];
    if (shared == 1) {
        return vertexShared({ofA[(i + 1) % 3], ofA[(i + 2) % 3]}, {ofB[(j + 1) % 3], ofB[(j + 2) % 3]});
    }
    return shared == 2 && sideShared(ofA[sharedA[1]], ofA[3 - i - sharedA[1]], ofB[3 - j - sharedB[1]]);
}

Crossing crossingOf(const std::array<dvec3, 3>& corners, const dvec3& direction, double off) noexcept {
    // A cross product of two corners changes by at most (|a| + |b| + off) * off, and a determinant of all three by less
    // than off times the square of the sum.
    const double lengths = glm::length(corners[0]) + glm::length(corners[1]) + glm::length(corners[2]) + off;
    const double slack = off * lengths * glm::length(direction) * (1 + 0x1p-40);
    std::array<int, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i) {
        sides[i] = crossed(corners[i], corners[(i + 1) % 3]).sign(direction, slack);
    }
    const auto [least, greatest] = std::ranges::minmax(sides);
    if (least < 0 && greatest > 0) {
        return Crossing::No;
    }
    const Axis normal = crossed(corners[1] - corners[0], corners[2] - corners[0]);
    const int away = normal.sign(corners[0], off * lengths * lengths); // of the plane, along the normal
    const int along = normal.sign(direction, 3 * slack);
    if (away * along < 0) {
        return Crossing::No;
    }
    if (least * greatest <= 0 || away == 0 || along == 0) {
        return Crossing::Unknown;
    }
    return along > 0 ? Crossing::Leaves : Crossing::Enters;
}

} // namespace voxtact::cpu
