// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "device/pair_pipeline.h"
#include "lab/engines/engine.h"
#include "lab/engines/mapped_poses.h"
#include "lab/measure/stopwatch.h"

#include <map>

namespace voxtact::lab {

namespace {

struct DevicePairs {
    const device::Session& session;
    Detector detector;
    std::map<std::pair<std::uint32_t, std::uint32_t>, device::PairPipeline> pipelines{};
};

/// Made once: a pass pays for no allocation.
Result<device::PairPipeline*> pipelineFor(DevicePairs& pairs, std::uint32_t batch, std::uint32_t frames) {
    const std::pair key{batch, frames};
    if (const auto found = pairs.pipelines.find(key); found != pairs.pipelines.end()) {
        return &found->second;
    }
    Result<device::PairPipeline> made =
        device::PairPipeline::create(pairs.session.device, pairs.session.context, pairs.detector,
                                     {.frames = frames, .pairsPerSubmission = batch, .timestamps = true});
    VOXTACT_TRY(made);
    return &pairs.pipelines.emplace(key, std::move(*made)).first->second;
}

Result<Pass> runOnDevice(DevicePairs& pairs, const Work& work, const Feeding& feeding) {
    const auto all = static_cast<std::uint32_t>(work.poses.size());
    const Result<device::PairPipeline*> pipe =
        pipelineFor(pairs, feeding.batch == 0 ? all : feeding.batch, feeding.frames);
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

struct BlockingPairs {
    const device::Session& session;
    BlockingDetector detector;
    std::optional<MappedPoses> poses{}; ///< where the poses are on the device

    /// Writes the poses of a work to where the device reads them.
    Result<void> feed(BatchItem& item);
};

Result<void> BlockingPairs::feed(BatchItem& item) {
    const auto count = static_cast<std::uint32_t>(item.world_from_object.size());
    if (!poses || poses->poses().count() < count) {
        Result<MappedPoses> larger = MappedPoses::create(session, count);
        VOXTACT_TRY(larger);
        poses.emplace(std::move(*larger));
    }
    VOXTACT_TRY(poses->write(item.world_from_object));
    item.world_from_object = {};
    item.poses = &poses->poses();
    item.poseCount = count;
    return {};
}

Result<Pass> runBlocking(BlockingPairs& pairs, const Work& work, const Feeding& /*feeding*/) {
    BatchItem item = work.onDevice();
    const Stopwatch watch;
    if (pairs.detector.detector().desc().devicePoses) {
        VOXTACT_TRY(pairs.feed(item));
    }
    Result<BatchAnswer> answer = pairs.detector.detect({{&item, 1}, work.view, work.volume->threshold});
    const double wall = watch.milliseconds();
    VOXTACT_TRY(answer);
    return Pass{.wallMilliseconds = wall,
                .gpuMilliseconds = answer->gpuMilliseconds,
                .pairs = std::move(answer->pairs),
                .triangles = std::move(answer->triangles)};
}

} // namespace

MadeEngine makeDeviceEngine(const device::Session& session, const DetectorDesc& desc) {
    Result<Detector> detector = Detector::create(session.context, desc);
    VOXTACT_TRY(detector);
    EngineFacts facts = factsOf(detector->desc().method, detector->desc(), 0);
    facts.posesOn = "host";
    return engineOf(std::move(facts), DevicePairs{session, std::move(*detector)}, runOnDevice);
}

MadeEngine makeBlockingEngine(const device::Session& session, const DetectorDesc& desc) {
    Result<BlockingDetector> detector = BlockingDetector::create(session.context, desc, session.device.queueAccess());
    VOXTACT_TRY(detector);
    EngineFacts facts = factsOf(desc.method, desc, 0);
    facts.posesOn = desc.devicePoses ? "device" : "host";
    return engineOf(std::move(facts), BlockingPairs{session, std::move(*detector)}, runBlocking);
}

} // namespace voxtact::lab
