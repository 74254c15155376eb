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

/// A pose in mapped memory, where a command buffer that was recorded once reads it.
struct MappedPose {
    ContextImpl& context;
    Buffer buffer;
    PoseBuffer poses;

    static Result<MappedPose> create(const device::Session& session) {
        ContextImpl& context = session.context.impl();
        Result<Buffer> buffer = makeBuffer(context, sizeof(std::array<float, 16>), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                           MemoryUse::Upload, "a pose");
        VOXTACT_TRY(buffer);
        Result<PoseBuffer> poses = PoseBuffer::wrap(session.context, {.buffer = buffer->get(), .count = 1});
        VOXTACT_TRY(poses);
        return MappedPose{context, std::move(*buffer), std::move(*poses)};
    }
    Result<void> write(const Mat4& pose) {
        std::transform(pose.begin(), pose.end(), static_cast<float*>(buffer.mapped),
                       [](double element) { return static_cast<float>(element); });
        return flush(context, buffer);
    }
};

/// What asks about a pair.
struct Asking {
    Detector detector;
    Results results;
    std::optional<MappedPose> pose{}; ///< where there is one, the command buffer is recorded once

    static Result<Asking> create(const device::Session& session, const DetectorDesc& desc) {
        Result<Detector> detector = Detector::create(session.context, desc);
        VOXTACT_TRY(detector);
        ResultsDesc room;
        if (desc.projection != Projection::Conservative) {
            room.clustersAtOnce = 0;
        }
        Result<Results> results = Results::create(session.context, room);
        VOXTACT_TRY(results);
        Asking asking{std::move(*detector), std::move(*results)};
        if (desc.devicePoses) {
            Result<MappedPose> pose = MappedPose::create(session);
            VOXTACT_TRY(pose);
            asking.pose.emplace(std::move(*pose));
        }
        return asking;
    }
};

EngineFacts tickFacts(const std::optional<DetectorDesc>& desc, Awaiting awaiting) {
    EngineFacts facts = desc ? factsOf(desc->method, *desc, 0) : EngineFacts{.name = "empty submit", .threads = 0};
    facts.recorded = desc && !desc->devicePoses ? "each tick" : "once";
    facts.awaited = awaiting == Awaiting::Poll ? "polled" : "waited";
    return facts;
}

class TickEngine final : public Engine {
  public:
    TickEngine(EngineFacts facts, std::optional<Asking> asking, device::TimedCommands commands, Awaiting awaiting)
        : Engine(std::move(facts)), asking_(std::move(asking)), commands_(std::move(commands)), awaiting_(awaiting) {}

    Result<Pass> run(const Work& work, const Feeding& feeding) override;

  private:
    Result<void> record(const Work& work, const BatchItem& item, Use use);
    /// From a pose to its answer.
    Result<void> tick(const Work& work, const BatchItem& item, Pass& pass);
    /// Nothing is in flight afterwards, not after an error either.
    Result<void> submitAndAwait();

    std::optional<Asking> asking_;   // none: an empty submission
    device::TimedCommands commands_; // last: it waits for what uses the others
    Awaiting awaiting_;
    bool recorded_ = false;
};

Result<void> TickEngine::record(const Work& work, const BatchItem& item, Use use) {
    const Result<VkCommandBuffer> begun = commands_.begin(use);
    VOXTACT_TRY(begun);
    if (asking_) {
        VOXTACT_TRY(
            asking_->detector.cmdDetect(*begun, {{&item, 1}, work.view, work.volume->threshold}, asking_->results));
        VOXTACT_TRY(asking_->results.cmdReadBack(*begun));
    }
    return commands_.end();
}

Result<void> TickEngine::submitAndAwait() {
    Result<void> done = commands_.submit();
    if (done.ok()) {
        done = awaiting_ == Awaiting::Poll ? commands_.poll() : commands_.wait();
    }
    if (!done.ok()) {
        commands_.waitForAll();
    }
    return done;
}

Result<void> TickEngine::tick(const Work& work, const BatchItem& item, Pass& pass) {
    const Stopwatch watch;
    if (pass.recordMilliseconds) {
        VOXTACT_TRY(record(work, item, Use::Once));
        *pass.recordMilliseconds += watch.milliseconds();
    } else if (asking_) {
        VOXTACT_TRY(asking_->pose->write(item.world_from_object.front()));
    }
    VOXTACT_TRY(submitAndAwait());
    if (asking_) {
        const Result<std::span<const PairResult>> read = asking_->results.read();
        VOXTACT_TRY(read);
        pass.pairs.push_back(unpack(read->front()));
    }
    pass.wallMilliseconds += watch.milliseconds();
    return {};
}

Result<Pass> TickEngine::run(const Work& work, const Feeding& /*feeding*/) {
    Pass pass;
    pass.pairs.reserve(work.poses.size());
    BatchItem item = work.onDevice();
    const bool once = !asking_ || asking_->pose;
    if (!once) {
        pass.recordMilliseconds = 0;
    } else if (!recorded_) {
        item.world_from_object = {};
        item.poses = asking_ ? &asking_->pose->poses : nullptr;
        VOXTACT_TRY(record(work, item, Use::Again));
        recorded_ = true;
    }
    for (const Mat4& pose : work.poses) {
        item.world_from_object = {&pose, 1};
        VOXTACT_TRY(tick(work, item, pass));
    }
    return pass;
}

} // namespace

MadeEngine makeTickEngine(const device::Session& session, const std::optional<DetectorDesc>& desc, Awaiting awaiting) {
    std::optional<Asking> asking;
    if (desc) {
        Result<Asking> made = Asking::create(session, *desc);
        VOXTACT_TRY(made);
        asking.emplace(std::move(*made));
    }
    Result<device::TimedCommands> commands = device::TimedCommands::create(session, 0);
    VOXTACT_TRY(commands);
    return MadeEngine(
        std::make_unique<TickEngine>(tickFacts(desc, awaiting), std::move(asking), std::move(*commands), awaiting));
}

} // namespace voxtact::lab
