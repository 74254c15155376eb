// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "core/live.h"
#include "gpu/barriers.h"
#include "gpu/submit.h"
#include "render/render_impl.h"

#include <cstring>
#include <optional>

namespace voxtact {

namespace {

constexpr std::size_t kPixelBytes = 4;

/// What a picture of one size needs.
struct Frame {
    RenderTargets targets;
    Image image;
    Buffer readBack;
};

Result<Frame> makeFrame(const Renderer& renderer, VkExtent2D extent) {
    ContextImpl& context = renderer.impl().context;
    Result<RenderTargets> targets = RenderTargets::create(renderer, extent);
    if (!targets.ok()) {
        return targets.error();
    }
    ImageDesc desc;
    desc.type = VK_IMAGE_TYPE_2D;
    desc.viewType = VK_IMAGE_VIEW_TYPE_2D;
    desc.format = renderer.impl().desc.colorFormat;
    desc.extent = {extent.width, extent.height, 1};
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    Result<Image> image = makeImage(context, desc, "the picture", "picture");
    if (!image.ok()) {
        return image.error();
    }
    Result<Buffer> readBack = makeBuffer(context, VkDeviceSize{kPixelBytes} * extent.width * extent.height,
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::ReadBack, "picture read-back");
    if (!readBack.ok()) {
        return readBack.error();
    }
    return Frame{std::move(*targets), std::move(*image), std::move(*readBack)};
}

void cmdReadBack(const ContextImpl& context, VkCommandBuffer commandBuffer, const Frame& frame) {
    barrier(context, commandBuffer, frame.image.image.get(),
            {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
            {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {frame.targets.extent().width, frame.targets.extent().height, 1};
    context.vk.CmdCopyImageToBuffer(commandBuffer, frame.image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                    frame.readBack.get(), 1, &region);
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

} // namespace

struct BlockingRenderer::State {
    ContextImpl& context;
    Renderer renderer;
    std::optional<Frame> frame;
    Submitter submitter;

    Result<void> record(VkCommandBuffer commandBuffer, const Scene& scene);
};

Result<void> BlockingRenderer::State::record(VkCommandBuffer commandBuffer, const Scene& scene) {
    barrier(context, commandBuffer, frame->image.image.get(),
            {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
            {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    Target target;
    target.view = frame->image.view.get();
    target.extent = frame->targets.extent();
    target.targets = &frame->targets;
    if (Result<void> recorded = renderer.cmdRender(commandBuffer, scene, target); !recorded.ok()) {
        return recorded;
    }
    cmdReadBack(context, commandBuffer, *frame);
    return {};
}

BlockingRenderer::BlockingRenderer(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
BlockingRenderer::BlockingRenderer(BlockingRenderer&&) noexcept = default;
BlockingRenderer& BlockingRenderer::operator=(BlockingRenderer&&) noexcept = default;
BlockingRenderer::~BlockingRenderer() = default;

Result<BlockingRenderer> BlockingRenderer::create(const Context& context, const QueueAccess& queue) {
    return guard([&]() -> Result<BlockingRenderer> {
        Result<Renderer> renderer = Renderer::create(context);
        if (!renderer.ok()) {
            return renderer.error();
        }
        Result<Submitter> submitter = Submitter::create(context.impl(), queue);
        if (!submitter.ok()) {
            return submitter.error();
        }
        return BlockingRenderer(
            std::make_unique<State>(State{context.impl(), std::move(*renderer), std::nullopt, std::move(*submitter)}));
    });
}

Result<Picture> BlockingRenderer::render(const Scene& scene, VkExtent2D extent) {
    return guard([&]() -> Result<Picture> {
        State& state = live(state_);
        // First of all: a submission whose wait failed may still be using the frame.
        const Result<VkCommandBuffer> commandBuffer = state.submitter.begin();
        if (!commandBuffer.ok()) {
            return commandBuffer.error();
        }
        const VkExtent2D kept = state.frame ? state.frame->targets.extent() : VkExtent2D{};
        if (!state.frame || kept.width != extent.width || kept.height != extent.height) {
            state.frame.reset();
            Result<Frame> frame = makeFrame(state.renderer, extent);
            if (!frame.ok()) {
                return frame.error();
            }
            state.frame.emplace(std::move(*frame));
        }
        if (Result<void> recorded = state.record(*commandBuffer, scene); !recorded.ok()) {
            return recorded.error();
        }
        if (Result<void> done = state.submitter.submitAndWait(); !done.ok()) {
            return done.error();
        }
        if (Result<void> visible = invalidate(state.context, state.frame->readBack); !visible.ok()) {
            return visible.error();
        }
        Picture picture{extent.width, extent.height, {}};
        picture.rgba.resize(kPixelBytes * extent.width * extent.height);
        std::memcpy(picture.rgba.data(), state.frame->readBack.mapped, picture.rgba.size());
        return picture;
    });
}

const Renderer& BlockingRenderer::renderer() const noexcept {
    return live(state_).renderer;
}

} // namespace voxtact
