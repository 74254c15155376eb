// SPDX-License-Identifier: MIT
// A small renderer that embeds voxtact: it opens the loader itself and makes its own instance, device, command buffer,
// image and vertex buffer. It asks whether a plate touches the opaque half of a volume (these lines are in README.md),
// then wraps its own image and vertex buffer and counts the plate's fragments in them.
//
// Exit status: 0 done, 1 something failed, 77 there is no Vulkan device.
#include "voxtact/detector.h"

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
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
    [[nodiscard]] VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) const;
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

VkDeviceMemory Renderer::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties properties{};
    LOAD(vkGetPhysicalDeviceMemoryProperties)(physicalDevice, &properties);
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    while ((needs.memoryTypeBits >> info.memoryTypeIndex & 1U) == 0 ||
           (properties.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) != wanted) {
        ++info.memoryTypeIndex;
    }
    VkDeviceMemory memory = VK_NULL_HANDLE;
    take(LOAD(vkAllocateMemory)(device, &info, nullptr, &memory));
    return memory;
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

/// The engine's own 3D image, 8^3 texels of 255, and its own vertex buffer, two triangles.
class EngineScene {
  public:
    explicit EngineScene(const Renderer& renderer) : renderer_(renderer) {
        makeImage();
        makeVertices();
    }
    EngineScene(const EngineScene&) = delete;
    EngineScene& operator=(const EngineScene&) = delete;
    ~EngineScene() {
        load<PFN_vkDestroyBuffer>("vkDestroyBuffer")(renderer_.device, vertices, nullptr);
        load<PFN_vkDestroyImageView>("vkDestroyImageView")(renderer_.device, view, nullptr);
        load<PFN_vkDestroyImage>("vkDestroyImage")(renderer_.device, image_, nullptr);
        for (const VkDeviceMemory memory : {imageMemory_, vertexMemory_}) {
            load<PFN_vkFreeMemory>("vkFreeMemory")(renderer_.device, memory, nullptr);
        }
    }

    /// Records the filling of the image; leaves it in SHADER_READ_ONLY_OPTIMAL.
    void cmdFill(VkCommandBuffer commands) const;

    VkImageView view = VK_NULL_HANDLE;
    VkBuffer vertices = VK_NULL_HANDLE;

  private:
    template <class Function> Function load(const char* name) const { return renderer_.load<Function>(name); }
    void makeImage();
    void makeVertices();

    const Renderer& renderer_;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory imageMemory_ = VK_NULL_HANDLE;
    VkDeviceMemory vertexMemory_ = VK_NULL_HANDLE;
};

void EngineScene::makeImage() {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_3D;
    info.format = VK_FORMAT_R8_UNORM;
    info.extent = {8, 8, 8};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    take(load<PFN_vkCreateImage>("vkCreateImage")(renderer_.device, &info, nullptr, &image_));
    VkMemoryRequirements needs{};
    load<PFN_vkGetImageMemoryRequirements>("vkGetImageMemoryRequirements")(renderer_.device, image_, &needs);
    imageMemory_ = renderer_.allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    take(load<PFN_vkBindImageMemory>("vkBindImageMemory")(renderer_.device, image_, imageMemory_, 0));
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = image_;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_3D;
    viewInfo.format = info.format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    take(load<PFN_vkCreateImageView>("vkCreateImageView")(renderer_.device, &viewInfo, nullptr, &view));
}

void EngineScene::makeVertices() {
    constexpr float kPlate[] = {-2, -2, 0, 2, -2, 0, 2, 2, 0, -2, -2, 0, 2, 2, 0, -2, 2, 0};
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = sizeof kPlate;
    info.usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    take(load<PFN_vkCreateBuffer>("vkCreateBuffer")(renderer_.device, &info, nullptr, &vertices));
    VkMemoryRequirements needs{};
    load<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(renderer_.device, vertices, &needs);
    vertexMemory_ =
        renderer_.allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    take(load<PFN_vkBindBufferMemory>("vkBindBufferMemory")(renderer_.device, vertices, vertexMemory_, 0));
    void* mapped = nullptr;
    take(load<PFN_vkMapMemory>("vkMapMemory")(renderer_.device, vertexMemory_, 0, VK_WHOLE_SIZE, 0, &mapped));
    std::memcpy(mapped, kPlate, sizeof kPlate);
    load<PFN_vkUnmapMemory>("vkUnmapMemory")(renderer_.device, vertexMemory_);
}

void EngineScene::cmdFill(VkCommandBuffer commands) const {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image_;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const auto pipelineBarrier = load<PFN_vkCmdPipelineBarrier>("vkCmdPipelineBarrier");
    pipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                    nullptr, 1, &barrier);
    const VkClearColorValue white{{1, 0, 0, 0}};
    load<PFN_vkCmdClearColorImage>("vkCmdClearColorImage")(commands, image_, barrier.newLayout, &white, 1,
                                                           &barrier.subresourceRange);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    pipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr, 0,
                    nullptr, 1, &barrier);
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
    const auto volume = take(voxtact::Volume::upload(context, queue, image.view(), {.bricks = true}));
    const auto opacity = take(voxtact::TransferFunction::upload(context, queue, {.points = points}));
    const auto mesh = take(voxtact::Mesh::upload(context, queue, shape.view()));
    const auto detector = take(voxtact::Detector::certified(context));
    auto results = take(voxtact::Results::create(detector, {.maxPairs = 1}));

    const voxtact::BatchItem item{&mesh, &volume, &opacity, {&world_from_object, 1}};
    take(detector.cmdDetect(commands, {.items = {&item, 1}}, results)); // only records
    take(results.cmdReadBack(commands));
    // [/readme]

    // [wrap]
    const EngineScene engine(renderer);
    voxtact::WrappedVolume texture;
    texture.view = engine.view;
    texture.format = VK_FORMAT_R8_UNORM;
    texture.grid = image.grid;
    const auto wrappedVolume = take(voxtact::Volume::wrap(context, texture));
    voxtact::WrappedMesh model;
    model.vertices = engine.vertices;
    model.vertexCount = 6;
    model.triangleCount = 2; // not indexed: three vertices per triangle
    const auto wrappedMesh = take(voxtact::Mesh::wrap(context, model));
    const auto counter = take(voxtact::Detector::raster(context, {.method = context.defaultMethod()}));
    auto counts = take(voxtact::Results::create(counter, {.maxPairs = 1}));

    engine.cmdFill(commands);
    const voxtact::BatchItem wrapped{&wrappedMesh, &wrappedVolume, &opacity, {&world_from_object, 1}};
    take(counter.cmdDetect(commands, {.items = {&wrapped, 1}, .view = view}, counts));
    take(counts.cmdReadBack(commands));
    // [/wrap]

    renderer.endFrameAndWait();
    std::printf("certified: %s\n", voxtact::unpack(take(results.read())[0]).hit ? "touch" : "no touch");
    const voxtact::PairAnswer answer = voxtact::unpack(take(counts.read())[0]);
    std::printf("wrapped: %llu fragments, method %s\n", static_cast<unsigned long long>(answer.count),
                voxtact::toString(answer.method));
    return EXIT_SUCCESS;
}
