// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "device/timed_commands.h"
#include "gpu/context_impl.h"
#include "lab/engines/engine.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>
#include <array>

namespace voxtact::lab {

namespace {

using Use = device::TimedCommands::Use;

EngineFacts tickFacts(EngineFacts facts, const char* recorded, Awaiting awaiting) {
    facts.recorded = recorded;
    facts.awaited = awaiting == Awaiting::Poll ? "polled" : "waited";
    return facts;
}

/// Nothing is in flight afterwards, not after an error either.
Result<void> submitAndAwait(device::TimedCommands& commands, Awaiting awaiting) {
    Result<void> done = commands.submit();
    if (done.ok()) {
        done = awaiting == Awaiting::Poll ? commands.poll() : commands.wait();
    }
    if (!done.ok()) {
        commands.waitForAll();
    }
    return done;
}

/// To the answer of the one pair, which ends its time.
Result<void> submitAndRead(device::TimedCommands& commands, Awaiting awaiting, Results& results, const Stopwatch& watch,
                           Pass& pass) {
    VOXTACT_TRY(submitAndAwait(commands, awaiting));
    const Result<std::span<const PairResult>> read = results.read();
    VOXTACT_TRY(read);
    const PairAnswer answer = unpack(read->front());
    pass.wallMilliseconds += watch.milliseconds();
    pass.pairs.push_back(answer);
    return {};
}

class TickEngine final : public Engine {
  public:
    TickEngine(Detector detector, Results results, device::TimedCommands commands, Awaiting awaiting)
        : Engine(tickFacts(factsOf(detector.desc()), "each tick", awaiting)), detector_(std::move(detector)),
          results_(std::move(results)), commands_(std::move(commands)), awaiting_(awaiting) {}

    Result<Pass> run(const Work& work, const Feeding& feeding) override;

  private:
    Result<void> record(const Batch& batch);
    /// From a pose to its answer.
    Result<void> tick(const Work& work, const BatchItem& item, Pass& pass);

    Detector detector_;
    Results results_;
    device::TimedCommands commands_; // last: it waits for what uses the others
    Awaiting awaiting_;
};

Result<void> TickEngine::record(const Batch& batch) {
    const Result<VkCommandBuffer> begun = commands_.begin();
    VOXTACT_TRY(begun);
    VOXTACT_TRY(detector_.cmdDetect(*begun, batch, results_));
    VOXTACT_TRY(results_.cmdReadBack(*begun));
    return commands_.end();
}

Result<void> TickEngine::tick(const Work& work, const BatchItem& item, Pass& pass) {
    const Stopwatch watch;
    VOXTACT_TRY(record({{&item, 1}, work.view, work.volume->threshold}));
    const double recorded = watch.milliseconds();
    VOXTACT_TRY(submitAndRead(commands_, awaiting_, results_, watch, pass));
    *pass.recordMilliseconds += recorded;
    return {};
}

Result<Pass> TickEngine::run(const Work& work, const Feeding& /*feeding*/) {
    Pass pass;
    pass.recordMilliseconds = 0;
    pass.pairs.reserve(work.poses.size());
    BatchItem item = work.onDevice();
    for (const Mat4& pose : work.poses) {
        item.world_from_object = {&pose, 1};
        VOXTACT_TRY(tick(work, item, pass));
    }
    return pass;
}

/// A pose in mapped memory, where a command buffer that was recorded once reads it.
struct MappedPose {
    Buffer buffer;
    PoseBuffer poses;

    static Result<MappedPose> create(const device::Session& session) {
        ContextImpl& context = session.context.impl();
        Result<Buffer> buffer = makeBuffer(context, sizeof(std::array<float, 16>), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                           MemoryUse::Upload, "a pose");
        VOXTACT_TRY(buffer);
        Result<PoseBuffer> poses = PoseBuffer::wrap(session.context, {.buffer = buffer->get(), .count = 1});
        VOXTACT_TRY(poses);
        return MappedPose{std::move(*buffer), std::move(*poses)};
    }
    Result<void> write(ContextImpl& context, const Mat4& pose) {
        std::transform(pose.begin(), pose.end(), static_cast<float*>(buffer.mapped),
                       [](double element) { return static_cast<float>(element); });
        return flush(context, buffer);
    }
};

class RecordedTickEngine final : public Engine {
  public:
    RecordedTickEngine(ContextImpl& context, Detector detector, Results results, MappedPose pose,
                       device::TimedCommands commands, Awaiting awaiting)
        : Engine(tickFacts(factsOf(detector.desc()), "once", awaiting)), context_(context),
          detector_(std::move(detector)), results_(std::move(results)), pose_(std::move(pose)),
          commands_(std::move(commands)), awaiting_(awaiting) {}

