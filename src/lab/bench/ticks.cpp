// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "lab/bench/parts.h"
#include "lab/measure/numbers.h"
#include "lab/measure/poses.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

constexpr std::uint32_t kBlock = 250; ///< ticks that an engine takes in a turn
constexpr std::uint32_t kLeadIn = 10; ///< before them, not timed: what the engine before it left in caches is not its
constexpr std::uint32_t kFewest = 10; ///< of a block that is cut because it takes too long
constexpr std::uint32_t kWarmUp = 50; ///< ticks of the warm-up

/// One tick: its time, and whether its answer is right.
Result<double> takeTick(KnownPoses& poses, Engine& engine, std::size_t tick, bool kept, BenchRow& row,
                        std::string& disagreement) {
    const Result<Pass> pass = engine.run(poses.at(tick, 1), {});
    VOXTACT_TRY(pass);
    std::size_t wrongAt = 0;
    if (const std::string wrong = poses.judge(*pass, tick, kept, row, wrongAt); !wrong.empty()) {
        disagreement = row.mesh + ", tick " + std::to_string(wrongAt) + ": " + wrong;
    }
    if (kept) {
        row.wall.push_back(pass->wallMilliseconds);
        keep(pass->recordMilliseconds, row.recording);
    }
    return pass->wallMilliseconds;
}

/// The ticks of a turn; fewer where the engine has used up its time.
Result<double> takeBlock(KnownPoses& poses, Engine& engine, const Turn& turn, double limit, BenchRow& row,
                         std::string& disagreement) {
    const std::size_t begin = turn.round == 0 ? 0 : (turn.round - 1) * kBlock;
    const std::size_t end = std::min<std::size_t>(begin + kLeadIn + (turn.round == 0 ? kWarmUp : kBlock), poses.size());
    VOXTACT_TRY(poses.learn(end));
    const double most = turn.round == 0 ? limit / 4 : limit;
    double spent = 0;
    for (std::size_t tick = begin; tick < end && disagreement.empty(); ++tick) {
        if (spent > most && tick >= begin + kLeadIn + kFewest) {
            break;
        }
        const bool kept = turn.round > 0 && tick >= begin + kLeadIn;
        const Result<double> took = takeTick(poses, engine, tick, kept, row, disagreement);
        VOXTACT_TRY(took);
        spent += *took;
    }
    return spent;
}

/// As floats, so that an engine whose pose is on the device is asked the same.
Result<std::vector<Mat4>> makePoses(const BenchRun& run, Engine& host) {
    Result<std::vector<Mat4>> poses =
        movingPoses(run.work.volume->data.grid, run.work.mesh->data.view(), run.settings.number + kLeadIn,
                    run.settings.seed, touchesBy(host, run.work));
    for (std::size_t i = 0; poses.ok() && i < poses->size(); ++i) {
        std::ranges::transform((*poses)[i], (*poses)[i].begin(),
                               [](double element) { return static_cast<double>(static_cast<float>(element)); });
    }
    return poses;
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
    Result<std::vector<Mat4>> all = makePoses(run, **certified);
    VOXTACT_TRY(all);
    KnownPoses poses(run.work, std::move(*all), **certified, **view);
    const double share = run.limit / static_cast<double>(run.engines.size());
    std::vector<Timed> things;
    for (const std::unique_ptr<Engine>& engine : run.engines) {
        const std::size_t row = run.addRow(*engine, "", 1);
        things.push_back({.take =
                              [&, row](const Turn& turn) {
                                  return takeBlock(poses, *engine, turn, share, run.result.rows[row],
                                                   run.result.disagreement);
                              },
                          .limit = share});
    }
    return run.time(things, {.repeats = tickRounds(run.settings.number), .warmUp = true, .step = run.step});
}

} // namespace voxtact::lab
