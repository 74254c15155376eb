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

/// Consecutive jobs with the volume of the first.
std::uint32_t endOfGroup(const PairJobs& jobs, std::uint32_t begin) {
    std::uint32_t end = begin + 1;
    while (end < jobs.jobs.size() && jobs.jobs[end].volume == jobs.jobs[begin].volume) {
        ++end;
    }
    return end;
}

} // namespace

Result<double> answerPairs(const DetectOptions& options, DetectInputs& inputs, PairEngine& engine, DetectOutput& output,
                           std::vector<std::string>& notes) {
    const PairJobs& jobs = options.jobs;
    output.begin(engine.device(), engine.driver());
    Progress progress(options.progress, "voxtact detect: pairs", inputs.pairs(jobs).value_or(0));
    FitNotes fit(options, inputs);
    double milliseconds = 0;
    for (std::uint32_t begin = 0, end = 0; begin < jobs.jobs.size() && !interrupted(); begin = end) {
        end = endOfGroup(jobs, begin);
        const Result<Grid> grid = engine.use(begin);
        VOXTACT_TRY(grid);
        PairWindows windows(options, inputs, begin, end);
        Window window;
        while (!interrupted()) {
            if (const Result<void> read = windows.next(window); !read.ok()) {
                return interrupted() ? Result<double>(milliseconds) : read.error();
            }
            if (window.pairs == 0) {
                break;
            }
            VOXTACT_TRY(selectPoses(options, inputs, *grid, window, fit.near()));
            fit.look(window, *grid);
            WindowRows rows(options, window, engine.untouched(), output);
            const auto begun = Clock::now();
            const Result<void> answered = engine.answer(window, rows, [&] {
                progress.update(output.rows());
                return interrupted() || !rows.written().ok();
            });
            milliseconds += std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
            VOXTACT_TRY(answered);
            if (!interrupted()) {
                rows.endWindow();
            }
            if (!rows.written().ok()) {
                return rows.written().error();
            }
            progress.update(output.rows());
        }
    }
    fit.addTo(notes);
    return milliseconds;
}

} // namespace voxtact::app
