// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/device_memory.h"
#include "voxtact/error.h"
#include "voxtact/methods.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace voxtact {

struct ContextImpl;

/// Receives a warning. `text` is valid during the call only. Called from any thread that calls voxtact.
using LogCallback = void (*)(void* user, const char* text);

using MemoryRequest = vxt_memory_request;     ///< a buffer or an image that needs device memory
using DeviceMemory = vxt_device_memory;       ///< memory for a request
using MemoryCallbacks = vxt_memory_callbacks; ///< the caller's allocator of device memory

/// The caller's device. A zero-initialised description is valid: check() then names everything that is missing. The
/// Context keeps only the handles, `getInstanceProcAddr`, `allocator`, and the memory and log callbacks. These must
/// outlive all objects created with the Context.
struct ContextDesc {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr; ///< the caller's loader; voxtact loads none
    VkInstance instance = VK_NULL_HANDLE;                    ///< the caller's instance
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;        ///< physical device of `device`
    VkDevice device = VK_NULL_HANDLE; ///< owned by the caller; must outlive all objects created with it
    std::uint32_t apiVersion = 0;     ///< VkApplicationInfo::apiVersion of the instance; at least VK_API_VERSION_1_3
    /// The *enabled* features: the chain given to vkCreateDevice, or an equal one. Both
    /// VkPhysicalDeviceVulkan1xFeatures and the single-feature structs are read.
    const VkPhysicalDeviceFeatures2* enabledFeatures = nullptr;
    std::span<const char* const> enabledInstanceExtensions{}; ///< VK_EXT_debug_utils: names and labels
    std::span<const char* const> enabledDeviceExtensions{};   ///< only optionalDeviceExtensions() matter
    /// Families of the queues that use the Context's objects, each once. Two or more: buffers and images have
    /// VK_SHARING_MODE_CONCURRENT, and queues need only semaphores between them. Otherwise, buffers and images are
    /// exclusive and belong to the family of their upload; record ownership transfers yourself. Wrapped objects keep
    /// the caller's sharing mode.
    std::span<const std::uint32_t> queueFamilies;
    /// All projections except certified (see ResultsDesc::clustersAtOnce): maximum fragments of a draw or dispatch, if
    /// each triangle covered the viewport. A larger batch takes more draws. Each draw has at least one triangle in one
    /// view (`compute`: 64) and at most 2^22. Reduce this if the driver resets the GPU during long draws. 0: 2^34.
    std::uint64_t fragmentsAtOnce = 0;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;   ///< optional; used, never destroyed
    const VkAllocationCallbacks* allocator = nullptr; ///< optional
    /// Optional: the caller's allocator of device memory for every buffer and image. Without it, objects share the
    /// Context's pool: blocks of 1 to 64 MiB, each at most a 16th of its heap. Objects of more than a quarter of the
    /// largest block have their own allocation. Empty blocks are freed, except one of 1 MiB per memory type.
    MemoryCallbacks memory{};
    LogCallback log = nullptr; ///< optional; receives warnings of one line
    void* logUser = nullptr;   ///< first argument of `log`
};

/// A feature that voxtact uses, as data.
struct Requirement {
    const char* feature;   ///< member of `structure`, as Vulkan spells it
    const char* structure; ///< e.g. "VkPhysicalDeviceVulkan13Features"
    bool required;         ///< false: recommended
    const char* without;   ///< loss without the feature
};

/// Returns all required and recommended features, in the order of check()'s report.
[[nodiscard]] VOXTACT_API std::span<const Requirement> requirements() noexcept;

/// Returns the optional device extensions: VK_EXT_conservative_rasterization, for RasterDesc::overestimate. check()
/// does not report them.
[[nodiscard]] VOXTACT_API std::span<const char* const> optionalDeviceExtensions() noexcept;

