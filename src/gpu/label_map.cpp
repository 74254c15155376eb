// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "core/volume/label_nodes.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/image_limits.h"
#include "gpu/layouts.h"
#include "gpu/scene_impl.h"
#include "gpu/submit.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace voxtact {

namespace {

/// That a stage sees in labelSearchLayout().
constexpr std::uint32_t kLabelStorageBuffers = kComputeStorageBuffers + 1;

bool canSearchLabels(const ContextImpl& context) {
    return context.computeLayout != VK_NULL_HANDLE && context.limits.maxBoundDescriptorSets >= kOutputSets &&
           context.limits.maxPerStageDescriptorStorageBuffers >= kLabelStorageBuffers;
}

VkExtent3D extentOf(const Grid& grid) {
    return {grid.size[0], grid.size[1], grid.size[2]};
}

Result<void> fillMap(LabelMapImpl& map, const LabelData& data, const char* name) {
    ContextImpl& context = map.context;
    ImageDesc desc;
    desc.format = kLabelFormat;
    desc.extent = extentOf(data.grid);
    Result<Image> image = makeImage(context, desc, "the label map", name);
    VOXTACT_TRY(image);
    map.image = std::move(*image);
    const VkDeviceSize bytes = data.indices.size() * sizeof data.indices[0];
    Result<Buffer> staging =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload, "label map staging");
    VOXTACT_TRY(staging);
    map.staging = std::move(*staging);
    std::memcpy(map.staging.mapped, data.indices.data(), bytes);
    VOXTACT_TRY(flush(context, map.staging));
    Result<DescriptorSet> set = makeLabelSet(context, map.image.view.get(), name);
    VOXTACT_TRY(set);
    map.descriptors = std::move(*set);
    return {};
}

/// What clearances to labels need in addition to the image.
Result<void> fillNodes(LabelMapImpl& map, const LabelData& data, const std::string& name) {
    ContextImpl& context = map.context;
    const VkDeviceSize bytes = labelNodeCount(data.grid) * sizeof(LabelBits);
    if (!canSearchLabels(context) || bytes > context.limits.maxStorageBufferRange) {
        return {};
    }
    Result<Buffer> nodes =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                   MemoryUse::Device, (name + " nodes").c_str());
    VOXTACT_TRY(nodes);
    Result<Buffer> staging =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload, "label map node staging");
    VOXTACT_TRY(staging);
    std::memcpy(staging->mapped, labelNodes(data).data(), bytes);
    VOXTACT_TRY(flush(context, *staging));
    const Result<VkDescriptorSetLayout> layout = labelSearchSetLayout(context);
    VOXTACT_TRY(layout);
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    Result<DescriptorSet> set = makeDescriptorSet(context, *layout, sizes, (name + " nodes").c_str());
    VOXTACT_TRY(set);
    map.nodes = std::move(*nodes);
    map.nodeStaging = std::move(*staging);
    map.searched = std::move(*set);
    writeImage(context, map.searched.set, 0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, map.image.view.get(),
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, context.nearestSampler);
    writeBuffer(context, map.searched.set, VOXTACT_BINDING_LABEL_NODES, map.nodes.get());
    return {};
}

} // namespace

Result<VkDescriptorSetLayout> labelSearchSetLayout(ContextImpl& context) {
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.labelSearchSetLayout) {
        constexpr VkDescriptorSetLayoutBinding kBindings[] = {
            {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
            {VOXTACT_BINDING_LABEL_NODES, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
        VOXTACT_TRY(makeSetLayout(context, context.labelSearchSetLayout, kBindings, "label search set layout"));
    }
    return context.labelSearchSetLayout.get();
}

Result<VkPipelineLayout> labelSearchLayout(ContextImpl& context) {
    if (!canSearchLabels(context)) {
        return Error{ErrorCode::Unsupported, 0,
                     "clearances to labels cannot be had on this device: its maxBoundDescriptorSets is " +
                         std::to_string(context.limits.maxBoundDescriptorSets) + ", " + std::to_string(kOutputSets) +
                         " are needed, and its maxPerStageDescriptorStorageBuffers " +
                         std::to_string(context.limits.maxPerStageDescriptorStorageBuffers) + ", " +
                         std::to_string(kLabelStorageBuffers) + " are needed"};
    }
    const Result<VkDescriptorSetLayout> set = labelSearchSetLayout(context);
    VOXTACT_TRY(set);
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.labelSearchLayout) {
        VkDescriptorSetLayout sets[kOutputSets];
        std::ranges::copy(context.setLayouts, std::begin(sets));
        sets[VOXTACT_SET_LABELS] = *set;
        VOXTACT_TRY(makePipelineLayout(context, context.labelSearchLayout, sets, kComputeConstants,
                                       "label search pipeline layout"));
    }
    return context.labelSearchLayout.get();
}

Result<DescriptorSet> makeLabelSet(ContextImpl& context, VkImageView view, const char* name) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.labelSetLayout, {&size, 1}, name);
    if (set.ok()) {
        writeImage(context, set->set, 0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, view);
    }
    return set;
}

LabelMap::LabelMap(std::unique_ptr<LabelMapImpl> impl) noexcept : impl_(std::move(impl)) {}
LabelMap::LabelMap(LabelMap&&) noexcept = default;
LabelMap& LabelMap::operator=(LabelMap&&) noexcept = default;
LabelMap::~LabelMap() = default;

Result<LabelMap> LabelMap::create(const Context& context, const LabelData& data, const char* name) {
    return guard([&]() -> Result<LabelMap> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkLabels(data));
        VOXTACT_TRY(
            checkImageLimits(c, data.grid, kLabelFormat, ImageDesc{}.usage, sizeof data.indices[0], "the label map"));
        auto impl = std::make_unique<LabelMapImpl>(LabelMapImpl{.context = c, .grid = data.grid});
        impl->values = std::make_shared<const std::vector<std::int32_t>>(data.values);
        VOXTACT_TRY(fillMap(*impl, data, name == nullptr ? "label map" : name));
        VOXTACT_TRY(fillNodes(*impl, data, name == nullptr ? "label map" : name));
        return LabelMap(std::move(impl));
    });
}

Result<LabelMap> LabelMap::upload(const Context& context, const QueueAccess& queue, const LabelData& data,
                                  const char* name) {
    return guard([&] { return uploaded(context.impl(), queue, create(context, data, name)); });
}

Result<void> LabelMap::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!live(impl_).staging.buffer) {
            return notUploadable("label map");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Label label(live(impl_).context, commandBuffer, "voxtact label map upload");
        cmdFillImage(live(impl_).context, commandBuffer, live(impl_).staging.get(), live(impl_).image.image.get(),
                     extentOf(live(impl_).grid));
        if (live(impl_).nodes.buffer) {
            cmdFillBuffer(live(impl_).context, commandBuffer, live(impl_).nodeStaging, live(impl_).nodes);
        }
        live(impl_).uploaded = true;
        return {};
    });
}

void LabelMap::releaseStaging() noexcept {
    live(impl_).staging = {};
    live(impl_).nodeStaging = {};
}

const Grid& LabelMap::grid() const noexcept {
    return live(impl_).grid;
}

std::span<const std::int32_t> LabelMap::values() const noexcept {
    return *live(impl_).values;
}

} // namespace voxtact
