// SPDX-License-Identifier: MIT
#include "lab/bench/latency.h"

#include "core/base/try.h"
#include "core/method/method_table.h"
#include "lab/measure/moving_poses.h"
#include "lab/measure/rounds.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

constexpr std::uint32_t kBlock = 250; ///< ticks that an engine takes in a turn
constexpr std::uint32_t kLeadIn = 10; ///< before them, not timed: what the engine before it left in caches is not its
constexpr std::uint32_t kFewest = 10; ///< of a block that is cut because it takes too long
constexpr std::uint32_t kWarmUp = 50; ///< ticks of the warm-up

/// A mesh on its way, and what must be answered there.
struct Motion {
    Work work;
    std::vector<Mat4> poses;       ///< kLeadIn more than there are ticks
    std::vector<TickTruth> truths; ///< of the first poses
    Engine& certified;
    Engine& view;
};

/// By a method that knows whether there are survivors and not how many.
bool countsNothing(const PairAnswer& answer) {
    return rowOf(answer.method).exactness == Exactness::LowerBound;
}

/// Whether a rasteriser's answer can be the host's but for roundings at pixels' centres and between table entries.
bool isNear(const PairAnswer& answer, const PairAnswer& host) {
    const std::uint64_t most = kRoundedFragments + host.count / 2;
    if (countsNothing(answer)) {
        return answer.hit == host.hit || host.count <= kRoundedFragments;
    }
    const std::uint64_t apart = std::max(answer.count, host.count) - std::min(answer.count, host.count);
    return apart <= most && answer.hit == (answer.count > 0);
}

/// Asks the host about the poses up to a number.
Result<void> learn(Motion& motion, std::size_t end) {
    const std::size_t begin = motion.truths.size();
    if (begin >= end) {
        return {};
    }
    const Work work = motion.work.at(std::span(motion.poses).subspan(begin, end - begin));
    const Result<Pass> certified = motion.certified.run(work, {});
    VOXTACT_TRY(certified);
    const Result<Pass> view = motion.view.run(work, {});
    VOXTACT_TRY(view);
    for (std::size_t i = 0; i < work.poses.size(); ++i) {
        motion.truths.push_back({certified->pairs[i], view->pairs[i]});
    }
    return {};
}

/// One tick: its time, and whether its answer is right.
Result<double> takeTick(Motion& motion, Engine& engine, std::size_t number, bool kept, LatencyRow& row,
                        std::string& disagreement) {
    const Result<Pass> pass = engine.run(motion.work.at({&motion.poses[number], 1}), {});
    VOXTACT_TRY(pass);
    if (!pass->pairs.empty()) {
        const PairAnswer& answer = pass->pairs.front();
        TickTruth& truth = motion.truths[number];
        const std::string wrong = judgeTick(engine.facts(), answer, truth);
        if (!wrong.empty() && disagreement.empty()) {
            disagreement = row.mesh + ", tick " + std::to_string(number) + ": " + wrong;
        }
        row.touching += kept && answer.hit ? 1 : 0;
        row.rounding += kept && !engine.facts().certified && differsByRounding(answer, truth.view) ? 1 : 0;
    }
    if (kept) {
        row.ticks.push_back(pass->wallMilliseconds * 1000);
        if (pass->recordMilliseconds) {
            row.recording.push_back(*pass->recordMilliseconds * 1000);
        }
    }
    return pass->wallMilliseconds;
}

/// The ticks of a turn; fewer where the engine has used up its time.
Result<double> takeBlock(Motion& motion, Engine& engine, const Turn& turn, double limit, LatencyRow& row,
                         std::string& disagreement) {
    const std::size_t begin = turn.round == 0 ? 0 : (turn.round - 1) * kBlock;
    const std::size_t end =
        std::min<std::size_t>(begin + kLeadIn + (turn.round == 0 ? kWarmUp : kBlock), motion.poses.size());
    VOXTACT_TRY(learn(motion, end));
    const double most = turn.round == 0 ? limit / 4 : limit;
    double spent = 0;
    for (std::size_t tick = begin; tick < end && disagreement.empty(); ++tick) {
        const bool kept = turn.round > 0 && tick >= begin + kLeadIn;
        if (spent > most && tick >= begin + kLeadIn + kFewest) {
            break;
        }
        const Result<double> took = takeTick(motion, engine, tick, kept, row, disagreement);
        VOXTACT_TRY(took);
        spent += *took;
    }
    return spent;
}

