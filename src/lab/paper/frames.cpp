// SPDX-License-Identifier: MIT
#include "lab/paper/frames.h"

#include "core/base/try.h"
#include "core/method/method_table.h"
#include "device/timed_commands.h"
#include "gpu/barriers.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>
#include <map>

namespace voxtact::lab {

namespace {

/// Timestamps of a frame, by their numbers: around everything, and those of Target::timestamps.
constexpr std::uint32_t kFrameBegins = 0;
constexpr std::uint32_t kPictureBegins = 1;
constexpr std::uint32_t kMeshDone = 2;
constexpr std::uint32_t kVolumeDone = 3;
constexpr std::uint32_t kFrameEnds = 4;
constexpr std::uint32_t kFrameStamps = 5;

constexpr ImageUse kDrawnTo{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};

/// What a picture needs beside what the detection has.
struct PictureParts {
    Renderer renderer;
    RenderTransferFunction function;
    RenderBricks bricks;
    MeshNormals normals;
    RenderTargets targets;
    Image image; ///< that is drawn to
};

Result<PictureParts> makePicture(const device::Session& session, const Scene& scene,
                                 const std::vector<ColourPoint>& colours) {
    const VolumePart& volume = *scene.volume;
    const QueueAccess queue = session.device.queueAccess();
    Result<Renderer> renderer = Renderer::create(session.context);
    VOXTACT_TRY(renderer);
    RenderTransferFunctionDesc desc;
    desc.opacity = {volume.points, volume.domain};
    desc.colours = colours;
    desc.step = *std::ranges::min_element(volume.data.grid.spacing) / 2;
    Result<RenderTransferFunction> function = RenderTransferFunction::upload(*renderer, queue, desc);
    VOXTACT_TRY(function);
    Result<RenderBricks> bricks = RenderBricks::create(*renderer, *volume.device);
    VOXTACT_TRY(bricks);
    Result<MeshNormals> normals = MeshNormals::upload(*renderer, queue, scene.mesh->data.view());
    VOXTACT_TRY(normals);
    Result<RenderTargets> targets = RenderTargets::create(*renderer, {scene.view.width, scene.view.height});
    VOXTACT_TRY(targets);
    Result<Image> image = makeImage(session.context.impl(),
                                    {.type = VK_IMAGE_TYPE_2D,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = RendererDesc{}.colorFormat,
                                     .extent = {scene.view.width, scene.view.height, 1},
                                     .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
                                    "the frame", "frame");
    VOXTACT_TRY(image);
    return PictureParts{std::move(*renderer), std::move(*function), std::move(*bricks),
                        std::move(*normals),  std::move(*targets),  std::move(*image)};
}

} // namespace

struct FrameLoop::State {
    const device::Session& session;
    const Scene& scene;
    PictureParts picture;
    Results results;
    std::map<CountingMethod, Detector> detectors{};
    Engine host{};
    device::TimedCommands commands; ///< ends first, and waits then

