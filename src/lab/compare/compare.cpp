// SPDX-License-Identifier: MIT
#include "lab/compare/compare.h"

#include "core/base/try.h"
#include "lab/measure/numbers.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

constexpr std::size_t kCountBatch = 1024;

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

const Verdict* CompareResult::firstFailure() const {
    const auto found = std::ranges::find_if(verdicts, &Verdict::failed);
    return found == verdicts.end() ? nullptr : &*found;
}

std::optional<bool> CompareResult::agrees() const {
    if (firstFailure() != nullptr) {
        return false;
    }
    const bool any = std::ranges::any_of(
        verdicts, [](const Verdict& verdict) { return verdict.required && verdict.unchecked.empty(); });
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
            notes.push_back(method->name + " is not to be trusted on this device, by its self-test: " + verdict.text);
        }
    }
    return {};
}

Result<Engines> makeMethodEngines(const device::Session& session, const CompareSettings& settings,
                                  CompareResult& result) {
    EngineList engines;
    for (const CountingMethod method : countingMethods()) {
        if (!settings.methods.empty() && std::ranges::find(settings.methods, method) == settings.methods.end()) {
            continue;
        }
        const std::string why = whyNot(session, method);
        result.methods.push_back({toString(method), why.empty(), why, toString(defaultFilter(method)),
                                  exactness(method) == Exactness::Exact});
        if (why.empty()) {
            engines.add(makeMethodEngine(session, method));
        } else {
            result.notes.push_back(std::string("no ") + toString(method) + " on this device: " + why);
        }
    }
    Result<Engines> made = engines.take();
    if (made.ok() && made->empty()) {
        return Error{ErrorCode::Unsupported, 0,
                     "none of the methods can be had: " + result.notes.front() + "; see voxtact devices"};
    }
    return made;
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
    run.step();
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
