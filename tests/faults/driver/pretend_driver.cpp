// SPDX-License-Identifier: MIT
#include "pretend_driver.h"
#include "pretend_state.h"

#include <algorithm>
#include <cstring>

namespace voxtact::test {

namespace {

PretendState* current = nullptr;

/// Handles of what is there from the beginning.
const auto kInstance = reinterpret_cast<VkInstance>(Id{0x10});
const auto kPhysicalDevice = reinterpret_cast<VkPhysicalDevice>(Id{0x20});
const auto kDevice = reinterpret_cast<VkDevice>(Id{0x30});
const auto kQueue = reinterpret_cast<VkQueue>(Id{0x40});

constexpr const char* kExtensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};

/// All that voxtact can use, as if vkCreateDevice had been asked for it.
const VkPhysicalDeviceFeatures2* features() {
    static const auto all = [] {
        VkPhysicalDeviceFeatures2 supported{};
        supported.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        supported.features.occlusionQueryPrecise = VK_TRUE;
        supported.features.fragmentStoresAndAtomics = VK_TRUE;
        supported.features.geometryShader = VK_TRUE;
        supported.features.shaderFloat64 = VK_TRUE;
        return std::make_unique<FeatureRequest>(&supported);
    }();
    return &all->features2;
}

PFN_vkVoidFunction VKAPI_PTR fromDevice(VkDevice, const char* name) {
    static const std::unordered_map<std::string, PFN_vkVoidFunction> all{
#define VOXTACT_ENTRY(name) {"vk" #name, reinterpret_cast<PFN_vkVoidFunction>(&pretended::name)},
        VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_ENTRY) VOXTACT_DEVICE_FUNCTIONS(VOXTACT_ENTRY)
            VOXTACT_DEBUG_FUNCTIONS(VOXTACT_ENTRY)
#undef VOXTACT_ENTRY
    };
    const auto found = all.find(name);
    return found == all.end() ? nullptr : found->second;
}

PFN_vkVoidFunction VKAPI_PTR fromInstance(VkInstance, const char* name) {
    return fromDevice(nullptr, name);
}

} // namespace

PretendState& pretend() {
    return *current;
}

void Hash::add(std::span<const std::byte> bytes) {
    constexpr std::uint64_t kPrime = 0x100000001b3;
    std::size_t at = 0;
    for (; at + sizeof(std::uint64_t) <= bytes.size(); at += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, sizeof word);
        value_ = (value_ ^ word) * kPrime;
        value_ ^= value_ >> 29U; // words differ in their upper bytes too
    }
    for (; at < bytes.size(); ++at) {
        value_ = (value_ ^ static_cast<std::uint64_t>(bytes[at])) * kPrime;
    }
}

PretendDriver::PretendDriver() : state_(std::make_unique<PretendState>()) {
    current = state_.get();
}

PretendDriver::~PretendDriver() {
    current = nullptr;
}

PFN_vkGetInstanceProcAddr PretendDriver::getInstanceProcAddr() {
    return &fromInstance;
}

ContextDesc PretendDriver::contextDesc() const {
    ContextDesc desc;
    desc.getInstanceProcAddr = getInstanceProcAddr();
    desc.instance = kInstance;
    desc.physicalDevice = kPhysicalDevice;
    desc.device = kDevice;
    desc.apiVersion = VK_API_VERSION_1_3;
    desc.enabledFeatures = features();
    desc.enabledInstanceExtensions = kExtensions;
    return desc;
}

QueueAccess PretendDriver::queueAccess() {
    QueueAccess access;
    access.queue = kQueue;
    return access;
}

void PretendDriver::count(Counting counting) noexcept {
    state_->counting = counting;
}

void PretendDriver::trace(std::uint32_t fragments) noexcept {
    state_->traced = fragments;
}

void PretendDriver::heap(VkDeviceSize bytes) noexcept {
    state_->heap = bytes;
}

void PretendDriver::lose() {
    state_->lost = true;
    state_->pending.clear();
}

std::vector<std::string> PretendDriver::takeComplaints() {
    return std::exchange(state_->complaints, {});
}

bool PretendState::inUse(Id id) const {
    return std::ranges::any_of(pending, [id](const Submission& submission) { return submission.uses.contains(id); });
}

void PretendState::bind(Id memory, VkDeviceSize offset, VkDeviceSize size) {
    PretendMemory* found = memories.find(memory);
    if (found == nullptr || offset > found->bytes.size() || size > found->bytes.size() - offset ||
        offset % kAlignment != 0) {
        complain("something is bound to no memory, beyond it or not aligned");
        return;
    }
    const auto after = found->bound.upper_bound(offset);
    const bool overlapsNext = after != found->bound.end() && after->first < offset + size;
    if (overlapsNext || (after != found->bound.begin() && std::prev(after)->second > offset)) {
        complain("two objects are bound to the same memory");
    }
    found->bound[offset] = offset + size;
}

void PretendState::unbind(Id memory, VkDeviceSize offset) {
    if (PretendMemory* found = memories.find(memory)) {
        found->bound.erase(offset);
    }
}

