// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "render/render_impl.h"

#include <algorithm>

namespace voxtact {

namespace {

std::string sizeText(std::uint32_t width, std::uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

Result<void> checkExtent(const ContextImpl& context, VkExtent2D extent) {
    const VkPhysicalDeviceLimits& limits = context.limits;
    if (extent.width == 0 || extent.height == 0) {
        return refuse("the picture is " + sizeText(extent.width, extent.height) + ", it needs at least one pixel");
    }
    const std::uint32_t width =
        std::min({limits.maxViewportDimensions[0], limits.maxFramebufferWidth, limits.maxImageDimension2D});
    const std::uint32_t height =
        std::min({limits.maxViewportDimensions[1], limits.maxFramebufferHeight, limits.maxImageDimension2D});
    if (extent.width > width || extent.height > height) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the picture is " + sizeText(extent.width, extent.height) +
                         ", the device's limit (maxViewportDimensions, maxFramebufferWidth and Height, "
                         "maxImageDimension2D) is " +
                         sizeText(width, height)};
    }
    return {};
}

Result<Image> makeTarget(ContextImpl& context, VkExtent2D extent, VkFormat format, const char* name) {
    const bool depth = format == kMeshDepthFormat;
    ImageDesc desc;
    desc.type = VK_IMAGE_TYPE_2D;
    desc.viewType = VK_IMAGE_VIEW_TYPE_2D;
    desc.format = format;
    desc.extent = {extent.width, extent.height, 1};
    desc.usage = depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                       : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    desc.aspect = depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    return makeImage(context, desc, "the mesh pass", name);
}

Result<void> makeImages(RenderTargetsImpl& targets) {
    struct Wanted {
        Image RenderTargetsImpl::*image;
        VkFormat format;
        const char* name;
    };
    for (const Wanted& wanted : {Wanted{&RenderTargetsImpl::colour, kMeshColourFormat, "mesh colour"},
                                 Wanted{&RenderTargetsImpl::distance, kMeshDistanceFormat, "mesh distance"},
                                 Wanted{&RenderTargetsImpl::depth, kMeshDepthFormat, "mesh depth"}}) {
        Result<Image> made = makeTarget(targets.renderer.context, targets.extent, wanted.format, wanted.name);
        VOXTACT_TRY(made);
        targets.*wanted.image = std::move(*made);
    }
    return {};
}

Result<void> describe(RenderTargetsImpl& targets) {
    ContextImpl& context = targets.renderer.context;
    Result<Buffer> constants = makeBuffer(
        context, sizeof(shader::PictureConstants) + PICTURE_MESHES * sizeof(shader::PictureMesh),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Device, "picture constants");
    VOXTACT_TRY(constants);
    targets.constants = std::move(*constants);
    constexpr VkDescriptorPoolSize kSizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    Result<DescriptorSet> set =
        makeDescriptorSet(context, targets.renderer.targetsLayout.get(), kSizes, "render targets");
    VOXTACT_TRY(set);
    targets.descriptors = std::move(*set);
    writeBuffer(context, targets.descriptors.set, PICTURE_BINDING_CONSTANTS, targets.constants.get());
    writeImage(context, targets.descriptors.set, PICTURE_BINDING_MESH_COLOUR, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
               targets.colour.view.get());
    writeImage(context, targets.descriptors.set, PICTURE_BINDING_MESH_DISTANCE,
               VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, targets.distance.view.get());
    return {};
}

} // namespace

RenderTargets::RenderTargets(std::unique_ptr<RenderTargetsImpl> impl) noexcept : impl_(std::move(impl)) {}
RenderTargets::RenderTargets(RenderTargets&&) noexcept = default;
RenderTargets& RenderTargets::operator=(RenderTargets&&) noexcept = default;
RenderTargets::~RenderTargets() = default;

Result<RenderTargets> RenderTargets::create(const Renderer& renderer, VkExtent2D extent) {
    return guard([&]() -> Result<RenderTargets> {
        ContextImpl& context = renderer.impl().context;
        VOXTACT_TRY(context.alive());
        VOXTACT_TRY(checkExtent(context, extent));
        auto impl =
            std::make_unique<RenderTargetsImpl>(RenderTargetsImpl{.renderer = renderer.impl(), .extent = extent});
        for (const auto make : {makeImages, describe}) {
            VOXTACT_TRY(make(*impl));
        }
        return RenderTargets(std::move(impl));
    });
}

VkExtent2D RenderTargets::extent() const noexcept {
    return live(impl_).extent;
}

} // namespace voxtact