    Result<Pass> run(const Work& work, const Feeding& feeding) override;

  private:
    Result<void> record(const Work& work);

    ContextImpl& context_;
    Detector detector_;
    Results results_;
    MappedPose pose_;
    device::TimedCommands commands_; // last: it waits for what uses the others
    Awaiting awaiting_;
    bool recorded_ = false;
};

Result<void> RecordedTickEngine::record(const Work& work) {
    const Result<VkCommandBuffer> begun = commands_.begin(Use::Again);
    VOXTACT_TRY(begun);
    BatchItem item = work.onDevice();
    item.world_from_object = {};
    item.poses = &pose_.poses;
    VOXTACT_TRY(detector_.cmdDetect(*begun, {{&item, 1}, work.view, work.volume->threshold}, results_));
    VOXTACT_TRY(results_.cmdReadBack(*begun));
    return commands_.end();
}

Result<Pass> RecordedTickEngine::run(const Work& work, const Feeding& /*feeding*/) {
    if (!recorded_) {
        VOXTACT_TRY(record(work));
        recorded_ = true;
    }
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    for (const Mat4& pose : work.poses) {
        const Stopwatch watch;
        VOXTACT_TRY(pose_.write(context_, pose));
        VOXTACT_TRY(submitAndRead(commands_, awaiting_, results_, watch, pass));
    }
    return pass;
}

class EmptyEngine final : public Engine {
  public:
    EmptyEngine(device::TimedCommands commands, Awaiting awaiting)
        : Engine(tickFacts({.name = "empty submit", .threads = 0}, "once", awaiting)), commands_(std::move(commands)),
          awaiting_(awaiting) {}

    Result<Pass> run(const Work& work, const Feeding& /*feeding*/) override {
        const Stopwatch watch;
        for (std::size_t pose = 0; pose < work.poses.size(); ++pose) {
            VOXTACT_TRY(submitAndAwait(commands_, awaiting_));
        }
        return Pass{.wallMilliseconds = watch.milliseconds()};
    }

  private:
    device::TimedCommands commands_;
    Awaiting awaiting_;
};

} // namespace

MadeEngine makeTickEngine(const device::Session& session, const DetectorDesc& desc, Awaiting awaiting) {
    Result<Detector> detector = Detector::create(session.context, desc);
    VOXTACT_TRY(detector);
    ResultsDesc room;
    if (desc.projection != Projection::Conservative) {
        room.clustersAtOnce = 0;
    }
    Result<Results> results = Results::create(session.context, room);
    VOXTACT_TRY(results);
    Result<device::TimedCommands> commands = device::TimedCommands::create(session, 0);
    VOXTACT_TRY(commands);
    if (desc.devicePoses) {
        Result<MappedPose> pose = MappedPose::create(session);
        VOXTACT_TRY(pose);
        return MadeEngine(std::make_unique<RecordedTickEngine>(session.context.impl(), std::move(*detector),
                                                               std::move(*results), std::move(*pose),
                                                               std::move(*commands), awaiting));
    }
    return MadeEngine(
        std::make_unique<TickEngine>(std::move(*detector), std::move(*results), std::move(*commands), awaiting));
}

MadeEngine makeEmptyEngine(const device::Session& session, Awaiting awaiting) {
    Result<device::TimedCommands> commands = device::TimedCommands::create(session, 0);
    VOXTACT_TRY(commands);
    VOXTACT_TRY(commands->begin(Use::Again));
    VOXTACT_TRY(commands->end());
    return MadeEngine(std::make_unique<EmptyEngine>(std::move(*commands), awaiting));
}

} // namespace voxtact::lab
