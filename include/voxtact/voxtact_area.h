/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_AREA_H
#define VOXTACT_VOXTACT_AREA_H

#include "voxtact/voxtact_host.h"

/// @file
/// How much, in C: contact areas. What holds for voxtact.h, which includes this, holds here.

#ifdef __cplusplus
extern "C" {
#endif

/// Why bounds of an area are no nearer to each other: voxtact::AreaEnd.
typedef enum vxt_area_end {
    VXT_AREA_CLOSED = 0,      ///< they are within the tolerance
    VXT_AREA_ROUNDING = 1,    ///< what is left is decided by roundings
    VXT_AREA_BUDGET = 2,      ///< the steps that were allowed are used up
    VXT_AREA_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_area_end;

/// "closed", "rounding" or "budget"; it lives for ever.
VXT_API const char* vxt_area_end_name(vxt_area_end end);

/// The contact area of one pair: voxtact::PairArea.
typedef struct vxt_pair_area {
    double lo;        ///< mm^2: so much of the surface is certainly opaque
    double hi;        ///< mm^2: no more of it may be; infinite where coordinates are too large or too small to say
    uint32_t pair;    ///< number in the batch
    uint32_t item;    ///< number of the item
    uint32_t pose;    ///< number of the pose in the item
    vxt_area_end end; ///< why they are no nearer to each other
} vxt_pair_area;

/// The area of one pair in what is opaque and has a label: voxtact::LabelArea.
typedef struct vxt_label_area {
    double lo;         ///< mm^2
    double hi;         ///< mm^2
    uint32_t pair;     ///< number in the batch
    uint32_t item;     ///< number of the item
    uint32_t pose;     ///< number of the pose in the item
    int32_t label;     ///< as the map has it
    vxt_area_end end;  ///< why they are no nearer to each other
    uint32_t reserved; ///< 0
} vxt_label_area;

/// The contact area of one triangle of a pair: voxtact::TriangleArea. Triangles that are not listed have none.
typedef struct vxt_triangle_area {
    double lo;         ///< mm^2
    double hi;         ///< mm^2
    double whole;      ///< mm^2: the area of all of it, at its pose, no bound; infinite where `hi` is
    uint32_t pair;     ///< number in the batch
    uint32_t item;     ///< number of the item
    uint32_t pose;     ///< number of the pose in the item
    uint32_t triangle; ///< number in the mesh
} vxt_triangle_area;

/// The arrays of areas, where they are.
typedef struct vxt_area_view {
    size_t struct_size;                 ///< sizeof
    const vxt_pair_area* pairs;         ///< in the order of the batch
    size_t pair_count;                  ///< of `pairs`
    const vxt_label_area* labels;       ///< by pair, then in the order that they were asked for
    size_t label_count;                 ///< of `labels`
    double wall_milliseconds;           ///< of the call
    const vxt_triangle_area* triangles; ///< those that may have an area, by pair, then by number
    size_t triangle_count;              ///< of `triangles`
} vxt_area_view;

/// What an area meter is made for.
typedef struct vxt_host_area_desc {
    size_t struct_size;  ///< sizeof
    double tolerance;    ///< mm^2, from 1e-9 on; default 0.1
    double resolution;   ///< of the touch, as for a detector; default 1/64
    uint64_t most_steps; ///< of a pair, or of a label of one, at least 1; default 2^18
    uint32_t threads;    ///< 0, the default: one for each processor
    uint32_t reserved;   ///< 0
} vxt_host_area_desc;

/// Nothing.
static inline vxt_area_view vxt_area_view_init(void) {
    vxt_area_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// To 0.1 mm^2.
static inline vxt_host_area_desc vxt_host_area_desc_init(void) {
    vxt_host_area_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.struct_size = sizeof desc;
    desc.tolerance = 0.1;
    desc.resolution = 1.0 / 64;
    desc.most_steps = UINT64_C(1) << 18;
    return desc;
}

/// Where a meter puts what it measures.
typedef struct vxt_areas vxt_areas;
/// An empty one.
VXT_CHECKED vxt_result vxt_areas_create(vxt_areas** areas);
/// What it holds; valid until the next is put there, or the object ends.
VXT_CHECKED vxt_result vxt_areas_get(const vxt_areas* areas, vxt_area_view* view);
/// Ends it.
VXT_API void vxt_areas_destroy(vxt_areas* areas);

/// Measures how much of meshes is in what is opaque: voxtact::cpu::AreaMeter. One call at a time. After a failure the
/// areas hold what they held.
typedef struct vxt_host_area_meter vxt_host_area_meter;
/// Starts its threads. A null `desc` is all defaults.
VXT_CHECKED vxt_result vxt_host_area_meter_create(const vxt_host_area_desc* desc, vxt_host_area_meter** meter);
/// The contact area of every pair.
VXT_CHECKED vxt_result vxt_host_area_meter_measure(vxt_host_area_meter* meter, const vxt_host_batch* batch,
                                                   vxt_areas* areas);
/// The same, and what each triangle has of it.
VXT_CHECKED vxt_result vxt_host_area_meter_measure_triangles(vxt_host_area_meter* meter, const vxt_host_batch* batch,
                                                             vxt_areas* areas);
/// The contact area of every pair in each label's part of what is opaque. Every item needs labels, on its volume's
/// grid.
VXT_CHECKED vxt_result vxt_host_area_meter_measure_labels(vxt_host_area_meter* meter, const vxt_host_batch* batch,
                                                          const int32_t* labels, size_t label_count, vxt_areas* areas);
/// How many threads it runs on; 0 of null.
VXT_API uint32_t vxt_host_area_meter_threads(const vxt_host_area_meter* meter);
/// Ends it and its threads.
VXT_API void vxt_host_area_meter_destroy(vxt_host_area_meter* meter);

#ifdef __cplusplus
}
#endif

#endif
