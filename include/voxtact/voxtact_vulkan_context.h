/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_VULKAN_CONTEXT_H
#define VOXTACT_VOXTACT_VULKAN_CONTEXT_H

#include "voxtact/device_memory.h"
#include "voxtact/voxtact.h"

#include <vulkan/vulkan_core.h>

/// @file
/// The caller's device: its requirements and reliable counting methods. See voxtact_vulkan.h.

#ifdef __cplusplus
extern "C" {
#endif

/// Receives a log line. `text` is valid during the call only. Called from any thread that calls voxtact.
typedef void (*vxt_log_callback)(void* user, const char* text);

/// The caller's device: voxtact::ContextDesc. The handles, the loader's pointer, the allocator, the memory and the log
/// callbacks are kept and must outlive what is made with the context.
typedef struct vxt_context_desc {
    size_t struct_size;                                ///< sizeof this struct
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;  ///< the caller's loader
    VkInstance instance;                               ///< the caller's instance
    VkPhysicalDevice physical_device;                  ///< physical device of `device`
    VkDevice device;                                   ///< the caller's device; outlives all objects created with it
    const VkPhysicalDeviceFeatures2* enabled_features; ///< the feature chain passed to vkCreateDevice
    const char* const* enabled_instance_extensions;    ///< only VK_EXT_debug_utils matters
    size_t enabled_instance_extension_count;           ///< length of enabled_instance_extensions
    const char* const* enabled_device_extensions;      ///< only those of vxt_optional_device_extensions() matter
    size_t enabled_device_extension_count;             ///< length of enabled_device_extensions
    VkPipelineCache pipeline_cache;                    ///< optional
    const VkAllocationCallbacks* allocator;            ///< optional
    vxt_log_callback log;                              ///< optional; receives warnings, one line each
    void* log_user;                                    ///< first argument of `log`
    uint32_t api_version;                              ///< of the instance; at least VK_API_VERSION_1_3
    const uint32_t* queue_families;                    ///< of the queues that use what is made; two or more share it
    size_t queue_family_count;                         ///< of these: voxtact::ContextDesc::queueFamilies
    uint64_t fragments_at_once;                        ///< that a draw tests: voxtact::ContextDesc::fragmentsAtOnce
    vxt_memory_callbacks memory;                       ///< optional: the caller's allocator of device memory
} vxt_context_desc;

/// A feature that voxtact uses: voxtact::Requirement. Its texts have static lifetime.
typedef struct vxt_requirement {
    const char* feature;   ///< member of `structure`, as Vulkan spells it
    const char* structure; ///< e.g. "VkPhysicalDeviceVulkan13Features"
    const char* without;   ///< the loss without it
    uint32_t required;     ///< 1: required; 0: recommended
} vxt_requirement;

/// Returns the number of requirements.
VXT_API size_t vxt_requirement_count(void);
/// Returns a requirement by index, in the order of vxt_check().
VXT_CHECKED vxt_result vxt_requirement_get(size_t index, vxt_requirement* requirement);
/// Returns the device extensions that voxtact can use; no method needs them. Static lifetime.
VXT_API const char* const* vxt_optional_device_extensions(size_t* count);

/// A feature chain for vkCreateDevice: voxtact::FeatureRequest.
typedef struct vxt_features vxt_features;
/// Creates a chain of exactly the requirements that `supported` offers, as vkGetPhysicalDeviceFeatures2 filled it in.
/// Null: only the required ones.
VXT_CHECKED vxt_result vxt_features_create(const VkPhysicalDeviceFeatures2* supported, vxt_features** features);
/// Returns the chain: VkPhysicalDeviceFeatures2, Vulkan12Features, Vulkan13Features; valid as long as the object. Set
/// your own features in their members, and append your own structs.
VXT_API VkPhysicalDeviceFeatures2* vxt_features_chain(vxt_features* features);
/// Destroys the object.
VXT_API void vxt_features_destroy(vxt_features* features);

/// A queue of the caller for blocking calls: voxtact::QueueAccess.
typedef struct vxt_queue {
    size_t struct_size;         ///< sizeof this struct
    VkQueue queue;              ///< a queue of the context's device
    void (*lock)(void* user);   ///< called before each submission; may be null
    void (*unlock)(void* user); ///< called after each submission; may be null
    void* user;                 ///< the argument of both
    uint32_t family;            ///< family of the queue; with graphics or, for uploads, compute
} vxt_queue;

/// Creates a context, voxtact on one device: voxtact::Context. A process may have any number of them.
VXT_CHECKED vxt_result vxt_context_create(const vxt_context_desc* desc, vxt_context** context);
/// Returns 1 if the device supports a counting method in a projection.
VXT_API uint32_t vxt_context_supports(const vxt_context* context, vxt_method method, vxt_projection projection);
/// Returns the exact method with the fewest requirements: query, else atomic, else query-any.
VXT_API vxt_method vxt_context_default_method(const vxt_context* context);
/// Returns the largest viewport.
VXT_API VkExtent2D vxt_context_max_viewport(const vxt_context* context);
/// Returns 1 if any call has seen VK_ERROR_DEVICE_LOST; every later call fails with VXT_ERROR_DEVICE_LOST.
VXT_API uint32_t vxt_context_device_lost(const vxt_context* context);
/// Destroys the object; objects created with it remain valid.
VXT_API void vxt_context_destroy(vxt_context* context);

/// A Vulkan device that the library owns: an instance, a device with one queue, and a context. Opening it loads the
/// Vulkan loader. A child process cannot use a device that was opened before fork().
typedef struct vxt_device vxt_device;
/// Facts of a device of the machine.
typedef struct vxt_device_facts {
    size_t struct_size;   ///< sizeof this struct
    char name[256];       ///< name of the driver's device
    char driver[520];     ///< name and version of the driver
    const char* type;     ///< "discrete", "integrated", "virtual", "cpu" or "other"; static lifetime
    uint32_t index;       ///< index of the device
    uint32_t api_version; ///< as VK_MAKE_API_VERSION packs it
} vxt_device_facts;
/// Returns the number of devices. UNSUPPORTED without a loader or a device.
VXT_CHECKED vxt_result vxt_device_count(uint32_t* count);
/// Returns the facts of a device by index.
VXT_CHECKED vxt_result vxt_device_describe(uint32_t index, vxt_device_facts* facts);
/// Opens a device: `wanted` is its index, a part of its name, or "" for the best. Refuses a name of no device or
/// several, and lists the devices. UNSUPPORTED without a loader, a device or Vulkan 1.3.
VXT_CHECKED vxt_result vxt_device_open(const char* wanted, vxt_device** device);
/// Returns the facts of the device.
VXT_CHECKED vxt_result vxt_device_get_facts(const vxt_device* device, vxt_device_facts* facts);
/// Returns the device's context, valid as long as the device. Null for null.
VXT_API const vxt_context* vxt_device_context(const vxt_device* device);
/// Returns the device's queue for blocking calls, valid as long as the device.
VXT_CHECKED vxt_result vxt_device_queue(const vxt_device* device, vxt_queue* queue);
/// Begins recording commands. One thread at a time, until vxt_device_submit().
VXT_CHECKED vxt_result vxt_device_begin(vxt_device* device, VkCommandBuffer* commands);
/// Submits the recorded commands, and waits.
VXT_CHECKED vxt_result vxt_device_submit(vxt_device* device);
/// Destroys the object. All objects created with it must have been destroyed.
VXT_API void vxt_device_destroy(vxt_device* device);

/// State of a counting method on a device.
typedef struct vxt_method_report {
    const char* text;   ///< reason if not available or not trusted, or the counts; may be empty
    vxt_method method;  ///< the method
    uint32_t available; ///< 1: a detector can use it
    uint32_t trusted;   ///< 1: vxt_self_test() found every count correct
} vxt_method_report;

/// Contents of a report of vxt_check() or vxt_self_test().
typedef struct vxt_report_view {
    size_t struct_size;               ///< sizeof this struct
    const char* const* missing;       ///< vxt_check(): one line each: the missing requirement, and the loss
    size_t missing_count;             ///< length of `missing`
    const vxt_method_report* methods; ///< every counting method of a device
    size_t method_count;              ///< length of `methods`
    uint32_t usable;                  ///< 1: a context can be created
} vxt_report_view;

/// A report.
typedef struct vxt_report vxt_report;
/// Returns the contents, valid as long as the object.
VXT_CHECKED vxt_result vxt_report_get(const vxt_report* report, vxt_report_view* view);
/// Destroys the object.
VXT_API void vxt_report_destroy(vxt_report* report);
/// Reports the methods that a detector can use on this device, and why others cannot be used.
VXT_CHECKED vxt_result vxt_context_methods(const vxt_context* context, vxt_report** report);
/// Checks a description without creating anything. Problems of the device are in the report, not in the result.
VXT_CHECKED vxt_result vxt_check(const vxt_context_desc* desc, vxt_report** report);
/// Counts a known number of fragments by each method: voxtact::selfTest(). Blocks.
VXT_CHECKED vxt_result vxt_self_test(const vxt_context* context, const vxt_queue* queue, vxt_report** report);

#ifdef __cplusplus
}
#endif

#endif
