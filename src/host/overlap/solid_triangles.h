// SPDX-License-Identifier: MIT
#pragma once

#include "host/overlap/triangle_pair.h"
#include "host/scene/scene_impl.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace voxtact::cpu {

/// A box of object space.
struct SolidBox {
    glm::dvec3 lo{};
    glm::dvec3 hi{};

    [[nodiscard]] bool meets(const SolidBox& other) const noexcept {
        return lo.x <= other.hi.x && lo.y <= other.hi.y && lo.z <= other.hi.z && hi.x >= other.lo.x &&
               hi.y >= other.lo.y && hi.z >= other.lo.z;
    }
};

/// Directions of rays, at odd angles, so that hardly one meets an edge.
inline constexpr std::array<std::array<double, 3>, 12> kRays{{{0.8191, 0.4717, 0.3265},
                                                              {-0.4331, 0.7877, 0.4380},
                                                              {0.2713, -0.5179, 0.8113},
                                                              {-0.6971, -0.3593, -0.6203},
                                                              {0.3371, 0.2297, -0.9129},
                                                              {-0.1373, -0.9419, -0.3067},
                                                              {0.9557, -0.1091, 0.2731},
                                                              {0.0919, 0.9871, -0.1307},
                                                              {-0.9029, 0.1931, 0.3833},
                                                              {0.5303, -0.7433, -0.4073},
                                                              {-0.2399, 0.3467, -0.9067},
                                                              {0.6113, 0.6703, 0.4201}}};
/// Returns true if a ray may meet a box.
[[nodiscard]] bool mayMeet(const glm::dvec3& origin, const glm::dvec3& direction, const SolidBox& box) noexcept;

/// The triangles of a mesh with welded vertices, by their places in its arrays. Of triangles with the same vertices the
/// first one stands for all.
class SolidTriangles {
  public:
    explicit SolidTriangles(const MeshImpl& mesh);

    [[nodiscard]] std::size_t count() const noexcept { return triangles_.size(); }
    [[nodiscard]] const SolidTriangle& at(std::size_t place) const noexcept { return triangles_[place]; }
    /// Increase of the winding number from front to back. 0: ignored, or padding.
    [[nodiscard]] int weight(std::size_t place) const noexcept { return weights_[place]; }
    [[nodiscard]] SolidBox box(std::size_t place) const noexcept;
    /// Returns the vertices of all triangles, three each.
    [[nodiscard]] std::vector<std::uint32_t> indices() const;
    /// Calls `visit(place)` for triangles with a weight in runs whose boxes `keep(SolidBox)` keeps, until it returns
    /// false.
    template <class Keep, class Visit> void descend(const Keep& keep, const Visit& visit) const {
        mesh_.tree.descend(
            0, static_cast<std::uint32_t>(mesh_.clusters.size()),
            [&](const RunBox& box) {
                return keep(SolidBox{toPoint(box.lo), toPoint(box.hi)});
            },
            [&](std::uint32_t run) {
                const std::uint32_t first = mesh_.clusters[run / ClusterTree::kRunsOfCluster].firstTriangle +
                                            run % ClusterTree::kRunsOfCluster * kRunTriangles;
                for (std::uint32_t i = 0; i < kRunTriangles && mesh_.numbers[first + i] != kNoTriangle; ++i) {
                    if (weights_[first + i] != 0 && !visit(std::size_t{first} + i)) {
                        return false;
                    }
                }
                return true;
            });
    }
    /// Returns the winding number in front of a point of a triangle, on the side of its normal; empty if rounding hides
    /// it. `stack`: triangles that the point is on; `weight`: of these together, by the normal.
    [[nodiscard]] std::optional<int> windingInFront(std::size_t place, const glm::dvec3& point,
                                                    std::span<const std::size_t> stack, int weight) const;

  private:
    static glm::dvec3 toPoint(const std::array<float, 3>& from) noexcept {
        return {static_cast<double>(from[0]), static_cast<double>(from[1]), static_cast<double>(from[2])};
    }
    void setWeights();
    [[nodiscard]] std::optional<int> windingAlong(const glm::dvec3& origin, const glm::dvec3& direction,
                                                  std::span<const std::size_t> stack) const;

    const MeshImpl& mesh_;
    std::vector<SolidTriangle> triangles_;
    std::vector<int> weights_;
};

} // namespace voxtact::cpu
