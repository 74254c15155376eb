// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/distance.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// Which straight paths: plain types, the same for whatever plans.
///
/// An instrument goes straight from an entry to a target: its tip moves from the one to the other, and its axis lies on
/// that line all the time. What it sweeps on the way keeps its distance from what must not be touched, or it does not.
namespace voxtact {

/// A round shaft with round ends, solid: all points within half the diameter of a piece of its axis. The piece begins
/// half a diameter behind the tip.
struct Needle {
    double diameter = 2; ///< mm, above 0
    double length = 200; ///< mm, from the tip to the other end; at least the diameter
};

/// Directions from a target, and entries, at most: 10 n^2 + 2 for n = 632.
inline constexpr std::uint32_t kMaxEntries = 3994242;
/// mm: what is farther from a path is not measured, where nothing else is asked for.
inline constexpr double kDefaultPlanMaximum = 10;
/// mm: how near to each other the bounds of a path are brought, where nothing else is asked for.
inline constexpr double kDefaultPlanTolerance = 0.05;

/// mm: no entry is as near to the target as that.
inline constexpr double kNearestEntry = 1e-3;

/// What is certain of a path.
enum class Safety : std::uint32_t {
    Unsafe,    ///< it comes as near to something as the margin, or touches it
    Safe,      ///< it keeps more than the margin from everything, all the way
    Undecided, ///< neither could be shown: roundings decide, or the steps that were allowed are used up
};
/// "unsafe", "safe" or "undecided"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Safety safety) noexcept;

/// What a path comes nearest to.
struct NearestObstacle {
    std::uint32_t obstacle = 0; ///< number in the task
    std::int32_t label = 0;     ///< of the obstacle's label map at `position`; 0 where it has none
    Vec3 position{};            ///< a point of it, world mm
    Vec3 onPath{};              ///< the nearest of the needle's axis, or of the mesh's surface on its way; world mm
};

/// One path.
struct PlannedPath {
    std::uint32_t entry = 0;                ///< number of its direction
    Vec3 position{};                        ///< of the entry, world mm
    double length = 0;                      ///< mm, from the entry to the target
    std::optional<double> angle;            ///< degrees between it and the normal of the entry's surface
    Safety safety = Safety::Undecided;      ///< of the whole way
    Bounds clearance;                       ///< mm, of the whole way: 0 where it touches
    StopReason end{};                       ///< why these are no nearer to each other
    std::optional<NearestObstacle> nearest; ///< where clearance.upper is finite
};

/// A triangle between the entries of neighbouring directions, outward counter-clockwise.
struct EntryTriangle {
    std::array<std::uint32_t, 3> paths{}; ///< places in PlanAnswer::paths
    /// Every path from any point of this triangle to the target certainly keeps more than the margin, not only those
    /// from its corners.
    bool safe = false;
    /// mm, where PlanTask::triangleDistances asks for it: every path from any point of this triangle certainly keeps
    /// at least so much; no more than PlannerDesc::maximum.
    double clearance = 0;
};

/// What a plan gave.
struct PlanAnswer {
    std::vector<PlannedPath> paths;       ///< in the order of the directions
    std::vector<EntryTriangle> triangles; ///< where three neighbouring directions have an entry
    double area = 0;                      ///< mm2 of all triangles
    double safeArea = 0;                  ///< mm2 of the safe ones
    std::uint32_t directions = 0;         ///< that were looked along
    std::uint32_t noSurface = 0;          ///< of them, those along which there is no surface to enter through
    std::uint32_t onBorder = 0;   ///< of the others, those where the image ends, or ends in air that is enclosed
                                  ///< there (EntrySurface::borderEntries)
    std::uint32_t tooLong = 0;    ///< of the others, those that are longer than the maximum
    std::uint32_t tooOblique = 0; ///< of the others, those at a larger angle than the maximum, or at none
    double wallMilliseconds = 0;  ///< of the whole call
};

/// The label values that a straight line crosses, in order from `from` to `to`, each once; 0 is left out. By the voxels
/// that the line is in (labelAt()); those that it only grazes may be missing. Where both ends are far away, a line at
/// an angle to the axes is known only as precisely as doubles hold its ends. Refuses ends that are not finite, or
/// further away than half of the largest double, in voxels, and a grid that checkGrid() refuses. Expects what
/// makeLabels() returns otherwise.
[[nodiscard]] VOXTACT_API Result<std::vector<std::int32_t>> labelsAlong(const LabelData& labels, const Vec3& from,
                                                                        const Vec3& to);

} // namespace voxtact
