// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "lab/bench/parts.h"
#include "lab/measure/poses.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

constexpr std::uint32_t kBlock = 250; ///< ticks that an engine takes in a turn
constexpr std::uint32_t kLeadIn = 10; ///< before them, not timed: what the engine before it left in caches is not its
constexpr std::uint32_t kFewest = 10; ///< of a block that is cut because it takes too long
constexpr std::uint32_t kWarmUp = 50; ///< ticks of the warm-up

/// The ticks of a turn; fewer where the engine has used up its time.
Result<double> takeBlock(const BenchRun& run, KnownPoses& poses, const Engine& engine, const Turn& turn, double limit,
                         BenchRow& row) {
    const std::size_t begin = turn.round == 0 ? 0 : (turn.round - 1) * kBlock;
    const std::size_t end = std::min<std::size_t>(begin + kLeadIn + (turn.round == 0 ? kWarmUp : kBlock), poses.size());
    VOXTACT_TRY(poses.learn(end));
    const double most = turn.round == 0 ? limit / 4 : limit;
    double spent = 0;
    for (std::size_t tick = begin; tick < end && run.result.disagreement.empty(); ++tick) {
        if (spent > most && tick >= begin + kLeadIn + kFewest) {
            break;
        }
        const bool kept = turn.round > 0 && tick >= begin + kLeadIn;
        const Result<double> took = poses.take(engine, tick, kept, row);
        VOXTACT_TRY(took);
        spent += *took;
    }
    return spent;
}

} // namespace

std::uint32_t tickRounds(std::uint32_t ticks) {
    return static_cast<std::uint32_t>((std::uint64_t{ticks} + kBlock - 1) / kBlock);
}

Result<void> benchTicks(const BenchRun& run) {
    const MadeEngine certified = makeHostEngine({.projection = Projection::Conservative});
    VOXTACT_TRY(certified);
    const MadeEngine view = makeHostEngine();
    VOXTACT_TRY(view);
    Result<std::vector<Mat4>> all =
        movingPoses(run.work.volume->data.grid, run.work.mesh->data.view(), run.settings.number + kLeadIn,
                    run.settings.seed, touchesBy(*certified, run.work));
    VOXTACT_TRY(all);
    KnownPoses poses(run, asFloats(std::move(*all)), *certified, *view);
    const double share = run.limit / static_cast<double>(run.engines.size());
    std::vector<Timed> things;
    for (const Engine& engine : run.engines) {
        const std::size_t row = run.addRow(engine, "", 1);
        const auto take = [&, row](const Turn& turn) {
            return takeBlock(run, poses, engine, turn, share, run.result.rows[row]);
        };
        things.push_back({.take = take, .limit = share});
    }
    return run.time(things, {.repeats = tickRounds(run.settings.number), .warmUp = true, .step = run.step});
}

} // namespace voxtact::lab
