// SPDX-License-Identifier: MIT
#include "vulkan/own/vulkan_instance.h"

#include "core/base/try.h"
#include "vulkan/own/enumerate.h"

#include "vulkan/own/created.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace voxtact::device {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

constexpr const char* kNoDevice = "no Vulkan device was found; install the driver of your GPU, or Debian's package "
                                  "mesa-vulkan-drivers, which brings lavapipe, a driver that runs on the CPU";

/// volk's few globals (the loader's entry points) are the same for every instance; this guards writing them.
std::mutex& volkMutex() {
    static std::mutex mutex;
    return mutex;
}

Result<void> loadLoader() {
    const std::lock_guard lock(volkMutex());
    if (vkCreateInstance == nullptr && volkInitialize() != VK_SUCCESS) {
        return Error{ErrorCode::Unsupported, 0,
                     "the Vulkan loader libvulkan.so.1 cannot be loaded; install Debian's package libvulkan1, and "
                     "mesa-vulkan-drivers for a driver that runs on "
                     "the CPU"};
    }
    return {};
}

Result<bool> hasLayer(const char* name) {
    const auto layers = enumerate<VkLayerProperties>("listing the Vulkan layers failed", [](auto... arguments) {
        return vkEnumerateInstanceLayerProperties(arguments...);
    });
    VOXTACT_TRY(layers);
    return std::ranges::any_of(
        *layers, [name](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

Result<bool> hasExtension(const char* name) {
    const auto extensions =
        enumerate<VkExtensionProperties>("listing the Vulkan extensions failed", [](auto... arguments) {
            return vkEnumerateInstanceExtensionProperties(nullptr, arguments...);
        });
    VOXTACT_TRY(extensions);
    return std::ranges::any_of(*extensions, [name](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<ValidationMessages*>(user)->add(data->pMessage != nullptr ? data->pMessage : "");
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationMessages* messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // Not GENERAL: those come from the loader, about drivers of the machine that have nothing to do with our calls.
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = messages;
    return info;
}

InstanceFunctions loadFunctions(VkInstance instance) {
    const auto get = [instance]<class F>(F& function, const char* name) {
        function = reinterpret_cast<F>(vkGetInstanceProcAddr(instance, name));
    };
    InstanceFunctions functions;
    get(functions.destroyInstance, "vkDestroyInstance");
    get(functions.enumeratePhysicalDevices, "vkEnumeratePhysicalDevices");
    get(functions.getPhysicalDeviceProperties, "vkGetPhysicalDeviceProperties");
    get(functions.getPhysicalDeviceProperties2, "vkGetPhysicalDeviceProperties2");
    get(functions.getPhysicalDeviceFeatures2, "vkGetPhysicalDeviceFeatures2");
    get(functions.getPhysicalDeviceQueueFamilyProperties, "vkGetPhysicalDeviceQueueFamilyProperties");
    get(functions.enumerateDeviceExtensionProperties, "vkEnumerateDeviceExtensionProperties");
    get(functions.createDevice, "vkCreateDevice");
    get(functions.createDebugUtilsMessenger, "vkCreateDebugUtilsMessengerEXT");
    get(functions.destroyDebugUtilsMessenger, "vkDestroyDebugUtilsMessengerEXT");
    return functions;
}

Result<void> createInstance(const InstanceOptions& options, VulkanInstance::State& state) {
    constexpr std::array kEnables{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(state.messages.get());
    VkValidationFeaturesEXT validation{};
    validation.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    validation.pNext = &messenger;
    validation.enabledValidationFeatureCount = static_cast<std::uint32_t>(kEnables.size());
    validation.pEnabledValidationFeatures = kEnables.data();

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "voxtact";
    application.apiVersion = VK_API_VERSION_1_3;

    const Result<bool> debugUtils = hasExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    VOXTACT_TRY(debugUtils);
    if (*debugUtils) {
        state.extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    for (const char* extension : options.extensions) {
        const Result<bool> there = hasExtension(extension);
        VOXTACT_TRY(there);
        if (!*there) {
            return Error{ErrorCode::Unsupported, 0,
                         std::string("no Vulkan driver here can show pictures in a window: the instance extension ") +
                             extension + " is missing"};
        }
        state.extensions.push_back(extension);
    }
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    // Without it the loader hides drivers that are not all of Vulkan, such as MoltenVK.
    const Result<bool> portability = hasExtension(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    VOXTACT_TRY(portability);
    if (*portability) {
        state.extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
        info.flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
    }
    if (options.validate) {
        const Result<bool> layer = hasLayer(kValidationLayer);
        VOXTACT_TRY(layer);
        if (!*layer) {
            return Error{ErrorCode::Unsupported, 0,
                         std::string("the layer ") + kValidationLayer +
                             " is not installed; it is in Debian's package vulkan-validationlayers"};
        }
        state.extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
        info.pNext = &validation;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(state.extensions.size());
    info.ppEnabledExtensionNames = state.extensions.data();

    const VkResult result = createdOrNull(vkCreateInstance(&info, nullptr, &state.instance), state.instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        return Error{ErrorCode::Unsupported, result, kNoDevice};
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a Vulkan instance failed");
    }
    return {};
}

PhysicalDevice describe(const InstanceFunctions& functions, VkPhysicalDevice handle, std::uint32_t index) {
    VkPhysicalDeviceProperties properties{};
    functions.getPhysicalDeviceProperties(handle, &properties);
    PhysicalDevice device{.index = index,
                          .handle = handle,
                          .name = properties.deviceName,
                          .type = properties.deviceType,
                          .apiVersion = properties.apiVersion,
                          .driver = apiVersionText(properties.driverVersion),
                          .vendor = properties.vendorID,
                          .deviceId = properties.deviceID,
                          .driverVersion = properties.driverVersion};
    std::copy_n(properties.pipelineCacheUUID, VK_UUID_SIZE, device.pipelineCacheUuid.begin());
    if (properties.apiVersion < VK_API_VERSION_1_2) {
        return device; // the structs below came with 1.2
    }
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceSubgroupProperties subgroup{};
    subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
    subgroup.pNext = &driver;
    VkPhysicalDeviceProperties2 properties2{};
    properties2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties2.pNext = &subgroup;
    functions.getPhysicalDeviceProperties2(handle, &properties2);
    device.subgroupSize = subgroup.subgroupSize;
    device.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    return device;
}

} // namespace

void ValidationMessages::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationMessages::all() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

bool ValidationMessages::empty() const {
    const std::lock_guard lock(mutex_);
    return messages_.empty();
}

VulkanInstance::State::~State() {
    if (messenger != VK_NULL_HANDLE) {
        functions.destroyDebugUtilsMessenger(instance, messenger, nullptr);
    }
    if (instance != VK_NULL_HANDLE) {
        functions.destroyInstance(instance, nullptr);
    }
}

Result<VulkanInstance> VulkanInstance::create(const InstanceOptions& options) {
    VOXTACT_TRY(loadLoader());
    auto state = std::make_shared<State>();
    VOXTACT_TRY(createInstance(options, *state));
    state->functions = loadFunctions(state->instance);
    {
        // volkLoadDeviceTable() asks the global vkGetDeviceProcAddr, which is the loader's own for every instance.
        const std::lock_guard lock(volkMutex());
        if (vkGetDeviceProcAddr == nullptr) {
            volkLoadInstanceOnly(state->instance);
        }
    }
    if (options.validate) {
        const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(state->messages.get());
        const VkResult result = createdOrNull(
            state->functions.createDebugUtilsMessenger(state->instance, &info, nullptr, &state->messenger),
            state->messenger);
        if (result != VK_SUCCESS) {
            return vulkanError(result, "making a debug messenger failed");
        }
    }
    return VulkanInstance(std::move(state));
}

Result<std::vector<PhysicalDevice>> VulkanInstance::devices() const {
    const auto handles = enumerate<VkPhysicalDevice>("listing the Vulkan devices failed", [this](auto... arguments) {
        return state_->functions.enumeratePhysicalDevices(state_->instance, arguments...);
    });
    if (!handles.ok() && handles.error().vkResult != VK_ERROR_INITIALIZATION_FAILED) {
        return handles.error();
    }
    if (!handles.ok() || handles->empty()) {
        return Error{ErrorCode::Unsupported, handles.ok() ? 0 : handles.error().vkResult, kNoDevice};
    }
    std::vector<PhysicalDevice> devices;
    for (std::uint32_t index = 0; index < handles->size(); ++index) {
        devices.push_back(describe(state_->functions, (*handles)[index], index));
    }
    return devices;
}

VkInstance VulkanInstance::handle() const noexcept {
    return state_->instance;
}

PFN_vkGetInstanceProcAddr VulkanInstance::getInstanceProcAddr() const noexcept {
    return vkGetInstanceProcAddr;
}

std::shared_ptr<const ValidationMessages> VulkanInstance::messages() const noexcept {
    return state_->messages;
}

} // namespace voxtact::device
