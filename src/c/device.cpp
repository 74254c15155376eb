// SPDX-License-Identifier: MIT
// A Vulkan device of the library's own.
#include "c/convert_vulkan.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <optional>

using namespace voxtact;
using namespace voxtact::c;

namespace {

/// A device of the machine.
struct DeviceFacts {
    std::uint32_t index = 0;
    std::string name;
    const char* type = "other";
    std::string driver;
    std::uint32_t apiVersion = 0;
};

/// In the order of creation.
struct VulkanObjects {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    DeviceFacts facts;
    std::optional<FeatureRequest> features;
    std::vector<const char*> extensions;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t family = 0;
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    std::mutex queueMutex; ///< of every submission
    std::optional<Context> context;

    VulkanObjects() = default;
    VulkanObjects(const VulkanObjects&) = delete;
    VulkanObjects& operator=(const VulkanObjects&) = delete;
    ~VulkanObjects();

    template <class Function> Function load(const char* name) const {
        return reinterpret_cast<Function>(getInstanceProcAddr(instance, name));
    }
    void makeInstance();
    [[nodiscard]] std::vector<VkPhysicalDevice> devices() const;
    [[nodiscard]] DeviceFacts describe(VkPhysicalDevice handle, std::uint32_t index) const;
    void choose(const std::string& wanted);
    void findQueue();
    void findExtensions();
    void makeDevice();
    void makeCommands();
    void makeContext();
};

#define VOXTACT_LOAD(name) load<PFN_##name>(#name)

constexpr const char* kNoDevice = "no Vulkan device was found; install the driver of your GPU, or Debian's package "
                                  "mesa-vulkan-drivers, which brings lavapipe, a driver that runs on the CPU";

void expect(VkResult result, const char* what) {
    if (result == VK_SUCCESS) {
        return;
    }
    ErrorCode code = ErrorCode::Vulkan;
    if (result == VK_ERROR_DEVICE_LOST) {
        code = ErrorCode::DeviceLost;
    } else if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
        code = ErrorCode::OutOfMemory;
    }
    throw Refusal({code, result, std::string(what) + " failed: VkResult " + std::to_string(result)});
}

/// Result of a two-call Vulkan function.
template <class T, class Function> std::vector<T> listed(const char* what, const Function& function) {
    std::vector<T> all;
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {
        std::uint32_t count = 0;
        expect(function(&count, static_cast<T*>(nullptr)), what);
        all.resize(count);
        result = count == 0 ? VK_SUCCESS : function(&count, all.data());
        all.resize(count);
    }
    expect(result, what);
    return all;
}

const char* typeName(VkPhysicalDeviceType type) noexcept {
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

/// Lower is better: one that can run voxtact before one that cannot, and then the faster kind.
std::pair<bool, std::size_t> rankOf(const DeviceFacts& facts) {
    constexpr std::array<std::string_view, 5> kOrder{"discrete", "integrated", "virtual", "other", "cpu"};
    const auto place = std::ranges::find(kOrder, std::string_view(facts.type));
    return {facts.apiVersion < VK_API_VERSION_1_3, static_cast<std::size_t>(place - kOrder.begin())};
}

std::string lowerCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

[[noreturn]] void noSuchDevice(const std::vector<DeviceFacts>& all, const std::string& wanted, const char* why) {
    std::string text = "device '" + wanted + "' " + why + "; there are: ";
    for (const DeviceFacts& facts : all) {
        text += (facts.index == 0 ? "" : ", ") + std::to_string(facts.index) + " " + facts.name;
    }
    refuse(ErrorCode::InvalidArgument, text);
}

std::size_t chosen(const std::vector<DeviceFacts>& all, const std::string& wanted) {
    if (wanted.empty()) {
        return static_cast<std::size_t>(std::ranges::min_element(all, {}, rankOf) - all.begin());
    }
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (error == std::errc() && end == wanted.data() + wanted.size()) {
        if (number >= all.size()) {
            noSuchDevice(all, wanted, "is not the number of a device");
        }
        return number;
    }
    std::optional<std::size_t> found;
    for (const DeviceFacts& facts : all) {
        if (lowerCase(facts.name).find(lowerCase(wanted)) == std::string::npos) {
            continue;
        }
        if (found) {
            noSuchDevice(all, wanted, "is part of the name of several devices: give the number");
        }
        found = facts.index;
    }
    if (!found) {
        noSuchDevice(all, wanted, "is not part of the name of a device");
    }
    return *found;
}

VulkanObjects::~VulkanObjects() {
    context.reset();
    if (device != VK_NULL_HANDLE) {
        VOXTACT_LOAD(vkDeviceWaitIdle)(device);
        VOXTACT_LOAD(vkDestroyFence)(device, fence, nullptr);
        VOXTACT_LOAD(vkDestroyCommandPool)(device, pool, nullptr);
        VOXTACT_LOAD(vkDestroyDevice)(device, nullptr);
    }
    if (instance != VK_NULL_HANDLE) {
        VOXTACT_LOAD(vkDestroyInstance)(instance, nullptr);
    }
}

void VulkanObjects::makeInstance() {
    // It stays loaded: drivers fail if unloaded and loaded again.
    void* const loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (loader == nullptr) {
        refuse(ErrorCode::Unsupported, "the Vulkan loader libvulkan.so.1 cannot be loaded; install Debian's package "
                                       "libvulkan1, and mesa-vulkan-drivers for a driver that runs on the CPU");
    }
    getInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "voxtact";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    const VkResult result = VOXTACT_LOAD(vkCreateInstance)(&info, nullptr, &instance);
    if (result != VK_SUCCESS) {
        instance = VK_NULL_HANDLE;
    }
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        refuse(ErrorCode::Unsupported, kNoDevice);
    }
    expect(result, "making a Vulkan instance");
}

