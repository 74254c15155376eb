// SPDX-License-Identifier: MIT
#include "lab/paper/parts.h"

#include "core/base/try.h"

#include <algorithm>
#include <array>

namespace voxtact::lab {

namespace {

/// Of the sweep of voxels, and its voxels a side: half to twice as many are 128 to 512.
constexpr const char* kVolume = "builtin:head";
constexpr std::uint32_t kVoxels = 256;
constexpr std::array<ControlPoint, 2> kOpacity{{{40, 0}, {80, 1}}};
constexpr ValueRange kSweepDomain{0, 255};
/// Of those of the scene: a query a polygon takes its time.
constexpr std::uint32_t kPolygonPoses = 4;
/// Each gets the same share of the time: the four sweeps, and the polygons.
constexpr double kParts = kSweeps.size() + 1.0;

CompareSettings settingsFor(const PaperSettings& settings, double seconds) {
    CompareSettings out;
    out.repeats = settings.repetitions;
    out.timeLimit = seconds / kParts;
    out.load = settings.load;
    return out;
}

/// The builtin head with the mesh and the viewport of the scene.
Result<Scene> headOf(const PaperSettings& settings, const Scene& v1s1) {
    Scene head{std::make_shared<VolumePart>(), v1s1.mesh, {}, {}, {}, v1s1.view};
    VolumePart& volume = *head.volume;
    volume.name = std::string(kVolume) + ":" + std::to_string(kVoxels / settings.scale);
    volume.points = {kOpacity.begin(), kOpacity.end()};
    volume.domain = kSweepDomain;
    Result<VolumeData> data = settings.load.volume(volume.name);
    VOXTACT_TRY(data);
    volume.data = std::move(*data);
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
    if (const Verdict* const failure = compared.firstFailure(); failure != nullptr) {
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

} // namespace

std::uint64_t paperSweepSteps(const PaperSettings& settings) {
    std::uint64_t steps = 1;
    for (const Sweep sweep : kSweeps) {
        steps += stepsOf(sweep, settings.repetitions);
    }
    const std::uint64_t poses = std::min(kPolygonPoses, settings.poses);
    return steps + poses * settings.repetitions + settings.repetitions + 1;
}

Result<void> runPaperSweeps(const PaperRun& run, double seconds, const Scene& v1s1) {
    const CompareSettings how = settingsFor(run.settings, seconds);
    VOXTACT_TRY(sweep(run, how, v1s1));
    if (!run.agrees()) {
        return {};
    }
    run.steps.doing("which triangles touch");
    VOXTACT_TRY(findPolygons(run, how, v1s1));
    if (!run.agrees()) {
        return {};
    }
    run.steps.doing("the pre-integrated table");
    Result<std::vector<IntegrationPoint>> integration = timeIntegration(run);
    VOXTACT_TRY(integration);
    run.result.integration = std::move(*integration);
    return {};
}

} // namespace voxtact::lab
