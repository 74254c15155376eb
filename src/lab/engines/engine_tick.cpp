// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "device/timed_commands.h"
#include "lab/engines/engine.h"
#include "lab/engines/mapped_poses.h"
#include "lab/measure/stopwatch.h"

namespace voxtact::lab {

namespace {

using Use = device::TimedCommands::Use;

/// What asks about a pair.
struct Asking {
    Detector detector;
    Results results;
    std::optional<MappedPoses> pose{}; ///< where there is one, the command buffer is recorded once

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
            Result<MappedPoses> pose = MappedPoses::create(session, 1);
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

/// A loop that asks about one pose after the other.
struct Ticking {
    std::optional<Asking> asking; ///< none: an empty submission
    Awaiting awaiting;
    device::TimedCommands commands; ///< last: it waits for what uses the others
    bool recorded = false;
};

Result<void> record(Ticking& loop, const Work& work, const BatchItem& item, Use use) {
    const Result<VkCommandBuffer> begun = loop.commands.begin(use);
    VOXTACT_TRY(begun);
    if (loop.asking) {
        Asking& asking = *loop.asking;
        VOXTACT_TRY(asking.detector.cmdDetect(*begun, {{&item, 1}, work.view, work.volume->threshold}, asking.results));
        VOXTACT_TRY(asking.results.cmdReadBack(*begun));
    }
    return loop.commands.end();
}

/// Nothing is in flight afterwards, not after an error either.
Result<void> submitAndAwait(Ticking& loop) {
    Result<void> done = loop.commands.submit();
    if (done.ok()) {
        done = loop.awaiting == Awaiting::Poll ? loop.commands.poll() : loop.commands.wait();
    }
    if (!done.ok()) {
        loop.commands.waitForAll();
    }
    return done;
}

/// From a pose to its answer.
Result<void> tick(Ticking& loop, const Work& work, const BatchItem& item, Pass& pass) {
    const Stopwatch watch;
    if (pass.recordMilliseconds) {
        VOXTACT_TRY(record(loop, work, item, Use::Once));
        *pass.recordMilliseconds += watch.milliseconds();
    } else if (loop.asking) {
        VOXTACT_TRY(loop.asking->pose->write(item.world_from_object));
    }
    VOXTACT_TRY(submitAndAwait(loop));
    if (loop.asking) {
        const Result<std::span<const PairResult>> read = loop.asking->results.read();
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
    const bool once = !loop.asking || loop.asking->pose;
    if (!once) {
        pass.recordMilliseconds = 0;
    } else if (!loop.recorded) {
        item.world_from_object = {};
        item.poses = loop.asking ? &loop.asking->pose->poses() : nullptr;
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

MadeEngine makeTickEngine(const device::Session& session, const std::optional<DetectorDesc>& desc, Awaiting awaiting) {
    std::optional<Asking> asking;
    if (desc) {
        Result<Asking> made = Asking::create(session, *desc);
        VOXTACT_TRY(made);
        asking.emplace(std::move(*made));
    }
    Result<device::TimedCommands> commands = device::TimedCommands::create(session, 0);
    VOXTACT_TRY(commands);
    return engineOf(tickFacts(desc, awaiting), Ticking{std::move(asking), awaiting, std::move(*commands)}, runTicks);
}

} // namespace voxtact::lab