/// A feature chain for vkCreateDevice with all requirements() that `supported` offers. Add your own features to
/// `features2.features`, `vulkan12` and `vulkan13`, or chain structs behind `vulkan13`.
class FeatureRequest {
  public:
    /// Requests features. `supported`: the chain filled by vkGetPhysicalDeviceFeatures2; null: the required ones only.
    VOXTACT_API explicit FeatureRequest(const VkPhysicalDeviceFeatures2* supported) noexcept;
    FeatureRequest(const FeatureRequest&) = delete;
    FeatureRequest& operator=(const FeatureRequest&) = delete;

    VkPhysicalDeviceFeatures2 features2{};       ///< the chain's beginning: VkDeviceCreateInfo::pNext
    VkPhysicalDeviceVulkan12Features vulkan12{}; ///< behind features2
    VkPhysicalDeviceVulkan13Features vulkan13{}; ///< behind vulkan12; its pNext is yours
};

/// Whether a counting method is supported.
struct MethodSupport {
    CountingMethod method; ///< the method
    bool available;        ///< true if a Detector can use it
    std::string reason;    ///< if not available: the missing feature
};

/// Report of check().
struct CheckReport {
    bool usable = false;                ///< true if Context::create() would succeed
    std::vector<std::string> missing;   ///< one line per missing feature, with its cost
    std::vector<MethodSupport> methods; ///< every counting method of a device
};

/// Checks a description without creating anything. Never fails: errors are in the report.
[[nodiscard]] VOXTACT_API CheckReport check(const ContextDesc& desc);

/// A queue of the caller for blocking functions. `lock` and `unlock` bracket each vkQueueSubmit2 and, after a failure,
/// vkQueueWaitIdle, so threads can share the queue. Functions wait for a fence outside the lock.
struct QueueAccess {
    VkQueue queue = VK_NULL_HANDLE;       ///< a queue of the Context's device
    std::uint32_t family = 0;             ///< family of the queue; with graphics or, for upload(), compute
    void (*lock)(void* user) = nullptr;   ///< called before each submission; may be null
    void (*unlock)(void* user) = nullptr; ///< called after each submission; may be null
    void* user = nullptr;                 ///< argument of both functions
};

/// voxtact on one device: a private function table, pipeline and descriptor layouts. No global state: a process may
/// have any number of contexts and devices. The first object that needs a compute pipeline creates it; later objects
/// share it, so creating a second Detector of a kind is fast.
///
/// Lifetime: objects created with a Context may outlive it, but not the device.
/// Thread-safety: const functions may be called, and objects created, from any thread.
class Context {
  public:
    /// Creates a context. Fails with one line that names everything missing.
    [[nodiscard]] VOXTACT_API static Result<Context> create(const ContextDesc& desc);
    VOXTACT_API Context(Context&&) noexcept;
    VOXTACT_API Context& operator=(Context&&) noexcept;
    VOXTACT_API ~Context();

    /// Returns the support of every device method, in the order of CountingMethod. Valid as long as the Context.
    [[nodiscard]] VOXTACT_API std::span<const MethodSupport> methods() const noexcept;
    /// Returns true if this device supports a counting method.
    [[nodiscard]] VOXTACT_API bool supports(CountingMethod method) const noexcept;
    /// Returns true if this device supports a method with a projection. `certified` needs `compute`, and 32-bit floats
    /// that keep infinities and NaN and round to nearest (VkPhysicalDeviceFloatControlsProperties).
    [[nodiscard]] VOXTACT_API bool supports(CountingMethod method, Projection projection) const noexcept;
    /// Returns the method with the fewest requirements: query, else atomic, else query-any.
    [[nodiscard]] VOXTACT_API CountingMethod defaultMethod() const noexcept;
    /// Returns the largest viewport.
    [[nodiscard]] VOXTACT_API VkExtent2D maxViewport() const noexcept;
    /// Returns true once any call has seen VK_ERROR_DEVICE_LOST; all later calls fail with ErrorCode::DeviceLost.
    [[nodiscard]] VOXTACT_API bool deviceLost() const noexcept;

    /// For internal use.
    [[nodiscard]] ContextImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Context(std::unique_ptr<ContextImpl> impl) noexcept;
    std::unique_ptr<ContextImpl> impl_;
};

} // namespace voxtact
