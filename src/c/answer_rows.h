// SPDX-License-Identifier: MIT
#pragma once

#include "c/answer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

/// The rows of all tables, and their columns: names, units and texts of the answers, for every binding.
namespace voxtact::c {

template <class Element> constexpr vxt_type typeOf() {
    if constexpr (std::is_same_v<Element, double>) {
        return VXT_TYPE_DOUBLE;
    } else if constexpr (std::is_same_v<Element, std::uint64_t>) {
        return VXT_TYPE_UINT64;
    } else if constexpr (std::is_same_v<Element, std::int32_t>) {
        return VXT_TYPE_INT32;
    } else {
        static_assert(std::is_same_v<Element, std::uint32_t>);
        return VXT_TYPE_UINT32;
    }
}

/// 1, or the length of an array.
template <class Member> constexpr std::uint32_t elementsOf() {
    return std::is_array_v<Member> ? std::uint32_t{std::extent_v<Member>} : 1;
}

// A column of a struct; `choices`: names of an enumeration.
#define VOXTACT_COLUMN(Row, table, member, unit, choices, text)                                                        \
    ColumnFacts {                                                                                                      \
        table, #member, unit, text, choices, typeOf<std::remove_all_extents_t<decltype(Row::member)>>(),               \
            elementsOf<decltype(Row::member)>(), offsetof(Row, member)                                                 \
    }

inline constexpr const char* kVerdicts = "no,yes,undecided";
inline constexpr const char* kStopReasons = "closed,beyond,rounding,budget";

struct TouchRow {
    std::uint32_t item, pose, touch, witness, triangle;
    double point[3];
};
inline constexpr std::array kTouchColumns{
    VOXTACT_COLUMN(TouchRow, "pairs", item, "", "", "number of the item"),
    VOXTACT_COLUMN(TouchRow, "pairs", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(TouchRow, "pairs", touch, "", kVerdicts, "whether it touches, certified"),
    VOXTACT_COLUMN(TouchRow, "pairs", witness, "", "", "1: there is a witness point"),
    VOXTACT_COLUMN(TouchRow, "pairs", triangle, "", "",
                   "triangle of the witness point: number in the mesh; 4294967295: the point is inside the mesh"),
    VOXTACT_COLUMN(TouchRow, "pairs", point, "mm", "",
                   "witness point, world: opaque, within the margin of the triangle, or inside the mesh"),
};

struct CountRow {
    std::uint32_t item, pose, touch, exactness, method, projection;
    std::uint64_t count;
};
inline constexpr std::array kCountColumns{
    VOXTACT_COLUMN(CountRow, "pairs", item, "", "", "number of the item"),
    VOXTACT_COLUMN(CountRow, "pairs", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(CountRow, "pairs", touch, "", kVerdicts, "whether any fragment passes"),
    VOXTACT_COLUMN(CountRow, "pairs", exactness, "", "exact,lower-bound,refused", "what the count is worth"),
    VOXTACT_COLUMN(CountRow, "pairs", method, "", "query,query-any,atomic,subgroup,compute,cpu", "what counted"),
    VOXTACT_COLUMN(CountRow, "pairs", projection, "", "view,two-view,dominant-axis,certified",
                   "what gave the fragments"),
    VOXTACT_COLUMN(CountRow, "pairs", count, "", "", "fragments that pass"),
};

struct TriangleCountRow {
    std::uint32_t pair, triangle, count;
};
inline constexpr std::array kTriangleCountColumns{
    VOXTACT_COLUMN(TriangleCountRow, "triangles", pair, "", "", "number of the pair"),
    VOXTACT_COLUMN(TriangleCountRow, "triangles", triangle, "", "", "number in the mesh"),
    VOXTACT_COLUMN(TriangleCountRow, "triangles", count, "", "", "its fragments that pass"),
};

struct ContactRow {
    std::uint32_t pair, triangle;
    double position[3], normal[3];
    double depth, value, opacity;
    std::int32_t label;
};
inline constexpr std::array kContactColumns{
    VOXTACT_COLUMN(ContactRow, "contacts", pair, "", "", "number of the pair"),
    VOXTACT_COLUMN(ContactRow, "contacts", triangle, "", "", "number in the mesh"),
    VOXTACT_COLUMN(ContactRow, "contacts", position, "mm", "", "world, on the triangle"),
    VOXTACT_COLUMN(ContactRow, "contacts", normal, "", "",
                   "unit vector in world space, out of the opaque region; or 0"),
    VOXTACT_COLUMN(ContactRow, "contacts", depth, "mm", "", "along the normal to where the opacity ends"),
    VOXTACT_COLUMN(ContactRow, "contacts", value, "", "", "value of the image, in its own units"),
    VOXTACT_COLUMN(ContactRow, "contacts", opacity, "", "", "opacity of that value"),
    VOXTACT_COLUMN(ContactRow, "contacts", label, "", "", "label of the nearest voxel; 0: none"),
};

struct BoundsRow {
    double lower[3], upper[3];
};
inline constexpr std::array kBoundsColumns{
    VOXTACT_COLUMN(BoundsRow, "bounds", lower, "mm", "", "world box of each pair's fragments that pass: lowest corner"),
    VOXTACT_COLUMN(BoundsRow, "bounds", upper, "mm", "", "highest corner; below the lowest where none passes"),
};

struct LabelCountRow {
    std::uint32_t pair;
    std::int32_t label;
    std::uint64_t count;
};
inline constexpr std::array kLabelCountColumns{
    VOXTACT_COLUMN(LabelCountRow, "labels", pair, "", "", "number of the pair"),
    VOXTACT_COLUMN(LabelCountRow, "labels", label, "", "", "value in the label map"),
    VOXTACT_COLUMN(LabelCountRow, "labels", count, "", "", "fragments that pass there; at least 1"),
};

struct CountTotals {
    std::uint64_t contacts_found;
    double gpu_milliseconds, wall_milliseconds;
};
inline constexpr std::array kCountTotals{
    VOXTACT_COLUMN(CountTotals, "totals", contacts_found, "", "",
                   "contacts found; more than listed if the list was cut"),
    VOXTACT_COLUMN(CountTotals, "totals", gpu_milliseconds, "ms", "", "duration on the device; 0: not measured"),
    VOXTACT_COLUMN(CountTotals, "totals", wall_milliseconds, "ms", "", "duration of the call"),
};

struct Totals {
    double wall_milliseconds;
};
inline constexpr std::array kTotals{
    VOXTACT_COLUMN(Totals, "totals", wall_milliseconds, "ms", "", "duration of the call"),
};

struct DistanceRow {
    std::uint32_t item, pose, end, witness, triangle;
    double lower, upper;
    double on_mesh[3], in_volume[3], per_translation[3], per_rotation[3];
};
inline constexpr std::array kDistanceColumns{
    VOXTACT_COLUMN(DistanceRow, "pairs", item, "", "", "number of the item"),
    VOXTACT_COLUMN(DistanceRow, "pairs", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(DistanceRow, "pairs", lower, "mm", "", "no point of the surface is nearer to an opaque one"),
    VOXTACT_COLUMN(DistanceRow, "pairs", upper, "mm", "", "some point is as near; infinite where none is known"),
    VOXTACT_COLUMN(DistanceRow, "pairs", end, "", kStopReasons, "why the search ended"),
    VOXTACT_COLUMN(DistanceRow, "pairs", witness, "", "", "1: there are closest points"),
    VOXTACT_COLUMN(
        DistanceRow, "pairs", triangle, "", "",
        "triangle of the closest point: number in the mesh; 4294967295: both points are one inside the mesh"),
    VOXTACT_COLUMN(DistanceRow, "pairs", on_mesh, "mm", "", "closest point of the surface, world"),
    VOXTACT_COLUMN(DistanceRow, "pairs", in_volume, "mm", "", "closest opaque point, world"),
    VOXTACT_COLUMN(DistanceRow, "pairs", per_translation, "mm/mm", "", "change when the mesh moves along x, y, z"),
    VOXTACT_COLUMN(DistanceRow, "pairs", per_rotation, "mm/rad", "",
                   "change when it turns about them through its origin"),
};

struct LabelRow {
    std::uint32_t pair, item, pose, end;
    std::int32_t label;
    double lower, upper;
};
#define VOXTACT_LABEL_COLUMNS(unit)                                                                                    \
    std::array {                                                                                                       \
        VOXTACT_COLUMN(LabelRow, "labels", pair, "", "", "number of the pair"),                                        \
            VOXTACT_COLUMN(LabelRow, "labels", item, "", "", "number of the item"),                                    \
            VOXTACT_COLUMN(LabelRow, "labels", pose, "", "", "number of the pose in the item"),                        \
            VOXTACT_COLUMN(LabelRow, "labels", label, "", "", "value in the label map"),                               \
            VOXTACT_COLUMN(LabelRow, "labels", lower, unit, "", "lower bound"),                                        \
            VOXTACT_COLUMN(LabelRow, "labels", upper, unit, "", "upper bound"),                                        \
            VOXTACT_COLUMN(LabelRow, "labels", end, "", kStopReasons, "why the search ended"),                         \
    }
inline constexpr std::array kLabelDistanceColumns = VOXTACT_LABEL_COLUMNS("mm");
inline constexpr std::array kLabelAreaColumns = VOXTACT_LABEL_COLUMNS("mm^2");

struct AreaRow {
    std::uint32_t item, pose, end;
    double lower, upper;
};
inline constexpr std::array kAreaColumns{
    VOXTACT_COLUMN(AreaRow, "pairs", item, "", "", "number of the item"),
    VOXTACT_COLUMN(AreaRow, "pairs", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(AreaRow, "pairs", lower, "mm^2", "", "so much of the surface is certainly opaque"),
    VOXTACT_COLUMN(AreaRow, "pairs", upper, "mm^2", "", "no more of it is"),
    VOXTACT_COLUMN(AreaRow, "pairs", end, "", kStopReasons, "why the search ended"),
};

struct TriangleAreaRow {
    std::uint32_t pair, triangle;
    double whole, lower, upper;
};
inline constexpr std::array kTriangleAreaColumns{
    VOXTACT_COLUMN(TriangleAreaRow, "triangles", pair, "", "", "number of the pair"),
    VOXTACT_COLUMN(TriangleAreaRow, "triangles", triangle, "", "", "number in the mesh"),
    VOXTACT_COLUMN(TriangleAreaRow, "triangles", whole, "mm^2", "", "area of all of it"),
    VOXTACT_COLUMN(TriangleAreaRow, "triangles", lower, "mm^2", "", "so much of it is certainly opaque"),
    VOXTACT_COLUMN(TriangleAreaRow, "triangles", upper, "mm^2", "", "no more of it is"),
};

inline constexpr const char* kContainments = "none,some,all,undecided";

struct OverlapRow {
    std::uint32_t item, pose, inside, end;
    double lower, upper, solid_lower, solid_upper;
};
inline constexpr std::array kOverlapColumns{
    VOXTACT_COLUMN(OverlapRow, "pairs", item, "", "", "number of the item"),
    VOXTACT_COLUMN(OverlapRow, "pairs", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(OverlapRow, "pairs", lower, "mm^3", "", "lower bound of the opaque volume inside"),
    VOXTACT_COLUMN(OverlapRow, "pairs", upper, "mm^3", "", "upper bound of it"),
    VOXTACT_COLUMN(OverlapRow, "pairs", solid_lower, "mm^3", "", "volume of the mesh: no less"),
    VOXTACT_COLUMN(OverlapRow, "pairs", solid_upper, "mm^3", "", "volume of the mesh: no more"),
    VOXTACT_COLUMN(OverlapRow, "pairs", inside, "", kContainments,
                   "how much of the opaque region of the image is inside"),
    VOXTACT_COLUMN(OverlapRow, "pairs", end, "", kStopReasons, "why the bounds are no nearer to each other"),
};

struct BandRow {
    std::uint32_t pair, item, pose, band, end;
    double lower, upper;
};
inline constexpr std::array kBandColumns{
    VOXTACT_COLUMN(BandRow, "bands", pair, "", "", "number of the pair"),
    VOXTACT_COLUMN(BandRow, "bands", item, "", "", "number of the item"),
    VOXTACT_COLUMN(BandRow, "bands", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(BandRow, "bands", band, "", "", "from limit band-1 on to below limit band"),
    VOXTACT_COLUMN(BandRow, "bands", lower, "mm^3", "", "so much of the inside certainly has these values"),
    VOXTACT_COLUMN(BandRow, "bands", upper, "mm^3", "", "no more of it has"),
    VOXTACT_COLUMN(BandRow, "bands", end, "", kStopReasons, "why the bounds are no nearer to each other"),
};

struct LabelOverlapRow {
    std::uint32_t pair, item, pose, inside, end;
    std::int32_t label;
    double lower, upper;
};
inline constexpr std::array kLabelOverlapColumns{
    VOXTACT_COLUMN(LabelOverlapRow, "labels", pair, "", "", "number of the pair"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", item, "", "", "number of the item"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", pose, "", "", "number of the pose in the item"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", label, "", "", "as the label map has it"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", lower, "mm^3", "", "so much of its opaque part is certainly inside"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", upper, "mm^3", "", "no more of it is"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", inside, "", kContainments, "how much of its opaque part is inside"),
    VOXTACT_COLUMN(LabelOverlapRow, "labels", end, "", kStopReasons, "why the bounds are no nearer to each other"),
};

struct SegmentRow {
    std::uint32_t item, pose, touch, end, triangle;
    double toi_lower, toi_upper;
    double point[3];
    double world_from_object[16];
};
inline constexpr std::array kSegmentColumns{
    VOXTACT_COLUMN(SegmentRow, "segments", item, "", "", "number of the item"),
    VOXTACT_COLUMN(SegmentRow, "segments", pose, "", "", "number of the pose that it begins with"),
    VOXTACT_COLUMN(SegmentRow, "segments", touch, "", kVerdicts, "whether it touches on the way, certified"),
    VOXTACT_COLUMN(SegmentRow, "segments", toi_lower, "", "", "collision-free up to this parameter; 1: all the way"),
    VOXTACT_COLUMN(SegmentRow, "segments", toi_upper, "", "", "certainly touching at this parameter; NaN: none"),
    VOXTACT_COLUMN(SegmentRow, "segments", end, "", "decided,grazes,budget", "why the search ended"),
    VOXTACT_COLUMN(SegmentRow, "segments", triangle, "", "", "triangle of the touch: number in the mesh"),
    VOXTACT_COLUMN(SegmentRow, "segments", point, "mm", "", "witness point of the touch, world"),
    VOXTACT_COLUMN(SegmentRow, "segments", world_from_object, "", "", "pose at toi_upper, column by column"),
};

struct PathRow {
    std::uint32_t entry, safe, end, near, obstacle;
    std::int32_t label;
    double lower, upper, length, angle;
    double position[3], nearest[3], on_path[3];
};
inline constexpr std::array kPathColumns{
    VOXTACT_COLUMN(PathRow, "paths", entry, "", "", "number of its direction"),
    VOXTACT_COLUMN(PathRow, "paths", safe, "", "unsafe,safe,undecided", "whether it keeps the margin all the way"),
    VOXTACT_COLUMN(PathRow, "paths", lower, "mm", "", "it comes no nearer to an obstacle; 0: it touches"),
    VOXTACT_COLUMN(PathRow, "paths", upper, "mm", "", "it comes as near; infinite beyond the maximum"),
    VOXTACT_COLUMN(PathRow, "paths", end, "", kStopReasons, "why the search ended"),
    VOXTACT_COLUMN(PathRow, "paths", length, "mm", "", "from the entry to the target"),
    VOXTACT_COLUMN(PathRow, "paths", angle, "degrees", "", "to the normal of the entry surface; NaN: it has none"),
    VOXTACT_COLUMN(PathRow, "paths", position, "mm", "", "entry point, world"),
    VOXTACT_COLUMN(PathRow, "paths", near, "", "", "1: there is a nearest obstacle"),
    VOXTACT_COLUMN(PathRow, "paths", obstacle, "", "", "number of the nearest obstacle"),
    VOXTACT_COLUMN(PathRow, "paths", label, "", "", "label of the obstacle at `nearest`; 0: none"),
    VOXTACT_COLUMN(PathRow, "paths", nearest, "mm", "", "nearest point of the obstacle, world"),
    VOXTACT_COLUMN(PathRow, "paths", on_path, "mm", "", "nearest point of the instrument on its way, world"),
};

struct EntryTriangleRow {
    std::uint32_t paths[3];
    std::uint32_t safe;
    double distance;
};
inline constexpr std::array kEntryTriangleColumns{
    VOXTACT_COLUMN(EntryTriangleRow, "triangles", paths, "", "", "rows of its corners, outward counter-clockwise"),
    VOXTACT_COLUMN(EntryTriangleRow, "triangles", safe, "", "", "1: every path from a point of the triangle is safe"),
    VOXTACT_COLUMN(EntryTriangleRow, "triangles", distance, "mm", "",
                   "every path from it keeps this distance, if asked for; else 0"),
};

struct PlanTotals {
    std::uint32_t directions, no_surface, on_border, too_long, too_oblique;
    double area, safe_area, wall_milliseconds;
};
inline constexpr std::array kPlanTotals{
    VOXTACT_COLUMN(PlanTotals, "totals", directions, "", "", "directions that were searched"),
    VOXTACT_COLUMN(PlanTotals, "totals", no_surface, "", "", "directions without a surface to enter through"),
    VOXTACT_COLUMN(PlanTotals, "totals", on_border, "", "", "of the rest: directions where the image ends"),
    VOXTACT_COLUMN(PlanTotals, "totals", too_long, "", "", "of the rest: paths longer than max_length"),
    VOXTACT_COLUMN(PlanTotals, "totals", too_oblique, "", "", "of the rest: paths at more than max_angle"),
    VOXTACT_COLUMN(PlanTotals, "totals", area, "mm^2", "", "area of all triangles"),
    VOXTACT_COLUMN(PlanTotals, "totals", safe_area, "mm^2", "", "area of the safe triangles"),
    VOXTACT_COLUMN(PlanTotals, "totals", wall_milliseconds, "ms", "", "duration of the call"),
};

} // namespace voxtact::c
