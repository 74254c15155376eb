// SPDX-License-Identifier: MIT
#include "lab/compare/compare_run.h"

#include "core/try.h"
#include "lab/compare/compare_timing.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

Result<void> timeSweep(const Session& session, const CompareSettings& settings, const Scene& scene,
                       const Engines& engines, Sweep sweep, CompareResult& result, const std::function<void()>& step) {
    switch (sweep) {
    case Sweep::Batch:
        return timeBatches(settings, engines, Work(scene), result, step);
    case Sweep::Triangles:
        return timeTriangles(session, settings, scene, engines, result, step);
    case Sweep::Fragments:
        return timeFragments(session, settings, scene, engines, result, step);
    case Sweep::Voxels:
        return timeVoxels(session, settings, scene, engines, result, step);
    }
    return {};
}

/// The oracle's time is that of its checks: one thread, one pose after the other.
void addOracleSeries(const Scene& scene, CompareResult& result) {
    if (!result.oracleMilliseconds) {
        return;
    }
    double fragments = 0;
    for (const FragmentCheck& check : result.fragmentChecks) {
        fragments += static_cast<double>(check.byOracle);
    }
    const auto poses = static_cast<std::uint32_t>(result.fragmentChecks.size());
    result.series.push_back({.sweep = Sweep::Batch,
                             .method = "oracle",
                             .mode = Mode::Sync,
                             .batch = 1,
                             .width = scene.view.width,
                             .height = scene.view.height,
                             .triangles = result.triangles,
                             .pairs = poses,
                             .fragments = fragments / poses,
                             .wall = {*result.oracleMilliseconds},
                             .gpu = {},
                             .voxels = scene.volume->data.grid.size});
}

} // namespace

Result<void> compare(const CompareSettings& settings, const Scene& scene, const Session& session, const Steps& steps,
                     CompareResult& result) {
    VOXTACT_TRY(checkViewport(session, {scene.view.width, scene.view.height}));
    result.poseNumbers = scene.poseNumbers;
    result.triangles = scene.mesh->triangles();
    VOXTACT_TRY(makeReady(session, {}, *scene.volume));
    VOXTACT_TRY(makeReady(&session, *scene.mesh));
    const Result<Engines> engines = makeMethodEngines(session, settings, result);
    VOXTACT_TRY(engines);
    std::uint64_t total = 1 + std::min<std::uint64_t>(settings.oraclePoses, scene.poses.size());
    for (const Sweep sweep : settings.sweeps) {
        total += stepsOf(sweep, settings.repeats);
    }
    steps.begin(total);
    Result<std::vector<NamedCounts>> counts = countAll(*engines, Work(scene));
    VOXTACT_TRY(counts);
    result.counts = std::move(*counts);
    result.verdicts = judgeCounts(result.counts, scene.poseNumbers);
    steps.step();
    VOXTACT_TRY(checkFragments(session, settings, scene, result, steps.step));
    for (const Sweep sweep : settings.sweeps) {
        if (result.firstFailure() != nullptr && !settings.keepGoing) {
            break;
        }
        VOXTACT_TRY(timeSweep(session, settings, scene, *engines, sweep, result, steps.step));
        if (sweep == Sweep::Batch) {
            addOracleSeries(scene, result);
        }
    }
    return {};
}

} // namespace voxtact::lab
