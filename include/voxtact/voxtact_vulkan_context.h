/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_CONTEXT_H
#define VOXTACT_VOXTACT_VULKAN_CONTEXT_H

#include "voxtact/device_memory.h"
#include "voxtact/voxtact.h"

#include <vulkan/vulkan_core.h>

/// @file
/// The caller's device: what it must have, which counting methods it can be trusted with. See voxtact_vulkan.h.

#ifdef __cplusplus
extern "C" {
#endif

/// `text` is valid during the call only. May be called from any thread that calls voxtact.
typedef void (*vxt_log_callback)(void* user, const char* text);

/// The caller's device: voxtact::ContextDesc. The handles, the loader's pointer, the allocator, the memory and the log
/// callbacks are kept and must outlive what is made with the context.
typedef struct vxt_context_desc {
    size_t struct_size;                                ///< sizeof
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;  ///< the caller's loader
    VkInstance instance;                               ///< the caller's
    VkPhysicalDevice physical_device;                  ///< that the device was made of
    VkDevice device;                                   ///< the caller's; outlives all that is made with it
    const VkPhysicalDeviceFeatures2* enabled_features; ///< the chain that vkCreateDevice was given
    const char* const* enabled_instance_extensions;    ///< only VK_EXT_debug_utils is looked for
    size_t enabled_instance_extension_count;           ///< of these
    const char* const* enabled_device_extensions;      ///< those of vxt_optional_device_extensions() are looked for
    size_t enabled_device_extension_count;             ///< of these
    VkPipelineCache pipeline_cache;                    ///< optional
    const VkAllocationCallbacks* allocator;            ///< optional
    vxt_log_callback log;                              ///< optional; warnings, a line each
    void* log_user;                                    ///< the first argument of every call of `log`
    uint32_t api_version;                              ///< of the instance; at least VK_API_VERSION_1_3
    const uint32_t* queue_families;                    ///< of the queues that use what is made; two or more share it
    size_t queue_family_count;                         ///< of these: voxtact::ContextDesc::queueFamilies
    uint64_t fragments_at_once;                        ///< that a draw tests: voxtact::ContextDesc::fragmentsAtOnce
    vxt_memory_callbacks memory;                       ///< optional: the caller's allocator of device memory
} vxt_context_desc;

/// A feature that voxtact uses: voxtact::Requirement. Its texts live for ever.
typedef struct vxt_requirement {
    const char* feature;   ///< member of `structure`, as Vulkan spells it
    const char* structure; ///< e.g. "VkPhysicalDeviceVulkan13Features"
    const char* without;   ///< what is lost without it
    uint32_t required;     ///< 0: recommended
} vxt_requirement;

/// How many there are.
VXT_API size_t vxt_requirement_count(void);
/// One of them, in the order in which vxt_check() reports them.
VXT_CHECKED vxt_result vxt_requirement_get(size_t index, vxt_requirement* requirement);
/// Device extensions that voxtact can use, and that no method needs. They live for ever.
VXT_API const char* const* vxt_optional_device_extensions(size_t* count);

/// A feature chain for vkCreateDevice: voxtact::FeatureRequest.
typedef struct vxt_features vxt_features;
/// Every one of the requirements that `supported` (what vkGetPhysicalDeviceFeatures2 filled in) offers, and nothing
/// else. Null: the required ones only.
VXT_CHECKED vxt_result vxt_features_create(const VkPhysicalDeviceFeatures2* supported, vxt_features** features);
/// The chain, valid as long as the object: VkPhysicalDeviceFeatures2, Vulkan12Features, Vulkan13Features. Add your own
/// features to the members of these, and your own structs behind the last one.
VXT_API VkPhysicalDeviceFeatures2* vxt_features_chain(vxt_features* features);
/// Ends it.
VXT_API void vxt_features_destroy(vxt_features* features);

/// A queue of the caller's for what blocks: voxtact::QueueAccess.
typedef struct vxt_queue {
    size_t struct_size;         ///< sizeof
    VkQueue queue;              ///< of the context's device
    void (*lock)(void* user);   ///< called before each submission; may be null
    void (*unlock)(void* user); ///< called after it; may be null
    void* user;                 ///< the argument of both
    uint32_t family;            ///< of the queue; with graphics or, for uploads, compute
} vxt_queue;

/// voxtact on one device: voxtact::Context. Any number of them live in one process.
VXT_CHECKED vxt_result vxt_context_create(const vxt_context_desc* desc, vxt_context** context);
/// Whether a counting method can be had in a projection on this device.
VXT_API uint32_t vxt_context_supports(const vxt_context* context, vxt_method method, vxt_projection projection);
/// The exact method that needs least: query, else atomic, else query-any.
VXT_API vxt_method vxt_context_default_method(const vxt_context* context);
/// Largest viewport.
VXT_API VkExtent2D vxt_context_max_viewport(const vxt_context* context);
/// Whether any call has seen VK_ERROR_DEVICE_LOST; every later one fails with VXT_ERROR_DEVICE_LOST.
VXT_API uint32_t vxt_context_device_lost(const vxt_context* context);
/// Ends it. What was made with it lives on.
VXT_API void vxt_context_destroy(vxt_context* context);

/// A Vulkan device of the library's own, for whoever has none: an instance, a device with one queue, and a context. The
/// Vulkan loader is looked for when it is opened. One that was opened before fork() cannot be used in the child.
typedef struct vxt_device vxt_device;
/// A device of the machine.
typedef struct vxt_device_facts {
    size_t struct_size;   ///< sizeof
    char name[256];       ///< as the driver has it
    char driver[520];     ///< its name and version
    const char* type;     ///< "discrete", "integrated", "virtual", "cpu" or "other"; it lives for ever
    uint32_t index;       ///< its number
    uint32_t api_version; ///< as VK_MAKE_API_VERSION packs it
} vxt_device_facts;
/// How many there are. UNSUPPORTED where there is no loader or no device.
VXT_CHECKED vxt_result vxt_device_count(uint32_t* count);
/// What is known of one of them.
VXT_CHECKED vxt_result vxt_device_describe(uint32_t index, vxt_device_facts* facts);
/// Opens one: `wanted` is its number, a part of its name, or "" for the best. Refuses a name of no or of several
/// devices, and lists those that there are. UNSUPPORTED without a loader, a device or Vulkan 1.3.
VXT_CHECKED vxt_result vxt_device_open(const char* wanted, vxt_device** device);
/// What is known of it.
VXT_CHECKED vxt_result vxt_device_get_facts(const vxt_device* device, vxt_device_facts* facts);
/// Its context; the device's own, valid as long as it. Null of null.
VXT_API const vxt_context* vxt_device_context(const vxt_device* device);
/// Its queue, for what blocks; valid as long as the device.
VXT_CHECKED vxt_result vxt_device_queue(const vxt_device* device, vxt_queue* queue);
/// Begins to record commands. One thread at a time, up to vxt_device_submit().
VXT_CHECKED vxt_result vxt_device_begin(vxt_device* device, VkCommandBuffer* commands);
/// Submits what was recorded, and waits.
VXT_CHECKED vxt_result vxt_device_submit(vxt_device* device);
/// Destroys it. What was made with it must have been destroyed.
VXT_API void vxt_device_destroy(vxt_device* device);

/// What is known of a counting method on a device.
typedef struct vxt_method_report {
    const char* text;   ///< why it is not available or not trusted, or what was counted; may be empty
    vxt_method method;  ///< which
    uint32_t available; ///< whether a detector can be made for it
    uint32_t trusted;   ///< vxt_self_test(): every count was as it must be
} vxt_method_report;

/// What vxt_check() or vxt_self_test() found.
typedef struct vxt_report_view {
    size_t struct_size;               ///< sizeof
    const char* const* missing;       ///< vxt_check(): a line for each thing: what, and what it costs
    size_t missing_count;             ///< of these
    const vxt_method_report* methods; ///< every counting method of a device
    size_t method_count;              ///< of these
    uint32_t usable;                  ///< a context can be made
} vxt_report_view;

/// A report.
typedef struct vxt_report vxt_report;
/// What is in it; valid as long as the object.
VXT_CHECKED vxt_result vxt_report_get(const vxt_report* report, vxt_report_view* view);
/// Ends it.
VXT_API void vxt_report_destroy(vxt_report* report);
/// Which methods a detector can be made for on this device, and why others cannot.
VXT_CHECKED vxt_result vxt_context_methods(const vxt_context* context, vxt_report** report);
/// Looks at a description without making anything. What is wrong with the device is in the report, not in the result.
VXT_CHECKED vxt_result vxt_check(const vxt_context_desc* desc, vxt_report** report);
/// Counts a known number of fragments by each method: voxtact::selfTest(). Blocks.
VXT_CHECKED vxt_result vxt_self_test(const vxt_context* context, const vxt_queue* queue, vxt_report** report);

#ifdef __cplusplus
}
#endif

#endif
