// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/area.h"
#include "voxtact/distance.h"
#include "voxtact/overlap.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Distance, contact area and overlap of each mesh, measured by the host engine together with the answer.
namespace voxtact::view {

struct MeshMeasures {
    std::size_t mesh = 0; ///< its number in Sources::meshes
    PairDistance pair;
    std::optional<PairArea> area{};       ///< measured after the distance
    std::optional<PairOverlap> overlap{}; ///< measured after the area; empty for a mesh without an inside
};

struct LiveMeasures {
    std::uint64_t revision = 0;       ///< of the question
    std::vector<MeshMeasures> meshes; ///< in the order of the question
    double milliseconds = 0;          ///< duration of all, wall clock

    /// Distances of a mesh, by its index. Null if it was not measured.
    [[nodiscard]] const MeshMeasures* of(std::size_t mesh) const noexcept;
    /// True if areas exist.
    [[nodiscard]] bool hasAreas() const noexcept;
};

/// Bounds of a length or an area, mm or mm^2, rounded down and up: the printed bounds hold.
[[nodiscard]] std::string lowerText(double mm);
[[nodiscard]] std::string upperText(double mm);

/// "12.34 to 12.35 mm away", "touches", "820.05 to 820.15 mm² touch", "nothing is opaque".
[[nodiscard]] std::string measuresText(const MeshMeasures& measured);

/// "33.42 to 33.51 mm³ inside, at least 24 %", of the mesh; empty if none was measured.
[[nodiscard]] std::string overlapText(const MeshMeasures& measured);

/// The two closest points, on the mesh and in the opaque region; empty if it touches, or nothing is opaque.
[[nodiscard]] std::optional<std::array<Vec3, 2>> closestSegment(const PairDistance& pair) noexcept;

/// Returns the distance in mm from a plane perpendicular to a world axis to the nearer end of a segment; 0 if it
/// crosses the plane.
[[nodiscard]] double distanceOfPlane(const std::array<Vec3, 2>& segment, std::size_t axis, double at) noexcept;

} // namespace voxtact::view
