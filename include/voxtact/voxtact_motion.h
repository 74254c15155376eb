/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_MOTION_H
#define VOXTACT_VOXTACT_MOTION_H

#include "voxtact/voxtact_host.h"

/// @file
/// On the way, in C. What holds for voxtact.h, which includes this, holds here.

#ifdef __cplusplus
extern "C" {
#endif

/// Which motion joins two poses: voxtact::Interpolation.
typedef enum vxt_interpolation {
    VXT_INTERPOLATION_SCREW = 0,       ///< about and along one axis
    VXT_INTERPOLATION_SLERP = 1,       ///< the middle of the mesh's box goes straight, and the mesh turns about it
    VXT_INTERPOLATION_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_interpolation;

/// Why no more is said of a motion: voxtact::MotionEnd.
typedef enum vxt_motion_end {
    VXT_MOTION_DECIDED = 0,     ///< free, or it touches within the resolution of where it is free until
    VXT_MOTION_GRAZES = 1,      ///< somewhere neither was proven within the resolution
    VXT_MOTION_BUDGET = 2,      ///< the steps that were allowed are used up
    VXT_MOTION_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_motion_end;

/// The names as on the command line; they live for ever.
/// @{
VXT_API const char* vxt_interpolation_name(vxt_interpolation interpolation);
VXT_API const char* vxt_motion_end_name(vxt_motion_end end);
/// @}

/// What was found of one segment of a motion: voxtact::SegmentMotion. Where `touches` is 0, what is of the touch is 0.
typedef struct vxt_segment_motion {
    double free_until;            ///< certainly nothing touches from 0 to this parameter; 1: all of it is free
    double touch_at;              ///< a parameter at which it certainly touches
    double world_from_object[16]; ///< the pose there
    double position[3];           ///< world mm: a point of the touch
    uint32_t segment;             ///< number in the batch
    uint32_t item;                ///< number of the item
    uint32_t pose;                ///< number in the item of the pose that it begins with
    uint32_t triangle;            ///< of the touch: number in the mesh
    uint32_t touches;             ///< whether there is a certain touch
    uint32_t possible;            ///< not free, and no certain touch
    vxt_motion_end end;           ///< why no more is said
    uint32_t reserved;            ///< 0
} vxt_segment_motion;

/// The array of motions, where it is.
typedef struct vxt_motion_view {
    size_t struct_size;                 ///< sizeof
    const vxt_segment_motion* segments; ///< in the order of the batch
    size_t segment_count;               ///< of `segments`
    double wall_milliseconds;           ///< of the call
} vxt_motion_view;

/// What a motion checker is made for.
typedef struct vxt_host_motion_desc {
    size_t struct_size;              ///< sizeof
    double resolution;               ///< mm, from 1e-6 on: from the end of what is free to a touch; default 0.01
    double touch_resolution;         ///< of the touch, as for a detector; default 1/64
    uint64_t most_steps;             ///< of a segment, at least 1; default 2^20
    vxt_interpolation interpolation; ///< default SCREW
    uint32_t threads;                ///< 0, the default: one for each processor
} vxt_host_motion_desc;

/// Nothing.
static inline vxt_motion_view vxt_motion_view_init(void) {
    vxt_motion_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// Screws, to 0.01 mm.
static inline vxt_host_motion_desc vxt_host_motion_desc_init(void) {
    vxt_host_motion_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.resolution = 0.01;
    desc.touch_resolution = 1.0 / 64;
    desc.most_steps = UINT64_C(1) << 20;
    return desc;
}

/// Where a checker puts what it finds. Used again and again, it keeps its memory.
typedef struct vxt_motions vxt_motions;
/// An empty one.
VXT_CHECKED vxt_result vxt_motions_create(vxt_motions** motions);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_motions_get(const vxt_motions* motions, vxt_motion_view* view);
/// Ends it.
VXT_API void vxt_motions_destroy(vxt_motions* motions);

/// Says whether meshes touch on the way from pose to pose: voxtact::cpu::MotionChecker. One call at a time. After a
/// failure the answers hold what they held.
typedef struct vxt_host_motion_checker vxt_host_motion_checker;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_motion_checker_create(const vxt_host_motion_desc* desc,
                                                      vxt_host_motion_checker** checker);
/// The segments between consecutive poses of each item: one fewer than it has poses.
VXT_CHECKED vxt_result vxt_host_motion_checker_check(vxt_host_motion_checker* checker, const vxt_host_batch* batch,
                                                     vxt_motions* motions);
/// Whether a mesh touches at some pose that is turned by no more than `angle` degrees about any axis through its
/// object's origin, and moved by no more than `distance` mm: `hit` and `possible` of each pair's answer.
VXT_CHECKED vxt_result vxt_host_motion_checker_around(vxt_host_motion_checker* checker, const vxt_host_batch* batch,
                                                      double distance, double angle, vxt_answer* answer);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_motion_checker_threads(const vxt_host_motion_checker* checker);
/// Ends it and its threads.
VXT_API void vxt_host_motion_checker_destroy(vxt_host_motion_checker* checker);

/// The pose at a parameter from 0 to 1 on the way between two: voxtact::poseBetween(). `centre` is the middle of the
/// mesh's box in object space, which SLERP alone needs; it may be null for SCREW.
VXT_CHECKED vxt_result vxt_pose_between(const double from[16], const double to[16], double parameter,
                                        vxt_interpolation interpolation, const double centre[3],
                                        double world_from_object[16]);

#ifdef __cplusplus
}
#endif

#endif
