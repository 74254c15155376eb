// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "device/scene/scene_impl.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/image_limits.h"
#include "vulkan/submit.h"

#include <cstring>

namespace voxtact {

namespace {

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

} // namespace

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
        live(impl_).uploaded = true;
        return {};
    });
}

void LabelMap::releaseStaging() noexcept {
    live(impl_).staging = {};
}

const Grid& LabelMap::grid() const noexcept {
    return live(impl_).grid;
}

std::span<const std::int32_t> LabelMap::values() const noexcept {
    return *live(impl_).values;
}

} // namespace voxtact