/// `limit`: ms of all engines.
Result<void> measureMesh(const LatencySettings& settings, const VolumePart& volume, MeshPart& mesh, double limit,
                         const device::Session* session, const std::function<void()>& step, LatencyResult& result) {
    VOXTACT_TRY(makeReady(session, mesh));
    const Result<Engines> engines = makeLatencyEngines(session);
    VOXTACT_TRY(engines);
    const double share = limit / static_cast<double>(engines->size());
    const MadeEngine certified = makeHostEngine({.projection = Projection::Conservative});
    VOXTACT_TRY(certified);
    const MadeEngine view = makeHostEngine();
    VOXTACT_TRY(view);
    Motion motion{.work = {volume, mesh, {}, {framingCamera(volume.data.grid, 512, 512), 512, 512}},
                  .poses = {},
                  .truths = {},
                  .certified = **certified,
                  .view = **view};
    const MadeEngine yesNo = makeHostEngine({.stopAtFirst = true, .projection = Projection::Conservative});
    VOXTACT_TRY(yesNo);
    Result<std::vector<Mat4>> poses =
        movingPoses(volume.data.grid, mesh.data.view(), settings.ticks + kLeadIn, settings.seed,
                    [&](const Mat4& pose) -> Result<bool> {
                        const Result<Pass> pass = (*yesNo)->run(motion.work.at({&pose, 1}), {});
                        return pass.ok() ? Result<bool>(pass->pairs.front().hit) : Result<bool>(pass.error());
                    });
    VOXTACT_TRY(poses);
    motion.poses = std::move(*poses);
    // Floats, so that an engine whose pose is on the device is asked the same.
    for (Mat4& pose : motion.poses) {
        std::transform(pose.begin(), pose.end(), pose.begin(),
                       [](double element) { return static_cast<double>(static_cast<float>(element)); });
    }
    const std::size_t firstRow = result.rows.size();
    std::vector<Timed> things;
    for (std::size_t i = 0; i < engines->size(); ++i) {
        result.rows.push_back({.mesh = mesh.name, .triangles = mesh.triangles(), .engine = (*engines)[i]->facts()});
        things.push_back({.take =
                              [&, i](const Turn& turn) {
                                  return takeBlock(motion, *(*engines)[i], turn, share, result.rows[firstRow + i],
                                                   result.disagreement);
                              },
                          .limit = share});
    }
    VOXTACT_TRY(takeRounds(
        things, {.repeats = static_cast<std::uint32_t>((std::uint64_t{settings.ticks} + kBlock - 1) / kBlock),
                 .warmUp = true,
                 .step = step,
                 .stop = [&] { return !result.disagreement.empty(); }}));
    return {};
}

} // namespace

bool differsByRounding(const PairAnswer& answer, const PairAnswer& host) {
    return answer.exactness == Exactness::LowerBound ? answer.hit != host.hit : answer.count != host.count;
}

std::string judgeTick(const EngineFacts& engine, const PairAnswer& answer, TickTruth& truth) {
    const bool raster = rowOf(answer.method).coverage == Coverage::Rasteriser;
    const bool any = countsNothing(answer);
    if (raster && !any && !truth.raster) {
        truth.raster = answer;
    }
    if (raster && !isNear(answer, truth.view)) {
        return engine.name + " " + engine.projection + " " + engine.question + " says " +
               (any ? std::string(answer.hit ? "a hit" : "no hit") : std::to_string(answer.count)) +
               " where cpu counts " + std::to_string(truth.view.count) +
               ": more than what roundings of a rasteriser explain";
    }
    const PairAnswer& must = engine.certified ? truth.certified : raster ? truth.raster.value_or(answer) : truth.view;
    const bool yesNo = engine.question == questionOf(true, {});
    const std::uint64_t count = yesNo ? (must.hit ? 1 : 0) : must.count;
    if (answer.hit == must.hit && answer.possible == must.possible && (any || answer.count == count)) {
        return {};
    }
    const auto says = [any](const PairAnswer& one, std::uint64_t counted) {
        return one.possible ? std::string("possible") : any ? one.hit ? "a hit" : "no hit" : std::to_string(counted);
    };
    return engine.name + " " + engine.projection + " " + engine.question + " says " + says(answer, answer.count) +
           ", it must be " + says(must, count);
}

Result<void> measureLatency(const LatencySettings& settings, const device::Session* session, VolumePart& volume,
                            std::vector<MeshPart> meshes, const Steps& steps, LatencyResult& result) {
    if (session != nullptr) {
        VOXTACT_TRY(upload(*session, {.bricks = true}, volume));
    }
    const double limit = settings.timeLimit * 1000 / static_cast<double>(meshes.size());
    const std::uint64_t rounds = (std::uint64_t{settings.ticks} + kBlock - 1) / kBlock;
    steps.begin((rounds + 1) * meshes.size());
    for (MeshPart& mesh : meshes) {
        VOXTACT_TRY(measureMesh(settings, volume, mesh, limit, session, steps.step, result));
    }
    return {};
}

} // namespace voxtact::lab
