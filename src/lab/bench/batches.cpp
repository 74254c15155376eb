// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "lab/bench/parts.h"
#include "lab/measure/numbers.h"
#include "lab/measure/poses.h"

#include <algorithm>

namespace voxtact::lab {

namespace {

/// One size, by every engine that is still `alive`; those for which the next would take longer than `longest` ms end,
/// and all where the host would take longer than `mostLearning` ms to say what must be answered.
Result<void> measureSize(const BenchRun& run, KnownPoses& poses, std::vector<const Engine*>& alive, std::uint32_t batch,
                         double longest, double mostLearning) {
    if (alive.empty()) {
        return {};
    }
    VOXTACT_TRY(poses.learn(batch));
    std::vector<BenchRow>& rows = run.result.rows;
    const std::size_t firstRow = rows.size();
    std::vector<Timed> things;
    for (const Engine* const engine : alive) {
        const std::size_t row = run.addRow(*engine, "", batch);
        things.push_back(
            {.take = [&, engine, row](const Turn& turn) { return poses.take(*engine, 0, turn.round > 0, rows[row]); }});
    }
    VOXTACT_TRY(run.time(things, {.repeats = run.settings.repetitions, .warmUp = true}));
    if (run.result.disagreement.empty()) {
        std::size_t row = firstRow;
        std::erase_if(alive, [&](const Engine*) {
            return 10 * medianOf(rows[row++].wall) > longest || 10 * poses.learning() > mostLearning;
        });
    }
    return {};
}

/// A note for each engine that ended early: which batches it had no time for.
void noteEnded(const BenchRun& run) {
    for (const Engine& engine : run.engines) {
        std::uint64_t largest = 0;
        for (const BenchRow& row : run.result.rows) {
            const EngineFacts& facts = row.engine;
            const bool own = facts.name == engine.facts.name && facts.projection == engine.facts.projection &&
                             facts.question == engine.facts.question && facts.posesOn == engine.facts.posesOn;
            largest = own ? std::max(largest, row.pairs) : largest;
        }
        if (largest < run.settings.number) {
            run.result.notes.push_back(engine.facts.name + " " + engine.facts.projection + " " + engine.facts.question +
                                       (engine.facts.posesOn == "device" ? ", poses on the device" : "") +
                                       ": batches of more than " + std::to_string(largest) +
                                       (largest == 1 ? " pose" : " poses") +
                                       " are left out, as they do not fit in --time-limit");
        }
    }
}

} // namespace

std::vector<std::uint32_t> batchSizes(std::uint32_t most) {
    std::vector<std::uint32_t> sizes;
    for (std::uint64_t size = 1; size < most; size *= 10) {
        sizes.push_back(static_cast<std::uint32_t>(size));
    }
    sizes.push_back(most);
    return sizes;
}

Result<void> benchBatches(const BenchRun& run) {
    KnownPoses poses(run,
                     asFloats(randomPoses(run.work.volume->data.grid, run.work.mesh->data.view(), run.settings.number,
                                          run.settings.seed)),
                     run.engines[0], run.engines[1]);
    // The largest batch, its warm-up and what is smaller: a ninth more.
    const double mostLearning = run.limit / 4;
    const double longest =
        (run.limit - mostLearning) / (1.2 * (run.settings.repetitions + 1) * static_cast<double>(run.engines.size()));
    std::vector<const Engine*> alive;
    std::ranges::transform(run.engines, std::back_inserter(alive), [](const Engine& engine) { return &engine; });
    for (const std::uint32_t batch : batchSizes(run.settings.number)) {
        if (run.result.disagreement.empty()) {
            VOXTACT_TRY(measureSize(run, poses, alive, batch, longest, mostLearning));
        }
        run.step();
    }
    // After a disagreement nothing more is measured.
    std::erase_if(run.result.rows, [](const BenchRow& row) { return row.wall.empty(); });
    if (run.result.disagreement.empty()) {
        noteEnded(run);
    }
    return {};
}

} // namespace voxtact::lab
