// SPDX-License-Identifier: MIT
#include "bench/compare/compare.h"

#include "bench/engines/localize.h"
#include "bench/measure/numbers.h"
#include "bench/measure/stopwatch.h"
#include "core/base/try.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

constexpr std::size_t kCountBatch = 1024;

using Fragments = std::vector<oracle::OracleFragment>;

/// Checks one pose; adds the oracle's time.
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

/// Compares the oracle with the method that counts the same, on the checked poses.
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

/// Returns the requested number of poses: spread evenly over those with a count and, if these are too few, over the
/// others, on which all methods may miss the same.
std::vector<std::uint32_t> oraclePoses(std::uint32_t asked, const CompareResult& result) {
    std::vector<std::uint32_t> touching = touchingPoses(result.counts);
    std::vector<std::uint32_t> others;
    for (std::uint32_t pose = 0; pose < result.poseNumbers.size(); ++pose) {
        if (!std::ranges::binary_search(touching, pose)) {
            others.push_back(pose);
        }
    }
    std::vector<std::uint32_t> out;
    for (const std::vector<std::uint32_t>& from : {touching, others}) {
        const auto left = asked - static_cast<std::uint32_t>(out.size());
        for (const std::uint32_t at : spreadEvenly(left, static_cast<std::uint32_t>(from.size()))) {
            out.push_back(from[at]);
        }
    }
    return out;
}

/// The device's fragments against the oracle's, on oraclePoses(). Adds to the result the checks, the verdicts and the
/// oracle's counts and time.
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
    const oracle::Tolerance tolerance{.value = result.machine.filterError};
    const std::vector<NamedCounts> raster = countsBy(result.counts, Coverage::Rasteriser);
    const std::vector<std::uint32_t> sample = oraclePoses(poses, result);
    double milliseconds = 0;
    for (const std::uint32_t index : sample) {
        Result<FragmentCheck> checked = check(*trace, run.scene, index, tolerance, milliseconds);
        VOXTACT_TRY(checked);
        if (!raster.empty()) {
            checked->counted = raster.front().counts[index];
        }
        result.fragmentChecks.push_back(std::move(*checked));
        run.step(1);
    }
    result.oracleMilliseconds = milliseconds / static_cast<double>(sample.size());
    result.verdicts.push_back(judgeFragments(result.fragmentChecks));
    tellOracle(sample, result);
    return {};
}

/// Why the device cannot do a method; empty: it can, or the method is cpu.
std::string whyNot(const device::Session& session, CountingMethod method) {
    if (rowOf(method).host) {
        return {};
    }
    const auto all = session.context.methods();
    const auto support = std::ranges::find(all, method, &MethodSupport::method);
    return support == all.end() ? "not in this version" : support->available ? std::string() : support->reason;
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
    Series series = seriesOf(Sweep::Batch, kOracle, Work(scene), Mode::Sync, 1);
    series.pairs = static_cast<std::uint32_t>(result.fragmentChecks.size());
    series.fragments = fragments / series.pairs;
    series.wall = {*result.oracleMilliseconds};
    result.series.push_back(std::move(series));
}

} // namespace

const char* toString(Sweep sweep) noexcept {
    constexpr std::array kNames{"batch", "triangles", "fragments", "voxels"};
    return kNames[static_cast<std::size_t>(sweep)];
}

const char* toString(Mode mode) noexcept {
    return mode == Mode::Sync ? "sync" : "pipelined";
}

Series seriesOf(Sweep sweep, const std::string& method, const Work& work, Mode mode, std::uint32_t batch) {
    return {.sweep = sweep,
            .method = method,
            .mode = mode,
            .batch = batch,
            .width = work.view.width,
            .height = work.view.height,
            .triangles = work.mesh->triangles(),
            .pairs = static_cast<std::uint32_t>(work.poses.size()),
            .voxels = work.volume->data.grid.size};
}

std::optional<double> Series::pairsPerSecond() const {
    const double median = wall.empty() ? 0 : medianOf(wall);
    return median > 0 ? std::optional(1000.0 * batch / median) : std::nullopt;
}

std::optional<double> Series::fragmentsPerSecond() const {
    const std::optional<double> rate = pairsPerSecond();
    return fragments && rate ? std::optional(*rate * *fragments) : std::nullopt;
}

bool Series::counts() const {
    const auto known = countingMethodFromName(method); // the oracle is none
    return known && exactness(*known) == Exactness::Exact;
}

const Series* fastestOf(std::span<const Series> all, const std::function<bool(const Series&)>& wanted) {
    const Series* best = nullptr;
    for (const Series& series : all) {
        if (series.sweep == Sweep::Batch && series.pairsPerSecond() && series.counts() && wanted(series) &&
            (best == nullptr || series.pairsPerSecond() > best->pairsPerSecond())) {
            best = &series;
        }
    }
    return best;
}

