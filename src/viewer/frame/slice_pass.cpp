// SPDX-License-Identifier: MIT
#include "viewer/frame/slice_pass.h"

#include "core/base/try.h"
#include "voxtact_shaders/slice_frag.h"
#include "voxtact_shaders/slice_vert.h"

#include <algorithm>

namespace voxtact::view {

namespace {

/// value = first * texel + second, as Volume::format() has the texels of a type.
std::array<float, 2> unitsOf(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return {255, 0};
    case ScalarType::UInt16:
        return {65535, 0};
    case ScalarType::Int16:
        return {65535, -32768}; // with its sign bit flipped
    case ScalarType::Float32:
        break;
    }
    return {1, 0};
}

bool filtersLinearly(const device::VulkanDevice& device, VkFormat format) {
    const ContextDesc& desc = device.contextDesc();
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceFormatProperties>(
        desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceFormatProperties"));
    VkFormatProperties properties{};
    get(desc.physicalDevice, format, &properties);
    return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

} // namespace

Result<SlicePass> SlicePass::create(const device::Session& session, const Volume& volume) {
    SlicePass out(session);
    const device::VulkanDevice& device = session.device;
    DrawPipelineDesc desc;
    desc.vertexShader = spirv::slice_vert;
    desc.fragmentShader = spirv::slice_frag;
    desc.format = VK_FORMAT_R8G8B8A8_UNORM;
    desc.pushStages = VK_SHADER_STAGE_FRAGMENT_BIT;
    desc.pushBytes = sizeof(Push);
    const VkFilter filter = filtersLinearly(device, volume.format()) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    Result<Drawing> drawing = Drawing::create(device, desc, 1, filter);
    VOXTACT_TRY(drawing);
    out.drawing_ = std::move(*drawing);
    const Result<VkDescriptorSet> set = out.drawing_.addTexture();
    VOXTACT_TRY(set);
    out.volume_ = *set;
    out.drawing_.textures.set(out.volume_, volume.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    VOXTACT_TRY(out.resize({}));
    return out;
}

bool SlicePass::fits(const std::array<Extent, 3>& extents) const {
    return std::ranges::equal(extents, images_, [](const Extent& extent, const Image& image) {
        return extent.width == image.extent().width && extent.height == image.extent().height;
    });
}

Result<void> SlicePass::resize(const std::array<Extent, 3>& extents) {
    for (std::size_t slice = 0; slice < extents.size(); ++slice) {
        const VkExtent2D extent{extents[slice].width, extents[slice].height};
        Result<Image> image = Image::create(session_->device, extent, VK_FORMAT_R8G8B8A8_UNORM,
                                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
        VOXTACT_TRY(image);
        images_[slice] = std::move(*image);
        drawn_[slice].reset();
    }
    return submitAndWait(*session_, [this](VkCommandBuffer commands) {
        for (const Image& image : images_) {
            layoutBarrier(session_->device, commands,
                          {image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL}, {}, {});
        }
    });
}

SlicePass::Push SlicePass::pushOf(const State& state, std::size_t slice) const {
    const VkExtent2D extent = images_[slice].extent();
    const SlicePlace place = slicePlace(kSlices[slice], state.volume.grid, state.cursor, {extent.width, extent.height});
    const Mat4 texture_from_clip = multiply(state.texture_from_world, place.world_from_clip);
    Push push{};
    std::ranges::transform(texture_from_clip, push.texture_from_clip.begin(),
                           [](double x) { return static_cast<float>(x); });
    push.units = unitsOf(state.volume.type);
    push.window = {static_cast<float>(state.window.lo), static_cast<float>(state.window.hi)};
    push.opaque = {1, 0, 1, 0, 1, 0, 1, 0};
    const Edit& edit = state.document.edit;
    std::size_t at = 0;
    for (const ValueRange& range : opaqueRanges(edit.curve, edit.threshold, state.document.domain)) {
        if (at < push.opaque.size()) {
            // Values beyond the domain have the opacity of its ends.
            const bool least = range.lo <= state.document.domain.lo;
            const bool most = range.hi >= state.document.domain.hi;
            push.opaque[at++] = static_cast<float>(least ? std::min(state.values.lo, range.lo) : range.lo);
            push.opaque[at++] = static_cast<float>(most ? std::max(state.values.hi, range.hi) : range.hi);
        }
    }
    return push;
}

void SlicePass::record(VkCommandBuffer commands, const State& state) {
    const VolkDeviceTable& table = session_->device.table();
    if (written_ != state.writes.end()) {
        written_ = state.writes.end();
        drawn_ = {};
    }
    for (std::size_t slice = 0; slice < images_.size(); ++slice) {
        const Push push = pushOf(state, slice);
        if (drawn_[slice] == push) {
            continue;
        }
        drawn_[slice] = push;
        const Image& image = images_[slice];
        memoryBarrier(session_->device, commands,
                      {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
                      {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT});
        beginRendering(session_->device, commands, image.view(), VK_IMAGE_LAYOUT_GENERAL, image.extent());
        table.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing_.pipeline.handle());
        table.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing_.pipeline.layout(), 0, 1,
                                      &volume_, 0, nullptr);
        table.vkCmdPushConstants(commands, drawing_.pipeline.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                                 &push);
        table.vkCmdDraw(commands, 3, 1, 0, 0);
        table.vkCmdEndRendering(commands);
    }
}

} // namespace voxtact::view
