/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_DEVICE_MEMORY_H
#define VOXTACT_DEVICE_MEMORY_H

#include <vulkan/vulkan_core.h>

/// @file
/// Device memory from the caller's own allocator, such as VMA, for ContextDesc::memory and vxt_context_desc::memory;
/// one definition for C and C++. Sizes, alignments and offsets are in bytes. docs/embedding.md shows the functions for
/// VMA.

#ifdef __cplusplus
extern "C" {
#endif

/// A buffer or an image that needs memory.
typedef struct vxt_memory_request {
    VkMemoryRequirements requirements; ///< the driver's: size, alignment and bits of the memory types that are allowed
    VkMemoryPropertyFlags required;    ///< flags that the memory type must have: 0, or HOST_VISIBLE and HOST_COHERENT
    VkMemoryPropertyFlags preferred;   ///< flags that it should have as well: DEVICE_LOCAL, HOST_CACHED or 0
    VkBuffer buffer;                   ///< created and not bound; null for an image. For a dedicated allocation
    VkImage image;                     ///< created and not bound; null for a buffer
    const char* name;                  ///< the object's, for debugging; valid during the call
} vxt_memory_request;

/// The memory of one buffer or image, which voxtact binds to it.
typedef struct vxt_device_memory {
    VkDeviceMemory memory; ///< never null
    VkDeviceSize offset;   ///< from its beginning; a multiple of the alignment
    void* mapped;          ///< where HOST_VISIBLE is required: the host address of `offset`, valid until release()
    void* handle;          ///< the caller's, for release(); may be null
} vxt_device_memory;

/// The caller's allocator. Both functions or none.
///
/// Threads: called from every thread that makes or ends objects of voxtact, by several at once. They must not call
/// voxtact.
/// Lifetime: `user` must outlive all that was made with the Context; objects that outlive the Context still release
/// their memory.
/// Errors: a result of allocate() other than VK_SUCCESS is that of voxtact's call, which leaves nothing behind:
/// VK_ERROR_OUT_OF_DEVICE_MEMORY is ErrorCode::OutOfMemory. Neither function may throw.
typedef struct vxt_memory_callbacks {
    /// Fills in `memory` for one buffer or image that is alone in its range. Bound to buffers and optimally tiled
    /// images: bufferImageGranularity is the allocator's to keep.
    VkResult (*allocate)(void* user, const vxt_memory_request* request, vxt_device_memory* memory);
    /// Takes back what allocate() gave, once for each success, when the buffer or image has been destroyed. Not called
    /// any more after a submission that could not be waited for: the device may still use everything.
    void (*release)(void* user, const vxt_device_memory* memory);
    void* user; ///< the first argument of both
} vxt_memory_callbacks;

#ifdef __cplusplus
}
#endif

#endif
