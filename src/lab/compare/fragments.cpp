// SPDX-License-Identifier: MIT
#include "lab/compare/compare.h"

#include "core/base/try.h"
#include "lab/engines/trace.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

using Fragments = std::vector<oracle::OracleFragment>;

/// One pose; adds the oracle's time.
Result<FragmentCheck> check(FragmentTrace& trace, const Scene& scene, std::uint32_t index,
                            const oracle::Tolerance& tolerance, double& oracleMilliseconds) {
    const Mat4& pose = scene.poses[index];
    const VolumePart& volume = *scene.volume;
    const BatchItem item = Work(scene).at({&pose, 1}).onDevice();
    const Result<std::vector<shader::TracedFragment>> traced =
        trace.survivors({{&item, 1}, scene.view, volume.threshold});
    VOXTACT_TRY(traced);
    const oracle::OraclePair pair{
        scene.mesh->data.view(), volume.data.view(), volume.transferFunction(), scene.view, pose, volume.threshold};
    const Stopwatch watch;
    const Result<Fragments> survivors = oracle::oracleSurvivors(pair);
    oracleMilliseconds += watch.milliseconds();
    VOXTACT_TRY(survivors);
    Fragments device;
    for (const shader::TracedFragment& fragment : *traced) {
        device.push_back({fragment.triangle, fragment.x, fragment.y});
    }
    std::ranges::sort(device);
    Fragments apart;
    std::ranges::set_symmetric_difference(device, *survivors, std::back_inserter(apart));
    FragmentCheck made{.pose = scene.poseNumbers[index], .onDevice = device.size(), .byOracle = survivors->size()};
    if (apart.empty()) {
        return made;
    }
    const Result<std::vector<oracle::Evidence>> evidence = oracle::oracleEvidence(pair, apart, tolerance);
    VOXTACT_TRY(evidence);
    for (std::size_t i = 0; i < apart.size(); ++i) {
        made.differing.push_back({made.pose, apart[i], std::ranges::binary_search(device, apart[i]), (*evidence)[i]});
    }
    return made;
}

/// The oracle beside the method that counts what it counts, on the poses that were checked: a part of all.
void tellOracle(const std::vector<std::uint32_t>& sample, CompareResult& result) {
    const std::vector<NamedCounts> exact = countsBy(result.counts, Coverage::Computed);
    if (exact.empty()) {
        return;
    }
    NamedCounts some{exact.back().method};
    NamedCounts oracle{kOracle};
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        some.counts.push_back(exact.back().counts[sample[i]]);
        oracle.counts.push_back(result.fragmentChecks[i].byOracle);
        numbers.push_back(result.poseNumbers[sample[i]]);
    }
    result.verdicts.push_back(tellDifference(some, oracle, numbers));
}

} // namespace

Result<void> checkFragments(const CompareRun& run) {
    CompareResult& result = run.result;
    const auto unchecked = [&result](std::string why) {
        result.verdicts.push_back({.rule = kFragmentRule, .members = kFragmentRule, .unchecked = std::move(why)});
        return Result<void>();
    };
    const std::uint32_t poses = run.settings.oraclePoses;
    if (poses == 0) {
        return unchecked("--oracle 0");
    }
    Result<FragmentTrace> trace =
        FragmentTrace::create(run.session.context, Filter::Hardware, run.session.device.queueAccess());
    if (!trace.ok()) {
        return trace.error().code == ErrorCode::Unsupported ? unchecked(trace.error().text) : trace.error();
    }
    const std::vector<std::uint32_t> touching = touchingPoses(result.counts);
    if (touching.empty()) {
        return unchecked("nothing touches on any pose");
    }
    const oracle::Tolerance tolerance{.value = result.machine.filterError};
    const std::vector<NamedCounts> raster = countsBy(result.counts, Coverage::Rasteriser);
    std::vector<std::uint32_t> sample = spreadEvenly(poses, static_cast<std::uint32_t>(touching.size()));
    std::ranges::transform(sample, sample.begin(), [&](std::uint32_t at) { return touching[at]; });
    double milliseconds = 0;
    for (const std::uint32_t index : sample) {
        Result<FragmentCheck> checked = check(*trace, run.scene, index, tolerance, milliseconds);
        VOXTACT_TRY(checked);
        if (!raster.empty()) {
            checked->counted = raster.front().counts[index];
        }
        result.fragmentChecks.push_back(std::move(*checked));
        run.step();
    }
    result.oracleMilliseconds = milliseconds / static_cast<double>(sample.size());
    result.verdicts.push_back(judgeFragments(result.fragmentChecks));
    tellOracle(sample, result);
    return {};
}

} // namespace voxtact::lab
