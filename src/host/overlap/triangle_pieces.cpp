// SPDX-License-Identifier: MIT
#include "host/overlap/triangle_pieces.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

constexpr std::size_t kMaxPieces = 2048;
/// Tolerance of a plane, relative to the lengths in a height.
constexpr double kInPlane = 0x1p-44;

struct Plane {
    dvec3 point{};
    dvec3 normal{}; ///< of length 1, or 0
};

Plane planeThrough(const dvec3& point, const dvec3& normal) {
    const double length = glm::length(normal);
    return {point, length > 0 ? normal / length : dvec3(0)};
}

/// A triangle that is cut.
class PieceCut {
  public:
    PieceCut(const SolidTriangles& triangles, std::size_t place)
        : triangles_(triangles), place_(place), corner_(triangles.at(place).corners[0]),
          side1_(triangles.at(place).corners[1] - corner_), side2_(triangles.at(place).corners[2] - corner_),
          normal_(planeThrough(corner_, glm::cross(side1_, side2_)).normal), parts_{UvPolygon::whole()} {
        size_ = glm::length(side1_) + glm::length(side2_);
    }

    [[nodiscard]] bool cutBy(std::size_t other) {
        const auto& corners = triangles_.at(other).corners;
        const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (isCoplanar(other)) {
            for (std::size_t i = 0; i < 3; ++i) {
                cutAt(planeThrough(corners[i], glm::cross(normal_, corners[(i + 1) % 3] - corners[i])), other);
            }
        } else {
            cutAt(planeThrough(corners[0], normal), other);
        }
        return parts_.size() <= kMaxPieces;
    }

    /// Returns true if another triangle lies completely in the plane of this one.
    [[nodiscard]] bool isCoplanar(std::size_t other) const {
        return std::ranges::all_of(triangles_.at(other).corners, [&](const dvec3& corner) {
            const dvec3 off = corner - corner_;
            return std::abs(glm::dot(normal_, off)) <= kInPlane * (glm::length(off) + size_);
        });
    }

    void addTo(std::span<const std::size_t> others, std::vector<SolidPiece>& pieces) const {
        std::vector<std::size_t> coplanar;
        std::ranges::copy_if(others, std::back_inserter(coplanar),
                             [&](std::size_t other) { return isCoplanar(other); });
        for (const UvPolygon& part : parts_) {
            const Jump jump = jumpOf(part, coplanar);
            if (jump != 0) {
                pieces.push_back({static_cast<std::uint32_t>(place_), jump, part});
            }
        }
    }

  private:
    [[nodiscard]] dvec3 at(const Uv& uv) const { return corner_ + uv.u * side1_ + uv.v * side2_; }

    void cutAt(const Plane& plane, std::size_t other) {
        const double height = glm::dot(plane.normal, corner_ - plane.point);
        const double along1 = glm::dot(plane.normal, side1_);
        const double along2 = glm::dot(plane.normal, side2_);
        const double slack = kInPlane * (glm::length(corner_ - plane.point) + size_);
        std::vector<UvPolygon> left = std::move(parts_);
        parts_.clear();
        while (!left.empty()) {
            const UvPolygon part = left.back();
            left.pop_back();
            Heights heights{};
            double least = 0;
            double greatest = 0;
            for (std::uint32_t i = 0; i < part.count; ++i) {
                heights[i] = height + part.corners[i].u * along1 + part.corners[i].v * along2;
                least = std::min(least, heights[i]);
                greatest = std::max(greatest, heights[i]);
            }
            if (least >= -slack || greatest <= slack || !mayMeet(part, other)) {
                parts_.push_back(part);
                continue;
            }
            UvPolygon below;
            UvPolygon above;
            const bool isCut = split(part, heights, slack, below, above);
            if (!isCut) { // no room for more corners
                std::tie(below, above) = halvesOf(part);
            }
            for (const UvPolygon& half : {below, above}) {
                if (!half.empty()) {
                    (isCut ? parts_ : left).push_back(half);
                }
            }
        }
    }

    /// Divides a polygon between two of its corners.
    static std::pair<UvPolygon, UvPolygon> halvesOf(const UvPolygon& whole) {
        const std::uint32_t middle = whole.count / 2;
        UvPolygon first;
        UvPolygon second;
        for (std::uint32_t i = 0; i <= middle; ++i) {
            first.corners[first.count++] = whole.corners[i];
        }
        for (std::uint32_t i = middle; i < whole.count; ++i) {
            second.corners[second.count++] = whole.corners[i];
        }
        second.corners[second.count++] = whole.corners[0];
        return {first, second};
    }

    /// By their boxes.
    [[nodiscard]] bool mayMeet(const UvPolygon& part, std::size_t other) const {
        SolidBox box{at(part.corners[0]), at(part.corners[0])};
        for (std::uint32_t i = 1; i < part.count; ++i) {
            const dvec3 corner = at(part.corners[i]);
            box = {glm::min(box.lo, corner), glm::max(box.hi, corner)};
        }
        const double slack = kInPlane * (size_ + glm::length(corner_));
        return SolidBox{box.lo - slack, box.hi + slack}.meets(triangles_.box(other));
    }

    /// The first of coincident triangles has the change of all together.
    [[nodiscard]] Jump jumpOf(const UvPolygon& part, std::span<const std::size_t> coplanar) const {
        Uv mean;
        for (std::uint32_t i = 0; i < part.count; ++i) {
            mean.u += part.corners[i].u / part.count;
            mean.v += part.corners[i].v / part.count;
        }
        const dvec3 point = at(mean);
        std::vector<std::size_t> stack{place_};
        int weight = triangles_.weight(place_);
        for (const std::size_t other : coplanar) {
            if (const int side = sideOf(other, point); side != 0) {
                stack.push_back(other);
                weight += side * triangles_.weight(other);
            }
        }
        if (*std::ranges::min_element(stack) != place_) {
            return 0;
        }
        const std::optional<int> front = triangles_.windingInFront(place_, point, stack, weight);
        if (!front) {
            return kUnknownJump;
        }
        return static_cast<Jump>((*front + weight != 0 ? 1 : 0) - (*front != 0 ? 1 : 0));
    }

    /// 1 where a point of the plane is in a triangle of it that faces the same way, -1 the other way, 0 elsewhere.
    [[nodiscard]] int sideOf(std::size_t other, const dvec3& point) const {
        const auto& corners = triangles_.at(other).corners;
        const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const int facing = glm::dot(normal, normal_) > 0 ? 1 : -1;
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec3 inward = glm::cross(normal, corners[(i + 1) % 3] - corners[i]);
            if (glm::dot(inward, point - corners[i]) <= 0) {
                return 0;
            }
        }
        return facing;
    }

    const SolidTriangles& triangles_;
    std::size_t place_;
    dvec3 corner_;
    dvec3 side1_;
    dvec3 side2_;
    dvec3 normal_;
    double size_ = 0;
    std::vector<UvPolygon> parts_;
};

} // namespace

bool addPieces(const SolidTriangles& triangles, std::size_t place, std::span<const std::size_t> others,
               std::vector<SolidPiece>& pieces) {
    PieceCut cut(triangles, place);
    for (const std::size_t other : others) {
        if (!cut.cutBy(other)) {
            return false;
        }
    }
    cut.addTo(others, pieces);
    return true;
}

} // namespace voxtact::cpu
