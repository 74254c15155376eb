// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/area.h"
#include "voxtact/distance.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// How near each mesh is, and how much of it touches, as the host measures it together with the answer.
namespace voxtact::view {

struct MeshClearance {
    std::size_t mesh = 0; ///< its number in Sources::meshes
    PairDistance pair;
    std::optional<PairArea> area; ///< measured after the clearance
};

struct LiveClearance {
    std::uint64_t revision = 0;        ///< of the question
    std::vector<MeshClearance> meshes; ///< in the order of the question
    double milliseconds = 0;           ///< of all of it, wall clock

    /// Of a mesh by its number. Null where it was not asked about.
    [[nodiscard]] const MeshClearance* of(std::size_t mesh) const noexcept;
    /// Whether there are areas, too.
    [[nodiscard]] bool hasAreas() const noexcept;
};

/// Bounds of a length or an area, so many mm or mm^2, rounded down and up: they hold as they are read.
[[nodiscard]] std::string lowerText(double mm);
[[nodiscard]] std::string upperText(double mm);

/// "12.34 to 12.35 mm away", "touches", "820.05 to 820.15 mm² touch", "nothing is opaque".
[[nodiscard]] std::string clearanceText(const MeshClearance& clearance);

/// The two closest points, on the mesh and in what is opaque; nothing where it touches, or nothing is opaque.
[[nodiscard]] std::optional<std::array<Vec3, 2>> closestSegment(const PairDistance& clearance) noexcept;

/// mm from a plane at right angles to an axis of the world to the nearer end of a segment; 0 where it goes through.
[[nodiscard]] double distanceOfPlane(const std::array<Vec3, 2>& segment, std::size_t axis, double at) noexcept;

} // namespace voxtact::view
