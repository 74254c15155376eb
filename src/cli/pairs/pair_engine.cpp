// SPDX-License-Identifier: MIT
#include "cli/pairs/pair_engine.h"

#include "cli/output/interrupt.h"
#include "cli/output/progress.h"
#include "cli/pairs/fit_notes.h"
#include "core/base/try.h"

#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

std::vector<PairRange> volumeGroups(const PairOptions& options, const PairInputs& inputs) {
    const std::vector<Job>& jobs = options.jobs.jobs;
    std::vector<PairRange> groups;
    for (std::uint32_t job = 0; job < jobs.size(); ++job) {
        if (job == 0 || jobs[job].volume != jobs[job - 1].volume) {
            groups.push_back({.begin = job, .end = job});
        }
        groups.back().end = job + 1;
    }
    if (!options.shard.isPart()) {
        return groups;
    }
    const auto [first, end] = options.shard.range(inputs.pairs(options.jobs).value_or(0));
    std::uint64_t before = 0;
    for (PairRange& group : groups) {
        std::uint64_t pairs = 0;
        for (std::uint32_t job = group.begin; job < group.end; ++job) {
            pairs += inputs.poses->count().value_or(0);
        }
        group.first = std::clamp(first, before, before + pairs) - before;
        group.count = std::clamp(end, before, before + pairs) - before - group.first;
        before += pairs;
    }
    std::erase_if(groups, [](const PairRange& group) { return group.count == 0; });
    return groups;
}

PairAsker::PairAsker(const PairOptions& options, PairInputs& inputs, PairEngine& engine)
    : options_(options), inputs_(inputs), engine_(engine), fit_(options, inputs) {}

Result<void> PairAsker::answer(const PairRange& range, PairOutput& output, const std::function<void()>& progress) {
    const Result<Grid> grid = engine_.use(range.begin);
    VOXTACT_TRY(grid);
    inputs_.isResampled[options_.jobs.jobs[range.begin].volume] = engine_.isResampled() ? 1 : 0;
    PairWindows windows(options_, inputs_, range);
    Window window;
    while (!interrupted()) {
        if (const Result<void> read = windows.next(window); !read.ok()) {
            return interrupted() ? Result<void>() : read.error();
        }
        if (window.pairs == 0) {
            break;
        }
        VOXTACT_TRY(answer(window, *grid, output, progress));
    }
    return {};
}

Result<void> PairAsker::answer(Window& window, const Grid& grid, PairOutput& output,
                               const std::function<void()>& progress) {
    VOXTACT_TRY(selectPoses(options_, inputs_, grid, window, fit_.near()));
    fit_.look(window, grid, engine_.opaque());
    WindowRows rows(options_, window, engine_.untouched(), output);
    const auto begun = Clock::now();
    const Result<void> answered = engine_.answer(window, rows, [&] {
        progress();
        return interrupted() || !rows.written().ok();
    });
    milliseconds_ += std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
    VOXTACT_TRY(answered);
    if (!interrupted()) {
        rows.endWindow();
    }
    fit_.lookAtAnswers(rows.rows());
    VOXTACT_TRY(rows.written());
    progress();
    return {};
}

Result<double> answerPairs(const PairOptions& options, PairInputs& inputs, PairEngine& engine, PairOutput& output,
                           std::vector<std::string>& notes) {
    output.begin(engine.device(), engine.driver());
    const auto [first, end] = options.shard.range(inputs.pairs(options.jobs).value_or(0));
    Progress progress(options.progress, ("voxtact " + std::string(options.question.name) + ": pairs").c_str(),
                      end - first);
    PairAsker asker(options, inputs, engine);
    for (const PairRange& group : volumeGroups(options, inputs)) {
        if (!interrupted()) {
            VOXTACT_TRY(asker.answer(group, output, [&] { progress.update(output.rows()); }));
        }
    }
    asker.addTo(notes);
    return asker.milliseconds();
}

} // namespace voxtact::app
