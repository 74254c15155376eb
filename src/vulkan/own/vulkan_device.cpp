// SPDX-License-Identifier: MIT
#include "vulkan/own/vulkan_device.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "vulkan/own/created.h"
#include "vulkan/own/enumerate.h"
#include "vulkan/own/vulkan_instance.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cstring>
#include <iterator>
#include <optional>

namespace voxtact::device {

namespace {

/// Lower is better.
int rank(VkPhysicalDeviceType type) noexcept {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 4;
    default:
        return 3;
    }
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

Error noSuchDevice(std::span<const PhysicalDevice> devices, std::string_view wanted, const char* why) {
    std::string text = "--device '" + std::string(wanted) + "' " + why + "; there are: ";
    for (const PhysicalDevice& device : devices) {
        text += (device.index == 0 ? "" : ", ") + std::to_string(device.index) + " " + device.name;
    }
    return refuse(std::move(text));
}

std::optional<VkQueueFamilyProperties> findGraphicsFamily(const InstanceFunctions& functions, VkPhysicalDevice physical,
                                                          std::uint32_t& family) {
    std::uint32_t count = 0;
    functions.getPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    functions.getPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    for (family = 0; family < count; ++family) {
        if ((families[family].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) {
            return families[family];
        }
    }
    return std::nullopt;
}

/// Of a device that is not all of Vulkan; who makes it must enable it. Its name is in Vulkan's beta headers alone.
constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";

/// Those of voxtact's optional extensions that the device has, the one that it demands, and all that are required.
Result<std::vector<const char*>> findExtensions(const InstanceFunctions& functions, const PhysicalDevice& device,
                                                std::span<const char* const> required) {
    const auto there =
        enumerate<VkExtensionProperties>("listing the device's extensions failed", [&](auto... arguments) {
            return functions.enumerateDeviceExtensionProperties(device.handle, nullptr, arguments...);
        });
    VOXTACT_TRY(there);
    const auto has = [&there](const char* wanted) {
        return std::ranges::any_of(*there, [wanted](const VkExtensionProperties& extension) {
            return std::strcmp(extension.extensionName, wanted) == 0;
        });
    };
    std::vector<const char*> all(optionalDeviceExtensions().begin(), optionalDeviceExtensions().end());
    all.push_back(kPortabilitySubset);
    std::vector<const char*> out(required.begin(), required.end());
    for (const char* wanted : out) {
        if (!has(wanted)) {
            return Error{ErrorCode::Unsupported, 0,
                         "the device '" + device.name + "' has no extension " + wanted +
                             "; choose another with --device"};
        }
    }
    std::ranges::copy_if(all, std::back_inserter(out), has);
    return out;
}

/// What the device supports, as the chain that FeatureRequest reads.
struct SupportedFeatures {
    SupportedFeatures(const InstanceFunctions& functions, VkPhysicalDevice physical) {
        features2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        features2.pNext = &vulkan12;
        vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
        vulkan12.pNext = &vulkan13;
        vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
        functions.getPhysicalDeviceFeatures2(physical, &features2);
    }
    SupportedFeatures(const SupportedFeatures&) = delete;
    SupportedFeatures& operator=(const SupportedFeatures&) = delete;

    VkPhysicalDeviceFeatures2 features2{};
    VkPhysicalDeviceVulkan12Features vulkan12{};
    VkPhysicalDeviceVulkan13Features vulkan13{};
};

} // namespace

struct VulkanDevice::State {
    State(VulkanInstance owner, PhysicalDevice what, const SupportedFeatures& supported)
        : instance(std::move(owner)), physical(std::move(what)), features(&supported.features2) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (device != VK_NULL_HANDLE) {
            table.vkDestroyDevice(device, nullptr);
        }
    }

