// SPDX-License-Identifier: MIT
#include "bench/paper/parts.h"

#include "bench/measure/numbers.h"
#include "bench/measure/rounds.h"
#include "bench/measure/stopwatch.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "voxtact/looks.h"
#include "voxtact/render.h"
#include "vulkan/barriers.h"
#include "vulkan/own/timed_commands.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace voxtact::lab {

namespace {

/// Work of an embedder's frame.
enum class FramePart {
    Rendering, ///< a picture of the volume and of the mesh in it
    Detection, ///< one pair, by one method
    Both,      ///< in one submission; the method `cpu` works while the picture is made
};

/// A completed frame. Times in ms; empty if unknown, or the part is not in the frame.
struct FrameSample {
    double wall = 0;             ///< from the submission to the end of the wait
    std::optional<double> gpu{}; ///< of the detection where there is nothing else; around everything that was submitted
    std::optional<double> mesh{};
    std::optional<double> volume{};
    std::optional<std::uint64_t> count{};
};

/// Timestamps of a frame, by their numbers: around everything, and those of Target::timestamps.
enum : std::uint32_t { kFrameBegins, kPictureBegins, kMeshDone, kVolumeDone, kFrameEnds, kFrameStamps };

constexpr ImageUse kDrawnTo{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};

/// Timed parts of each method.
constexpr std::array<FramePart, 2> kFrameParts{FramePart::Detection, FramePart::Both};

/// A scene on the device and the host, with its verified counts.
struct PaperWork {
    const PaperInput& input;
    std::vector<NamedCounts> counts; ///< by method
    std::size_t firstRow;            ///< theirs follow each other

    [[nodiscard]] CountingMethod methodOf(std::size_t number) const {
        return *countingMethodFromName(counts[number].method);
    }
};

/// Frames as an embedder makes them: a picture and the detection in one command buffer, with the same camera, volume
/// and mesh, recorded again for each, submitted and waited for. Recording is in none of the times.
struct PaperFrames {
    const PaperRun& run;
    const PaperWork& work;
    const device::Session& session = run.session;
    const Scene& scene = work.input.scene;
    std::optional<Renderer> renderer{};
    std::optional<RenderTransferFunction> function{};
    std::optional<RenderBricks> bricks{};
    std::optional<MeshNormals> normals{};
    std::optional<RenderTargets> targets{};
    std::optional<Image> image{}; ///< that is drawn to
    std::optional<Results> results{};
    std::map<CountingMethod, Detector> detectors{};
    Engine host{};
    std::optional<device::TimedCommands> commands{}; ///< ends first, and waits then

    /// The parts of the scene must be ready, the volume with bricks.
    Result<void> create();
    Result<void> createPicture();
    /// Creates the objects of a method for frames.
    Result<void> add(CountingMethod method);
    /// One frame, with the mesh at a pose. The method is not examined where nothing is detected.
    Result<FrameSample> take(FramePart part, CountingMethod method, const Mat4& world_from_object);

    Result<void> record(FramePart part, CountingMethod method, const Mat4& pose);
    Result<void> cmdPicture(VkCommandBuffer buffer, const Mat4& pose);
    Result<void> readTimes(FramePart part, bool onDevice, FrameSample& sample);

