// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "host/scene/scene_impl.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>

namespace voxtact::cpu {

/// Error bound of a computed distance, mm.
struct DistanceError {
    /// Relative to the distance: the last roundings, which do not depend on positions.
    static constexpr double kRelative = 0x1p-40;

    [[nodiscard]] double below(double distance) const noexcept {
        return std::max(0.0, distance * (1 - kRelative) - absolute);
    }
    [[nodiscard]] double above(double distance) const noexcept { return distance * (1 + kRelative) + absolute; }

    double absolute = 0;
};

/// Result of a search. Distances in mm.
struct Found {
    double lo = kInfinity;                ///< no opaque point is nearer
    double hi = kInfinity;                ///< an opaque point is at most this far
    bool exhausted = false;               ///< maxSteps ended it
    std::uint32_t triangle = kNoTriangle; ///< the closest one, by its place in the mesh's arrays; with hi finite
    glm::dvec3 onMesh{};                  ///< local
    glm::dvec3 inVolume{};
    bool isOpaque = false; ///< inVolume is: not only some point about there
    std::uint64_t steps = 0;

    /// Offers an opaque point at this distance from a triangle: near `volume`, or exactly there if `opaque`, and near
    /// `mesh` on the triangle.
    void offer(double distance, std::uint32_t number, const glm::dvec3& mesh, const glm::dvec3& volume,
               bool opaque) noexcept {
        if (distance < hi) {
            hi = distance;
            isOpaque = opaque;
            triangle = number;
            onMesh = mesh;
            inVolume = volume;
        }
    }
};

} // namespace voxtact::cpu
