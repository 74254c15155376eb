// SPDX-License-Identifier: MIT
// Ticks and batches: every answer is held against what is known of its pose.
#include "bench/engine_bench/parts.h"
#include "bench/measure/numbers.h"
#include "cli/make/poses.h"
#include "core/base/try.h"
#include "core/method/method_table.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

/// Compares a method that counts 0 or 1.
bool countsNothing(const PairAnswer& answer) {
    return rowOf(answer.method).exactness == Exactness::LowerBound;
}

/// Returns true if rounding at pixel centres and between table entries explains a rasteriser's difference from the
/// host.
bool isNear(const PairAnswer& answer, const PairAnswer& host) {
    const bool any = countsNothing(answer);
    const std::uint64_t counted = any ? (answer.hit ? 1 : 0) : answer.count;
    return explainedByRounding(counted, host.count, any) && answer.hit == (counted > 0);
}

/// Returns true if an answer in the view differs from the host's.
bool differs(const PairAnswer& answer, const PairAnswer& host) {
    return answer.exactness == Exactness::LowerBound ? answer.hit != host.hit : answer.count != host.count;
}

/// Poses of a mesh with their expected answers, which are computed on demand.
struct KnownPoses {
    const BenchRun& run;
    std::vector<Mat4> poses;
    const Engine& certified; ///< two engines of the host give the expected answers: this one and the next
    const Engine& view;
    std::vector<PoseTruth> truths{}; ///< of the first poses
    double learning = 0;             ///< ms that the last ones took

    /// Up to a pose.
    Result<void> learn(std::size_t end);
    /// Takes one sample of an engine: as many pairs as its row has, from pose `first` on. Compares its answers with the
    /// expected ones; an error is the result's disagreement. Returns the sample's ms. If `kept`, adds times and
    /// findings to the row.
    Result<double> take(const Engine& engine, std::size_t first, bool kept, BenchRow& row);
};

Result<void> KnownPoses::learn(std::size_t end) {
    const std::size_t begin = truths.size();
    if (begin >= end) {
        return {};
    }
    const Work work = run.work.at(std::span(poses).subspan(begin, end - begin));
    const Result<Pass> sure = certified.run(work, {});
    VOXTACT_TRY(sure);
    const Result<Pass> seen = view.run(work, {});
    VOXTACT_TRY(seen);
    learning = sure->wallMilliseconds + seen->wallMilliseconds;
    for (std::size_t i = 0; i < work.poses.size(); ++i) {
        truths.push_back({sure->pairs[i], seen->pairs[i]});
    }
    return {};
}

Result<double> KnownPoses::take(const Engine& engine, std::size_t first, bool kept, BenchRow& row) {
    const Result<Pass> pass = engine.run(run.work.at(std::span(poses).subspan(first, row.pairs)), {});
    VOXTACT_TRY(pass);
    for (std::size_t i = 0; i < pass->pairs.size(); ++i) {
        const PairAnswer& answer = pass->pairs[i];
        PoseTruth& truth = truths[first + i];
        const std::string wrong = judgePose(row.engine, answer, truth);
        row.touching += kept && answer.hit ? 1 : 0;
        row.rounding += kept && !row.engine.certified && differs(answer, truth.view) ? 1 : 0;
        if (!wrong.empty()) {
            const bool tick = run.settings.mode == BenchMode::Latency;
            run.result.disagreement = concat(row.mesh, tick ? ", tick " : ", pose ", first + i,
                                             tick ? "" : concat(" of ", row.pairs), ": ", wrong);
            break;
        }
    }
    if (kept) {
        row.wall.push_back(pass->wallMilliseconds);
        keep(pass->gpuMilliseconds, row.gpu);
        keep(pass->recordMilliseconds, row.recording);
    }
    return pass->wallMilliseconds;
}

constexpr std::uint32_t kBlock = 250; ///< ticks that an engine takes in a turn
constexpr std::uint32_t kLeadIn = 10; ///< before them, not timed: fills the caches after the previous engine
constexpr std::uint32_t kFewest = 10; ///< of a block that is cut because it is too slow
constexpr std::uint32_t kWarmUp = 50; ///< ticks of the warm-up

