// SPDX-License-Identifier: MIT
#include "bench/engines/engine.h"
#include "bench/measure/stopwatch.h"
#include "core/base/try.h"
#include "device/detector/pass_desc.h"
#include "device/engine/pair_pipeline.h"
#include "vulkan/context_impl.h"
#include "vulkan/memory/memory.h"
#include "vulkan/own/timed_commands.h"

#include <algorithm>
#include <array>
#include <map>

namespace voxtact::lab {

namespace {

EngineFacts factsOf(const PassDesc& desc) {
    return lab::factsOf(desc.method, desc, 0);
}

struct DevicePairs {
    const device::Session& session;
    Detector detector;
    /// By batch and frames in flight. Allocated once, outside the times.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<device::PairPipeline>> pipelines{};
};

Result<Pass> runOnDevice(DevicePairs& pairs, const Work& work, const Feeding& feeding) {
    const std::uint32_t batch = feeding.batch == 0 ? static_cast<std::uint32_t>(work.poses.size()) : feeding.batch;
    std::optional<device::PairPipeline>& pipe = pairs.pipelines[{batch, feeding.frames}];
    if (!pipe) {
        VOXTACT_TRY(put(
            device::PairPipeline::create(pairs.session.device, pairs.session.context, pairs.detector,
                                         {.frames = feeding.frames, .pairsPerSubmission = batch, .timestamps = true}),
            pipe));
    }
    const BatchItem item = work.onDevice();
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    double gpu = 0;
    bool timed = true;
    const Stopwatch watch;
    const Result<void> done =
        pipe->run({{&item, 1}, work.view, work.volume->threshold}, {.pair = [&](const device::TimedAnswer& answer) {
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

/// Poses in mapped memory, as floats, for devicePoses.
struct MappedPoses {
    ContextImpl& context;
    Buffer buffer;
    PoseBuffer poses;

    /// Makes room for this number of pairs, at least one.
    static Result<MappedPoses> create(const device::Session& session, std::uint32_t count) {
        ContextImpl& context = session.context.impl();
        Result<Buffer> buffer = makeBuffer(context, count * sizeof(std::array<float, 16>),
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::Upload, "mapped poses");
        VOXTACT_TRY(buffer);
        Result<PoseBuffer> poses = PoseBuffer::wrap(session.context, {.buffer = buffer->get(), .count = count});
        VOXTACT_TRY(poses);
        return MappedPoses{context, std::move(*buffer), std::move(*poses)};
    }

    /// Writes the first poses, at most the capacity. No reader may be in flight.
    Result<void> write(std::span<const Mat4> matrices) {
        auto* at = static_cast<float*>(buffer.mapped);
        for (const Mat4& pose : matrices) {
            at = std::ranges::transform(pose, at, [](double element) { return static_cast<float>(element); }).out;
        }
        return flush(context, buffer);
    }
};

struct BlockingPairs {
    const device::Session& session;
    BlockingDetector detector;
    std::optional<MappedPoses> mapped{}; ///< where the poses are on the device
};

/// Writes the poses of an item to where the device reads them.
Result<void> feed(BlockingPairs& pairs, BatchItem& item) {
    const auto count = static_cast<std::uint32_t>(item.world_from_object.size());
    if (!pairs.mapped || pairs.mapped->poses.count() < count) {
        VOXTACT_TRY(put(MappedPoses::create(pairs.session, count), pairs.mapped));
    }
    VOXTACT_TRY(pairs.mapped->write(item.world_from_object));
    item.world_from_object = {};
    item.poses = &pairs.mapped->poses;
    item.poseCount = count;
    return {};
}

Result<Pass> runBlocking(BlockingPairs& pairs, const Work& work, const Feeding& /*feeding*/) {
    BatchItem item = work.onDevice();
    const Stopwatch watch;
    if (passDesc(pairs.detector.detector().desc()).devicePoses) {
        VOXTACT_TRY(feed(pairs, item));
    }
    Result<BatchAnswer> answer = pairs.detector.detect({{&item, 1}, work.view, work.volume->threshold});
    const double wall = watch.milliseconds();
    VOXTACT_TRY(answer);
    return Pass{.wallMilliseconds = wall,
                .gpuMilliseconds = answer->gpuMilliseconds,
                .pairs = std::move(answer->pairs),
                .triangles = std::move(answer->triangles)};
}

using Use = device::TimedCommands::Use;

/// A loop that asks about one pose after the other.
struct Ticking {
    Awaiting awaiting;
    std::optional<Detector> detector{}; ///< none: an empty submission
    std::optional<Results> results{};
    std::optional<MappedPoses> mapped{};             ///< where there is one, the command buffer is recorded once
    std::optional<device::TimedCommands> commands{}; ///< last: waits for users of the others
    bool recorded = false;
};

Result<void> record(Ticking& loop, const Work& work, const BatchItem& item, Use use) {
    const Result<VkCommandBuffer> begun = loop.commands->begin(use);
    VOXTACT_TRY(begun);
    if (loop.detector) {
        VOXTACT_TRY(loop.detector->cmdDetect(*begun, {{&item, 1}, work.view, work.volume->threshold}, *loop.results));
        VOXTACT_TRY(loop.results->cmdReadBack(*begun));
    }
    return loop.commands->end();
}

/// Nothing is in flight afterwards, even after an error.
Result<void> submitAndAwait(Ticking& loop) {
    Result<void> done = loop.commands->submit();
    if (done.ok()) {
        done = loop.awaiting == Awaiting::Poll ? loop.commands->poll() : loop.commands->wait();
    }
    if (!done.ok()) {
        loop.commands->waitForAll();
    }
    return done;
}

/// From a pose to its answer.
Result<void> tick(Ticking& loop, const Work& work, const BatchItem& item, Pass& pass) {
    const Stopwatch watch;
    if (pass.recordMilliseconds) {
        VOXTACT_TRY(record(loop, work, item, Use::Once));
        *pass.recordMilliseconds += watch.milliseconds();
    } else if (loop.mapped) {
        VOXTACT_TRY(loop.mapped->write(item.world_from_object));
    }
    VOXTACT_TRY(submitAndAwait(loop));
    if (loop.results) {
        const Result<std::span<const PairResult>> read = loop.results->read();
        VOXTACT_TRY(read);
        pass.pairs.push_back(unpack(read->front()));
    }
    pass.wallMilliseconds += watch.milliseconds();
    return {};
}

Result<Pass> runTicks(Ticking& loop, const Work& work, const Feeding& /*feeding*/) {
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    BatchItem item = work.onDevice();
    if (loop.detector && !loop.mapped) {
        pass.recordMilliseconds = 0;
    } else if (!loop.recorded) {
        item.world_from_object = {};
        item.poses = loop.mapped ? &loop.mapped->poses : nullptr;
        VOXTACT_TRY(record(loop, work, item, Use::Again));
        loop.recorded = true;
    }
    for (const Mat4& pose : work.poses) {
        item.world_from_object = {&pose, 1};
        VOXTACT_TRY(tick(loop, work, item, pass));
    }
    return pass;
}

} // namespace

MadeEngine makeDeviceEngine(const device::Session& session, const DetectorDesc& desc) {
    Result<Detector> detector = Detector::create(session.context, desc);
    VOXTACT_TRY(detector);
    EngineFacts facts = factsOf(passDesc(desc));
    facts.posesOn = "host";
    return engineOf(std::move(facts), DevicePairs{session, std::move(*detector)}, runOnDevice);
}

MadeEngine makeBlockingEngine(const device::Session& session, const DetectorDesc& desc) {
    Result<BlockingDetector> detector = BlockingDetector::create(session.context, desc, session.device.queueAccess());
    VOXTACT_TRY(detector);
    const PassDesc pass = passDesc(desc);
    EngineFacts facts = factsOf(pass);
    facts.posesOn = pass.devicePoses ? "device" : "host";
    return engineOf(std::move(facts), BlockingPairs{session, std::move(*detector)}, runBlocking);
}

MadeEngine makeTickEngine(const device::Session& session, const std::optional<DetectorDesc>& desc, Awaiting awaiting) {
    EngineFacts facts{.name = "empty submit", .threads = 0};
    Ticking loop{awaiting};
    bool devicePoses = false;
    if (desc) {
        const PassDesc pass = passDesc(*desc);
        devicePoses = pass.devicePoses;
        facts = factsOf(pass);
        VOXTACT_TRY(put(Detector::create(session.context, *desc), loop.detector));
        VOXTACT_TRY(put(Results::create(*loop.detector, {}), loop.results));
    }
    if (devicePoses) {
        VOXTACT_TRY(put(MappedPoses::create(session, 1), loop.mapped));
    }
    VOXTACT_TRY(put(device::TimedCommands::create(session, 0), loop.commands));
    facts.recorded = desc && !devicePoses ? "each tick" : "once";
    facts.awaited = awaiting == Awaiting::Poll ? "polled" : "waited";
    return engineOf(std::move(facts), std::move(loop), runTicks);
}

} // namespace voxtact::lab
