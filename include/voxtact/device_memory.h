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
    VkMemoryRequirements requirements; ///< from the driver: size, alignment, bits of the allowed memory types
    VkMemoryPropertyFlags required;    ///< flags that the memory type must have: 0, or HOST_VISIBLE and HOST_COHERENT
    VkMemoryPropertyFlags preferred;   ///< flags that it should also have: DEVICE_LOCAL, HOST_CACHED or 0
    VkBuffer buffer;                   ///< for a dedicated allocation: created, not bound; null for an image
    VkImage image;                     ///< created, not bound; null for a buffer
    const char* name;                  ///< name of the object, for debugging; valid during the call
} vxt_memory_request;

/// Memory that voxtact binds to one buffer or image.
typedef struct vxt_device_memory {
    VkDeviceMemory memory; ///< never null
    VkDeviceSize offset;   ///< from the beginning of `memory`; a multiple of the alignment
    void* mapped;          ///< if HOST_VISIBLE is required: the host address of `offset`, valid until release()
    void* handle;          ///< private to the caller, for release(); may be null
} vxt_device_memory;

/// The caller's allocator. Set both functions or neither.
///
/// Threads: called from any thread that creates or destroys objects of voxtact, also concurrently. Neither function may
/// call voxtact.
/// Lifetime: `user` must outlive all objects created with the Context; objects that outlive the Context still release
/// their memory.
/// Errors: if allocate() fails, voxtact's call creates nothing and returns its VkResult: VK_ERROR_OUT_OF_DEVICE_MEMORY
/// is ErrorCode::OutOfMemory. Neither function may throw.
typedef struct vxt_memory_callbacks {
    /// Fills in `memory` for one buffer or optimally tiled image, which is alone in its range. The allocator must
    /// respect bufferImageGranularity.
    VkResult (*allocate)(void* user, const vxt_memory_request* request, vxt_device_memory* memory);
    /// Releases the memory of one successful allocate(), after the buffer or image is destroyed. Not called after a
    /// failed wait for a submission: the device may still use all memory.
    void (*release)(void* user, const vxt_device_memory* memory);
    void* user; ///< first argument of both functions
} vxt_memory_callbacks;

#ifdef __cplusplus
}
#endif

#endif
