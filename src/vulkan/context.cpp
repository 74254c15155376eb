// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "exact/shared.h"
#include "vulkan/context_impl.h"
#include "vulkan/debug.h"
#include "vulkan/layouts.h"
#include "vulkan/queue_families.h"

#include <algorithm>

namespace voxtact {

namespace {

Error refusal(const CheckReport& report) {
    std::string text = "the device cannot be used: ";
    for (std::size_t i = 0; i < report.missing.size(); ++i) {
        text += (i == 0 ? "" : "; ") + report.missing[i];
    }
    return {ErrorCode::Unsupported, 0, std::move(text)};
}

/// What ContextDesc::fragmentsAtOnce says for 0.
constexpr std::uint64_t kUsualFragments = std::uint64_t{1} << 34U;

void readProperties(ContextImpl& context) {
    VkPhysicalDeviceMaintenance3Properties maintenance3{};
    maintenance3.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    maintenance3.pNext = &driver;
    VkPhysicalDeviceFloatControlsProperties floats{};
    floats.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES;
    driver.pNext = &floats;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &maintenance3;
    context.vk.GetPhysicalDeviceProperties2(context.physicalDevice, &properties);
    context.limits = properties.properties.limits;
    context.onHost = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    context.maxAllocation = maintenance3.maxMemoryAllocationSize;
    context.floatControls = readFloatControls(floats);
    if (!context.features.shaderFloat64) {
        context.floatControls.missingForDoubles = FloatControls{}.missingForDoubles;
    }
    context.flushAfterQuery = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
    context.endsLongLoops = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
    context.vk.GetPhysicalDeviceMemoryProperties(context.physicalDevice, &context.memory);
}

Result<void> makeSampler(ContextImpl& context, VkFilter filter, VkSampler& out, const char* name) {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = filter;
    info.minFilter = filter;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    // What a failed call leaves in it is nothing to destroy.
    VkSampler made = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateSampler(context.device, &info, context.allocator, &made);
        result != VK_SUCCESS) {
        return context.failure(result, "making a sampler");
    }
    out = made;
    nameObject(context, VK_OBJECT_TYPE_SAMPLER, out, name);
    return {};
}

Result<void> makeSamplers(ContextImpl& context) {
    VOXTACT_TRY(makeSampler(context, VK_FILTER_LINEAR, context.sampler, "linear sampler"));
    return makeSampler(context, VK_FILTER_NEAREST, context.nearestSampler, "nearest sampler");
}

Result<void> makeSetLayout(ContextImpl& context, SetIndex index, std::span<const VkDescriptorSetLayoutBinding> bindings,
                           const char* name) {
    return makeSetLayout(context, context.setLayouts[static_cast<std::size_t>(index)], bindings, name);
}

Result<void> makeSetLayouts(ContextImpl& context) {
    static_assert(static_cast<int>(SetIndex::Volume) == VOXTACT_SET_VOLUME);
    static_assert(static_cast<int>(SetIndex::TransferFunction) == VOXTACT_SET_TRANSFER_FUNCTION);
    static_assert(static_cast<int>(SetIndex::Pairs) == VOXTACT_SET_PAIRS);
    static_assert(static_cast<int>(SetIndex::Mesh) == VOXTACT_SET_MESH);
    constexpr VkShaderStageFlags kStages =
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    const VkDescriptorSetLayoutBinding image{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, kStages, nullptr};
    const VkDescriptorSetLayoutBinding volume[] = {
        image,
        {VOXTACT_BINDING_BRICKS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
    };
    const VkDescriptorSetLayoutBinding function[] = {
        image,
    };
    // Storage buffers in the vertex stage are written nowhere, so that no feature is needed for them.
    const VkDescriptorSetLayoutBinding pairs[] = {
        {VOXTACT_BINDING_TRANSFORMS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages, nullptr},
        {VOXTACT_BINDING_RESULTS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages, nullptr},
    };
    VOXTACT_TRY(makeSetLayout(context, SetIndex::Volume, volume, "volume set layout"));
    if (Result<void> made =
            makeSetLayout(context, SetIndex::TransferFunction, function, "transfer function set layout");
        !made.ok()) {
        return made;
    }
    VOXTACT_TRY(makeSetLayout(context, SetIndex::Pairs, pairs, "pairs set layout"));
    const VkDescriptorSetLayoutBinding mesh[] = {
        {VOXTACT_BINDING_VERTICES, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages, nullptr},
        {VOXTACT_BINDING_INDICES, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages, nullptr},
    };
    return makeSetLayout(context, SetIndex::Mesh, mesh, "mesh set layout");
}

/// The second is that of the projection dominant-axis alone.
constexpr VkPushConstantRange kRasterConstants[] = {
    {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(shader::RasterConstants)},
    {VK_SHADER_STAGE_VERTEX_BIT, VOXTACT_OFFSET_DOMINANT, sizeof(shader::DominantConstants)},
};

Result<void> makeLayouts(ContextImpl& context) {
    const std::span<const VkDescriptorSetLayout> sets(context.setLayouts);
    VOXTACT_TRY(makePipelineLayout(context, context.rasterLayout, sets.first(VOXTACT_SET_PAIRS + 1),
                                   std::span(kRasterConstants).first(1), "raster pipeline layout"));
    VOXTACT_TRY(makePipelineLayout(context, context.dominantLayout, sets.first(VOXTACT_SET_MESH + 1), kRasterConstants,
                                   "dominant-axis pipeline layout"));
    if (context.limits.maxPerStageDescriptorStorageBuffers < kComputeStorageBuffers) {
        return {};
    }
    return makePipelineLayout(context, context.computeLayout, sets.first(VOXTACT_SET_MESH + 1), kComputeConstants,
                              "compute pipeline layout");
}

Result<void> makeOutputSetLayouts(ContextImpl& context) {
    constexpr VkShaderStageFlags kWriters = VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | kWriters;
    constexpr VkDescriptorSetLayoutBinding kPairs[] = {
        {VOXTACT_BINDING_TRANSFORMS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages, nullptr},
        {VOXTACT_BINDING_RESULTS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kWriters, nullptr},
        {VOXTACT_BINDING_OUTPUT_PAIRS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kWriters, nullptr},
        {VOXTACT_BINDING_OUTPUTS, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kWriters, nullptr},
    };
    VOXTACT_TRY(makeSetLayout(context, context.outputSetLayout, kPairs, "output set layout"));
    constexpr VkDescriptorSetLayoutBinding kLabels{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, kWriters, nullptr};
    return makeSetLayout(context, context.labelSetLayout, {&kLabels, 1}, "label set layout");
}

Result<void> makeOutputLayouts(ContextImpl& context) {
    VOXTACT_TRY(makeOutputSetLayouts(context));
    if (context.limits.maxBoundDescriptorSets < kOutputSets ||
        context.limits.maxPerStageDescriptorStorageBuffers < kOutputStorageBuffers) {
        return {};
    }
    const VkDescriptorSetLayout sets[] = {context.setLayouts[VOXTACT_SET_VOLUME],
                                          context.setLayouts[VOXTACT_SET_TRANSFER_FUNCTION], context.outputSetLayout,
                                          context.setLayouts[VOXTACT_SET_MESH], context.labelSetLayout};
    static_assert(std::size(sets) == kOutputSets && kOutputSets == VOXTACT_SET_LABELS + 1);
    VOXTACT_TRY(makePipelineLayout(context, context.rasterOutputLayout, sets, kRasterConstants,
                                   "raster pipeline layout with outputs"));
    return makePipelineLayout(context, context.computeOutputLayout, sets, kComputeConstants,
                              "compute pipeline layout with outputs");
}

} // namespace

ContextImpl::~ContextImpl() {
    if (givenUp.load()) {
        return;
    }
    for (const VkPipelineLayout layout :
         {rasterLayout, dominantLayout, computeLayout, rasterOutputLayout, computeOutputLayout}) {
        if (layout != VK_NULL_HANDLE) {
            vk.DestroyPipelineLayout(device, layout, allocator);
        }
    }
    for (const VkDescriptorSetLayout layout : setLayouts) {
        if (layout != VK_NULL_HANDLE) {
            vk.DestroyDescriptorSetLayout(device, layout, allocator);
        }
    }
    for (const VkDescriptorSetLayout layout : {outputSetLayout, labelSetLayout}) {
        if (layout != VK_NULL_HANDLE) {
            vk.DestroyDescriptorSetLayout(device, layout, allocator);
        }
    }
    for (const VkSampler each : {sampler, nearestSampler}) {
        if (each != VK_NULL_HANDLE) {
            vk.DestroySampler(device, each, allocator);
        }
    }
}

void ContextImpl::log(const std::string& text) const noexcept {
    if (logCallback != nullptr) {
        logCallback(logUser, text.c_str());
    }
}

std::vector<VkQueueFamilyProperties> ContextImpl::families() const {
    return queueFamiliesOf(physicalDevice, vk.GetPhysicalDeviceQueueFamilyProperties);
}

std::uint32_t ContextImpl::timestampBits(std::uint32_t family) const {
    const std::vector<VkQueueFamilyProperties> all = families();
    return family < all.size() ? all[family].timestampValidBits : 0;
}

Result<void> ContextImpl::checkFamily(std::uint32_t family, VkQueueFlags anyOf, const char* what) const {
    return voxtact::checkFamily(families(), family, anyOf, what);
}

Context::Context(std::unique_ptr<ContextImpl> impl) noexcept : impl_(std::move(impl)) {}
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&& other) noexcept {
    if (this != &other) {
        ContextImpl::letGo(impl_);
        impl_ = std::move(other.impl_);
    }
    return *this;
}
Context::~Context() {
    ContextImpl::letGo(impl_);
}

