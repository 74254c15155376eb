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

/// `text` is valid during the call only. May be called from any thread that calls voxtact.
using LogCallback = void (*)(void* user, const char* text);

using MemoryRequest = vxt_memory_request;     ///< a buffer or an image that needs device memory
using DeviceMemory = vxt_device_memory;       ///< its memory
using MemoryCallbacks = vxt_memory_callbacks; ///< the caller's allocator of it

/// The caller's device. Valid when zero-initialised: check() then names everything that is missing. Nothing in it is
/// kept but the handles, `getInstanceProcAddr`, `allocator`, the memory and the log callbacks; those must outlive what
/// is made with the Context.
struct ContextDesc {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr; ///< the caller's loader; never looked up by voxtact
    VkInstance instance = VK_NULL_HANDLE;                    ///< the caller's
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;        ///< that the device was made of
    VkDevice device = VK_NULL_HANDLE;                        ///< the caller's; must outlive all that is made with it
    std::uint32_t apiVersion = 0; ///< VkApplicationInfo::apiVersion of the instance; at least VK_API_VERSION_1_3
    /// The chain that vkCreateDevice was given, or one that says the same: what was *enabled*, not what is supported.
    /// Both VkPhysicalDeviceVulkan1xFeatures and the single-feature structs are read.
    const VkPhysicalDeviceFeatures2* enabledFeatures = nullptr;
    /// Only VK_EXT_debug_utils is looked for: names and labels.
    std::span<const char* const> enabledInstanceExtensions{};
    std::span<const char* const> enabledDeviceExtensions{}; ///< those of optionalDeviceExtensions() are looked for
    /// The families of the queues that will use what is made with the Context, each once. Two or more: buffers and
    /// images are shared by them (VK_SHARING_MODE_CONCURRENT), and between queues you need semaphores alone. None or
    /// one: they are exclusive, as upload() and cmdUpload() leave them to the family that they are submitted to; for a
    /// queue of another family you record the transfer of ownership, which voxtact does not. Wrapped objects are as you
    /// made them.
    std::span<const std::uint32_t> queueFamilies;
    /// Of all projections but certified, which ResultsDesc::clustersAtOnce is for: maximum number of fragments of a
    /// draw or a dispatch, if each triangle were as large as the viewport; a larger batch takes more draws. At
    /// least a triangle in one view (by `compute`, 64). Never more than 2^22 triangles. Make it less for a GPU whose
    /// driver takes a long draw for a GPU that hangs. 0: 2^34.
    std::uint64_t fragmentsAtOnce = 0;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;   ///< optional; used, never destroyed
    const VkAllocationCallbacks* allocator = nullptr; ///< optional
    /// Optional: device memory for every buffer and image comes from the caller's allocator. Without it the Context
    /// has a pool, which objects share: blocks of 1 to 64 MiB, each at most a 16th of its heap, and an allocation of
    /// its own for an object that needs more than a quarter of the largest block. A block with nothing in it is freed,
    /// but for one of 1 MiB for each kind of memory.
    MemoryCallbacks memory{};
    LogCallback log = nullptr; ///< optional; warnings, a line each
    void* logUser = nullptr;   ///< the first argument of every call of `log`
};

/// A feature that voxtact uses, as data.
struct Requirement {
    const char* feature;   ///< member of `structure`, as Vulkan spells it
    const char* structure; ///< e.g. "VkPhysicalDeviceVulkan13Features"
    bool required;         ///< false: recommended
    const char* without;   ///< what is lost without it
};

/// Everything that voxtact requires or recommends, in the order in which check() reports it.
[[nodiscard]] VOXTACT_API std::span<const Requirement> requirements() noexcept;

/// Device extensions that voxtact can use, and that no method needs: VK_EXT_conservative_rasterization, for
/// RasterDesc::overestimate. Nothing is reported where they are not enabled.
[[nodiscard]] VOXTACT_API std::span<const char* const> optionalDeviceExtensions() noexcept;

