// SPDX-License-Identifier: MIT
#include "lab/compare/compare.h"

#include "core/base/try.h"
#include "lab/engines/trace.h"
#include "lab/measure/stopwatch.h"
#include "oracle/oracle.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace voxtact::lab {

namespace {

using Fragments = std::vector<oracle::OracleFragment>;

/// Why each of `apart` is on one side only.
Result<std::vector<DifferingFragment>> explain(const oracle::OraclePair& pair, const Fragments& apart,
                                               const Fragments& device, std::uint32_t pose, bool eightBit) {
    std::vector<DifferingFragment> differing;
    if (apart.empty()) {
        return differing;
    }
    oracle::Tolerance tolerance;
    tolerance.value = eightBit ? oracle::kEightBitFilterError : 0;
    const Result<std::vector<oracle::Evidence>> evidence = oracle::oracleEvidence(pair, apart, tolerance);
    VOXTACT_TRY(evidence);
    for (std::size_t i = 0; i < apart.size(); ++i) {
        const oracle::OracleFragment& fragment = apart[i];
        const oracle::Evidence& known = (*evidence)[i];
        const auto doubt = static_cast<std::size_t>(known.doubt);
        differing.push_back({.pose = pose,
                             .triangle = fragment.triangle,
                             .x = fragment.x,
                             .y = fragment.y,
                             .onDevice = std::binary_search(device.begin(), device.end(), fragment),
                             .reason = kReasons.at(doubt == 0 ? 3 : doubt - 1),
                             .edgeDistance = known.edgeDistance,
                             .domainDistance = known.domainDistance,
                             .opacity = known.opacity,
                             .opacityLow = known.opacityLow,
                             .opacityHigh = known.opacityHigh});
    }
    return differing;
}

/// One pose; adds the oracle's time.
Result<FragmentCheck> check(FragmentTrace& trace, const Scene& scene, std::uint32_t index, bool eightBit,
                            double& oracleMilliseconds) {
    const Mat4& pose = scene.poses[index];
    const VolumePart& volume = *scene.volume;
    const BatchItem item = Work(scene).at({&pose, 1}).onDevice();
    const Result<std::vector<shader::TracedFragment>> traced =
        trace.survivors({{&item, 1}, scene.view, volume.threshold});
    VOXTACT_TRY(traced);
    const oracle::OraclePair pair{
        scene.mesh->data.view(), volume.data.view(), volume.transferFunction(), scene.view, pose, volume.threshold};
    const Stopwatch watch;
    const Result<Fragments> oracle = oracle::oracleSurvivors(pair);
    oracleMilliseconds += watch.milliseconds();
    VOXTACT_TRY(oracle);
    Fragments device;
    for (const shader::TracedFragment& fragment : *traced) {
        device.push_back({fragment.triangle, fragment.x, fragment.y});
    }
    std::sort(device.begin(), device.end());
    Fragments apart;
    std::set_symmetric_difference(device.begin(), device.end(), oracle->begin(), oracle->end(),
                                  std::back_inserter(apart));
    Result<std::vector<DifferingFragment>> differing = explain(pair, apart, device, scene.poseNumbers[index], eightBit);
    VOXTACT_TRY(differing);
    return FragmentCheck{.pose = scene.poseNumbers[index],
                         .onDevice = device.size(),
                         .byOracle = oracle->size(),
                         .counted = std::nullopt,
                         .differing = std::move(*differing)};
}

void judgeOracle(const std::vector<std::uint32_t>& sample, CompareResult& result) {
    result.verdicts.push_back(judgeFragments(result.fragmentChecks));
    const std::vector<NamedCounts> exact = exactGroup(result.counts);
    if (exact.empty()) {
        return;
    }
    NamedCounts some{exact.back().method, {}};
    NamedCounts oracle{"oracle", {}};
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        some.counts.push_back(exact.back().counts[sample[i]]);
        oracle.counts.push_back(result.fragmentChecks[i].byOracle);
        numbers.push_back(result.poseNumbers[sample[i]]);
    }
    result.verdicts.push_back(tellDifference(some, oracle, numbers));
}

} // namespace

Result<void> checkFragments(const device::Session& session, std::uint32_t poses, const Scene& scene,
                            CompareResult& result, const std::function<void()>& step) {
    if (poses == 0) {
        result.verdicts.push_back(notChecked(kFragmentRule, "--oracle 0"));
        return {};
    }
    Result<FragmentTrace> trace =
        FragmentTrace::create(session.context, Filter::Hardware, session.device.queueAccess());
    if (!trace.ok()) {
        if (trace.error().code != ErrorCode::Unsupported) {
            return trace.error();
        }
        result.verdicts.push_back(notChecked(kFragmentRule, trace.error().text));
        return {};
    }
    const std::vector<NamedCounts> raster = rasterGroup(result.counts);
    const std::vector<std::uint32_t> sample = spreadEvenly(poses, static_cast<std::uint32_t>(scene.poses.size()));
    double milliseconds = 0;
    for (const std::uint32_t index : sample) {
        Result<FragmentCheck> checked = check(*trace, scene, index, result.machine.eightBitFilter, milliseconds);
        VOXTACT_TRY(checked);
        if (!raster.empty()) {
            checked->counted = raster.front().counts[index];
        }
        result.fragmentChecks.push_back(std::move(*checked));
        step();
    }
    result.oracleMilliseconds = milliseconds / static_cast<double>(sample.size());
    judgeOracle(sample, result);
    return {};
}

} // namespace voxtact::lab