    VulkanInstance instance;
    PhysicalDevice physical;
    FeatureRequest features;
    std::vector<const char*> extensions;
    VkDevice device = VK_NULL_HANDLE;
    VolkDeviceTable table{};
    VkQueue queue = VK_NULL_HANDLE;
    std::mutex queueMutex;
    std::uint32_t family = 0;
    bool timestamps = false;
    std::atomic<bool> missedTimestamps = false;
    ContextDesc desc;
};

std::string vkResultName(VkResult result) {
    switch (result) {
    case VK_SUCCESS:
        return "VK_SUCCESS";
    case VK_NOT_READY:
        return "VK_NOT_READY";
    case VK_TIMEOUT:
        return "VK_TIMEOUT";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
        return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_UNKNOWN:
        return "VK_ERROR_UNKNOWN";
    default:
        return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

Error vulkanError(VkResult result, std::string_view what) {
    ErrorCode code = ErrorCode::Vulkan;
    if (result == VK_ERROR_DEVICE_LOST) {
        code = ErrorCode::DeviceLost;
    } else if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
        code = ErrorCode::OutOfMemory;
    }
    return Error{code, result, std::string(what) + ": " + vkResultName(result)};
}

const char* deviceTypeName(VkPhysicalDeviceType type) noexcept {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

std::string apiVersionText(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

Result<PhysicalDevice> chooseDevice(std::span<const PhysicalDevice> devices, std::string_view wanted) {
    if (wanted.empty()) {
        return *std::min_element(devices.begin(), devices.end(), [](const auto& a, const auto& b) {
            const bool oldA = a.apiVersion < VK_API_VERSION_1_3;
            const bool oldB = b.apiVersion < VK_API_VERSION_1_3;
            return oldA != oldB ? oldB : rank(a.type) < rank(b.type);
        });
    }
    std::uint32_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size()) {
        if (index < devices.size()) {
            return devices[index];
        }
        return noSuchDevice(devices, wanted, "is not the number of a device");
    }
    const PhysicalDevice* found = nullptr;
    for (const PhysicalDevice& device : devices) {
        if (lowerCase(device.name).find(lowerCase(wanted)) == std::string::npos) {
            continue;
        }
        if (found != nullptr) {
            return noSuchDevice(devices, wanted, "is part of the name of several devices: give the number");
        }
        found = &device;
    }
    if (found == nullptr) {
        return noSuchDevice(devices, wanted, "is not part of the name of a device");
    }
    return *found;
}

Result<VulkanDevice> VulkanDevice::create(const VulkanInstance& instance, const PhysicalDevice& physical,
                                          const DeviceOptions& options) {
    if (physical.apiVersion < VK_API_VERSION_1_3) {
        return Error{ErrorCode::Unsupported, 0,
                     "the device '" + physical.name + "' has Vulkan " + apiVersionText(physical.apiVersion) +
                         "; 1.3 is needed: choose another with --device, or update its driver"};
    }
    const InstanceFunctions& functions = instance.state_->functions;
    const SupportedFeatures supported(functions, physical.handle);
    auto state = std::make_shared<State>(instance, physical, supported);
    const auto family = findGraphicsFamily(functions, physical.handle, state->family);
    if (!family) {
        return Error{ErrorCode::Unsupported, 0,
                     "the device '" + physical.name + "' has no queue that can draw; choose another with --device"};
    }
    VkPhysicalDeviceProperties properties{};
    functions.getPhysicalDeviceProperties(physical.handle, &properties);
    state->timestamps = family->timestampValidBits > 0 && properties.limits.timestampPeriod > 0;
    if (options.adjustFeatures) {
        options.adjustFeatures(state->features);
    }
    // A required feature that the device lacks would only fail vkCreateDevice without a name; check() names it.
    FeatureRequest& request = state->features;
    request.vulkan13.dynamicRendering &= supported.vulkan13.dynamicRendering;
    request.vulkan13.synchronization2 &= supported.vulkan13.synchronization2;

    Result<std::vector<const char*>> extensions = findExtensions(functions, physical, options.extensions);
    VOXTACT_TRY(extensions);
    state->extensions = std::move(*extensions);

    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = state->family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &request.features2;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<std::uint32_t>(state->extensions.size());
    info.ppEnabledExtensionNames = state->extensions.data();
    const VkResult result =
        createdOrNull(functions.createDevice(physical.handle, &info, nullptr, &state->device), state->device);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a Vulkan device on '" + physical.name + "' failed");
    }
    volkLoadDeviceTable(&state->table, state->device);
    state->table.vkGetDeviceQueue(state->device, state->family, 0, &state->queue);

    state->desc.getInstanceProcAddr = instance.getInstanceProcAddr();
    state->desc.instance = instance.handle();
    state->desc.physicalDevice = physical.handle;
    state->desc.device = state->device;
    state->desc.apiVersion = VK_API_VERSION_1_3;
    state->desc.enabledFeatures = &request.features2;
    state->desc.enabledInstanceExtensions = instance.state_->extensions;
    state->desc.enabledDeviceExtensions = state->extensions;
    return VulkanDevice(std::move(state));
}

VkDevice VulkanDevice::handle() const noexcept {
    return state_->device;
}

const VolkDeviceTable& VulkanDevice::table() const noexcept {
    return state_->table;
}

const PhysicalDevice& VulkanDevice::physical() const noexcept {
    return state_->physical;
}

const ContextDesc& VulkanDevice::contextDesc() const noexcept {
    return state_->desc;
}

QueueAccess VulkanDevice::queueAccess() const noexcept {
    QueueAccess access;
    access.queue = state_->queue;
    access.family = state_->family;
    access.lock = [](void* mutex) { static_cast<std::mutex*>(mutex)->lock(); };
    access.unlock = [](void* mutex) { static_cast<std::mutex*>(mutex)->unlock(); };
    access.user = &state_->queueMutex;
    return access;
}

std::unique_lock<std::mutex> VulkanDevice::lockQueue() const {
    return std::unique_lock(state_->queueMutex);
}

bool VulkanDevice::hasTimestamps() const noexcept {
    return state_->timestamps;
}

void VulkanDevice::missTimestamp() const noexcept {
    state_->missedTimestamps = true;
}

bool VulkanDevice::missedTimestamps() const noexcept {
    return state_->missedTimestamps;
}

} // namespace voxtact::device