std::vector<VkPhysicalDevice> VulkanObjects::devices() const {
    const auto enumerate = VOXTACT_LOAD(vkEnumeratePhysicalDevices);
    std::vector<VkPhysicalDevice> all = listed<VkPhysicalDevice>(
        "listing the Vulkan devices", [&](std::uint32_t* count, VkPhysicalDevice* to) -> VkResult {
            const VkResult result = enumerate(instance, count, to);
            // The loader's result without a driver.
            return result == VK_ERROR_INITIALIZATION_FAILED ? VK_SUCCESS : result;
        });
    if (all.empty()) {
        refuse(ErrorCode::Unsupported, kNoDevice);
    }
    return all;
}

DeviceFacts VulkanObjects::describe(VkPhysicalDevice handle, std::uint32_t index) const {
    VkPhysicalDeviceProperties properties{};
    VOXTACT_LOAD(vkGetPhysicalDeviceProperties)(handle, &properties);
    DeviceFacts found{index, properties.deviceName, typeName(properties.deviceType), {}, properties.apiVersion};
    if (properties.apiVersion < VK_API_VERSION_1_2) {
        return found; // the struct below came with 1.2
    }
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties2{};
    properties2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties2.pNext = &driver;
    VOXTACT_LOAD(vkGetPhysicalDeviceProperties2)(handle, &properties2);
    found.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    return found;
}

void VulkanObjects::choose(const std::string& wanted) {
    const std::vector<VkPhysicalDevice> handles = devices();
    std::vector<DeviceFacts> all;
    for (std::uint32_t index = 0; index < handles.size(); ++index) {
        all.push_back(describe(handles[index], index));
    }
    const std::size_t which = chosen(all, wanted);
    physical = handles[which];
    facts = all[which];
    if (facts.apiVersion < VK_API_VERSION_1_3) {
        refuse(ErrorCode::Unsupported,
               "the device '" + facts.name + "' has a Vulkan before 1.3: choose another, or update its driver");
    }
}

