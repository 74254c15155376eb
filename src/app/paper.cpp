// SPDX-License-Identifier: MIT
#include "app/paper.h"

#include "app/paper_output.h"
#include "app/paper_sweeps.h"
#include "app/paper_tables.h"
#include "app/progress.h"
#include "app/report.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

void addNotes(const BenchOptions& options, PaperResult& result) {
    result.notes.emplace_back(
        "recording is in none of the times; collision: the detection of one pair, alone; "
        "overhead: of a frame with the detection in it against one without, round by round; a round "
        "has one frame without it for all methods");
    result.notes.emplace_back("mesh and volume are times of the GPU only; cpu detects while the picture is made, which "
                              "the wall clock alone tells");
    // More samples never have less of an interval, and there may be more than the memory holds at once.
    constexpr std::uint32_t kEnough = 100;
    if (!medianInterval(std::vector<double>(std::min(options.repetitions, kEnough)), kConfidence)) {
        result.notes.emplace_back("the overhead has no interval: its median is known with a confidence of 95 % from 6 "
                                  "--repetitions on");
    }
    if (options.scale > 1) {
        result.notes.emplace_back("--scale " + std::to_string(options.scale) +
                                  ": the volumes are smaller than the paper's, and the times are not to be compared");
    }
}

Result<void> measureAll(const BenchOptions& options, const Session& session, PaperResult& result) {
    if (Result<void> fits = checkViewport(session, options.size); !fits.ok()) {
        return fits;
    }
    const Result<std::vector<PaperInput>> inputs = loadPaperScenes(options);
    if (!inputs.ok()) {
        return inputs.error();
    }
    result.machine = describeMachine(session, inputs->front().data.volume.type);
    result.width = options.size.width;
    result.height = options.size.height;
    addNotes(options, result);
    const std::uint64_t steps =
        inputs->size() * paperSceneSteps(options) + (options.noSweeps ? 0 : paperSweepSteps(options));
    Progress progress(options.progress, "voxtact bench", steps);
    std::uint64_t done = 0;
    const std::function<void()> step = [&] { progress.update(++done); };
    for (const PaperInput& input : *inputs) {
        Result<void> measured = measurePaperScene(session, options, input, result, step);
        if (!measured.ok() || !result.disagreement.empty()) {
            return measured;
        }
    }
    return options.noSweeps ? Result<void>() : runPaperSweeps(session, options, inputs->front().data, result, step);
}

Result<void> writeOutputs(const BenchOptions& options, const PaperResult& result) {
    std::vector<Delivery> deliveries{{options.output.path, [&](std::ostream& out) -> Result<void> {
                                          writePaper(out, options, result);
                                          return {};
                                      }}};
    if (!options.report.empty()) {
        deliveries.push_back({options.report, [&](std::ostream& out) {
                                  return writeReport(out, ReportKind::Paper, paperSummary(result),
                                                     paperJson(options, result));
                              }});
    }
    return deliverAll(std::move(deliveries));
}

} // namespace

Outcome runPaper(const BenchOptions& options) {
    if (const Result<void> usable =
            checkReportPaths(options.output.path, options.report,
                             {{"--data", options.data / "volumes"}, {"--data", options.data / "meshes"}});
        !usable.ok()) {
        return usable.error();
    }
    PaperResult result;
    std::shared_ptr<const ValidationMessages> messages;
    {
        const Result<Session> session = openSession(options.device);
        if (!session.ok()) {
            return session.error();
        }
        messages = session->instance.messages();
        if (const Result<void> done = measureAll(options, *session, result); !done.ok()) {
            return done.error();
        }
    }
    if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
        return invalid;
    }
    if (!result.disagreement.empty()) {
        return {kExitVerify, "methods that must agree do not: " + result.disagreement};
    }
    const Result<void> written = writeOutputs(options, result);
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace voxtact::app