std::span<std::byte> PretendState::bytesOf(Id memory, VkDeviceSize offset, VkDeviceSize size, const char* what) {
    PretendMemory* found = memories.find(memory);
    if (found == nullptr || offset > found->bytes.size() || size > found->bytes.size() - offset) {
        complain(std::string(what) + " is used that has no memory, or beyond it");
        return {};
    }
    return std::span(found->bytes).subspan(offset, size);
}

std::span<std::byte> PretendState::bufferBytes(Id buffer, VkDeviceSize offset, VkDeviceSize size) {
    const PretendBuffer* found = get(buffers, buffer);
    if (found == nullptr) {
        return {};
    }
    if (offset > found->size || (size != VK_WHOLE_SIZE && size > found->size - offset)) {
        complain("a buffer is used beyond its end");
        return {};
    }
    return bytesOf(found->memory, found->offset + offset, size == VK_WHOLE_SIZE ? found->size - offset : size,
                   "a buffer");
}

std::span<std::byte> PretendState::imageBytes(Id image) {
    const PretendImage* found = get(images, image);
    return found == nullptr ? std::span<std::byte>()
                            : bytesOf(found->memory, found->offset, found->bytes(), "an image");
}

namespace pretended {

PFN_vkVoidFunction VKAPI_CALL GetDeviceProcAddr(VkDevice device, const char* name) {
    return fromDevice(device, name);
}

void VKAPI_CALL GetPhysicalDeviceProperties2(VkPhysicalDevice, VkPhysicalDeviceProperties2* out) {
    VkPhysicalDeviceProperties& properties = out->properties;
    properties = {};
    properties.apiVersion = VK_API_VERSION_1_3;
    std::strcpy(properties.deviceName, "pretended");
    VkPhysicalDeviceLimits& limits = properties.limits;
    limits.maxImageDimension1D = limits.maxImageDimension2D = limits.maxImageDimension3D = 4096;
    limits.maxStorageBufferRange = 1U << 27U;
    limits.maxPerStageDescriptorStorageBuffers = 16;
    limits.maxBoundDescriptorSets = 8;
    limits.maxVertexInputBindingStride = 2048;
    limits.maxViewportDimensions[0] = limits.maxViewportDimensions[1] = 4096;
    limits.maxFramebufferWidth = limits.maxFramebufferHeight = 4096;
    for (std::uint32_t& count : limits.maxComputeWorkGroupCount) {
        count = 65535;
    }
    limits.nonCoherentAtomSize = kAtom;
    limits.timestampPeriod = 1;
    for (auto* next = static_cast<VkBaseOutStructure*>(out->pNext); next != nullptr; next = next->pNext) {
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES) {
            reinterpret_cast<VkPhysicalDeviceMaintenance3Properties*>(next)->maxMemoryAllocationSize = 1U << 30U;
        } else if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES) {
            auto* floats = reinterpret_cast<VkPhysicalDeviceFloatControlsProperties*>(next);
            floats->shaderSignedZeroInfNanPreserveFloat32 = VK_TRUE;
            floats->shaderRoundingModeRTEFloat32 = VK_TRUE;
            floats->shaderSignedZeroInfNanPreserveFloat64 = VK_TRUE;
            floats->shaderRoundingModeRTEFloat64 = VK_TRUE;
        } else if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES) {
            auto* subgroup = reinterpret_cast<VkPhysicalDeviceSubgroupProperties*>(next);
            subgroup->supportedStages = VK_SHADER_STAGE_ALL;
            subgroup->supportedOperations = ~VkSubgroupFeatureFlags{0};
        }
    }
}

void VKAPI_CALL GetPhysicalDeviceMemoryProperties(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out) {
    *out = {};
    out->memoryTypeCount = 2;
    out->memoryTypes[0].propertyFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    // Never coherent, so that a forgotten flush is seen.
    out->memoryTypes[1].propertyFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    out->memoryHeapCount = 1;
    out->memoryHeaps[0].size = pretend().heap;
}

void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice, std::uint32_t* count,
                                                       VkQueueFamilyProperties* out) {
    *count = 1;
    if (out != nullptr) {
        *out = {VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1, 64, {1, 1, 1}};
    }
}

void VKAPI_CALL GetPhysicalDeviceFormatProperties(VkPhysicalDevice, VkFormat, VkFormatProperties* out) {
    *out = {~VkFormatFeatureFlags{0}, ~VkFormatFeatureFlags{0}, ~VkFormatFeatureFlags{0}};
}

VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties(VkPhysicalDevice, VkFormat, VkImageType, VkImageTiling,
                                                           VkImageUsageFlags, VkImageCreateFlags,
                                                           VkImageFormatProperties* out) {
    *out = {{4096, 4096, 4096}, 1, 1, VK_SAMPLE_COUNT_1_BIT, VkDeviceSize{1} << 30U};
    return VK_SUCCESS;
}

VkResult VKAPI_CALL SetDebugUtilsObjectNameEXT(VkDevice, const VkDebugUtilsObjectNameInfoEXT*) {
    return VK_SUCCESS;
}
void VKAPI_CALL CmdBeginDebugUtilsLabelEXT(VkCommandBuffer, const VkDebugUtilsLabelEXT*) {}
void VKAPI_CALL CmdEndDebugUtilsLabelEXT(VkCommandBuffer) {}

} // namespace pretended

} // namespace voxtact::test