const CompareVerdict* CompareResult::firstFailure() const {
    const auto found = std::ranges::find_if(verdicts, &CompareVerdict::failed);
    return found == verdicts.end() ? nullptr : &*found;
}

std::optional<bool> CompareResult::agrees() const {
    if (firstFailure() != nullptr) {
        return false;
    }
    const bool any = std::ranges::any_of(
        verdicts, [](const CompareVerdict& verdict) { return verdict.required && verdict.unchecked.empty(); });
    return any ? std::optional(true) : std::nullopt;
}

Result<void> addTrust(const device::Session& session, std::vector<MethodEntry>& methods,
                      std::vector<std::string>& notes) {
    const Result<std::vector<SelfTestVerdict>> verdicts = selfTest(session.context, session.device.queueAccess());
    VOXTACT_TRY(verdicts);
    for (const SelfTestVerdict& verdict : *verdicts) {
        const auto method = std::ranges::find(methods, toString(verdict.method), &MethodEntry::name);
        if (method == methods.end()) {
            continue;
        }
        method->trusted = verdict.trusted;
        method->selfTest = verdict.text;
        if (method->available && !verdict.trusted) {
            notes.push_back(method->name + " is not trusted on this device; its self-test: " + verdict.text);
        }
    }
    return {};
}

Result<Engines> makeMethodEngines(const device::Session& session, const CompareSettings& settings,
                                  CompareResult& result) {
    Engines engines;
    for (const CountingMethod method : countingMethods()) {
        if (!settings.methods.empty() && std::ranges::find(settings.methods, method) == settings.methods.end()) {
            continue;
        }
        const std::string why = whyNot(session, method);
        result.methods.push_back({toString(method), why.empty(), why, toString(defaultFilter(method)),
                                  exactness(method) == Exactness::Exact});
        if (why.empty()) {
            VOXTACT_TRY(add(engines, rowOf(method).host
                                         ? makeHostEngine()
                                         : makeDeviceEngine(session, RasterDesc{.method = method,
                                                                                .filter = defaultFilter(method)})));
        } else {
            result.notes.push_back(std::string("no ") + toString(method) + " on this device: " + why);
        }
    }
    if (engines.empty()) {
        return Error{ErrorCode::Unsupported, 0,
                     "no method is supported: " + result.notes.front() + "; see voxtact devices"};
    }
    return engines;
}

Result<std::vector<NamedCounts>> countAll(const Engines& engines, const Work& work) {
    std::vector<NamedCounts> all;
    const auto batch = static_cast<std::uint32_t>(std::min(kCountBatch, work.poses.size()));
    for (const Engine& engine : engines) {
        const Result<Pass> pass = engine.run(work, {batch, 1});
        VOXTACT_TRY(pass);
        all.push_back({engine.facts.name, pass->counts()});
    }
    return all;
}

Result<void> checkCounts(const CompareRun& run) {
    Result<std::vector<NamedCounts>> counts = countAll(run.engines, Work(run.scene));
    VOXTACT_TRY(counts);
    run.result.counts = std::move(*counts);
    run.result.verdicts = judgeCounts(run.result.counts, run.scene.poseNumbers);
    if (touchingPoses(run.result.counts).empty()) {
        run.result.notes.emplace_back(kNothingTouches);
    }
    run.step(1);
    return {};
}

Result<void> compare(const CompareSettings& settings, const Scene& scene, const device::Session& session,
                     const Steps& steps, CompareResult& result) {
    VOXTACT_TRY(makeReady(session, scene));
    result.poseNumbers = scene.poseNumbers;
    const Result<Engines> engines = makeMethodEngines(session, settings, result);
    VOXTACT_TRY(engines);
    VOXTACT_TRY(addTrust(session, result.methods, result.notes));
    std::uint64_t total = 1 + std::min<std::uint64_t>(settings.oraclePoses, scene.poses.size());
    for (const Sweep sweep : settings.sweeps) {
        total += stepsOf(sweep, settings.repeats);
    }
    steps.begin(total);
    const CompareRun run{session, settings, scene, *engines, result, steps.step};
    VOXTACT_TRY(checkCounts(run));
    VOXTACT_TRY(checkFragments(run));
    for (const Sweep sweep : settings.sweeps) {
        if (run.ended()) {
            break;
        }
        VOXTACT_TRY(timeSweep(run, sweep));
        if (sweep == Sweep::Batch) {
            addOracleSeries(scene, result);
        }
    }
    noteMissedTimes(session, result.notes);
    return {};
}

} // namespace voxtact::lab
