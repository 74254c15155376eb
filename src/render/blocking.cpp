// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/barriers.h"
#include "vulkan/submit.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>

namespace voxtact {

namespace {

constexpr std::size_t kPixelBytes = 4;

/// Resources of a picture of one size.
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

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begun) {
    return std::max(std::chrono::duration<double>(Clock::now() - begun).count(), 1e-6);
}

/// Renders a picture in one piece, or in bands of about a fifth of a second. A row in the middle, usually among the
/// slowest, is timed first. The rows of each band follow from the slower pace of that row and the previous band.
class Bands {
  public:
    /// In one piece.
    explicit Bands(VkExtent2D extent) : height_(extent.height), last_(extent.height) {}
    /// `secondsOfRow`: time of a row in the middle.
    Bands(VkExtent2D extent, double secondsOfRow) : height_(extent.height), secondsOfRow_(secondsOfRow) {
        last_ = std::min(height_, rowsFor(secondsOfRow, kMostTimes));
    }

    [[nodiscard]] std::uint32_t first() const noexcept { return first_; }
    [[nodiscard]] std::uint32_t last() const noexcept { return last_; }
    /// Advances to the next band; returns false after the last.
    [[nodiscard]] bool next() {
        const std::uint32_t rows = last_ - first_;
        const double pace = std::max(secondsOfRow_, secondsSince(begun_) / rows);
        begun_ = Clock::now();
        first_ = last_;
        last_ = first_ + std::min(height_ - first_, rowsFor(pace, kMostTimes * rows));
        return first_ < height_;
    }

  private:
    static constexpr std::uint32_t kMostTimes = 8; // as many rows as before

    [[nodiscard]] static std::uint32_t rowsFor(double secondsOfRow, std::uint32_t most) {
        constexpr double kSeconds = 0.2;
        return static_cast<std::uint32_t>(std::clamp(kSeconds / secondsOfRow, 1.0, static_cast<double>(most)));
    }

    std::uint32_t height_;
    std::uint32_t first_ = 0;
    std::uint32_t last_ = 0;
    double secondsOfRow_ = 0;
    Clock::time_point begun_ = Clock::now();
};

} // namespace

struct BlockingRenderer::State {
    ContextImpl& context;
    Renderer renderer;
    std::optional<Frame> frame;
    Submitter submitter;

    /// A band of rows: from the first on, before the last.
    Result<void> record(VkCommandBuffer commandBuffer, const Scene& scene, std::uint32_t first, std::uint32_t last,
                        bool anew);
    /// A submission. A band from the first row on, or `again`, discards earlier results.
    Result<void> renderBand(const Scene& scene, VkExtent2D extent, std::uint32_t first, std::uint32_t last,
                            bool anew = false);
    /// Seconds per row in the middle; not used for the picture.
    Result<double> pace(const Scene& scene, VkExtent2D extent);
    Result<void> prepare(VkExtent2D extent);
    Result<Picture> read();
};

Result<void> BlockingRenderer::State::record(VkCommandBuffer commandBuffer, const Scene& scene, std::uint32_t first,
                                             std::uint32_t last, bool anew) {
    const VkExtent2D extent = frame->targets.extent();
    constexpr ImageUse kWritten{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    if (anew) {
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

Result<void> BlockingRenderer::State::renderBand(const Scene& scene, VkExtent2D extent, std::uint32_t first,
                                                 std::uint32_t last, bool anew) {
    // First of all: a submission whose wait failed may still be using the frame.
    const Result<VkCommandBuffer> commandBuffer = submitter.begin();
    VOXTACT_TRY(commandBuffer);
    VOXTACT_TRY(prepare(extent));
    VOXTACT_TRY(record(*commandBuffer, scene, first, last, anew || first == 0));
    return submitter.submitAndWait();
}

Result<double> BlockingRenderer::State::pace(const Scene& scene, VkExtent2D extent) {
    const std::uint32_t middle = extent.height / 2;
    double seconds = 0;
    for (int turn = 0; turn < 2; ++turn) { // in the first one the driver compiles
        const auto begun = Clock::now();
        VOXTACT_TRY(renderBand(scene, extent, middle, middle + 1, true));
        seconds = secondsSince(begun);
    }
    return seconds;
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
        Bands bands(extent);
        if (progress && extent.height > 1) {
            const Result<double> ofRow = state.pace(scene, extent);
            VOXTACT_TRY(ofRow);
            bands = Bands(extent, *ofRow);
        }
        do {
            VOXTACT_TRY(state.renderBand(scene, extent, bands.first(), bands.last()));
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
