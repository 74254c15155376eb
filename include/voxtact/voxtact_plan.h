/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_PLAN_H
#define VOXTACT_VOXTACT_PLAN_H

#include "voxtact/voxtact_clearance.h"

/// @file
/// Which straight paths, in C. What holds for voxtact.h, which includes this, holds here. Lengths are in mm, points in
/// world space.

#ifdef __cplusplus
extern "C" {
#endif

/// What is certain of a path: voxtact::Safety.
typedef enum vxt_safety {
    VXT_SAFETY_UNSAFE = 0,      ///< it comes as near to something as the margin, or touches it
    VXT_SAFETY_SAFE = 1,        ///< it keeps more than the margin from everything, all the way
    VXT_SAFETY_POSSIBLE = 2,    ///< neither could be shown
    VXT_SAFETY_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_safety;

/// As on the command line; it lives for ever; "unknown" for a number that is none.
VXT_API const char* vxt_safety_name(vxt_safety safety);

/// What must not be touched: voxtact::cpu::PlanObstacle.
typedef struct vxt_plan_obstacle {
    size_t struct_size;                                  ///< sizeof
    const vxt_host_volume* volume;                       ///< must be given
    const vxt_host_transfer_function* transfer_function; ///< what of it is opaque; null: labels at any opacity
    const vxt_labels* labels;                            ///< on the volume's grid; null: all that is opaque
    const int32_t* avoid;                                ///< these labels
    size_t avoid_count;                                  ///< of `avoid`
    double threshold;                                    ///< 0..1; default 0.1
} vxt_plan_obstacle;

/// What is to be planned: voxtact::cpu::PlanTask. Entries are where a direction from the target leaves what is opaque
/// in `entry_volume`, or `entry_label`, or a ball; one of them is given.
typedef struct vxt_plan_task {
    size_t struct_size;                                        ///< sizeof
    const vxt_plan_obstacle* obstacles;                        ///< at least one
    size_t obstacle_count;                                     ///< of `obstacles`
    const vxt_host_volume* entry_volume;                       ///< with a transfer function: of what is opaque in it
    const vxt_host_transfer_function* entry_transfer_function; ///< see entry_volume
    const vxt_labels* entry_labels;                            ///< or of a label
    const vxt_host_mesh* mesh;                                 ///< the instrument, instead of the needle; may be null
    const vxt_cancel* cancel;                                  ///< ends the call early; may be null, the default
    double target[3];                                          ///< where the tip goes
    double mesh_tip[3];                                        ///< object space: comes to the target
    double mesh_axis[3];          ///< object space: from the tip to where it is held; default 0 0 1
    double entry_threshold;       ///< 0..1: of entry_volume; default 0.1
    double entry_radius;          ///< mm, above 0.001: of a ball, where neither a volume nor labels are given
    double needle_diameter;       ///< above 0; default 2
    double needle_length;         ///< from the tip to the other end, at least the diameter; default 200
    double margin;                ///< that is to be kept; default 0
    double max_length;            ///< of paths, above 0; 0, the default: of any length
    double max_angle;             ///< with has_max_angle: degrees between a path and the normal of the surface, 0 to 90
    uint32_t has_max_angle;       ///< default 0: at any angle, and where the surface has no normal
    uint32_t entries;             ///< directions: the least 10 n^2 + 2 that is no fewer; default 1002
    int32_t entry_label;          ///< of entry_labels
    uint32_t border_entries;      ///< 1: paths may begin where the image ends within the thing, too; default 0
    uint32_t triangle_clearances; ///< of a needle: those of vxt_plan_view, for about as long again; default 0
    uint32_t reserved;            ///< 0
} vxt_plan_task;

/// What a planner is made for: voxtact::cpu::PlannerDesc.
typedef struct vxt_host_planner_desc {
    size_t struct_size;  ///< sizeof
    double tolerance;    ///< from 1e-6 on: how near to each other the bounds are brought; default 0.05
    double maximum;      ///< above 0: what is farther from a path is not measured; default 10
    uint64_t most_steps; ///< of a path, at least 1; default 2^18
    uint32_t threads;    ///< 0, the default: one for each processor
    uint32_t reserved;   ///< 0
} vxt_host_planner_desc;

/// One path: voxtact::PlannedPath.
typedef struct vxt_planned_path {
    double position[3];    ///< of the entry
    double length;         ///< from the entry to the target
    double angle;          ///< with has_angle: degrees between it and the normal of the entry's surface; else 0
    double lo;             ///< of the whole way: it comes no nearer to an obstacle; 0 where it touches
    double hi;             ///< it comes as near; infinite beyond the planner's maximum
    double nearest[3];     ///< with has_nearest: a point of what it comes nearest to; else 0, as what follows of it
    double on_path[3];     ///< the nearest of the needle's axis, or of the mesh's surface on its way
    uint32_t entry;        ///< number of its direction
    vxt_safety safety;     ///< of the whole way
    vxt_clearance_end end; ///< why the bounds are no nearer to each other
    uint32_t has_angle;    ///< the surface has a normal there
    uint32_t has_nearest;  ///< where `hi` is finite
    uint32_t obstacle;     ///< number in the task of what it comes nearest to
    int32_t label;         ///< of that obstacle's label map at `nearest`; 0 where it has none
    uint32_t reserved;     ///< 0
} vxt_planned_path;

/// A triangle between the entries of neighbouring directions, outward counter-clockwise.
typedef struct vxt_entry_triangle {
    uint32_t paths[3]; ///< places in the array of paths
    uint32_t safe;     ///< every path from anywhere in it is; never of a mesh, whose paths alone are decided
} vxt_entry_triangle;

/// The arrays of a plan, where they are: voxtact::PlanAnswer.
typedef struct vxt_plan_view {
    size_t struct_size;                  ///< sizeof
    const vxt_planned_path* paths;       ///< in the order of the directions
    size_t path_count;                   ///< of `paths`
    const vxt_entry_triangle* triangles; ///< where three neighbouring directions have an entry
    size_t triangle_count;               ///< of `triangles`
    double area;                         ///< mm2 of all triangles
    double safe_area;                    ///< mm2 of the safe ones
    double wall_milliseconds;            ///< of the call
    uint32_t directions;                 ///< that were looked along
    uint32_t no_surface;                 ///< of them, those along which there is no surface to enter through
    uint32_t too_long;                   ///< of the others, those that are longer than the maximum
    uint32_t too_oblique;                ///< of the others, those at a larger angle than the maximum, or at none
    uint32_t on_border;                  ///< of those with a surface, those where the image ends
    uint32_t reserved;                   ///< 0
    /// Of each triangle, where the task asks for them: every path from any point of it certainly keeps at least so
    /// much, up to the planner's maximum; else null.
    const double* triangle_clearances;
} vxt_plan_view;

/// No labels, and the threshold 0.1.
static inline vxt_plan_obstacle vxt_plan_obstacle_init(void) {
    vxt_plan_obstacle obstacle;
    memset(&obstacle, 0, sizeof obstacle);
    obstacle.struct_size = sizeof obstacle;
    obstacle.threshold = 0.1;
    return obstacle;
}

/// A needle of 2 mm by 200 mm along any of 1002 directions; no obstacle and no surface of entries.
static inline vxt_plan_task vxt_plan_task_init(void) {
    vxt_plan_task task;
    memset(&task, 0, sizeof task);
    task.struct_size = sizeof task;
    task.mesh_axis[2] = 1;
    task.entry_threshold = 0.1;
    task.needle_diameter = 2;
    task.needle_length = 200;
    task.entries = 1002;
    return task;
}

/// To 0.05 mm, up to 10 mm.
static inline vxt_host_planner_desc vxt_host_planner_desc_init(void) {
    vxt_host_planner_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.tolerance = 0.05;
    desc.maximum = 10;
    desc.most_steps = UINT64_C(1) << 18;
    return desc;
}

/// Nothing.
static inline vxt_plan_view vxt_plan_view_init(void) {
    vxt_plan_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// Where a planner puts what it finds. Used again and again, it keeps its memory.
typedef struct vxt_plan vxt_plan;
/// An empty one.
VXT_CHECKED vxt_result vxt_plan_create(vxt_plan** plan);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_plan_get(const vxt_plan* plan, vxt_plan_view* view);
/// Ends it.
VXT_API void vxt_plan_destroy(vxt_plan* plan);

/// Looks for straight paths to a target that keep clear of obstacles: voxtact::cpu::Planner. One call at a time.
typedef struct vxt_host_planner vxt_host_planner;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_planner_create(const vxt_host_planner_desc* desc, vxt_host_planner** planner);
/// Of all directions of the task. After a failure `plan` holds what it held. Refuses what voxtact::cpu::Planner::plan()
/// refuses.
VXT_CHECKED vxt_result vxt_host_planner_plan(vxt_host_planner* planner, const vxt_plan_task* task, vxt_plan* plan);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_planner_threads(const vxt_host_planner* planner);
/// Ends it and its threads.
VXT_API void vxt_host_planner_destroy(vxt_host_planner* planner);

/// The labels that a straight line crosses, in their order, each once, without 0: voxtact::labelsAlong(). As many as
/// there is `room` for go to `found`, which may be null where that is 0; `count` is how many there are.
VXT_CHECKED vxt_result vxt_labels_along(const vxt_labels* labels, const double from[3], const double to[3],
                                        int32_t* found, size_t room, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
