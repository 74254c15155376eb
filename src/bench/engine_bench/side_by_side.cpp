// SPDX-License-Identifier: MIT
#include "bench/engine_bench/parts.h"
#include "bench/measure/numbers.h"
#include "bench/measure/stopwatch.h"
#include "cli/make/poses.h"
#include "core/base/try.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace voxtact::lab {

namespace {

constexpr std::size_t kCounting = 1; ///< the engine that the others are held against: it knows what is possible
/// Seconds of a sample: repeated up to the one, cut beyond the other.
constexpr double kShortest = 0.03;
constexpr double kLongest = 1.0;
constexpr std::size_t kFewestPoses = 8;
/// Time of a sample if the clock stands still.
constexpr double kMostPasses = 10'000;

/// Work of an engine for a sample.
struct Sample {
    const Engine& engine;
    Work work; ///< as many of the poses as fit
    std::size_t passes = 1;
    std::size_t row = 0;
    std::size_t besideRow = 0; ///< that of the engine which it is held against
};

/// Passes of an engine, one after the other.
struct Taken {
    Pass last;
    double wall = 0; ///< seconds of all of them
    double cpu = 0;  ///< the same, of the whole process
};

Result<Taken> takePasses(const Engine& engine, const Work& work, std::size_t passes) {
    const std::clock_t cpu = std::clock();
    const Stopwatch wall;
    Result<Pass> last = engine.run(work, {});
    for (std::size_t pass = 1; pass < passes && last.ok(); ++pass) {
        last = engine.run(work, {});
    }
    VOXTACT_TRY(last);
    // A tick at least, so that no rate is infinite.
    return Taken{std::move(*last), std::max(wall.milliseconds() / 1000, 1e-9),
                 static_cast<double>(std::max<std::clock_t>(std::clock() - cpu, 1)) / CLOCKS_PER_SEC};
}

/// Says where an engine does not count as the one that it must count as.
std::string compareCounts(std::span<const PairAnswer> bare, std::span<const PairAnswer> answers, const BenchRow& row) {
    for (std::size_t i = 0; i < bare.size(); ++i) {
        if (bare[i].count != answers[i].count) {
            return concat(row.mesh, ", poses ", row.poses, ", pose ", i, ": ", row.engine.text(), " counts ",
                          answers[i].count, ", but without the output ", bare[i].count);
        }
    }
    return {};
}

/// Runs every engine once: its answers are judged, and say how long a sample is.
Result<std::vector<Sample>> verify(const BenchRun& run, const Work& work, const char* kind) {
    const Result<Pass> certified = run.engines[kCounting].run(work, {});
    VOXTACT_TRY(certified);
    const std::size_t firstRow = run.result.rows.size();
    std::vector<Sample> samples;
    std::vector<Pass> passes;
    for (const Engine& engine : run.engines) {
        Result<Taken> took = takePasses(engine, work, 1);
        VOXTACT_TRY(took);
        passes.push_back(std::move(took->last));
        const std::size_t number = run.addRow(engine, kind, work.poses.size());
        BenchRow& row = run.result.rows[number];
        std::string wrong = judgeEngine(certified->pairs, passes.back().pairs, row);
        if (wrong.empty() && row.engine.sameCounts) {
            wrong = compareCounts(passes[row.engine.ratioTo].pairs, passes.back().pairs, row);
        }
        if (run.result.disagreement.empty()) {
            run.result.disagreement = wrong;
        }
        const auto fitting =
            static_cast<std::size_t>(static_cast<double>(work.poses.size()) * std::min(1.0, kLongest / took->wall));
        samples.push_back(
            {.engine = engine,
             .work = work.at(work.poses.first(std::min(work.poses.size(), std::max(kFewestPoses, fitting)))),
             .passes = static_cast<std::size_t>(std::clamp(std::ceil(kShortest / took->wall), 1.0, kMostPasses)),
             .row = number,
             .besideRow = firstRow + row.engine.ratioTo});
    }
    return samples;
}

/// A sample of an engine, and its ratio to that of the same round which it is held against.
Result<double> take(const Sample& sample, std::vector<BenchRow>& rows) {
    const Result<Taken> took = takePasses(sample.engine, sample.work, sample.passes);
    VOXTACT_TRY(took);
    BenchRow& row = rows[sample.row];
    const BenchRow& beside = rows[sample.besideRow];
    const auto pairs = static_cast<double>(sample.work.poses.size() * sample.passes);
    row.wallRate.push_back(pairs / took->wall);
    row.cpuRate.push_back(pairs / took->cpu);
    row.wallRatio.push_back(row.wallRate.back() / beside.wallRate.back());
    row.cpuRatio.push_back(row.cpuRate.back() / beside.cpuRate.back());
    return took->wall * 1000;
}

/// Verifies, then times one kind of poses.
Result<void> benchKind(const BenchRun& run, const char* kind, const Result<std::vector<Mat4>>& poses) {
    VOXTACT_TRY(poses);
    const Result<std::vector<Sample>> samples = verify(run, run.work.at(*poses), kind);
    VOXTACT_TRY(samples);
    std::vector<Timed> things;
    for (const Sample& sample : *samples) {
        things.push_back({.take = [&](const Turn&) { return take(sample, run.result.rows); }});
    }
    return run.time(things, {.repeats = run.settings.repetitions, .step = run.step});
}

} // namespace

std::string judgeEngine(std::span<const PairAnswer> certified, std::span<const PairAnswer> answers, BenchRow& row) {
    std::string disagreement;
    for (std::size_t i = 0; i < certified.size(); ++i) {
        const PairAnswer& truth = certified[i];
        const PairAnswer& answer = answers[i];
        const bool none = !truth.hit && !truth.possible;
        row.contacts += truth.hit ? 1 : 0;
        row.untouched += none ? 1 : 0;
        row.missed += truth.hit && !answer.hit ? 1 : 0;
        row.wrong += none && answer.hit ? 1 : 0;
        const std::uint64_t expected = row.engine.question == "yes/no" ? (truth.hit ? 1 : 0) : truth.count;
        if (row.engine.certified && disagreement.empty() &&
            (answer.hit != truth.hit || answer.possible != truth.possible || answer.count != expected)) {
            disagreement = concat(row.mesh, ", poses ", row.poses, ", pose ", i, ": ", row.engine.name, " ",
                                  row.engine.question, " says ", answer.count, "; expected: ", expected);
        }
    }
    return disagreement;
}

Result<void> benchPoses(const BenchRun& run) {
    const Grid& grid = run.work.volume->data.grid;
    const MeshView mesh = run.work.mesh->data.view();
    const std::uint32_t number = run.settings.number;
    VOXTACT_TRY(benchKind(run, "large", randomPoses(grid, mesh, number, run.settings.seed)));
    if (run.settings.mode == BenchMode::Outputs) {
        return {}; // at the onset of contact, hardly any passing fragment has outputs
    }
    const auto touches = touchesBy(run.engines.front(), run.work);
    return benchKind(run, "onset", onsetPoses(grid, mesh, number, run.settings.seed, touches));
}

} // namespace voxtact::lab
