// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "gpu/barriers.h"
#include "gpu/submit.h"
#include "render/render_impl.h"

#include <algorithm>
#include <chrono>
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
    VOXTACT_TRY(targets);
    ImageDesc desc;
    desc.type = VK_IMAGE_TYPE_2D;
    desc.viewType = VK_IMAGE_VIEW_TYPE_2D;
    desc.format = renderer.impl().desc.colorFormat;
    desc.extent = {extent.width, extent.height, 1};
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    Result<Image> image = makeImage(context, desc, "the picture", "picture");
    VOXTACT_TRY(image);
    Result<Buffer> readBack = makeBuffer(context, VkDeviceSize{kPixelBytes} * extent.width * extent.height,
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::ReadBack, "picture read-back");
    VOXTACT_TRY(readBack);
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

/// A picture in one piece, or in bands that take about a fifth of a second each: the first is short, and each of the
/// next has as many rows as the pace of the one before asks for.
class Bands {
  public:
    Bands(VkExtent2D extent, bool several)
        : height_(extent.height), last_(several ? std::min(extent.height, kFirstRows) : extent.height) {}

    [[nodiscard]] std::uint32_t first() const noexcept { return first_; }
    [[nodiscard]] std::uint32_t last() const noexcept { return last_; }
    /// After a band is done. False: it was the last.
    [[nodiscard]] bool next() {
        constexpr double kSeconds = 0.2;
        constexpr std::uint32_t kMostTimes = 8; // as many rows as before
        const auto now = Clock::now();
        const double took = std::max(std::chrono::duration<double>(now - begun_).count(), 1e-6);
        begun_ = now;
        const std::uint32_t rows = last_ - first_;
        const double wanted = std::clamp(rows * kSeconds / took, 1.0, static_cast<double>(kMostTimes) * rows);
        first_ = last_;
        last_ = height_ - first_ > wanted ? first_ + static_cast<std::uint32_t>(wanted) : height_;
        return first_ < height_;
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::uint32_t kFirstRows = 32;

    std::uint32_t height_;
    std::uint32_t first_ = 0;
    std::uint32_t last_;
    Clock::time_point begun_ = Clock::now();
};

} // namespace

struct BlockingRenderer::State {
    ContextImpl& context;
    Renderer renderer;
    std::optional<Frame> frame;
    Submitter submitter;

    /// A band of rows: from the first on, before the last.
    Result<void> record(VkCommandBuffer commandBuffer, const Scene& scene, std::uint32_t first, std::uint32_t last);
    /// A submission.
    Result<void> renderBand(VkCommandBuffer commandBuffer, const Scene& scene, std::uint32_t first, std::uint32_t last);
    Result<void> prepare(VkExtent2D extent);
    Result<Picture> read();
};

Result<void> BlockingRenderer::State::record(VkCommandBuffer commandBuffer, const Scene& scene, std::uint32_t first,
                                             std::uint32_t last) {
    const VkExtent2D extent = frame->targets.extent();
    constexpr ImageUse kWritten{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    if (first == 0) {
        barrier(context, commandBuffer, frame->image.image.get(),
                {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED}, kWritten);
    } else {
        barrier(context, commandBuffer, frame->image.image.get(), kWritten, kWritten);
    }
    Target target;
    target.view = frame->image.view.get();
    target.extent = extent;
    target.targets = &frame->targets;
    target.area = {{0, static_cast<std::int32_t>(first)}, {extent.width, last - first}};
    VOXTACT_TRY(renderer.cmdRender(commandBuffer, scene, target));
    if (last == extent.height) {
        cmdReadBack(context, commandBuffer, *frame);
    }
    return {};
}

Result<void> BlockingRenderer::State::renderBand(VkCommandBuffer commandBuffer, const Scene& scene, std::uint32_t first,
                                                 std::uint32_t last) {
    VOXTACT_TRY(record(commandBuffer, scene, first, last));
    return submitter.submitAndWait();
}

Result<void> BlockingRenderer::State::prepare(VkExtent2D extent) {
    const VkExtent2D kept = frame ? frame->targets.extent() : VkExtent2D{};
    if (frame && kept.width == extent.width && kept.height == extent.height) {
        return {};
    }
    frame.reset();
    Result<Frame> made = makeFrame(renderer, extent);
    VOXTACT_TRY(made);
    frame.emplace(std::move(*made));
    return {};
}

Result<Picture> BlockingRenderer::State::read() {
    VOXTACT_TRY(invalidate(context, frame->readBack));
    const VkExtent2D extent = frame->targets.extent();
    Picture picture{extent.width, extent.height, {}};
    picture.rgba.resize(kPixelBytes * extent.width * extent.height);
    std::memcpy(picture.rgba.data(), frame->readBack.mapped, picture.rgba.size());
    return picture;
}

BlockingRenderer::BlockingRenderer(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
BlockingRenderer::BlockingRenderer(BlockingRenderer&&) noexcept = default;
BlockingRenderer& BlockingRenderer::operator=(BlockingRenderer&&) noexcept = default;
BlockingRenderer::~BlockingRenderer() = default;

Result<BlockingRenderer> BlockingRenderer::create(const Context& context, const QueueAccess& queue) {
    return guard([&]() -> Result<BlockingRenderer> {
        Result<Renderer> renderer = Renderer::create(context);
        VOXTACT_TRY(renderer);
        Result<Submitter> submitter = Submitter::create(context.impl(), queue);
        VOXTACT_TRY(submitter);
        return BlockingRenderer(
            std::make_unique<State>(State{context.impl(), std::move(*renderer), std::nullopt, std::move(*submitter)}));
    });
}

Result<Picture> BlockingRenderer::render(const Scene& scene, VkExtent2D extent) {
    return render(scene, extent, {});
}

Result<Picture> BlockingRenderer::render(const Scene& scene, VkExtent2D extent, const Progress& progress) {
    return guard([&]() -> Result<Picture> {
        State& state = live(state_);
        Bands bands(extent, progress != nullptr);
        do {
            // First of all: a submission whose wait failed may still be using the frame.
            const Result<VkCommandBuffer> commandBuffer = state.submitter.begin();
            VOXTACT_TRY(commandBuffer);
            VOXTACT_TRY(state.prepare(extent));
            VOXTACT_TRY(state.renderBand(*commandBuffer, scene, bands.first(), bands.last()));
            if (progress && !progress(bands.last(), extent.height)) {
                return Error{ErrorCode::Cancelled, 0, "the picture was cancelled"};
            }
        } while (bands.next());
        return state.read();
    });
}

const Renderer& BlockingRenderer::renderer() const noexcept {
    return live(state_).renderer;
}

} // namespace voxtact
