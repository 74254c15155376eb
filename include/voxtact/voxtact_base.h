/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_BASE_H
#define VOXTACT_VOXTACT_BASE_H

#include "voxtact/version.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// @file
/// What all of the C interface has in common: results and their texts, and the numbers that choose methods. What holds
/// for voxtact.h, which includes this, holds here.

#if defined(__GNUC__) && defined(VOXTACT_STATIC)
#define VXT_API
#define VXT_CHECKED __attribute__((warn_unused_result))
#elif defined(__GNUC__)
/// What the library exports; nothing of a static one (VOXTACT_STATIC, which its packages define).
#define VXT_API __attribute__((visibility("default")))
/// The same, of a function whose result must be looked at.
#define VXT_CHECKED __attribute__((visibility("default"), warn_unused_result))
#else
#define VXT_API
#define VXT_CHECKED
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// How a call ended. The numbers are those of voxtact::ErrorCode.
typedef enum vxt_result {
    VXT_OK = 0,                     ///< done
    VXT_ERROR_INVALID_ARGUMENT = 1, ///< an argument that no device could accept
    VXT_ERROR_UNSUPPORTED = 2,      ///< the device, its enabled features, or this build of the library cannot do this
    VXT_ERROR_LIMIT_EXCEEDED = 3,   ///< a limit of the device, named in the text with its size
    VXT_ERROR_OUT_OF_MEMORY = 4,    ///< host or device memory
    VXT_ERROR_DEVICE_LOST = 5,      ///< sticky: every later call on the same context returns it
    VXT_ERROR_VULKAN = 6,           ///< another VkResult: vxt_last_vk_result()
    VXT_ERROR_FILE = 7,             ///< a file cannot be read or written
    VXT_ERROR_FORMAT = 8,           ///< a file can be read, but what it holds cannot be used
    VXT_ERROR_NOT_READY = 9,        ///< the result asked for does not exist yet, or no longer
    VXT_ERROR_INTERNAL = 10,        ///< a bug in voxtact
    VXT_ERROR_CANCELLED = 11,       ///< the caller ended the call early: vxt_cancel
    VXT_RESULT_MAX = 0x7fffffff     ///< makes the type 32 bits wide
} vxt_result;

/// voxtact on one Vulkan device: voxtact_vulkan.h.
typedef struct vxt_context vxt_context;

/// "0.1.0"; it lives for ever.
VXT_API const char* vxt_version(void);
/// One line about what went wrong last: which argument, why, and what to do. Of a context: in any call that had to do
/// with it or with what was made with it, from any thread. Null: in the calling thread. Empty where nothing did.
/// Success does not change it. Valid until the same thread asks again.
VXT_API const char* vxt_last_error(const vxt_context* context);
/// The VkResult behind that error; 0 (VK_SUCCESS) where there is none.
VXT_API int32_t vxt_last_vk_result(const vxt_context* context);

/// How surviving fragments are counted: voxtact::CountingMethod.
typedef enum vxt_method {
    VXT_METHOD_QUERY = 0,       ///< precise occlusion query, one a pair
    VXT_METHOD_QUERY_ANY = 1,   ///< occlusion query without the precise bit: zero or not zero
    VXT_METHOD_ATOMIC = 2,      ///< one atomicAdd a survivor
    VXT_METHOD_SUBGROUP = 3,    ///< ballot, then one atomicAdd a subgroup
    VXT_METHOD_COMPUTE = 4,     ///< no rasteriser: a compute shader covers the same pixels by the same rule
    VXT_METHOD_CPU = 5,         ///< the host, no device
    VXT_METHOD_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_method;

/// How a mesh is turned into fragments: voxtact::Projection.
typedef enum vxt_projection {
    VXT_PROJECTION_VIEW = 0,          ///< the caller's camera and viewport
    VXT_PROJECTION_TWO_VIEW = 1,      ///< the view, and its view volume seen along its x
    VXT_PROJECTION_DOMINANT_AXIS = 2, ///< each triangle along its own dominant axis in voxel space: no camera
    VXT_PROJECTION_CERTIFIED = 3,     ///< every voxel cell that a triangle passes through, decided with bounds
    VXT_PROJECTION_MAX = 0x7fffffff   ///< makes the type 32 bits wide
} vxt_projection;

/// How the image is sampled: voxtact::Filter.
typedef enum vxt_filter {
    VXT_FILTER_HARDWARE = 0,    ///< the device's sampler
    VXT_FILTER_EXACT = 1,       ///< fp32 in a written order: the same bits on every device and on the host
    VXT_FILTER_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_filter;

/// What happens to fragments outside of the volume: voxtact::Boundary.
typedef enum vxt_boundary {
    VXT_BOUNDARY_AUTO = 0,        ///< CLAMP where it provably gives the same count
    VXT_BOUNDARY_RANGE = 1,       ///< a range test discards them
    VXT_BOUNDARY_CLAMP = 2,       ///< the coordinate is clamped. The caller vouches for transparent boundary voxels
    VXT_BOUNDARY_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_boundary;

/// What a count is worth: voxtact::Exactness.
typedef enum vxt_exactness {
    VXT_EXACTNESS_EXACT = 0,       ///< it is the count
    VXT_EXACTNESS_LOWER_BOUND = 1, ///< at least that many
    VXT_EXACTNESS_REFUSED = 2,     ///< nothing was counted: the pose, which is on the device, is not finite or affine
    VXT_EXACTNESS_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_exactness;

/// The names as on the command line ("query-any"); they live for ever; "unknown" for a number that is none.
/// @{
VXT_API const char* vxt_method_name(vxt_method method);
VXT_API const char* vxt_projection_name(vxt_projection projection);
VXT_API const char* vxt_filter_name(vxt_filter filter);
VXT_API const char* vxt_boundary_name(vxt_boundary boundary);
VXT_API const char* vxt_exactness_name(vxt_exactness exactness);
/// @}
/// The inverse of vxt_method_name().
VXT_CHECKED vxt_result vxt_method_from_name(const char* name, vxt_method* method);
/// The inverse of vxt_projection_name().
VXT_CHECKED vxt_result vxt_projection_from_name(const char* name, vxt_projection* projection);
/// Whether a projection looks through the batch's view.
VXT_API uint32_t vxt_projection_uses_view(vxt_projection projection);
/// What a count by a method is worth, at most.
VXT_API vxt_exactness vxt_method_exactness(vxt_method method);
/// EXACT for the methods that are the same on every device with it (compute, cpu), HARDWARE for the others.
VXT_API vxt_filter vxt_default_filter(vxt_method method);

/// What a detector answers in addition to the counts: bits of `outputs`.
typedef enum vxt_output {
    VXT_OUTPUT_TRIANGLES = 1,   ///< which triangles have survivors, and how many
    VXT_OUTPUT_CONTACTS = 2,    ///< a vxt_contact for each survivor, as many as there is room for
    VXT_OUTPUT_BOUNDS = 4,      ///< the world box of the survivors of each pair
    VXT_OUTPUT_LABELS = 8,      ///< survivors by the label of the place where they are; the items need label maps
    VXT_OUTPUT_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_output;

#ifdef __cplusplus
}
#endif

#endif
