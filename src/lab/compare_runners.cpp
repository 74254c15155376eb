// SPDX-License-Identifier: MIT
#include "device/pair_pipeline.h"
#include "lab/compare_result.h"

#include <algorithm>
#include <chrono>
#include <map>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

class DeviceRunner final : public MethodRunner {
  public:
    DeviceRunner(const Session& session, const Surroundings& surroundings, Detector detector, double threshold)
        : MethodRunner(detector.desc().method, detector.desc().filter, surroundings.hostVolume.grid().size),
          session_(session), surroundings_(surroundings), detector_(std::move(detector)), threshold_(threshold) {}

    Result<Pass> run(const Work& work, std::uint32_t batch, std::uint32_t frames) override;

  private:
    /// Made once: a pass pays for no allocation.
    Result<PairPipeline*> pipeline(std::uint32_t batch, std::uint32_t frames);

    const Session& session_;
    const Surroundings& surroundings_;
    Detector detector_;
    double threshold_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, PairPipeline> pipelines_;
};

Result<PairPipeline*> DeviceRunner::pipeline(std::uint32_t batch, std::uint32_t frames) {
    const std::pair key{batch, frames};
    if (const auto found = pipelines_.find(key); found != pipelines_.end()) {
        return &found->second;
    }
    Result<PairPipeline> made =
        PairPipeline::create(session_.device, session_.context, detector_,
                             {.frames = frames, .pairsPerSubmission = batch, .timestamps = true});
    if (!made.ok()) {
        return made.error();
    }
    return &pipelines_.emplace(key, std::move(*made)).first->second;
}

Result<MethodRunner::Pass> DeviceRunner::run(const Work& work, std::uint32_t batch, std::uint32_t frames) {
    const Result<PairPipeline*> pipe = pipeline(batch, frames);
    if (!pipe.ok()) {
        return pipe.error();
    }
    const BatchItem item{&work.subject->device, &surroundings_.volume, &surroundings_.transferFunction, work.poses};
    Pass pass;
    pass.counts.reserve(work.poses.size());
    double gpu = 0;
    bool timed = true;
    const auto begun = Clock::now();
    const Result<void> done =
        (*pipe)->run({{&item, 1}, work.view, threshold_}, {.pair = [&](const TimedAnswer& answer) {
                         pass.counts.push_back(answer.answer.count);
                         gpu += answer.gpuMilliseconds.value_or(0);
                         timed = timed && answer.gpuMilliseconds.has_value();
                     }});
    pass.wallMilliseconds = millisecondsSince(begun);
    if (!done.ok()) {
        return done.error();
    }
    if (timed) {
        pass.gpuMilliseconds = gpu;
    }
    return pass;
}

class HostRunner final : public MethodRunner {
  public:
    HostRunner(const Surroundings& surroundings, cpu::Detector detector, double threshold)
        : MethodRunner(CountingMethod::Cpu, Filter::Exact, surroundings.hostVolume.grid().size),
          surroundings_(surroundings), detector_(std::move(detector)), threshold_(threshold) {}

    Result<Pass> run(const Work& work, std::uint32_t batch, std::uint32_t frames) override;

  private:
    const Surroundings& surroundings_;
    cpu::Detector detector_;
    double threshold_;
};

Result<MethodRunner::Pass> HostRunner::run(const Work& work, std::uint32_t batch, std::uint32_t /*frames*/) {
    Pass pass;
    pass.counts.reserve(work.poses.size());
    const auto begun = Clock::now();
    for (std::size_t first = 0; first < work.poses.size(); first += batch) {
        const std::size_t taken = std::min<std::size_t>(batch, work.poses.size() - first);
        const cpu::BatchItem item{&work.subject->host, &surroundings_.hostVolume, &surroundings_.hostTransferFunction,
                                  work.poses.subspan(first, taken)};
        const Result<BatchAnswer> answer = detector_.detect({{&item, 1}, work.view, threshold_});
        if (!answer.ok()) {
            return answer.error();
        }
        for (const PairAnswer& pair : answer->pairs) {
            pass.counts.push_back(pair.count);
        }
    }
    pass.wallMilliseconds = millisecondsSince(begun);
    return pass;
}

Result<std::unique_ptr<MethodRunner>> makeHostRunner(const Surroundings& surroundings, double threshold) {
    Result<cpu::Detector> detector = cpu::Detector::create();
    if (!detector.ok()) {
        return detector.error();
    }
    return std::unique_ptr<MethodRunner>(std::make_unique<HostRunner>(surroundings, std::move(*detector), threshold));
}

} // namespace

Result<std::unique_ptr<MethodRunner>> makeRunner(const Session& session, const Surroundings& surroundings,
                                                 CountingMethod method, double threshold) {
    if (method == CountingMethod::Cpu) {
        return makeHostRunner(surroundings, threshold);
    }
    Result<Detector> detector = Detector::create(session.context, {.method = method, .filter = defaultFilter(method)});
    if (!detector.ok()) {
        return detector.error();
    }
    return std::unique_ptr<MethodRunner>(
        std::make_unique<DeviceRunner>(session, surroundings, std::move(*detector), threshold));
}

Result<Runners> makeRunners(const Session& session, const CompareSettings& settings, const Surroundings& surroundings,
                            double threshold, CompareResult& result) {
    Runners runners;
    for (const CountingMethod method : countingMethods()) {
        if (!settings.wants(method)) {
            continue;
        }
        const auto methods = session.context.methods();
        const auto support = std::find_if(methods.begin(), methods.end(),
                                          [method](const MethodSupport& s) { return s.method == method; });
        MethodEntry entry{toString(method), true, "", toString(defaultFilter(method)),
                          exactness(method) == Exactness::Exact};
        if (method != CountingMethod::Cpu && (support == methods.end() || !support->available)) {
            entry.available = false;
            entry.reason = support == methods.end() ? "this version has it not" : support->reason;
            result.notes.push_back("no " + entry.name + " on this device: " + entry.reason);
            result.methods.push_back(std::move(entry));
            continue;
        }
        Result<std::unique_ptr<MethodRunner>> runner = makeRunner(session, surroundings, method, threshold);
        if (!runner.ok()) {
            return runner.error();
        }
        runners.push_back(std::move(*runner));
        result.methods.push_back(std::move(entry));
    }
    if (runners.empty()) {
        return Error{ErrorCode::Unsupported, 0,
                     "none of the methods can be had: " + result.notes.front() + "; see voxtact devices"};
    }
    return runners;
}

} // namespace voxtact::app
