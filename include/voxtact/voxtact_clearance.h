/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_CLEARANCE_H
#define VOXTACT_VOXTACT_CLEARANCE_H

#include "voxtact/voxtact_host.h"

/// @file
/// How near, in C. What holds for voxtact.h, which includes this, holds here.

#ifdef __cplusplus
extern "C" {
#endif

/// Why bounds of a clearance are no nearer to each other: voxtact::ClearanceEnd.
typedef enum vxt_clearance_end {
    VXT_CLEARANCE_CLOSED = 0,      ///< they are within the tolerance, or both infinite
    VXT_CLEARANCE_BEYOND = 1,      ///< it is not less than the maximum
    VXT_CLEARANCE_ROUNDING = 2,    ///< what is left is decided by roundings
    VXT_CLEARANCE_BUDGET = 3,      ///< the steps that were allowed are used up
    VXT_CLEARANCE_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_clearance_end;

/// As on the command line; it lives for ever.
VXT_API const char* vxt_clearance_end_name(vxt_clearance_end end);

/// The clearance of one pair: voxtact::PairClearance. Where `has_closest` is 0, what is of the closest points is 0.
typedef struct vxt_pair_clearance {
    double lo;                 ///< mm: no point of the surface is nearer to an opaque one
    double hi;                 ///< mm: some point is as near; infinite where nothing is opaque
    double mesh[3];            ///< closest points: on the triangle, world mm
    double volume[3];          ///< opaque, world mm
    double per_translation[3]; ///< mm of their distance for each mm that the mesh is moved along the world's axes
    double per_rotation[3];    ///< and for each radian that it is turned about them, through the object's origin
    uint32_t pair;             ///< number in the batch
    uint32_t item;             ///< number of the item
    uint32_t pose;             ///< number of the pose in the item
    uint32_t triangle;         ///< closest points: number in the mesh
    uint32_t has_closest;      ///< where `hi` is finite
    vxt_clearance_end end;     ///< why the bounds are no nearer to each other
} vxt_pair_clearance;

/// The clearance of one pair to what is opaque and has a label, or to what has it: voxtact::LabelClearance.
typedef struct vxt_label_clearance {
    double lo;             ///< mm
    double hi;             ///< mm; both are infinite where nothing of it is looked for
    uint32_t pair;         ///< number in the batch
    uint32_t item;         ///< number of the item
    uint32_t pose;         ///< number of the pose in the item
    int32_t label;         ///< as the map has it
    vxt_clearance_end end; ///< why they are no nearer to each other
    uint32_t reserved;     ///< 0
} vxt_label_clearance;

/// The arrays of clearances, where they are.
typedef struct vxt_clearance_view {
    size_t struct_size;                ///< sizeof
    const vxt_pair_clearance* pairs;   ///< in the order of the batch
    size_t pair_count;                 ///< of `pairs`
    const vxt_label_clearance* labels; ///< by pair, then in the order that they were asked for
    size_t label_count;                ///< of `labels`
    double wall_milliseconds;          ///< of the call
} vxt_clearance_view;

/// What a clearance meter is made for.
typedef struct vxt_host_clearance_desc {
    size_t struct_size;  ///< sizeof
    double tolerance;    ///< mm, from 1e-6 on; default 0.01
    double maximum;      ///< mm: what is farther is not measured; 0, the default: all is
    double resolution;   ///< of the touch, as for a detector; default 1/64
    uint64_t most_steps; ///< of a pair, at least 1; default 2^18
    uint32_t threads;    ///< 0, the default: one for each processor
    /// To labels: all of each, be it opaque or not; default 0: its part of what is opaque.
    uint32_t labels_at_any_opacity;
} vxt_host_clearance_desc;

/// Nothing.
static inline vxt_clearance_view vxt_clearance_view_init(void) {
    vxt_clearance_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// To 0.01 mm at any distance.
static inline vxt_host_clearance_desc vxt_host_clearance_desc_init(void) {
    vxt_host_clearance_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.tolerance = 0.01;
    desc.resolution = 1.0 / 64;
    desc.most_steps = UINT64_C(1) << 18;
    return desc;
}

/// Where a meter puts what it measures.
typedef struct vxt_clearances vxt_clearances;
/// An empty one.
VXT_CHECKED vxt_result vxt_clearances_create(vxt_clearances** clearances);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_clearances_get(const vxt_clearances* clearances, vxt_clearance_view* view);
/// Ends it.
VXT_API void vxt_clearances_destroy(vxt_clearances* clearances);

/// Measures how near meshes are: voxtact::cpu::ClearanceMeter. One call at a time. After a failure the answers hold
/// what they held.
typedef struct vxt_host_clearance_meter vxt_host_clearance_meter;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_clearance_meter_create(const vxt_host_clearance_desc* desc,
                                                       vxt_host_clearance_meter** meter);
/// The clearance of every pair.
VXT_CHECKED vxt_result vxt_host_clearance_meter_measure(vxt_host_clearance_meter* meter, const vxt_host_batch* batch,
                                                        vxt_clearances* clearances);
/// The clearance of every pair to each label's part of what is opaque, or to all of the label
/// (vxt_host_clearance_desc::labels_at_any_opacity). Every item needs labels, on its volume's grid.
VXT_CHECKED vxt_result vxt_host_clearance_meter_measure_labels(vxt_host_clearance_meter* meter,
                                                               const vxt_host_batch* batch, const int32_t* labels,
                                                               size_t label_count, vxt_clearances* clearances);
/// Whether something opaque is within `margin` mm, for every pair: `hit` and `possible` of its answer.
VXT_CHECKED vxt_result vxt_host_clearance_meter_within(vxt_host_clearance_meter* meter, const vxt_host_batch* batch,
                                                       double margin, vxt_answer* answer);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_clearance_meter_threads(const vxt_host_clearance_meter* meter);
/// Ends it and its threads.
VXT_API void vxt_host_clearance_meter_destroy(vxt_host_clearance_meter* meter);

/// What is known of a mesh that moves, at one of its poses: voxtact::TrackedClearance.
typedef struct vxt_tracked_clearance {
    size_t struct_size; ///< sizeof
    double lo;          ///< mm: no point of the surface is nearer to an opaque one
    double hi;          ///< mm: some point is as near; infinite where that is not known
    uint32_t hit;       ///< it certainly touches
    uint32_t possible;  ///< roundings decide whether it touches; with neither it certainly does not
    uint32_t searched;  ///< the volume was looked into; 0: it follows from what was known before
    uint32_t reserved;  ///< 0
} vxt_tracked_clearance;

/// What a clearance tracker is made for.
typedef struct vxt_host_tracker_desc {
    size_t struct_size;  ///< sizeof
    double maximum;      ///< mm: farther than this is never looked; 0, the default: as far as it takes
    double resolution;   ///< of the touch, as for a detector; default 1/64
    uint64_t most_steps; ///< of one search, at least 1; default 512
} vxt_host_tracker_desc;

/// Nothing.
static inline vxt_tracked_clearance vxt_tracked_clearance_init(void) {
    vxt_tracked_clearance clearance;
    memset(&clearance, 0, sizeof clearance);
    clearance.struct_size = sizeof clearance;
    return clearance;
}

/// 512 steps, at any distance.
static inline vxt_host_tracker_desc vxt_host_tracker_desc_init(void) {
    vxt_host_tracker_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.resolution = 1.0 / 64;
    desc.most_steps = 512;
    return desc;
}

/// Follows a mesh that moves by little from call to call: voxtact::cpu::ClearanceTracker. One call at a time, on the
/// calling thread.
typedef struct vxt_host_clearance_tracker vxt_host_clearance_tracker;
/// A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_clearance_tracker_create(const vxt_host_tracker_desc* desc,
                                                         vxt_host_clearance_tracker** tracker);
/// Of a mesh at the one pose of the item.
VXT_CHECKED vxt_result vxt_host_clearance_tracker_track(vxt_host_clearance_tracker* tracker, const vxt_host_item* item,
                                                        double threshold, vxt_tracked_clearance* clearance);
/// Ends it.
VXT_API void vxt_host_clearance_tracker_destroy(vxt_host_clearance_tracker* tracker);

#ifdef __cplusplus
}
#endif

#endif
