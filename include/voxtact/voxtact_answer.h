/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_ANSWER_H
#define VOXTACT_VOXTACT_ANSWER_H

#include "voxtact/voxtact_data.h"

/// @file
/// Answers in device memory. The conventions of voxtact_vulkan.h apply.

#ifdef __cplusplus
extern "C" {
#endif

/// The answer for one pair: voxtact::PairAnswer.
typedef struct vxt_pair {
    uint64_t count;            ///< passing fragments; 1 for a hit of a boolean query or an early exit
    uint32_t pair;             ///< index of the pair in its batch
    uint32_t item;             ///< index of the item of the pair
    uint32_t pose;             ///< index of the pose in that item
    uint32_t hit;              ///< at least one passing fragment: the pair certainly touches
    uint32_t possible;         ///< undecided: no passing fragment, but undecided fragments
    vxt_exactness exactness;   ///< meaning of the count
    vxt_method method;         ///< method that counted
    vxt_projection projection; ///< projection that made the fragments
} vxt_pair;

/// The answer for one pair in device memory: PairResult of device_results.h, which is for C++ and GLSL.
typedef struct vxt_device_pair {
    uint32_t count_low;  ///< passing fragments, low 32 bits
    uint32_t count_high; ///< passing fragments, high 32 bits
    uint32_t pair;       ///< index of the pair in its batch
    uint32_t item;       ///< index of the item of the pair
    uint32_t pose;       ///< index of the pose in that item
    uint32_t how;        ///< method, projection, exactness and more, packed
} vxt_device_pair;

/// A contact in device memory: ContactResult of device_results.h.
typedef struct vxt_device_contact {
    float position[3]; ///< world, mm
    float normal[3];   ///< unit vector, or zero
    float depth;       ///< mm
    float value;       ///< image value, in its own units
    float opacity;     ///< opacity of that value, 0..1
    uint32_t pair;     ///< index of the pair in its batch
    uint32_t triangle; ///< index of the triangle in the mesh
    uint32_t label;    ///< index of the label in the label map's values; 0 without a label map
} vxt_device_contact;

/// Unpacks a device pair: voxtact::unpack().
VXT_CHECKED vxt_result vxt_unpack(const vxt_device_pair* packed, vxt_pair* pair);

#ifdef __cplusplus
}
#endif

#endif
