// SPDX-License-Identifier: MIT
#include "host/ask/tables.h"

#include <limits>

namespace voxtact {

namespace {

struct PathRow {
    std::uint32_t entry = 0;
    Safety safe{};
    StopReason end{};
    std::uint32_t near = 0, obstacle = 0;
    std::int32_t label = 0;
    Bounds clearance{};
    double length = 0, angle = 0;
    Vec3 position{}, nearest{}, onPath{};
};
constexpr std::array kPathColumns{
    VOXTACT_COLUMN(PathRow, "entry", entry, "", "number of its direction"),
    VOXTACT_COLUMN(PathRow, "safe", safe, "", "whether the whole path keeps the margin", Printed::No,
                   "unsafe,safe,undecided"),
    VOXTACT_COLUMN(PathRow, "lower", clearance.lower, "mm",
                   "lower bound of the distance from the obstacles; 0: it touches"),
    VOXTACT_COLUMN(PathRow, "upper", clearance.upper, "mm", "upper bound; infinite beyond the maximum"),
    VOXTACT_COLUMN(PathRow, "end", end, "", kEndText, Printed::No, kStopReasonNames),
    VOXTACT_COLUMN(PathRow, "length", length, "mm", "from the entry to the target"),
    VOXTACT_COLUMN(PathRow, "angle", angle, "degrees",
                   "angle to the normal of the entry surface; NaN without a normal"),
    VOXTACT_COLUMN(PathRow, "position", position, "mm", "entry point, world"),
    VOXTACT_COLUMN(PathRow, "near", near, "", "1: there is a nearest obstacle"),
    VOXTACT_COLUMN(PathRow, "obstacle", obstacle, "", "number of the nearest obstacle"),
    VOXTACT_COLUMN(PathRow, "label", label, "", "label of the obstacle at `nearest`; 0: none"),
    VOXTACT_COLUMN(PathRow, "nearest", nearest, "mm", "nearest point of the obstacle, world"),
    VOXTACT_COLUMN(PathRow, "on_path", onPath, "mm", "nearest point of the instrument on the path, world"),
};

struct EntryTriangleRow {
    std::array<std::uint32_t, 3> paths;
    std::uint32_t safe;
    double distance;
};
constexpr std::array kTriangleColumns{
    VOXTACT_COLUMN(EntryTriangleRow, "paths", paths, "", "rows of its corners, outward counter-clockwise"),
    VOXTACT_COLUMN(EntryTriangleRow, "safe", safe, "", "1: every path from a point of the triangle is safe"),
    VOXTACT_COLUMN(EntryTriangleRow, "distance", distance, "mm",
                   "lower bound of the distance of every path from it, if requested; else 0"),
};

struct PlanTotals {
    std::uint32_t directions, noSurface, onBorder, tooLong, tooOblique;
    double area, safeArea, wallMilliseconds;
};
constexpr std::array kTotals{
    VOXTACT_COLUMN(PlanTotals, "directions", directions, "", "directions that were searched"),
    VOXTACT_COLUMN(PlanTotals, "no_surface", noSurface, "", "directions without a surface to enter through"),
    VOXTACT_COLUMN(PlanTotals, "on_border", onBorder, "", "of the others: directions where the image ends"),
    VOXTACT_COLUMN(PlanTotals, "too_long", tooLong, "", "of the others: paths longer than max_length"),
    VOXTACT_COLUMN(PlanTotals, "too_oblique", tooOblique, "", "of the others: paths at more than max_angle"),
    VOXTACT_COLUMN(PlanTotals, "area", area, "mm^2", "area of all triangles"),
    VOXTACT_COLUMN(PlanTotals, "safe_area", safeArea, "mm^2", "area of the safe triangles"),
    VOXTACT_COLUMN(PlanTotals, "wall_milliseconds", wallMilliseconds, "ms", "duration of the call"),
};

PathRow toRow(const PlannedPath& path) noexcept {
    PathRow out{.entry = path.entry,
                .safe = path.safety,
                .end = path.end,
                .clearance = path.clearance,
                .length = path.length,
                .angle = path.angle.value_or(std::numeric_limits<double>::quiet_NaN()),
                .position = path.position};
    if (path.nearest) {
        out.near = 1;
        out.obstacle = path.nearest->obstacle;
        out.label = path.nearest->label;
        out.nearest = path.nearest->position;
        out.onPath = path.nearest->onPath;
    }
    return out;
}

} // namespace

AnswerTables toTables(PlanAnswer answer) {
    const auto toTriangle = [](const EntryTriangle& triangle) {
        return EntryTriangleRow{triangle.paths, triangle.safe ? 1U : 0U, triangle.clearance};
    };
    const PlanTotals totals{answer.directions, answer.noSurface, answer.onBorder, answer.tooLong,
                            answer.tooOblique, answer.area,      answer.safeArea, answer.wallMilliseconds};
    return {{tableOf("paths", kPathColumns, answer.paths, toRow),
             tableOf("triangles", kTriangleColumns, answer.triangles, toTriangle),
             tableOf("totals", kTotals, std::vector<PlanTotals>{totals})}};
}

} // namespace voxtact
