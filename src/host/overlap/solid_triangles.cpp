// SPDX-License-Identifier: MIT
#include "host/overlap/solid_triangles.h"
#include "core/geometry/holes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// 1 if the second triangle has the vertices of the first in the same order, -1 in the other one.
int turnOf(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
    const auto at = static_cast<std::size_t>(std::ranges::find(b, a[0]) - b.begin());
    return b[(at + 1) % 3] == a[1] ? 1 : -1;
}

} // namespace

bool mayMeet(const dvec3& origin, const dvec3& direction, const SolidBox& box) noexcept {
    const auto& [lo, hi] = box;
    double from = 0;
    double to = std::numeric_limits<double>::infinity();
    const dvec3 margin = (hi - lo) * 0x1p-20 + (glm::abs(lo) + glm::abs(hi) + glm::abs(origin)) * 0x1p-40;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (lo[axis] - margin[axis] - origin[axis]) / direction[axis];
        const double b = (hi[axis] + margin[axis] - origin[axis]) / direction[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from * (1 - 0x1p-40) <= to * (1 + 0x1p-40);
}

SolidTriangles::SolidTriangles(const MeshImpl& mesh)
    : mesh_(mesh), triangles_(mesh.numbers.size()), weights_(mesh.numbers.size(), 0) {
    std::vector<float> positions;
    positions.reserve(3 * mesh.x.size());
    for (std::size_t i = 0; i < mesh.x.size(); ++i) {
        positions.insert(positions.end(), {mesh.x[i], mesh.y[i], mesh.z[i]});
    }
    const std::vector<std::uint32_t> welded = weldedVertices(std::span<const float>(positions));
    for (const ClusterPlace& place : mesh.clusters) {
        for (std::uint32_t i = 0; i < place.triangleCount; ++i) {
            const std::size_t at = std::size_t{place.firstTriangle} + i;
            const std::array<std::uint8_t, 3> corners{mesh.corner0[at], mesh.corner1[at], mesh.corner2[at]};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::size_t vertex = std::size_t{place.firstVertex} + corners[corner];
                triangles_[at].vertices[corner] = welded[vertex];
                triangles_[at].corners[corner] = toPoint({mesh.x[vertex], mesh.y[vertex], mesh.z[vertex]});
            }
        }
    }
    setWeights();
}

void SolidTriangles::setWeights() {
    struct Key {
        std::array<std::uint32_t, 3> sorted{};
        std::size_t place = 0;
    };
    std::vector<Key> keys;
    for (std::size_t place = 0; place < count(); ++place) {
        auto sorted = triangles_[place].vertices;
        std::ranges::sort(sorted);
        // Two corners that are the same: it has no area, and its sides cancel out.
        if (mesh_.numbers[place] != kNoTriangle && sorted[0] != sorted[1] && sorted[1] != sorted[2]) {
            keys.push_back({sorted, place});
        }
    }
    std::ranges::sort(keys, [](const Key& a, const Key& b) {
        return a.sorted != b.sorted ? a.sorted < b.sorted : a.place < b.place;
    });
    std::size_t first = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        first = i > 0 && keys[i].sorted == keys[i - 1].sorted ? first : i;
        weights_[keys[first].place] +=
            turnOf(triangles_[keys[first].place].vertices, triangles_[keys[i].place].vertices);
    }
}

SolidBox SolidTriangles::box(std::size_t place) const noexcept {
    const auto& corners = triangles_[place].corners;
    return {glm::min(corners[0], glm::min(corners[1], corners[2])),
            glm::max(corners[0], glm::max(corners[1], corners[2]))};
}

std::vector<std::uint32_t> SolidTriangles::indices() const {
    std::vector<std::uint32_t> out;
    for (std::size_t place = 0; place < count(); ++place) {
        if (mesh_.numbers[place] != kNoTriangle) {
            out.insert(out.end(), triangles_[place].vertices.begin(), triangles_[place].vertices.end());
        }
    }
    return out;
}

std::optional<int> SolidTriangles::windingAlong(const dvec3& origin, const dvec3& direction,
                                                std::span<const std::size_t> stack) const {
    int winding = 0;
    bool isKnown = true;
    descend([&](const SolidBox& box) { return mayMeet(origin, direction, box); },
            [&](std::size_t other) {
                if (std::ranges::find(stack, other) != stack.end()) {
                    return true;
                }
                const auto& corners = triangles_[other].corners;
                const Crossing crossing =
                    crossingOf({corners[0] - origin, corners[1] - origin, corners[2] - origin}, direction);
                const int leaves = crossing == Crossing::Leaves ? 1 : (crossing == Crossing::Enters ? -1 : 0);
                winding += leaves * weights_[other];
                isKnown = crossing != Crossing::Unknown;
                return isKnown;
            });
    return isKnown ? std::optional(winding) : std::nullopt;
}

std::optional<int> SolidTriangles::windingInFront(std::size_t place, const dvec3& point,
                                                  std::span<const std::size_t> stack, int weight) const {
    constexpr double kSteep = 0.05; // a ray at a smaller angle is not worth its trouble
    const auto& corners = triangles_[place].corners;
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    for (const auto& ray : kRays) {
        const dvec3 direction{ray[0], ray[1], ray[2]};
        const double along = glm::dot(normal, direction);
        if (std::abs(along) > kSteep * glm::length(normal)) {
            if (const std::optional<int> winding = windingAlong(point, direction, stack)) {
                return along > 0 ? *winding : *winding - weight;
            }
        }
    }
    return {};
}

} // namespace voxtact::cpu