/// A feature chain for vkCreateDevice with every one of requirements() that `supported` offers, and nothing else.
/// Add your own features to `features2.features`, `vulkan12` and `vulkan13`, or chain more structs behind `vulkan13`.
class FeatureRequest {
  public:
    /// `supported`: the chain that vkGetPhysicalDeviceFeatures2 filled in. Null asks for the required features only.
    VOXTACT_API explicit FeatureRequest(const VkPhysicalDeviceFeatures2* supported) noexcept;
    FeatureRequest(const FeatureRequest&) = delete;
    FeatureRequest& operator=(const FeatureRequest&) = delete;

    VkPhysicalDeviceFeatures2 features2{};       ///< the chain's beginning: VkDeviceCreateInfo::pNext
    VkPhysicalDeviceVulkan12Features vulkan12{}; ///< behind features2
    VkPhysicalDeviceVulkan13Features vulkan13{}; ///< behind vulkan12; its pNext is yours
};

/// Whether a counting method is supported.
struct MethodSupport {
    CountingMethod method; ///< which
    bool available;        ///< whether a Detector can be made for it
    std::string reason;    ///< when not: the missing feature
};

/// What check() found.
struct CheckReport {
    bool usable = false;                ///< Context::create() would succeed
    std::vector<std::string> missing;   ///< a line for each thing: what, and what it costs
    std::vector<MethodSupport> methods; ///< every counting method of a device
};

/// Looks at a description without making anything. Never fails: what is wrong is in the report.
[[nodiscard]] VOXTACT_API CheckReport check(const ContextDesc& desc);

/// A queue of the caller's for the blocking conveniences. lock and unlock, where given, bracket each vkQueueSubmit2
/// and, after a failure, vkQueueWaitIdle: threads can share the queue. The wait is on a fence, outside the lock.
struct QueueAccess {
    VkQueue queue = VK_NULL_HANDLE;       ///< of the Context's device
    std::uint32_t family = 0;             ///< of the device; with graphics or, for upload(), compute
    void (*lock)(void* user) = nullptr;   ///< called before each submission; may be null
    void (*unlock)(void* user) = nullptr; ///< called after it; may be null
    void* user = nullptr;                 ///< the argument of both
};

/// voxtact on one device: a private function table, pipeline and descriptor layouts. No global state: any number of
/// contexts on any number of devices live in one process. Compute pipelines are made for the first object that needs
/// them and kept: all others share them, so a further Detector of a kind is made at once.
///
/// Lifetime: what was made with a Context may outlive it. All of it must end before the device.
/// Thread-safety: the const functions, and making objects with it, are safe from any thread.
class Context {
  public:
    /// Fails with everything that is missing in one line.
    [[nodiscard]] VOXTACT_API static Result<Context> create(const ContextDesc& desc);
    VOXTACT_API Context(Context&&) noexcept;
    VOXTACT_API Context& operator=(Context&&) noexcept;
    VOXTACT_API ~Context();

    /// Every counting method of a device, in the order of their numbers. Valid as long as the Context.
    [[nodiscard]] VOXTACT_API std::span<const MethodSupport> methods() const noexcept;
    /// Whether this device supports a counting method.
    [[nodiscard]] VOXTACT_API bool supports(CountingMethod method) const noexcept;
    /// Whether it supports a projection: `certified` is for `compute` alone, and needs 32-bit floats that keep
    /// infinities and NaN and round to the nearest (VkPhysicalDeviceFloatControlsProperties).
    [[nodiscard]] VOXTACT_API bool supports(CountingMethod method, Projection projection) const noexcept;
    /// The exact method that needs least: query, else atomic, else query-any.
    [[nodiscard]] VOXTACT_API CountingMethod defaultMethod() const noexcept;
    /// Largest viewport: {width, height}.
    [[nodiscard]] VOXTACT_API VkExtent2D maxViewport() const noexcept;
    /// True once any call has seen VK_ERROR_DEVICE_LOST; every later call fails with ErrorCode::DeviceLost.
    [[nodiscard]] VOXTACT_API bool deviceLost() const noexcept;

    /// For voxtact's own parts.
    [[nodiscard]] ContextImpl& impl() const noexcept { return *impl_; }

  private:
    explicit Context(std::unique_ptr<ContextImpl> impl) noexcept;
    std::unique_ptr<ContextImpl> impl_;
};

} // namespace voxtact