    /// Each round has another pose.
    [[nodiscard]] std::size_t poseOf(std::uint64_t round) const {
        return (round + scene.poses.size() - 1) % scene.poses.size();
    }
    Result<double> render(const Turn& turn);
    Result<double> detect(std::size_t method, const Turn& turn);
};

Result<void> PaperFrames::cmdPicture(VkCommandBuffer buffer, const Mat4& pose) {
    voxtact::Scene drawn;
    drawn.volume = &*scene.volume->device;
    drawn.transferFunction = &*function;
    drawn.bricks = &*bricks;
    drawn.mesh = &*scene.mesh->device;
    drawn.normals = &*normals;
    drawn.world_from_object = pose;
    drawn.clip_from_world = scene.view.clip_from_world;
    Target where;
    where.view = image->view.get();
    where.extent = targets->extent();
    where.targets = &*targets;
    where.timestamps = commands->timestamps();
    where.firstTimestamp = kPictureBegins;
    return renderer->cmdRender(buffer, drawn, where);
}

Result<void> PaperFrames::record(FramePart part, CountingMethod method, const Mat4& pose) {
    const Result<VkCommandBuffer> buffer = commands->begin();
    VOXTACT_TRY(buffer);
    commands->cmdStamp(kFrameBegins);
    // Discards the output of the last frame, which nobody reads.
    barrier(session.context.impl(), *buffer, image->image.get(),
            {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED}, kDrawnTo);
    if (part != FramePart::Detection) {
        VOXTACT_TRY(cmdPicture(*buffer, pose));
    }
    if (part != FramePart::Rendering && !rowOf(method).host) {
        const BatchItem item = Work(scene).at({&pose, 1}).onDevice();
        VOXTACT_TRY(detectors.at(method).cmdDetect(*buffer, {{&item, 1}, scene.view, kDefaultThreshold}, *results));
        VOXTACT_TRY(results->cmdReadBack(*buffer));
    }
    commands->cmdStamp(kFrameEnds);
    return commands->end();
}

Result<void> PaperFrames::readTimes(FramePart part, bool onDevice, FrameSample& sample) {
    if (commands->timestamps() == VK_NULL_HANDLE) {
        return {};
    }
    if (part == FramePart::Detection) {
        const Result<double> time = results->gpuMilliseconds();
        VOXTACT_TRY(time);
        if (*time > 0) {
            sample.gpu = *time;
        } else {
            session.device.missTimestamp();
        }
        return {};
    }
    VOXTACT_TRY(put(commands->between(kPictureBegins, kMeshDone), sample.mesh));
    VOXTACT_TRY(put(commands->between(kMeshDone, kVolumeDone), sample.volume));
    // While the host detects, a frame is not what is submitted alone.
    return part == FramePart::Both && !onDevice ? Result<void>()
                                                : put(commands->between(kFrameBegins, kFrameEnds), sample.gpu);
}

Result<void> PaperFrames::createPicture() {
    const VolumePart& volume = *scene.volume;
    const QueueAccess queue = session.device.queueAccess();
    const VkExtent2D extent{scene.view.width, scene.view.height};
    VOXTACT_TRY(put(Renderer::create(session.context), renderer));
    const std::vector<ColourPoint> colours = plainColours();
    RenderTransferFunctionDesc desc;
    desc.opacity = {volume.points, volume.domain};
    desc.colours = colours;
    desc.step = *std::ranges::min_element(volume.data.grid.spacing) / 2;
    VOXTACT_TRY(put(RenderTransferFunction::upload(*renderer, queue, desc), function));
    VOXTACT_TRY(put(RenderBricks::create(*renderer, *volume.device), bricks));
    VOXTACT_TRY(put(MeshNormals::upload(*renderer, queue, scene.mesh->data.view()), normals));
    VOXTACT_TRY(put(RenderTargets::create(*renderer, extent), targets));
    return put(makeImage(session.context.impl(),
                         {.type = VK_IMAGE_TYPE_2D,
                          .viewType = VK_IMAGE_VIEW_TYPE_2D,
                          .format = RendererDesc{}.colorFormat,
                          .extent = {extent.width, extent.height, 1},
                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
                         "the frame", "frame"),
               image);
}

Result<void> PaperFrames::create() {
    VOXTACT_TRY(createPicture());
    return put(device::TimedCommands::create(session, kFrameStamps), commands);
}

Result<void> PaperFrames::add(CountingMethod method) {
    if (rowOf(method).host) {
        return put(makeHostEngine(), host);
    }
    Result<Detector> detector = Detector::raster(session.context, {.method = method, .filter = defaultFilter(method)});
    VOXTACT_TRY(detector);
    if (!results) {
        VOXTACT_TRY(put(Results::create(*detector, {.timestamps = session.device.hasTimestamps(),
                                                    .queueFamily = session.device.queueAccess().family}),
                        results));
    }
    detectors.emplace(method, std::move(*detector));
    return {};
}

Result<FrameSample> PaperFrames::take(FramePart part, CountingMethod method, const Mat4& world_from_object) {
    const bool onHost = part != FramePart::Rendering && rowOf(method).host;
    const bool onDevice = part != FramePart::Rendering && !onHost;
    const bool submits = part != FramePart::Detection || onDevice;
    if (submits) {
        VOXTACT_TRY(record(part, method, world_from_object));
    }
    FrameSample sample;
    const Stopwatch watch;
    if (submits) {
        VOXTACT_TRY(commands->submit());
    }
    if (onHost) {
        const Result<Pass> pass = host.run(Work(scene).at({&world_from_object, 1}), {});
        VOXTACT_TRY(pass);
        sample.count = pass->pairs.front().count;
    }
    if (submits) {
        VOXTACT_TRY(commands->wait());
    }
    sample.wall = watch.milliseconds();
    if (onDevice) {
        const Result<std::span<const PairResult>> read = results->read();
        VOXTACT_TRY(read);
        sample.count = unpack(read->front()).count;
    }
    if (submits) {
        VOXTACT_TRY(readTimes(part, onDevice, sample));
    }
    return sample;
}

/// Counts every pose by every method. The first broken rule is the result's.
Result<std::vector<NamedCounts>> verify(const PaperRun& run, const PaperInput& input) {
    CompareResult compared;
    const CompareSettings settings;
    const Result<Engines> engines = makeMethodEngines(run.session, settings, compared);
    VOXTACT_TRY(engines);
    if (run.result.methods.empty()) {
        run.result.methods = compared.methods;
        VOXTACT_TRY(addTrust(run.session, run.result.methods, run.result.notes));
    }
    VOXTACT_TRY(checkCounts({run.session, settings, input.scene, *engines, compared, run.steps.step}));
    for (const std::string& note : compared.notes) {
        run.note(note);
    }
    if (const CompareVerdict* const failure = compared.firstFailure(); failure != nullptr) {
        run.disagree(
            concat(input.facts.name, ", ", failure->rule, ": pose ", failure->first->pose, ": ", failure->first->text));
    }
    return std::move(compared.counts);
}

PaperWork addRows(const PaperInput& input, std::vector<NamedCounts> counts, PaperResult& result) {
    PaperWork work{input, std::move(counts), result.rows.size()};
    for (const NamedCounts& by : work.counts) {
        const auto sum = static_cast<double>(std::accumulate(by.counts.begin(), by.counts.end(), 0ULL));
        const auto hits = std::ranges::count_if(by.counts, [](std::uint64_t count) { return count > 0; });
        const std::optional<CountingMethod> method = countingMethodFromName(by.method);
        const bool isCount = !method || rowOf(*method).exactness == Exactness::Exact;
        result.rows.push_back(
            {.scene = result.scenes.size(),
             .method = by.method,
             .survivors = isCount ? std::optional(sum / static_cast<double>(by.counts.size())) : std::nullopt,
             .hits = static_cast<std::uint32_t>(hits)});
    }
    result.scenes.push_back(input.facts);
    return work;
}

void keepFrame(FramePart part, const FrameSample& sample, PaperRow& row) {
    // In the order of FramePart.
    constexpr std::array kColumns{&PaperColumns::rendering, &PaperColumns::collision, &PaperColumns::total};
    const auto column = kColumns.at(static_cast<std::size_t>(part));
    keep(sample.gpu, row.gpu.*column);
    (row.wall.*column).push_back(sample.wall);
    if (part == FramePart::Rendering) {
        keep(sample.mesh, row.gpu.mesh);
        keep(sample.volume, row.gpu.volume);
    }
}

/// A frame without detection. It is the same by every method, so that a round takes one for all of them.
Result<double> PaperFrames::render(const Turn& turn) {
    const Result<FrameSample> sample = take(FramePart::Rendering, work.methodOf(0), scene.poses[poseOf(turn.round)]);
    VOXTACT_TRY(sample);
    for (std::size_t method = 0; turn.round > 0 && method < work.counts.size(); ++method) {
        keepFrame(FramePart::Rendering, *sample, run.result.rows[work.firstRow + method]);
    }
    return sample->wall;
}

/// The two frames of a method. A count that is not the verified one is the result's disagreement.
Result<double> PaperFrames::detect(std::size_t method, const Turn& turn) {
    const std::size_t pose = poseOf(turn.round);
    const std::uint64_t verified = work.counts[method].counts[pose];
    double wall = 0;
    for (std::size_t i = 0; i < kFrameParts.size(); ++i) {
        const FramePart part = kFrameParts.at(turn.backwards ? kFrameParts.size() - 1 - i : i);
        const Result<FrameSample> sample = take(part, work.methodOf(method), scene.poses[pose]);
        VOXTACT_TRY(sample);
        if (sample->count.value_or(verified) != verified) {
            run.disagree(concat(work.input.facts.name, ", pose ", pose, ": ", work.counts[method].method,
                                part == FramePart::Both ? " in a frame" : " alone", " counts ", *sample->count,
                                ", before it was ", verified));
        }
        if (turn.round > 0) {
            keepFrame(part, *sample, run.result.rows[work.firstRow + method]);
        }
        wall += sample->wall;
    }
    return wall;
}

/// Every method in turn, and in their middle the frame that they are held against.
Result<void> timeFrames(const PaperRun& run, double seconds, const PaperWork& work) {
    const Stopwatch watch;
    PaperFrames frames{run, work};
    VOXTACT_TRY(frames.create());
    std::vector<Timed> things;
    for (std::size_t method = 0; method < work.counts.size(); ++method) {
        VOXTACT_TRY(frames.add(work.methodOf(method)));
        if (method == work.counts.size() / 2) {
            things.push_back({.take = [&frames](const Turn& turn) { return frames.render(turn); }});
        }
        things.push_back({.take = [&frames, method](const Turn& turn) { return frames.detect(method, turn); }});
    }
    const Result<std::uint64_t> taken = takeRounds(things, {.repeats = run.settings.repetitions,
                                                            .warmUp = true,
                                                            .limit = seconds * 1000 - watch.milliseconds(),
                                                            .cycle = work.input.scene.poses.size(),
                                                            .step = run.steps.step,
                                                            .stop = [&run] { return !run.agrees(); }});
    VOXTACT_TRY(taken);
    if (*taken < run.settings.repetitions && run.agrees()) {
        run.note(concat(work.input.facts.name, ": ", *taken, " of ", run.settings.repetitions,
                        " repetitions fit in --time-limit"));
    }
    return {};
}

} // namespace

Result<void> measurePaperScene(const PaperRun& run, double seconds, const PaperInput& input) {
    VOXTACT_TRY(makeReady(run.session, input.scene, {.bricks = true}));
    Result<std::vector<NamedCounts>> counts = verify(run, input);
    VOXTACT_TRY(counts);
    return timeFrames(run, seconds, addRows(input, std::move(*counts), run.result));
}

std::uint64_t paperSceneSteps(const PaperSettings& settings) {
    return std::uint64_t{2} + settings.repetitions;
}

} // namespace voxtact::lab
