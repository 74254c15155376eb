// SPDX-License-Identifier: MIT
// A small renderer that embeds voxtact: it opens the loader itself, makes its own instance, device and command buffer,
// and asks how much of a plate is inside the opaque half of a volume. The marked lines are the ones in README.md.
//
// Exit status: 0 done, 1 something failed, 77 there is no Vulkan device.
#include "voxtact/detector.h"

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

namespace {

constexpr int kExitNoDevice = 77;

[[noreturn]] void quit(int status, const char* why) {
    std::fprintf(stderr, "embed: %s\n", why);
    std::exit(status);
}

/// voxtact throws nothing: an error is a value, and this program ends with it.
template <class T> T take(voxtact::Result<T> result) {
    if (!result) {
        quit(EXIT_FAILURE, result.error().text.c_str());
    }
    return std::move(*result);
}
void take(const voxtact::Result<void>& result) {
    if (!result) {
        quit(EXIT_FAILURE, result.error().text.c_str());
    }
}
void take(VkResult result) {
    if (result != VK_SUCCESS) {
        quit(EXIT_FAILURE, "a Vulkan call failed");
    }
}

/// What an engine has long before it meets voxtact.
struct Renderer {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queueFamily = 0;
    std::optional<voxtact::FeatureRequest> features; ///< what the device was made with
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;

    Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    template <class Function> Function load(const char* name) const {
        return reinterpret_cast<Function>(getInstanceProcAddr(instance, name));
    }
    void makeInstance();
    void makeDevice(const VkPhysicalDeviceFeatures2& enabled);
    void beginFrame();
    void endFrameAndWait();
};

#define LOAD(name) load<PFN_##name>(#name)

void Renderer::makeInstance() {
    void* loader = dlopen("libvulkan.so.1", RTLD_NOW);
    if (loader == nullptr) {
        quit(kExitNoDevice, "there is no Vulkan loader");
    }
    getInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (LOAD(vkCreateInstance)(&info, nullptr, &instance) != VK_SUCCESS) {
        quit(kExitNoDevice, "there is no Vulkan driver");
    }
    std::uint32_t one = 1;
    const VkResult found = LOAD(vkEnumeratePhysicalDevices)(instance, &one, &physicalDevice);
    if ((found != VK_SUCCESS && found != VK_INCOMPLETE) || one == 0) {
        quit(kExitNoDevice, "there is no Vulkan device");
    }
}

void Renderer::makeDevice(const VkPhysicalDeviceFeatures2& enabled) {
    std::uint32_t count = 0;
    LOAD(vkGetPhysicalDeviceQueueFamilyProperties)(physicalDevice, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    LOAD(vkGetPhysicalDeviceQueueFamilyProperties)(physicalDevice, &count, families.data());
    while (queueFamily < count && (families[queueFamily].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) {
        ++queueFamily;
    }
    if (queueFamily == count) {
        quit(kExitNoDevice, "the device cannot draw");
    }
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = queueFamily;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &enabled;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    take(LOAD(vkCreateDevice)(physicalDevice, &info, nullptr, &device));
    LOAD(vkGetDeviceQueue)(device, queueFamily, 0, &queue);
}

Renderer::Renderer() {
    makeInstance();

    // voxtact says which features it wants; an engine adds its own to the chain before it makes the device.
    VkPhysicalDeviceFeatures2 supported{};
    supported.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    LOAD(vkGetPhysicalDeviceFeatures2)(physicalDevice, &supported);
    makeDevice(features.emplace(&supported).features2);

    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = queueFamily;
    take(LOAD(vkCreateCommandPool)(device, &poolInfo, nullptr, &pool));
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = pool;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    take(LOAD(vkAllocateCommandBuffers)(device, &allocation, &commands));
}

Renderer::~Renderer() {
    LOAD(vkDestroyCommandPool)(device, pool, nullptr);
    LOAD(vkDestroyDevice)(device, nullptr);
    LOAD(vkDestroyInstance)(instance, nullptr);
}

void Renderer::beginFrame() {
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    take(LOAD(vkBeginCommandBuffer)(commands, &info));
}

void Renderer::endFrameAndWait() {
    take(LOAD(vkEndCommandBuffer)(commands));
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    take(LOAD(vkQueueSubmit)(queue, 1, &info, VK_NULL_HANDLE));
    take(LOAD(vkQueueWaitIdle)(queue));
}

/// 8^3 voxels of 1 mm, centred on the world's origin: 255 where x < 0, else 0.
voxtact::VolumeData halfOpaque() {
    voxtact::VolumeData volume;
    volume.grid.size = {8, 8, 8};
    volume.grid.origin = {-3.5, -3.5, -3.5};
    for (int i = 0; i < 8 * 8 * 8; ++i) {
        volume.voxels.push_back(i % 8 < 4 ? std::byte{255} : std::byte{0});
    }
    return volume;
}

/// A plate of 4 mm by 4 mm around its own origin.
voxtact::MeshData plate() {
    voxtact::MeshData mesh;
    mesh.positions = {-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

/// 8 mm by 8 mm of the world's x and y on 64x64 pixels.
voxtact::View viewOfTheVolume() {
    voxtact::View view{voxtact::identity(), 64, 64};
    view.clip_from_world[0] = 0.25;
    view.clip_from_world[5] = 0.25;
    view.clip_from_world[10] = 0.1;
    view.clip_from_world[14] = 0.5;
    return view;
}

} // namespace

int main() {
    Renderer renderer;
    voxtact::ContextDesc desc;
    desc.getInstanceProcAddr = renderer.getInstanceProcAddr;
    desc.instance = renderer.instance;
    desc.physicalDevice = renderer.physicalDevice;
    desc.device = renderer.device;
    desc.apiVersion = VK_API_VERSION_1_3;
    desc.enabledFeatures = &renderer.features->features2;
    voxtact::QueueAccess queue;
    queue.queue = renderer.queue;
    queue.family = renderer.queueFamily;

    const voxtact::VolumeData image = halfOpaque();
    const voxtact::MeshData shape = plate();
    const voxtact::ControlPoint points[] = {{120, 0}, {135, 1}};
    const voxtact::Mat4 world_from_object = voxtact::translation({-1, 0, 0});
    const voxtact::View view = viewOfTheVolume();
    const VkCommandBuffer commands = renderer.commands;
    renderer.beginFrame();

    // [readme]
    const auto context = take(voxtact::Context::create(desc)); // your instance, device and loader
    const auto volume = take(voxtact::Volume::upload(context, queue, image.view()));
    const auto opacity = take(voxtact::TransferFunction::upload(context, queue, {.points = points}));
    const auto mesh = take(voxtact::Mesh::upload(context, queue, shape.view()));
    const auto detector = take(voxtact::Detector::raster(context, {.method = context.defaultMethod()}));
    auto results = take(voxtact::Results::create(detector, {.maxPairs = 1}));

    const voxtact::BatchItem item{&mesh, &volume, &opacity, {&world_from_object, 1}};
    take(detector.cmdDetect(commands, {.items = {&item, 1}, .view = view}, results)); // only records
    take(results.cmdReadBack(commands));
    // [/readme]

    renderer.endFrameAndWait();
    const voxtact::PairAnswer answer = voxtact::unpack(take(results.read())[0]);
    std::printf("hit %d, %llu fragments, method %s\n", answer.hit ? 1 : 0,
                static_cast<unsigned long long>(answer.count), voxtact::toString(answer.method));
    return EXIT_SUCCESS;
}