void VulkanObjects::findQueue() {
    std::uint32_t count = 0;
    VOXTACT_LOAD(vkGetPhysicalDeviceQueueFamilyProperties)(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    VOXTACT_LOAD(vkGetPhysicalDeviceQueueFamilyProperties)(physical, &count, families.data());
    while (family < count && (families[family].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) {
        ++family;
    }
    if (family == count) {
        refuse(ErrorCode::Unsupported, "the device '" + facts.name + "' has no queue that can draw; choose another");
    }
}

void VulkanObjects::findExtensions() {
    const auto enumerate = VOXTACT_LOAD(vkEnumerateDeviceExtensionProperties);
    const auto there = listed<VkExtensionProperties>(
        "listing the device's extensions",
        [&](std::uint32_t* count, VkExtensionProperties* to) { return enumerate(physical, nullptr, count, to); });
    for (const char* wanted : optionalDeviceExtensions()) {
        if (std::ranges::any_of(there, [wanted](const VkExtensionProperties& extension) {
                return std::strcmp(extension.extensionName, wanted) == 0;
            })) {
            extensions.push_back(wanted);
        }
    }
}

void VulkanObjects::makeDevice() {
    VkPhysicalDeviceVulkan13Features vulkan13{};
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    VkPhysicalDeviceVulkan12Features vulkan12{};
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.pNext = &vulkan13;
    VkPhysicalDeviceFeatures2 supported{};
    supported.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    supported.pNext = &vulkan12;
    VOXTACT_LOAD(vkGetPhysicalDeviceFeatures2)(physical, &supported);
    FeatureRequest& request = features.emplace(&supported);
    // A required feature that the device lacks would only fail vkCreateDevice without a name; the context names it.
    request.vulkan13.dynamicRendering &= vulkan13.dynamicRendering;
    request.vulkan13.synchronization2 &= vulkan13.synchronization2;

    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = family;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &request.features2;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const VkResult result = VOXTACT_LOAD(vkCreateDevice)(physical, &info, nullptr, &device);
    if (result != VK_SUCCESS) {
        device = VK_NULL_HANDLE;
    }
    expect(result, "making a Vulkan device");
    VOXTACT_LOAD(vkGetDeviceQueue)(device, family, 0, &queue);
}

void VulkanObjects::makeCommands() {
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    poolInfo.queueFamilyIndex = family;
    expect(VOXTACT_LOAD(vkCreateCommandPool)(device, &poolInfo, nullptr, &pool), "making a command pool");
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = pool;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    expect(VOXTACT_LOAD(vkAllocateCommandBuffers)(device, &allocation, &commands), "making a command buffer");
    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    expect(VOXTACT_LOAD(vkCreateFence)(device, &fenceInfo, nullptr, &fence), "making a fence");
}

void VulkanObjects::makeContext() {
    ContextDesc desc;
    desc.getInstanceProcAddr = getInstanceProcAddr;
    desc.instance = instance;
    desc.physicalDevice = physical;
    desc.device = device;
    desc.apiVersion = VK_API_VERSION_1_3;
    desc.enabledFeatures = &features->features2;
    desc.enabledDeviceExtensions = extensions;
    context.emplace(take(Context::create(desc)));
}

std::vector<DeviceFacts> listDevices() {
    VulkanObjects objects;
    objects.makeInstance();
    std::vector<DeviceFacts> all;
    for (const VkPhysicalDevice handle : objects.devices()) {
        all.push_back(objects.describe(handle, static_cast<std::uint32_t>(all.size())));
    }
    return all;
}

void copyText(const std::string& from, std::span<char> to) noexcept {
    const std::size_t length = std::min(from.size(), to.size() - 1);
    std::copy_n(from.begin(), length, to.begin());
    to[length] = 0;
}

vxt_device_facts fromFacts(const DeviceFacts& facts) noexcept {
    vxt_device_facts out = zero<vxt_device_facts>();
    copyText(facts.name, out.name);
    copyText(facts.driver, out.driver);
    out.type = facts.type;
    out.index = facts.index;
    out.api_version = facts.apiVersion;
    return out;
}

} // namespace

struct vxt_device {
    std::unique_ptr<VulkanObjects> objects;
    std::unique_ptr<vxt_context> context;
    pid_t process = getpid();

    [[nodiscard]] bool isForeign() const noexcept { return process != getpid(); }
    /// Refuses a child of the process that opened it.
    [[nodiscard]] VulkanObjects& own() const {
        if (isForeign()) {
            refuse(ErrorCode::Unsupported, "the device '" + objects->facts.name +
                                               "' was opened before this process was forked, which Vulkan does not "
                                               "survive: open it in the child, or start children with 'spawn'");
        }
        return *objects;
    }
};

vxt_result vxt_device_count(uint32_t* count) {
    return call([&] {
        std::uint32_t& to = need(count, "count");
        to = static_cast<std::uint32_t>(listDevices().size());
    });
}

vxt_result vxt_device_describe(uint32_t index, vxt_device_facts* facts) {
    return call([&] {
        const std::vector<DeviceFacts> all = listDevices();
        if (index >= all.size()) {
            refuse(ErrorCode::InvalidArgument, "there is no device " + std::to_string(index));
        }
        writeStruct(facts, fromFacts(all[index]), "facts");
    });
}

vxt_result vxt_device_open(const char* wanted, vxt_device** device) {
    return call([&] {
        vxt_device*& place = need(device, "the place for the new object");
        place = nullptr;
        const std::string name = &need(wanted, "wanted");
        auto made = std::make_unique<vxt_device>();
        made->objects = std::make_unique<VulkanObjects>();
        VulkanObjects& own = *made->objects;
        own.makeInstance();
        own.choose(name);
        own.findQueue();
        own.findExtensions();
        own.makeDevice();
        own.makeCommands();
        own.makeContext();
        made->context =
            std::make_unique<vxt_context>(vxt_context{std::move(*own.context), std::make_shared<ContextErrors>()});
        own.context.reset();
        place = made.release();
    });
}

vxt_result vxt_device_get_facts(const vxt_device* device, vxt_device_facts* facts) {
    return call([&] { writeStruct(facts, fromFacts(need(device, "device").objects->facts), "facts"); });
}

const vxt_context* vxt_device_context(const vxt_device* device) {
    return device == nullptr || device->isForeign() ? nullptr : device->context.get();
}

vxt_result vxt_device_queue(const vxt_device* device, vxt_queue* queue) {
    return call([&] {
        VulkanObjects& own = need(device, "device").own();
        vxt_queue out = zero<vxt_queue>();
        out.queue = own.queue;
        out.family = own.family;
        out.lock = [](void* user) { static_cast<VulkanObjects*>(user)->queueMutex.lock(); };
        out.unlock = [](void* user) { static_cast<VulkanObjects*>(user)->queueMutex.unlock(); };
        out.user = &own;
        writeStruct(queue, out, "queue");
    });
}

vxt_result vxt_device_begin(vxt_device* device, VkCommandBuffer* commands) {
    return call([&] {
        VkCommandBuffer& to = need(commands, "commands");
        to = VK_NULL_HANDLE;
        VulkanObjects& own = need(device, "device").own();
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
        // A recording that began and then failed is still open.
        expect(own.VOXTACT_LOAD(vkResetCommandBuffer)(own.commands, 0), "resetting a command buffer");
        expect(own.VOXTACT_LOAD(vkBeginCommandBuffer)(own.commands, &begin), "beginning a command buffer");
        to = own.commands;
    });
}

vxt_result vxt_device_submit(vxt_device* device) {
    return call([&] {
        VulkanObjects& own = need(device, "device").own();
        expect(own.VOXTACT_LOAD(vkEndCommandBuffer)(own.commands), "ending a command buffer");
        expect(own.VOXTACT_LOAD(vkResetFences)(own.device, 1, &own.fence), "resetting a fence");
        VkSubmitInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        info.commandBufferCount = 1;
        info.pCommandBuffers = &own.commands;
        {
            const std::lock_guard queueLock(own.queueMutex);
            expect(own.VOXTACT_LOAD(vkQueueSubmit)(own.queue, 1, &info, own.fence), "submitting to the device");
        }
        const VkResult waited = own.VOXTACT_LOAD(vkWaitForFences)(own.device, 1, &own.fence, VK_TRUE, UINT64_MAX);
        if (waited != VK_SUCCESS) {
            // The commands and the fence are used again: not while the device still does.
            const std::lock_guard queueLock(own.queueMutex);
            own.VOXTACT_LOAD(vkDeviceWaitIdle)(own.device);
        }
        expect(waited, "waiting for the device");
    });
}

void vxt_device_destroy(vxt_device* device) {
    if (device != nullptr && device->isForeign()) {
        // In a child of the process that opened it: destruction would wait for missing threads.
        [[maybe_unused]] const VulkanObjects* objects = device->objects.release();
        [[maybe_unused]] const vxt_context* context = device->context.release();
    }
    delete device;
}