    Result<void> record(FramePart part, CountingMethod method, const Mat4& pose);
    Result<void> cmdPicture(VkCommandBuffer buffer, const Mat4& pose);
    Result<void> cmdDetect(VkCommandBuffer buffer, CountingMethod method, const Mat4& pose);
    Result<void> readTimes(FramePart part, bool onDevice, FrameSample& sample);
};

Result<void> FrameLoop::State::cmdPicture(VkCommandBuffer buffer, const Mat4& pose) {
    voxtact::Scene drawn;
    drawn.volume = &*scene.volume->device;
    drawn.transferFunction = &picture.function;
    drawn.bricks = &picture.bricks;
    drawn.mesh = &*scene.mesh->device;
    drawn.normals = &picture.normals;
    drawn.world_from_object = pose;
    drawn.clip_from_world = scene.view.clip_from_world;
    Target where;
    where.view = picture.image.view.get();
    where.extent = picture.targets.extent();
    where.targets = &picture.targets;
    where.timestamps = commands.timestamps();
    where.firstTimestamp = kPictureBegins;
    return picture.renderer.cmdRender(buffer, drawn, where);
}

Result<void> FrameLoop::State::cmdDetect(VkCommandBuffer buffer, CountingMethod method, const Mat4& pose) {
    const BatchItem item = Work(scene).at({&pose, 1}).onDevice();
    Result<void> recorded =
        detectors.at(method).cmdDetect(buffer, {{&item, 1}, scene.view, kDefaultThreshold}, results);
    return recorded.ok() ? results.cmdReadBack(buffer) : recorded;
}

Result<void> FrameLoop::State::record(FramePart part, CountingMethod method, const Mat4& pose) {
    const Result<VkCommandBuffer> buffer = commands.begin();
    VOXTACT_TRY(buffer);
    commands.cmdStamp(kFrameBegins);
    // What the last frame drew is lost, and was read by nobody.
    barrier(session.context.impl(), *buffer, picture.image.image.get(),
            {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED}, kDrawnTo);
    if (part != FramePart::Detection) {
        VOXTACT_TRY(cmdPicture(*buffer, pose));
    }
    if (part != FramePart::Rendering && !rowOf(method).host) {
        VOXTACT_TRY(cmdDetect(*buffer, method, pose));
    }
    commands.cmdStamp(kFrameEnds);
    return commands.end();
}

Result<void> FrameLoop::State::readTimes(FramePart part, bool onDevice, FrameSample& sample) {
    if (commands.timestamps() == VK_NULL_HANDLE) {
        return {};
    }
    const auto read = [this](std::uint32_t from, std::uint32_t to, std::optional<double>& time) -> Result<void> {
        const Result<std::optional<double>> between = commands.between(from, to);
        VOXTACT_TRY(between);
        time = *between;
        return {};
    };
    if (part == FramePart::Detection) {
        const Result<double> time = results.gpuMilliseconds();
        VOXTACT_TRY(time);
        if (*time > 0) {
            sample.gpu = *time;
        } else {
            session.device.missTimestamp();
        }
        return {};
    }
    VOXTACT_TRY(read(kPictureBegins, kMeshDone, sample.mesh));
    VOXTACT_TRY(read(kMeshDone, kVolumeDone, sample.volume));
    // While the host detects, a frame is not what is submitted alone.
    return part == FramePart::Both && !onDevice ? Result<void>() : read(kFrameBegins, kFrameEnds, sample.gpu);
}

Result<FrameLoop> FrameLoop::create(const device::Session& session, const Scene& scene,
                                    const std::vector<ColourPoint>& colours) {
    Result<PictureParts> picture = makePicture(session, scene, colours);
    VOXTACT_TRY(picture);
    Result<Results> results = Results::create(session.context, {.maxPairs = 1,
                                                                .readBack = true,
                                                                .timestamps = session.device.hasTimestamps(),
                                                                .queueFamily = session.device.queueAccess().family});
    VOXTACT_TRY(results);
    Result<device::TimedCommands> commands = device::TimedCommands::create(session, kFrameStamps);
    VOXTACT_TRY(commands);
    return FrameLoop(std::make_shared<State>(State{.session = session,
                                                   .scene = scene,
                                                   .picture = std::move(*picture),
                                                   .results = std::move(*results),
                                                   .commands = std::move(*commands)}));
}

Result<void> FrameLoop::add(CountingMethod method) {
    if (rowOf(method).host) {
        MadeEngine host = makeHostEngine();
        VOXTACT_TRY(host);
        state_->host = std::move(*host);
        return {};
    }
    Result<Detector> detector =
        Detector::create(state_->session.context, {.method = method, .filter = defaultFilter(method)});
    VOXTACT_TRY(detector);
    state_->detectors.emplace(method, std::move(*detector));
    return {};
}

Result<FrameSample> FrameLoop::run(FramePart part, CountingMethod method, const Mat4& world_from_object) {
    const bool onHost = part != FramePart::Rendering && rowOf(method).host;
    const bool onDevice = part != FramePart::Rendering && !onHost;
    const bool submits = part != FramePart::Detection || onDevice;
    if (submits) {
        VOXTACT_TRY(state_->record(part, method, world_from_object));
    }
    FrameSample sample;
    const Stopwatch watch;
    if (submits) {
        VOXTACT_TRY(state_->commands.submit());
    }
    if (onHost) {
        const Result<Pass> pass = state_->host.run(Work(state_->scene).at({&world_from_object, 1}), {});
        VOXTACT_TRY(pass);
        sample.count = pass->pairs.front().count;
    }
    if (submits) {
        VOXTACT_TRY(state_->commands.wait());
    }
    sample.wall = watch.milliseconds();
    if (onDevice) {
        const Result<std::span<const PairResult>> read = state_->results.read();
        VOXTACT_TRY(read);
        sample.count = unpack(read->front()).count;
    }
    if (submits) {
        VOXTACT_TRY(state_->readTimes(part, onDevice, sample));
    }
    return sample;
}

} // namespace voxtact::lab
