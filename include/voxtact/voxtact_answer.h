/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_ANSWER_H
#define VOXTACT_VOXTACT_ANSWER_H

#include "voxtact/voxtact_data.h"

/// @file
/// Answers as they lie in device memory. What holds for voxtact_vulkan.h, which includes this, holds here.

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

#ifdef __cplusplus
}
#endif

#endif
