/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_BASE_H
#define VOXTACT_VOXTACT_BASE_H

#include "voxtact/version.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// @file
/// Common parts of the C interface: results and their texts, and the numbers of methods. The conventions of voxtact.h
/// apply.

#if defined(__GNUC__) && defined(VOXTACT_STATIC)
#define VXT_API
#define VXT_CHECKED __attribute__((warn_unused_result))
#elif defined(__GNUC__)
/// Marks exported symbols; empty for a static library (VOXTACT_STATIC, which its packages define).
#define VXT_API __attribute__((visibility("default")))
/// Marks exported functions whose result must be checked.
#define VXT_CHECKED __attribute__((visibility("default"), warn_unused_result))
#else
#define VXT_API
#define VXT_CHECKED
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// Result of a call. The numbers are those of voxtact::ErrorCode.
typedef enum vxt_result {
    VXT_OK = 0,                     ///< done
    VXT_ERROR_INVALID_ARGUMENT = 1, ///< an argument that no device could accept
    VXT_ERROR_UNSUPPORTED = 2,      ///< not supported by the device, its enabled features, or this build of the library
    VXT_ERROR_LIMIT_EXCEEDED = 3,   ///< a limit of the device; the text names it with its value
    VXT_ERROR_OUT_OF_MEMORY = 4,    ///< host or device memory
    VXT_ERROR_DEVICE_LOST = 5,      ///< sticky: every later call on the same context returns it
    VXT_ERROR_VULKAN = 6,           ///< another VkResult: vxt_last_vk_result()
    VXT_ERROR_FILE = 7,             ///< a file cannot be read or written
    VXT_ERROR_FORMAT = 8,           ///< the contents of a file cannot be used
    VXT_ERROR_NOT_READY = 9,        ///< the result does not exist yet, or was replaced
    VXT_ERROR_INTERNAL = 10,        ///< a bug in voxtact
    VXT_ERROR_CANCELLED = 11,       ///< the caller cancelled the call: vxt_cancel
    VXT_RESULT_MAX = 0x7fffffff     ///< makes the type 32 bits wide
} vxt_result;

/// voxtact on one Vulkan device: voxtact_vulkan.h.
typedef struct vxt_context vxt_context;

/// Returns the version, "0.1.0", with static lifetime.
VXT_API const char* vxt_version(void);
/// Returns the last error as one line: the argument, the reason and the fix. With a context: of any call that used it
/// or its objects, from any thread. Null: of the calling thread. Empty without an error; success does not change it.
/// Valid until the same thread calls this again.
VXT_API const char* vxt_last_error(const vxt_context* context);
/// Returns the VkResult of that error; 0 (VK_SUCCESS) if there is none.
VXT_API int32_t vxt_last_vk_result(const vxt_context* context);

/// How passing fragments are counted: voxtact::CountingMethod.
typedef enum vxt_method {
    VXT_METHOD_QUERY = 0,       ///< precise occlusion query, one per pair
    VXT_METHOD_QUERY_ANY = 1,   ///< occlusion query without the precise bit: zero or not zero
    VXT_METHOD_ATOMIC = 2,      ///< one atomicAdd per passing fragment
    VXT_METHOD_SUBGROUP = 3,    ///< ballot, then one atomicAdd per subgroup
    VXT_METHOD_COMPUTE = 4,     ///< no rasteriser: a compute shader covers the same pixels by the same rule
    VXT_METHOD_CPU = 5,         ///< on the host, without a device
    VXT_METHOD_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_method;

/// How triangles become fragments: voxtact::Projection.
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
    VXT_FILTER_EXACT = 1,       ///< fp32 in a fixed order: the same bits on every device and on the host
    VXT_FILTER_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_filter;

/// Treatment of fragments outside the volume: voxtact::Boundary.
typedef enum vxt_boundary {
    VXT_BOUNDARY_AUTO = 0,        ///< CLAMP if it provably gives the same count
    VXT_BOUNDARY_RANGE = 1,       ///< a range test discards them
    VXT_BOUNDARY_CLAMP = 2,       ///< the coordinate is clamped; the caller guarantees transparent boundary voxels
    VXT_BOUNDARY_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_boundary;

/// Meaning of a count: voxtact::Exactness.
typedef enum vxt_exactness {
    VXT_EXACTNESS_EXACT = 0,       ///< the exact count
    VXT_EXACTNESS_LOWER_BOUND = 1, ///< a lower bound
    VXT_EXACTNESS_REFUSED = 2,     ///< nothing was counted: the pose on the device is not finite or not affine
    VXT_EXACTNESS_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_exactness;

/// Return the names on the command line ("query-any"), with static lifetime; "unknown" for an invalid number.
/// @{
VXT_API const char* vxt_method_name(vxt_method method);
VXT_API const char* vxt_projection_name(vxt_projection projection);
VXT_API const char* vxt_filter_name(vxt_filter filter);
VXT_API const char* vxt_boundary_name(vxt_boundary boundary);
VXT_API const char* vxt_exactness_name(vxt_exactness exactness);
/// @}
/// Inverts vxt_method_name().
VXT_CHECKED vxt_result vxt_method_from_name(const char* name, vxt_method* method);
/// Inverts vxt_projection_name().
VXT_CHECKED vxt_result vxt_projection_from_name(const char* name, vxt_projection* projection);
/// Returns 1 if a projection uses the batch's view, else 0.
VXT_API uint32_t vxt_projection_uses_view(vxt_projection projection);
/// Returns the best exactness of a method.
VXT_API vxt_exactness vxt_method_exactness(vxt_method method);
/// Returns EXACT for methods that give the same count on every device with it (compute, cpu), HARDWARE for the others.
VXT_API vxt_filter vxt_default_filter(vxt_method method);

/// Additional outputs of a detector: bits of `outputs`.
typedef enum vxt_output {
    VXT_OUTPUT_TRIANGLES = 1,   ///< triangles with passing fragments, and their counts
    VXT_OUTPUT_CONTACTS = 2,    ///< a contact per passing fragment, up to the capacity
    VXT_OUTPUT_BOUNDS = 4,      ///< world bounding box of each pair's passing fragments
    VXT_OUTPUT_LABELS = 8,      ///< counts per label of the passing fragments; the items need label maps
    VXT_OUTPUT_MAX = 0x7fffffff ///< makes the type 32 bits wide
} vxt_output;

#ifdef __cplusplus
}
#endif

#endif
