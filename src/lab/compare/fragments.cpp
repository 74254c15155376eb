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

/// What checks one pose after the other.
class FragmentChecker {
  public:
    FragmentChecker(FragmentTrace trace, const Scene& scene, bool eightBit) : trace_(std::move(trace)), scene_(scene) {
        tolerance_.value = eightBit ? oracle::kEightBitFilterError : 0;
    }

    Result<FragmentCheck> check(std::uint32_t index);
    [[nodiscard]] double oracleMilliseconds() const { return oracleMilliseconds_; }

  private:
    Result<void> explain(const oracle::OraclePair& pair, const std::vector<oracle::OracleFragment>& fragments,
                         const std::vector<oracle::OracleFragment>& device, FragmentCheck& check) const;

    FragmentTrace trace_;
    const Scene& scene_;
    oracle::Tolerance tolerance_;
    double oracleMilliseconds_ = 0;
};

Result<void> FragmentChecker::explain(const oracle::OraclePair& pair,
                                      const std::vector<oracle::OracleFragment>& fragments,
                                      const std::vector<oracle::OracleFragment>& device, FragmentCheck& check) const {
    if (fragments.empty()) {
        return {};
    }
    const Result<std::vector<oracle::Evidence>> evidence = oracle::oracleEvidence(pair, fragments, tolerance_);
    VOXTACT_TRY(evidence);
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        const oracle::OracleFragment& fragment = fragments[i];
        const oracle::Evidence& known = (*evidence)[i];
        const auto doubt = static_cast<std::size_t>(known.doubt);
        check.differing.push_back({.pose = check.pose,
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
    return {};
}

Result<FragmentCheck> FragmentChecker::check(std::uint32_t index) {
    const Mat4& pose = scene_.poses[index];
    const VolumePart& volume = *scene_.volume;
    const BatchItem item = Work(scene_).at({&pose, 1}).onDevice();
    const Result<std::vector<shader::TracedFragment>> traced =
        trace_.survivors({{&item, 1}, scene_.view, volume.threshold});
    VOXTACT_TRY(traced);
    const oracle::OraclePair pair{
        scene_.mesh->data.view(), volume.data.view(), volume.transferFunction(), scene_.view, pose, volume.threshold};
    const Stopwatch watch;
    const Result<std::vector<oracle::OracleFragment>> oracle = oracle::oracleSurvivors(pair);
    oracleMilliseconds_ += watch.milliseconds();
    VOXTACT_TRY(oracle);
    std::vector<oracle::OracleFragment> device;
    device.reserve(traced->size());
    for (const shader::TracedFragment& fragment : *traced) {
        device.push_back({fragment.triangle, fragment.x, fragment.y});
    }
    std::sort(device.begin(), device.end());
    std::vector<oracle::OracleFragment> apart;
    std::set_symmetric_difference(device.begin(), device.end(), oracle->begin(), oracle->end(),
                                  std::back_inserter(apart));
    FragmentCheck check{.pose = scene_.poseNumbers[index],
                        .onDevice = device.size(),
                        .byOracle = oracle->size(),
                        .counted = std::nullopt,
                        .differing = {}};
    VOXTACT_TRY(explain(pair, apart, device, check));
    return check;
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
    FragmentChecker checker(std::move(*trace), scene, result.machine.eightBitFilter);
    const std::vector<NamedCounts> raster = rasterGroup(result.counts);
    const std::vector<std::uint32_t> sample = spreadEvenly(poses, static_cast<std::uint32_t>(scene.poses.size()));
    for (const std::uint32_t index : sample) {
        Result<FragmentCheck> check = checker.check(index);
        VOXTACT_TRY(check);
        if (!raster.empty()) {
            check->counted = raster.front().counts[index];
        }
        result.fragmentChecks.push_back(std::move(*check));
        step();
    }
    result.oracleMilliseconds = checker.oracleMilliseconds() / static_cast<double>(sample.size());
    judgeOracle(sample, result);
    return {};
}

} // namespace voxtact::lab