Result<Context> Context::create(const ContextDesc& desc) {
    return guard([&]() -> Result<Context> {
        if ((desc.memory.allocate == nullptr) != (desc.memory.release == nullptr)) {
            return refuse("ContextDesc::memory has one function: both are needed, or neither");
        }
        VOXTACT_TRY(checkFamilies(desc));
        CheckReport report = check(desc);
        if (!report.usable) {
            return refusal(report);
        }
        auto impl = std::make_shared<ContextImpl>();
        impl->instance = desc.instance;
        impl->physicalDevice = desc.physicalDevice;
        impl->device = desc.device;
        impl->pipelineCache = desc.pipelineCache;
        impl->allocator = desc.allocator;
        impl->memoryCallbacks = desc.memory;
        impl->logCallback = desc.log;
        impl->logUser = desc.logUser;
        impl->features = readFeatures(desc.enabledFeatures);
        impl->conservativeRasterization = conservativeRasterizationEnabled(desc);
        impl->methods = std::move(report.methods);
        impl->vk.load(desc.getInstanceProcAddr, desc.instance, desc.device, debugUtilsEnabled(desc));
        readProperties(*impl);
        impl->fragmentsAtOnce = desc.fragmentsAtOnce == 0 ? kUsualFragments : desc.fragmentsAtOnce;
        impl->queueFamilies.assign(desc.queueFamilies.begin(), desc.queueFamilies.end());
        for (const auto make : {makeSamplers, makeSetLayouts, makeLayouts, makeOutputLayouts}) {
            VOXTACT_TRY(make(*impl));
        }
        for (const std::string& line : report.missing) {
            impl->log(line);
        }
        return Context(ContextImpl::hold(impl));
    });
}

std::span<const MethodSupport> Context::methods() const noexcept {
    return live(impl_).methods;
}

bool Context::supports(CountingMethod method) const noexcept {
    return std::ranges::any_of(live(impl_).methods,
                               [&](const MethodSupport& entry) { return entry.method == method && entry.available; });
}

bool Context::supports(CountingMethod method, Projection projection) const noexcept {
    if (!isKnown(projection) || !supports(method) || !answers(method, projection)) {
        return false;
    }
    return !rowOf(projection).certified || missingFloatControl(live(impl_).floatControls) == nullptr;
}

CountingMethod Context::defaultMethod() const noexcept {
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic}) {
        if (supports(method)) {
            return method;
        }
    }
    return CountingMethod::QueryAny;
}

VkExtent2D Context::maxViewport() const noexcept {
    const VkPhysicalDeviceLimits& limits = live(impl_).limits;
    return {std::min(limits.maxViewportDimensions[0], limits.maxFramebufferWidth),
            std::min(limits.maxViewportDimensions[1], limits.maxFramebufferHeight)};
}

bool Context::deviceLost() const noexcept {
    return live(impl_).lost.load();
}

} // namespace voxtact
