// SPDX-License-Identifier: MIT
#include "lab/paper/paper_frames.h"

#include "core/try.h"
#include "lab/engines/engine.h"
#include "lab/measure/stopwatch.h"
#include "lab/paper/frame_target.h"
#include "voxtact/render.h"

#include <algorithm>
#include <map>

namespace voxtact::lab {

namespace {

/// What a picture needs beside what the detection has.
struct PictureParts {
    Renderer renderer;
    RenderTransferFunction function;
    RenderBricks bricks;
    MeshNormals normals;
    RenderTargets targets;
};

Result<PictureParts> makePicture(const Session& session, const Scene& scene, const std::vector<ColourPoint>& colours) {
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
    return PictureParts{std::move(*renderer), std::move(*function), std::move(*bricks), std::move(*normals),
                        std::move(*targets)};
}

Result<Results> makeResults(const Session& session) {
    return Results::create(session.context, {.maxPairs = 1,
                                             .readBack = true,
                                             .timestamps = session.device.hasTimestamps(),
                                             .queueFamily = session.device.queueAccess().family});
}

} // namespace

struct FrameLoop::State {
    const Session& session;
    const Scene& scene;
    PictureParts picture;
    Results results;
    std::map<CountingMethod, Detector> detectors{};
    std::unique_ptr<Engine> host{};
    FrameTarget target; ///< ends first, and waits then

    Result<void> record(FramePart part, CountingMethod method, const Mat4& pose);
    Result<void> cmdPicture(VkCommandBuffer commands, const Mat4& pose);
    Result<void> cmdDetect(VkCommandBuffer commands, CountingMethod method, const Mat4& pose);
    Result<std::uint64_t> detectOnHost(const Mat4& pose);
    Result<void> readTimes(FramePart part, bool onDevice, FrameSample& sample);
};

Result<void> FrameLoop::State::cmdPicture(VkCommandBuffer commands, const Mat4& pose) {
    voxtact::Scene drawn;
    drawn.volume = &*scene.volume->device;
    drawn.transferFunction = &picture.function;
    drawn.bricks = &picture.bricks;
    drawn.mesh = &*scene.mesh->device;
    drawn.normals = &picture.normals;
    drawn.world_from_object = pose;
    drawn.clip_from_world = scene.view.clip_from_world;
    Target where;
    where.view = target.view();
    where.extent = picture.targets.extent();
    where.targets = &picture.targets;
    where.timestamps = target.timestamps();
    where.firstTimestamp = kPictureBegins;
    return picture.renderer.cmdRender(commands, drawn, where);
}

Result<void> FrameLoop::State::cmdDetect(VkCommandBuffer commands, CountingMethod method, const Mat4& pose) {
    const BatchItem item{&*scene.mesh->device, &*scene.volume->device, &*scene.volume->deviceFunction, {&pose, 1}};
    Result<void> recorded =
        detectors.at(method).cmdDetect(commands, {{&item, 1}, scene.view, kDefaultThreshold}, results);
    return recorded.ok() ? results.cmdReadBack(commands) : recorded;
}

Result<void> FrameLoop::State::record(FramePart part, CountingMethod method, const Mat4& pose) {
    const Result<VkCommandBuffer> commands = target.begin();
    VOXTACT_TRY(commands);
    if (part != FramePart::Detection) {
        VOXTACT_TRY(cmdPicture(*commands, pose));
    }
    if (part != FramePart::Rendering && method != CountingMethod::Cpu) {
        VOXTACT_TRY(cmdDetect(*commands, method, pose));
    }
    return target.end();
}

Result<std::uint64_t> FrameLoop::State::detectOnHost(const Mat4& pose) {
    const Result<Pass> pass = host->run(Work(scene).at({&pose, 1}), {});
    return pass.ok() ? Result<std::uint64_t>(pass->pairs.front().count) : pass.error();
}

Result<void> FrameLoop::State::readTimes(FramePart part, bool onDevice, FrameSample& sample) {
    if (target.timestamps() == VK_NULL_HANDLE) {
        return {};
    }
    struct Reading {
        std::optional<double>& time;
        std::uint32_t from;
        std::uint32_t to;
        bool wanted;
    };
    const bool drawn = part != FramePart::Detection;
    // While the host detects, a frame is not what is submitted alone.
    const bool whole = part != FramePart::Both || onDevice;
    for (const Reading& reading :
         {Reading{sample.mesh, kPictureBegins, kMeshDone, drawn}, Reading{sample.volume, kMeshDone, kVolumeDone, drawn},
          Reading{sample.all, kFrameBegins, kFrameEnds, whole}}) {
        if (!reading.wanted) {
            continue;
        }
        const Result<std::optional<double>> time = target.between(reading.from, reading.to);
        VOXTACT_TRY(time);
        reading.time = *time;
    }
    if (part == FramePart::Detection) {
        const Result<double> time = results.gpuMilliseconds();
        VOXTACT_TRY(time);
        sample.detection = *time;
    }
    return {};
}

FrameLoop::FrameLoop(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
FrameLoop::FrameLoop(FrameLoop&&) noexcept = default;
FrameLoop& FrameLoop::operator=(FrameLoop&&) noexcept = default;
FrameLoop::~FrameLoop() = default;

Result<FrameLoop> FrameLoop::create(const Session& session, const Scene& scene,
                                    const std::vector<ColourPoint>& colours) {
    Result<PictureParts> picture = makePicture(session, scene, colours);
    VOXTACT_TRY(picture);
    Result<Results> results = makeResults(session);
    VOXTACT_TRY(results);
    Result<FrameTarget> target =
        FrameTarget::create(session, RendererDesc{}.colorFormat, {scene.view.width, scene.view.height});
    VOXTACT_TRY(target);
    return FrameLoop(std::unique_ptr<State>(new State{.session = session,
                                                      .scene = scene,
                                                      .picture = std::move(*picture),
                                                      .results = std::move(*results),
                                                      .target = std::move(*target)}));
}

Result<void> FrameLoop::add(CountingMethod method) {
    if (method == CountingMethod::Cpu) {
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
    const bool onHost = part != FramePart::Rendering && method == CountingMethod::Cpu;
    const bool onDevice = part != FramePart::Rendering && !onHost;
    const bool submits = part != FramePart::Detection || onDevice;
    if (submits) {
        VOXTACT_TRY(state_->record(part, method, world_from_object));
    }
    FrameSample sample;
    const Stopwatch watch;
    if (submits) {
        VOXTACT_TRY(state_->target.submit());
    }
    if (onHost) {
        const Result<std::uint64_t> count = state_->detectOnHost(world_from_object);
        VOXTACT_TRY(count);
        sample.count = *count;
    }
    if (submits) {
        VOXTACT_TRY(state_->target.wait());
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
