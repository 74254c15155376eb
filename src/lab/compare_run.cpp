// SPDX-License-Identifier: MIT
#include "lab/compare_run.h"

#include "lab/compare_timing.h"

#include <algorithm>

namespace voxtact::app {

namespace {

struct Bench {
    const CompareSettings& settings;
    const CompareData& data;
    const Session& session;
    const Surroundings& surroundings;
    const Subject& subject;
    Runners runners;
    const std::function<void()>& step;
};

Result<void> verify(Bench& bench, CompareResult& result) {
    const Work work{&bench.subject, bench.data.poses, bench.data.view};
    Result<std::vector<NamedCounts>> counts = countAll(bench.runners, work);
    if (!counts.ok()) {
        return counts.error();
    }
    result.counts = std::move(*counts);
    result.verdicts = judgeCounts(result.counts, bench.data.poseNumbers);
    bench.step();
    return checkFragments(bench.session, bench.settings, bench.data, bench.surroundings, bench.subject, result,
                          bench.step);
}

Result<void> timeSweep(Bench& bench, Sweep sweep, CompareResult& result) {
    switch (sweep) {
    case Sweep::Batch:
        return timeBatches(bench.settings, bench.runners, {&bench.subject, bench.data.poses, bench.data.view}, result,
                           bench.step);
    case Sweep::Triangles:
        return timeTriangles(bench.session, bench.settings, bench.data, bench.runners, result, bench.step);
    case Sweep::Fragments:
        return timeFragments(bench.session, bench.settings, bench.data, bench.subject, bench.runners, result,
                             bench.step);
    case Sweep::Voxels:
        return timeVoxels(bench.session, bench.settings, bench.data, bench.subject, bench.runners, result, bench.step);
    }
    return {};
}

/// The oracle's time is that of its checks: one thread, one pose after the other.
void addOracleSeries(const CompareData& data, CompareResult& result) {
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
                             .width = data.view.width,
                             .height = data.view.height,
                             .triangles = result.triangles,
                             .pairs = poses,
                             .fragments = fragments / poses,
                             .wall = {*result.oracleMilliseconds},
                             .gpu = {},
                             .voxels = data.volume.grid.size});
}

} // namespace

Result<void> compare(const CompareSettings& settings, const CompareData& data, const Session& session,
                     const Steps& steps, CompareResult& result) {
    if (Result<void> fits = checkViewport(session, {data.view.width, data.view.height}); !fits.ok()) {
        return fits;
    }
    result.poseNumbers = data.poseNumbers;
    result.triangles = static_cast<std::uint32_t>(data.mesh.indices.size() / 3);
    const Result<Surroundings> surroundings = makeSurroundings(session, data.volume.view(), data.transferFunction());
    if (!surroundings.ok()) {
        return surroundings.error();
    }
    const Result<Subject> subject = makeSubject(session, data.mesh);
    if (!subject.ok()) {
        return subject.error();
    }
    Result<Runners> runners = makeRunners(session, settings, *surroundings, data.threshold, result);
    if (!runners.ok()) {
        return runners.error();
    }
    std::uint64_t total = 1 + std::min<std::uint64_t>(settings.oraclePoses, data.poses.size());
    for (const Sweep sweep : settings.sweeps) {
        total += stepsOf(sweep, settings.repeats);
    }
    steps.begin(total);
    Bench bench{settings, data, session, *surroundings, *subject, std::move(*runners), steps.step};
    if (Result<void> verified = verify(bench, result); !verified.ok()) {
        return verified;
    }
    for (const Sweep sweep : settings.sweeps) {
        if (result.firstFailure() != nullptr && !settings.keepGoing) {
            break;
        }
        if (Result<void> timed = timeSweep(bench, sweep, result); !timed.ok()) {
            return timed;
        }
        if (sweep == Sweep::Batch) {
            addOracleSeries(data, result);
        }
    }
    return {};
}

} // namespace voxtact::app
