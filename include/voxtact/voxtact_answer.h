/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_ANSWER_H
#define VOXTACT_VOXTACT_ANSWER_H

#include "voxtact/voxtact_data.h"

/// @file
/// Answers of the C interface, of the host and of a device. What holds for voxtact.h, which includes this, holds here.

#ifdef __cplusplus
extern "C" {
#endif

/// The answer for one pair: voxtact::PairAnswer.
typedef struct vxt_pair {
    uint64_t count;            ///< survivors; 1 for a hit of a boolean query or an early exit
    uint32_t pair;             ///< number of the pair in its batch
    uint32_t item;             ///< number of the item that the pair came from
    uint32_t pose;             ///< number of the pose within that item
    uint32_t hit;              ///< at least one survivor: the pair certainly touches
    uint32_t possible;         ///< no survivor, but fragments that could not be decided: it may touch
    vxt_exactness exactness;   ///< what the count is worth
    vxt_method method;         ///< what counted
    vxt_projection projection; ///< what gave the fragments
} vxt_pair;

/// The answer for one pair as it lies in device memory: PairResult of device_results.h, which is for C++ and GLSL.
typedef struct vxt_device_pair {
    uint32_t count_low;  ///< survivors, low 32 bits
    uint32_t count_high; ///< survivors, high 32 bits
    uint32_t pair;       ///< number of the pair in its batch
    uint32_t item;       ///< number of the item that the pair came from
    uint32_t pose;       ///< number of the pose within that item
    uint32_t how;        ///< method, projection, exactness and more, packed
} vxt_device_pair;

/// A contact as it lies in device memory: ContactResult of device_results.h.
typedef struct vxt_device_contact {
    float position[3]; ///< world, mm
    float normal[3];   ///< unit vector, or zero
    float depth;       ///< mm
    float value;       ///< of the image, in its own units
    float opacity;     ///< of that value, 0..1
    uint32_t pair;     ///< number of the pair in its batch
    uint32_t triangle; ///< number in the mesh
    uint32_t label;    ///< number of the label in the label map's values; 0 without a label map
} vxt_device_contact;

/// What the words of one mean: voxtact::unpack().
VXT_CHECKED vxt_result vxt_unpack(const vxt_device_pair* packed, vxt_pair* pair);

/// A triangle with at least one survivor.
typedef struct vxt_touched_triangle {
    uint32_t pair;     ///< number of the pair in its batch
    uint32_t triangle; ///< number in the mesh
    uint32_t count;    ///< its survivors
} vxt_touched_triangle;

/// One survivor and its place: voxtact::Contact.
typedef struct vxt_contact {
    double position[3]; ///< world, mm: on the triangle
    double normal[3];   ///< unit vector in world space, out of what is opaque; zero where there is none
    double depth;       ///< mm along the normal to where the opacity ends; at most max_depth
    double value;       ///< of the image, in its own units
    double opacity;     ///< of that value
    uint32_t pair;      ///< number of the pair in its batch
    uint32_t triangle;  ///< number in the mesh
    int32_t label;      ///< of the nearest voxel of the label map; 0 without a map, and outside of it
    uint32_t reserved;  ///< 0
} vxt_contact;

/// Survivors of a pair at one label.
typedef struct vxt_label_count {
    uint64_t count; ///< at least 1
    uint32_t pair;  ///< number of the pair in its batch
    int32_t label;  ///< as the label map has it
} vxt_label_count;

/// What a batch gave; what the detector was not asked for is empty. The arrays are the answer's.
typedef struct vxt_answer_view {
    size_t struct_size;                    ///< sizeof
    const vxt_pair* pairs;                 ///< in the order of the batch
    size_t pair_count;                     ///< pairs of the batch
    const vxt_touched_triangle* triangles; ///< by pair, then by triangle
    size_t triangle_count;                 ///< of `triangles`
    const vxt_contact* contacts;           ///< by pair, then by triangle, then by position
    size_t contact_count;                  ///< of `contacts`
    uint64_t contacts_found;               ///< more than contact_count: the list was cut, arbitrarily
    const vxt_box* bounds;                 ///< world, of each pair; empty (lo > hi) where it has no survivor
    size_t bounds_count;                   ///< 0 or pair_count
    const vxt_label_count* labels;         ///< by pair, then by label
    size_t label_count;                    ///< of `labels`
    double gpu_milliseconds;               ///< device time of the batch; 0 where it was not measured
    double wall_milliseconds;              ///< from the start to the results in host memory; 0 where it is not known
} vxt_answer_view;

/// Nothing.
static inline vxt_answer_view vxt_answer_view_init(void) {
    vxt_answer_view view;
    memset(&view, 0, sizeof view);
    view.struct_size = sizeof view;
    return view;
}

/// Where a detector puts its answers. Used again and again, it keeps its memory.
typedef struct vxt_answer vxt_answer;
/// An empty one.
VXT_CHECKED vxt_result vxt_answer_create(vxt_answer** answer);
/// What it holds; valid until the next answer is put there, or the object ends.
VXT_CHECKED vxt_result vxt_answer_get(const vxt_answer* answer, vxt_answer_view* view);
/// Ends it.
VXT_API void vxt_answer_destroy(vxt_answer* answer);

#ifdef __cplusplus
}
#endif

#endif
