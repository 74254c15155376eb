// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "device/pair_pipeline.h"
#include "lab/engines/engine.h"
#include "lab/measure/stopwatch.h"

#include <map>

namespace voxtact::lab {

namespace {

class DeviceEngine final : public Engine {
  public:
    DeviceEngine(const device::Session& session, Detector detector)
        : Engine(factsOf(detector.desc().method, detector.desc(), 0)), session_(session),
          detector_(std::move(detector)) {}

    Result<Pass> run(const Work& work, const Feeding& feeding) override;

  private:
    /// Made once: a pass pays for no allocation.
    Result<device::PairPipeline*> pipeline(std::uint32_t batch, std::uint32_t frames);

    const device::Session& session_;
    Detector detector_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, device::PairPipeline> pipelines_;
};

Result<device::PairPipeline*> DeviceEngine::pipeline(std::uint32_t batch, std::uint32_t frames) {
    const std::pair key{batch, frames};
    if (const auto found = pipelines_.find(key); found != pipelines_.end()) {
        return &found->second;
    }
    Result<device::PairPipeline> made =
        device::PairPipeline::create(session_.device, session_.context, detector_,
                                     {.frames = frames, .pairsPerSubmission = batch, .timestamps = true});
    VOXTACT_TRY(made);
    return &pipelines_.emplace(key, std::move(*made)).first->second;
}

Result<Pass> DeviceEngine::run(const Work& work, const Feeding& feeding) {
    const auto all = static_cast<std::uint32_t>(work.poses.size());
    const Result<device::PairPipeline*> pipe = pipeline(feeding.batch == 0 ? all : feeding.batch, feeding.frames);
    VOXTACT_TRY(pipe);
    const BatchItem item = work.onDevice();
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    double gpu = 0;
    bool timed = true;
    const Stopwatch watch;
    const Result<void> done =
        (*pipe)->run({{&item, 1}, work.view, work.volume->threshold}, {.pair = [&](const device::TimedAnswer& answer) {
                         pass.pairs.push_back(answer.answer);
                         gpu += answer.gpuMilliseconds.value_or(0);
                         timed = timed && answer.gpuMilliseconds.has_value();
                     }});
    pass.wallMilliseconds = watch.milliseconds();
    VOXTACT_TRY(done);
    if (timed) {
        pass.gpuMilliseconds = gpu;
    }
    return pass;
}

} // namespace

MadeEngine makeDeviceEngine(const device::Session& session, const DetectorDesc& desc) {
    Result<Detector> detector = Detector::create(session.context, desc);
    VOXTACT_TRY(detector);
    return MadeEngine(std::make_unique<DeviceEngine>(session, std::move(*detector)));
}

MadeEngine makeBlockingEngine(const device::Session& session, const DetectorDesc& desc) {
    Result<BlockingDetector> detector = BlockingDetector::create(session.context, desc, session.device.queueAccess());
    VOXTACT_TRY(detector);
    return engineOf(factsOf(desc.method, desc, 0),
                    [detector = std::move(*detector)](const Work& work, const Feeding&) mutable -> Result<Pass> {
                        const BatchItem item = work.onDevice();
                        Result<BatchAnswer> answer = detector.detect({{&item, 1}, work.view, work.volume->threshold});
                        VOXTACT_TRY(answer);
                        return Pass{.wallMilliseconds = answer->wallMilliseconds,
                                    .pairs = std::move(answer->pairs),
                                    .triangles = std::move(answer->triangles)};
                    });
}

} // namespace voxtact::lab