/// The ticks of a turn; fewer where the engine has used up its time.
Result<double> takeBlock(const BenchRun& run, KnownPoses& poses, const Engine& engine, const Turn& turn, double limit,
                         BenchRow& row) {
    const std::size_t begin = turn.round == 0 ? 0 : (turn.round - 1) * kBlock;
    const std::size_t end =
        std::min<std::size_t>(begin + kLeadIn + (turn.round == 0 ? kWarmUp : kBlock), poses.poses.size());
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

/// One size, by every engine that is still `alive`, none of which has more than `longest` ms for a sample on average.
/// Those for which the next size would take longer than `longest` ms end, and all where the host would take longer than
/// `mostLearning` ms to say what must be answered.
Result<void> measureSize(const BenchRun& run, KnownPoses& poses, Engines& alive, std::uint32_t batch, double longest,
                         double mostLearning) {
    if (alive.empty()) {
        return {};
    }
    VOXTACT_TRY(poses.learn(batch));
    std::vector<BenchRow>& rows = run.result.rows;
    const std::size_t firstRow = rows.size();
    std::vector<Timed> things;
    for (const Engine& engine : alive) {
        const std::size_t row = run.addRow(engine, "", batch);
        things.push_back(
            {.take = [&, row](const Turn& turn) { return poses.take(engine, 0, turn.round > 0, rows[row]); },
             .limit = longest * run.settings.repetitions});
    }
    VOXTACT_TRY(run.time(things, {.repeats = run.settings.repetitions, .warmUp = true}));
    if (run.result.disagreement.empty()) {
        std::size_t row = firstRow;
        std::erase_if(alive, [&](const Engine&) {
            return 10 * medianOf(rows[row++].wall) > longest || 10 * poses.learning > mostLearning;
        });
    }
    return {};
}

/// A note for each engine that ended early: which batches it had no time for.
void noteEnded(const BenchRun& run) {
    for (const Engine& engine : run.engines) {
        std::uint64_t largest = 0;
        for (const BenchRow& row : run.result.rows) {
            largest = row.engine == engine.facts ? std::max(largest, row.pairs) : largest;
        }
        if (largest < run.settings.number) {
            run.result.notes.push_back(
                concat(engine.facts.text(), engine.facts.posesOn == "device" ? ", poses on the device" : "",
                       ": batches of more than ", counted(largest, "pose"), " exceed --time-limit and are left out"));
        }
    }
}

} // namespace

std::string judgePose(const EngineFacts& engine, const PairAnswer& answer, PoseTruth& truth) {
    const bool raster = rowOf(answer.method).coverage == Coverage::Rasteriser;
    const bool any = countsNothing(answer);
    const auto says = [any](const PairAnswer& one, std::uint64_t counted) {
        return one.possible ? std::string("possible") : any ? one.hit ? "a hit" : "no hit" : std::to_string(counted);
    };
    const std::string text = engine.text() + " says " + says(answer, answer.count);
    if (raster && !any && !truth.raster) {
        truth.raster = answer;
    }
    if (raster && !isNear(answer, truth.view)) {
        return concat(text, " where cpu counts ", truth.view.count,
                      ": more than the rounding of a rasteriser explains");
    }
    const PairAnswer& must = engine.certified ? truth.certified : raster ? truth.raster.value_or(answer) : truth.view;
    const bool yesNo = engine.question == questionOf(true, {});
    const std::uint64_t count = yesNo ? (must.hit ? 1 : 0) : must.count;
    const bool right = answer.hit == must.hit && answer.possible == must.possible && (any || answer.count == count);
    return right ? std::string() : text + "; expected: " + says(must, count);
}

std::uint32_t tickRounds(std::uint32_t ticks) {
    return static_cast<std::uint32_t>((std::uint64_t{ticks} + kBlock - 1) / kBlock);
}

Result<void> benchTicks(const BenchRun& run) {
    const MadeEngine certified = makeHostEngine({.projection = Projection::Certified});
    VOXTACT_TRY(certified);
    const MadeEngine view = makeHostEngine();
    VOXTACT_TRY(view);
    Result<std::vector<Mat4>> all =
        movingPoses(run.work.volume->data.grid, run.work.mesh->data.view(), run.settings.number + kLeadIn,
                    run.settings.seed, touchesBy(*certified, run.work));
    VOXTACT_TRY(all);
    KnownPoses poses{run, asFloats(std::move(*all)), *certified, *view};
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

std::vector<std::uint32_t> batchSizes(std::uint32_t most) {
    std::vector<std::uint32_t> sizes;
    for (std::uint64_t size = 1; size < most; size *= 10) {
        sizes.push_back(static_cast<std::uint32_t>(size));
    }
    sizes.push_back(most);
    return sizes;
}

Result<void> benchBatches(const BenchRun& run) {
    KnownPoses poses{run,
                     asFloats(randomPoses(run.work.volume->data.grid, run.work.mesh->data.view(), run.settings.number,
                                          run.settings.seed)),
                     run.engines[0], run.engines[1]};
    // The largest batch, its warm-up and the smaller batches: a ninth more.
    const double mostLearning = run.limit / 4;
    const double longest =
        (run.limit - mostLearning) / (1.2 * (run.settings.repetitions + 1) * static_cast<double>(run.engines.size()));
    Engines alive = run.engines;
    for (const std::uint32_t batch : batchSizes(run.settings.number)) {
        if (run.result.disagreement.empty()) {
            VOXTACT_TRY(measureSize(run, poses, alive, batch, longest, mostLearning));
        }
        run.step(1);
    }
    // Stops after a disagreement.
    std::erase_if(run.result.rows, [](const BenchRow& row) { return row.wall.empty(); });
    if (run.result.disagreement.empty()) {
        noteEnded(run);
    }
    return {};
}

} // namespace voxtact::lab
