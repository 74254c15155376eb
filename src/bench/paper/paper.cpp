// SPDX-License-Identifier: MIT
#include "bench/paper/parts.h"

#include "bench/measure/numbers.h"
#include "bench/measure/rounds.h"
#include "core/base/try.h"
#include "voxtact/render.h"
#include "vulkan/own/timed_submission.h"

#include <algorithm>
#include <array>

namespace voxtact::lab {

namespace {

/// Share of the time for frames, with sweeps.
constexpr double kFramesShare = 0.65;

void addNotes(const PaperSettings& settings, PaperResult& result) {
    result.notes.emplace_back(
        "times exclude recording; collision: the detection of one pair, alone; "
        "overhead: of a frame with the detection in it against one without, round by round; a round "
        "has one frame without it for all methods");
    result.notes.emplace_back("mesh and volume have GPU times only; cpu detects while the GPU draws, so only the wall "
                              "clock includes it");
    // More samples never have less of an interval, and there may be more than the memory holds at once.
    constexpr std::uint32_t kEnough = 100;
    if (!medianInterval(std::vector<double>(std::min(settings.repetitions, kEnough)), kConfidence)) {
        result.notes.emplace_back("the overhead has no interval: its median is known with a confidence of 95 % from 6 "
                                  "--repetitions on");
    }
    if (settings.scale > 1) {
        result.notes.push_back(concat("--scale ", settings.scale,
                                      ": the volumes are smaller than the paper's, so the times are not comparable"));
    }
}

/// Returns the other sample of each round, or its increase, as a percentage of rendering.
std::vector<double> percents(const std::vector<double>& rendering, const std::vector<double>& other, bool added) {
    std::vector<double> out;
    for (std::size_t i = 0; rendering.size() == other.size() && i < other.size(); ++i) {
        // A clock may be so coarse, or stand still, that a small picture takes no time.
        if (rendering[i] > 0) {
            out.push_back(100 * (other[i] - (added ? rendering[i] : 0)) / rendering[i]);
        }
    }
    return out;
}

/// Volume of the sweep of voxels, and its voxels per side: half to twice as many are 128 to 512.
constexpr const char* kVolume = "builtin:head";
constexpr std::uint32_t kVoxels = 256;
constexpr std::array<ControlPoint, 2> kOpacity{{{40, 0}, {80, 1}}};
constexpr ValueRange kSweepDomain{0, 255};
/// Number of the scene's poses: a query per polygon is slow.
constexpr std::uint32_t kPolygonPoses = 4;
/// Each gets the same share of the time: the four sweeps, the polygons, and the pre-integrated tables.
constexpr double kParts = kSweeps.size() + 2.0;

/// The builtin head with the mesh and the viewport of the scene.
Result<Scene> headOf(const PaperSettings& settings, const Scene& v1s1) {
    Scene head{std::make_shared<VolumePart>(), v1s1.mesh, {}, {}, {}, v1s1.view};
    VolumePart& volume = *head.volume;
    volume.name = std::string(kVolume) + ":" + std::to_string(kVoxels / settings.scale);
    volume.points = {kOpacity.begin(), kOpacity.end()};
    volume.domain = kSweepDomain;
    VOXTACT_TRY(put(settings.load.volume(volume.name), volume.data));
    head.view.clip_from_world = framingCamera(volume.data.grid, head.view.width, head.view.height);
    const auto poses = static_cast<std::uint32_t>(v1s1.poses.size());
    VOXTACT_TRY(chooseTouching(poses, settings.seed, kVolume, head));
    return head;
}

std::string nameOf(Sweep sweep) {
    return sweep == Sweep::Batch ? "sweep of batches" : std::string("sweep of ") + toString(sweep);
}

/// Counts every pose, and where the methods agree times them; as `voxtact compare` does.
Result<void> timeAll(const PaperRun& run, const CompareSettings& how, const Scene& v1s1, CompareResult& compared) {
    run.steps.doing(nameOf(Sweep::Batch));
    const Result<Engines> engines = makeMethodEngines(run.session, how, compared);
    VOXTACT_TRY(engines);
    const CompareRun comparing{run.session, how, v1s1, *engines, compared, run.steps.step};
    VOXTACT_TRY(checkCounts(comparing));
    for (const Sweep sweep : {Sweep::Batch, Sweep::Triangles, Sweep::Fragments}) {
        if (comparing.ended()) {
            return {};
        }
        run.steps.doing(nameOf(sweep));
        VOXTACT_TRY(timeSweep(comparing, sweep));
    }
    if (comparing.ended()) {
        return {};
    }
    run.steps.doing(nameOf(Sweep::Voxels));
    const Result<Scene> head = headOf(run.settings, v1s1);
    VOXTACT_TRY(head);
    return timeSweep({run.session, how, *head, *engines, compared, run.steps.step}, Sweep::Voxels);
}

Result<void> sweep(const PaperRun& run, const CompareSettings& how, const Scene& v1s1) {
    VOXTACT_TRY(makeReady(run.session, v1s1));
    CompareResult compared;
    VOXTACT_TRY(timeAll(run, how, v1s1, compared));
    if (const CompareVerdict* const failure = compared.firstFailure(); failure != nullptr) {
        run.disagree(disagreementOf(*failure));
    }
    run.result.series = std::move(compared.series);
    run.result.notes.insert(run.result.notes.end(), compared.notes.begin(), compared.notes.end());
    return {};
}

/// Which triangles touch, on a few poses.
Result<void> findPolygons(const PaperRun& run, const CompareSettings& how, const Scene& v1s1) {
    LocalizeResult found;
    found.machine = run.result.machine;
    VOXTACT_TRY(localize(run.session, how, v1s1.withPoses(kPolygonPoses), found, run.steps.step));
    if (found.verdict.failed()) {
        run.disagree(disagreementOf(found.verdict));
    }
    run.result.polygons = std::move(found.ways);
    run.result.polygonTriangles = v1s1.mesh->triangles();
    run.result.polygonPoses = static_cast<std::uint32_t>(found.poseNumbers.size());
    run.result.notes.insert(run.result.notes.end(), found.notes.begin(), found.notes.end());
    return {};
}

constexpr std::array<std::uint32_t, 5> kEntries{64, 128, 256, 512, 1024};

/// Two functions with colours that take turns.
constexpr std::array<std::array<ControlPoint, 3>, 2> kOpacities{
    {{{{40, 0}, {80, 0.6}, {255, 1}}}, {{{60, 0}, {120, 0.3}, {255, 0.9}}}}};
constexpr std::array<std::array<ColourPoint, 3>, 2> kColours{
    {{{{0, {0.3, 0.1, 0.1}}, {120, {0.9, 0.6, 0.5}}, {255, {1, 1, 0.95}}}},
     {{{0, {0.1, 0.1, 0.3}}, {140, {0.5, 0.6, 0.9}}, {255, {0.95, 1, 1}}}}}};

RenderTransferFunctionDesc functionOf(std::uint32_t entries, std::size_t number) {
    return {.opacity = {kOpacities.at(number), kSweepDomain, entries}, .colours = kColours.at(number)};
}

/// The making of the pre-integrated table, in several sizes: a warm-up, then rounds that make each size once, every
/// time of a function that has changed. The rounds are cut to fit in `seconds`.
Result<void> timeIntegration(const PaperRun& run, double seconds) {
    const Result<Renderer> renderer = Renderer::create(run.session.context);
    VOXTACT_TRY(renderer);
    std::vector<RenderTransferFunction> tables;
    std::vector<IntegrationPoint>& points = run.result.integration;
    for (const std::uint32_t entries : kEntries) {
        Result<RenderTransferFunction> made = RenderTransferFunction::create(*renderer, functionOf(entries, 0));
        VOXTACT_TRY(made);
        tables.push_back(std::move(*made));
        points.push_back({.entries = entries});
    }
    Result<device::TimedSubmission> submission = device::TimedSubmission::create(run.session);
    VOXTACT_TRY(submission);
    std::vector<Timed> things;
    for (std::size_t i = 0; i < points.size(); ++i) {
        things.push_back({.take = [&, i](const Turn& turn) -> Result<double> {
            const auto times = submission->run([&](VkCommandBuffer commands) {
                return tables[i].cmdUpdate(commands,
                                           functionOf(kEntries.at(i), turn.round % 2)); // one that has changed
            });
            VOXTACT_TRY(times);
            if (turn.round > 0) {
                points[i].wall.push_back(times->wallMilliseconds);
                keep(times->gpuMilliseconds, points[i].gpu);
            }
            return times->wallMilliseconds;
        }});
    }
    const Result<std::uint64_t> taken = takeRounds(
        things, {.repeats = run.settings.repetitions, .warmUp = true, .limit = seconds * 1000, .step = run.steps.step});
    VOXTACT_TRY(taken);
    if (*taken < run.settings.repetitions) {
        run.note(concat("pre-integrated tables: ", *taken, " of ", run.settings.repetitions,
                        " repetitions fit in --time-limit"));
    }
    return {};
}

std::uint64_t paperSweepSteps(const PaperSettings& settings) {
    std::uint64_t steps = 1;
    for (const Sweep sweep : kSweeps) {
        steps += stepsOf(sweep, settings.repetitions);
    }
    const std::uint64_t poses = std::min(kPolygonPoses, settings.poses);
    return steps + poses * settings.repetitions + settings.repetitions + 1;
}

/// Runs the sweeps, the measurement of touched triangles, and that of the pre-integrated table. `v1s1` is the first
/// scene, with the numbers of its poses; its mesh is the builtin scalpel. Fills `series`, `polygons`,
/// `polygonTriangles`, `polygonPoses` and `integration` of `result`, and adds to its notes. If methods disagree, it
/// fills `disagreement`, unless already set, and stops. The samples are cut to fit in `seconds`.
Result<void> runPaperSweeps(const PaperRun& run, double seconds, const Scene& v1s1) {
    const CompareSettings how{
        .repeats = run.settings.repetitions, .timeLimit = seconds / kParts, .load = run.settings.load};
    VOXTACT_TRY(sweep(run, how, v1s1));
    if (!run.agrees()) {
        return {};
    }
    run.steps.doing("finding touched triangles");
    VOXTACT_TRY(findPolygons(run, how, v1s1));
    if (!run.agrees()) {
        return {};
    }
    run.steps.doing("the pre-integrated table");
    return timeIntegration(run, seconds / kParts);
}

} // namespace

void PaperRun::note(const std::string& text) const {
    if (std::ranges::find(result.notes, text) == result.notes.end()) {
        result.notes.push_back(text);
    }
}

std::vector<double> collisionPercent(const PaperColumns& columns) {
    return percents(columns.rendering, columns.collision, false);
}

std::vector<double> overheadPercent(const PaperColumns& columns) {
    return percents(columns.rendering, columns.total, true);
}

Result<void> measurePaper(const PaperSettings& settings, const device::Session& session, const Steps& steps,
                          PaperResult& result) {
    VOXTACT_TRY(checkViewport(session, settings.size));
    const Result<std::vector<PaperInput>> inputs = loadPaperScenes(settings);
    VOXTACT_TRY(inputs);
    result.machine = describeMachine(session, inputs->front().scene.volume->data.type, result.machine.provenance);
    result.width = settings.size.width;
    result.height = settings.size.height;
    addNotes(settings, result);
    const auto scenes = static_cast<double>(inputs->size());
    const double frames = settings.noSweeps ? 1 : kFramesShare;
    steps.begin(inputs->size() * paperSceneSteps(settings) + (settings.noSweeps ? 0 : paperSweepSteps(settings)));
    const PaperRun run{session, settings, steps, result};
    for (const PaperInput& input : *inputs) {
        steps.doing("frames of " + input.facts.name);
        Result<void> measured = measurePaperScene(run, settings.timeLimit * frames / scenes, input);
        if (!measured.ok() || !run.agrees()) {
            return measured;
        }
    }
    if (!settings.noSweeps) {
        VOXTACT_TRY(runPaperSweeps(run, settings.timeLimit * (1 - kFramesShare), inputs->front().scene));
    }
    noteMissedTimes(session, result.notes);
    return {};
}

} // namespace voxtact::lab
