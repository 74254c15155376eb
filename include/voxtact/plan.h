// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/distance.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// Straight insertion paths: plain types, the same for every engine.
///
/// An instrument moves straight from an entry to a target: its tip follows the line between them, and its axis lies on
/// that line. A path is safe if the volume swept by the instrument keeps its distance from the obstacles.
namespace voxtact {

/// A solid round shaft with round ends: all points within half the diameter of a segment of its axis. The segment
/// begins half a diameter behind the tip.
struct Needle {
    double diameter = 2; ///< mm, above 0
    double length = 200; ///< mm, from tip to end; at least the diameter
};

/// Maximum number of directions from a target: 10 n^2 + 2 for n = 632.
inline constexpr std::uint32_t kMaxEntries = 3994242;
/// Default maximum distance, mm: larger distances of a path are not measured.
inline constexpr double kDefaultPlanMaximum = 10;
/// Default tolerance, mm: maximum upper - lower of a path.
inline constexpr double kDefaultPlanTolerance = 0.05;

/// Minimum distance of an entry from the target, mm.
inline constexpr double kNearestEntry = 1e-3;

/// Verdict on a path.
enum class Safety : std::uint32_t {
    Unsafe,    ///< its distance from an obstacle is at most the margin
    Safe,      ///< its distance from all obstacles exceeds the margin along the whole path
    Undecided, ///< not proven, because of rounding or the iteration limit
};
/// Returns "unsafe", "safe" or "undecided", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Safety safety) noexcept;

/// The obstacle that is nearest to a path.
struct NearestObstacle {
    std::uint32_t obstacle = 0; ///< index in the question
    std::int32_t label = 0;     ///< label at `position` in the obstacle's label map; 0 if there is none
    Vec3 position{};            ///< a point of the obstacle, world mm
    Vec3 onPath{};              ///< nearest point of the needle's axis or the mesh's surface; world mm
};

/// One path.
struct PlannedPath {
    std::uint32_t entry = 0;                ///< index of the direction of the path
    Vec3 position{};                        ///< entry point, world mm
    double length = 0;                      ///< mm, from the entry to the target
    std::optional<double> angle;            ///< degrees between the path and the normal of the entry surface
    Safety safety = Safety::Undecided;      ///< for the whole path
    Bounds clearance;                       ///< distance from the obstacles, mm; 0 if the path touches
    StopReason end{};                       ///< why the search stopped
    std::optional<NearestObstacle> nearest; ///< if clearance.upper is finite
};

/// A triangle between the entries of neighbouring directions, outward counter-clockwise.
struct EntryTriangle {
    std::array<std::uint32_t, 3> paths{}; ///< indices into PlanAnswer::paths
    /// Every path from this triangle to the target certainly keeps more than the margin from the obstacles.
    bool safe = false;
    /// mm, with Plan::triangleDistances: lower bound of the distance of every path from this triangle; at most
    /// Plan::maximum.
    double clearance = 0;
};

/// The answer to a plan.
struct PlanAnswer {
    std::vector<PlannedPath> paths;       ///< in the order of the directions
    std::vector<EntryTriangle> triangles; ///< between three neighbouring directions with an entry
    double area = 0;                      ///< mm^2 of all triangles
    double safeArea = 0;                  ///< mm^2 of the safe triangles
    std::uint32_t directions = 0;         ///< directions that were tested
    std::uint32_t noSurface = 0;          ///< directions without a surface to enter through
    std::uint32_t onBorder = 0;   ///< of the others, entries at the image's border (EntrySurface::borderEntries)
    std::uint32_t tooLong = 0;    ///< of the others, paths longer than the maximum
    std::uint32_t tooOblique = 0; ///< of the others, paths at an angle above the maximum, or without a normal
    double wallMilliseconds = 0;  ///< duration of the whole call
};

/// Returns the labels that a straight line crosses, in order from `from` to `to`, each once, without 0. Uses the voxels
/// that contain the line (labelAt()); voxels that the line only grazes may be missing. If both ends are far away, a
/// line at an angle to the axes is as precise as the doubles of its ends. Refuses ends that are not finite, or whose
/// voxel coordinates exceed half of the largest double, and a grid that checkGrid() refuses. Otherwise expects a map
/// that makeLabels() returned.
[[nodiscard]] VOXTACT_API Result<std::vector<std::int32_t>> labelsAlong(const LabelData& labels, const Vec3& from,
                                                                        const Vec3& to);

} // namespace voxtact
