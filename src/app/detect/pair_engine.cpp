// SPDX-License-Identifier: MIT
#include "app/detect/pair_engine.h"

#include "app/detect/detect_notes.h"
#include "app/output/interrupt.h"
#include "app/output/progress.h"
#include "core/base/try.h"

#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

std::vector<PairRange> volumeGroups(const PairJobs& jobs) {
    std::vector<PairRange> groups;
    for (std::uint32_t job = 0; job < jobs.jobs.size(); ++job) {
        if (job == 0 || jobs.jobs[job].volume != jobs.jobs[job - 1].volume) {
            groups.push_back({.begin = job, .end = job});
        }
        groups.back().end = job + 1;
    }
    return groups;
}

PairAsker::PairAsker(const DetectOptions& options, DetectInputs& inputs, PairEngine& engine)
    : options_(options), inputs_(inputs), engine_(engine), fit_(options, inputs) {}

Result<void> PairAsker::answer(const PairRange& range, DetectOutput& output, const std::function<void()>& progress) {
    const Result<Grid> grid = engine_.use(range.begin);
    VOXTACT_TRY(grid);
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

Result<void> PairAsker::answer(Window& window, const Grid& grid, DetectOutput& output,
                               const std::function<void()>& progress) {
    VOXTACT_TRY(selectPoses(options_, inputs_, grid, window, fit_.near()));
    fit_.look(window, grid);
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

Result<double> answerPairs(const DetectOptions& options, DetectInputs& inputs, PairEngine& engine, DetectOutput& output,
                           std::vector<std::string>& notes) {
    output.begin(engine.device(), engine.driver());
    Progress progress(options.progress, "voxtact detect: pairs", inputs.pairs(options.jobs).value_or(0));
    PairAsker asker(options, inputs, engine);
    for (const PairRange& group : volumeGroups(options.jobs)) {
        if (!interrupted()) {
            VOXTACT_TRY(asker.answer(group, output, [&] { progress.update(output.rows()); }));
        }
    }
    asker.addTo(notes);
    return asker.milliseconds();
}

} // namespace voxtact::app
