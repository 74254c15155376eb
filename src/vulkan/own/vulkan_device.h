// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"

#include <volk.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A Vulkan instance and device of our own, for the program and the tests (target voxtact_device). Every function is
/// called through a table that belongs to its instance or device, never through volk's global pointers, so any number
/// of them live in one process.
namespace voxtact::device {

/// "VK_ERROR_DEVICE_LOST"; the number for a result without a name here.
[[nodiscard]] std::string vkResultName(VkResult result);
/// An Error for a failed Vulkan call: `what` says what was tried.
[[nodiscard]] Error vulkanError(VkResult result, std::string_view what);

/// What the validation layer said, in order. Thread-safety: safe from any thread.
class ValidationMessages {
  public:
    void add(std::string message);
    [[nodiscard]] std::vector<std::string> all() const;
    [[nodiscard]] bool empty() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

/// What is known of a physical device without making a device.
struct PhysicalDevice {
    std::uint32_t index = 0; ///< in the order of vkEnumeratePhysicalDevices
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t apiVersion = 0;
    std::string driver; ///< name and version as the driver gives them: "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    std::uint32_t subgroupSize = 0;
    std::uint32_t vendor = 0;
    std::uint32_t deviceId = 0;
    std::uint32_t driverVersion = 0;
    std::array<std::uint8_t, VK_UUID_SIZE> pipelineCacheUuid{};
};

/// "discrete", "integrated", "virtual", "cpu" or "other".
[[nodiscard]] const char* deviceTypeName(VkPhysicalDeviceType type) noexcept;
/// "1.3.230"
[[nodiscard]] std::string apiVersionText(std::uint32_t version);

struct InstanceOptions {
    bool validate = false; ///< the Khronos layer with synchronization validation; messages go to messages()
    std::vector<const char*> extensions{}; ///< that a window system asks for; without them there is no instance
};

/// Copies share the instance; it ends with the last copy and the last device made from it.
/// Thread-safety: const functions are safe from any thread.
class VulkanInstance {
  public:
    /// Unsupported when there is no loader, no driver or no layer: the text says which Debian package brings it.
    [[nodiscard]] static Result<VulkanInstance> create(const InstanceOptions& options = {});

    /// Unsupported when there is none: at least one comes back.
    [[nodiscard]] Result<std::vector<PhysicalDevice>> devices() const;
    [[nodiscard]] VkInstance handle() const noexcept;
    [[nodiscard]] PFN_vkGetInstanceProcAddr getInstanceProcAddr() const noexcept;
    /// Warnings and errors; empty without InstanceOptions::validate. May be kept after the instance has ended, which
    /// is when the layer reports what was not destroyed.
    [[nodiscard]] std::shared_ptr<const ValidationMessages> messages() const noexcept;

    struct State;

  private:
    friend class VulkanDevice;
    explicit VulkanInstance(std::shared_ptr<State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

/// The device that `wanted` names: a number is an index, anything else a part of the name, upper or lower case alike.
/// Empty: the first discrete GPU, else whatever there is, a CPU last. InvalidArgument, with the devices listed, when
/// none or several match. `devices` must not be empty.
[[nodiscard]] Result<PhysicalDevice> chooseDevice(std::span<const PhysicalDevice> devices, std::string_view wanted);

struct DeviceOptions {
    /// Changes what is enabled, before the device is made: a test takes features away with it.
    std::function<void(FeatureRequest&)> adjustFeatures{};
    std::vector<const char*> extensions{}; ///< in addition to voxtact's optional ones; without them there is no device
};

/// A device with one graphics queue and every feature that voxtact can use.
/// Thread-safety: const functions are safe from any thread; what uses the queue itself holds lockQueue().
class VulkanDevice {
  public:
    /// Unsupported, with the reason, for a device below Vulkan 1.3 or without a graphics queue. A device that lacks a
    /// feature that voxtact requires is made nevertheless: voxtact::check(contextDesc()) names what is missing.
    [[nodiscard]] static Result<VulkanDevice> create(const VulkanInstance& instance, const PhysicalDevice& physical,
                                                     const DeviceOptions& options = {});

    [[nodiscard]] VkDevice handle() const noexcept;
    [[nodiscard]] const VolkDeviceTable& table() const noexcept;
    [[nodiscard]] const PhysicalDevice& physical() const noexcept;
    /// Its pointers are valid as long as this device.
    [[nodiscard]] const ContextDesc& contextDesc() const noexcept;
    /// With the lock of the queue.
    [[nodiscard]] QueueAccess queueAccess() const noexcept;
    /// Threads share the queue: held by the thread that submits to it, shows an image, or waits for all that is on the
    /// device.
    [[nodiscard]] std::unique_lock<std::mutex> lockQueue() const;
    /// With a period: without one they are no time.
    [[nodiscard]] bool hasTimestamps() const noexcept;
    /// To be remembered: timestamps went backwards, or did not move, and were no time.
    void missTimestamp() const noexcept;
    [[nodiscard]] bool missedTimestamps() const noexcept;

    struct State;

  private:
    explicit VulkanDevice(std::shared_ptr<State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

} // namespace voxtact::device
