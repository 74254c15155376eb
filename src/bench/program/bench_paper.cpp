// SPDX-License-Identifier: MIT
#include "bench/paper/paper.h"
#include "bench/program/bench.h"
#include "bench/program/lab_run.h"
#include "bench/report/report.h"
#include "core/base/try.h"

#include <nlohmann/json.hpp>

namespace voxtact::app {

using namespace lab;

namespace {

Result<void> writeOutputs(const BenchOptions& options, const PaperResult& result) {
    std::vector<Delivery> deliveries{{options.output.path, [&](std::ostream& out) -> Result<void> {
                                          writePaper(out, options.output.format(), result);
                                          return {};
                                      }}};
    if (!options.report.empty()) {
        deliveries.push_back({options.report, [&](std::ostream& out) -> Result<void> {
                                  writeReport(out, "voxtact bench --paper: the paper's measurements, repeated",
                                              paperJson(result));
                                  return {};
                              }});
    }
    return deliverAll(std::move(deliveries));
}

} // namespace

Outcome runPaper(const BenchOptions& options, const CLI::App& parser) {
    PaperSettings settings = options.paperSettings;
    settings.load = loaders();
    if (const Result<void> usable =
            checkReportPaths(options.output.path, options.report,
                             {{"--data", settings.data / "volumes"}, {"--data", settings.data / "meshes"}});
        !usable.ok()) {
        return usable.error();
    }
    PaperResult result;
    result.machine.provenance = provenanceOf(parser);
    const auto measure = [&](const device::Session& session) {
        ShownSteps shown(options.progress, "voxtact bench");
        return measurePaper(settings, session, shown.steps(), result);
    };
    if (Outcome failed = measureOn(options.device, measure); failed.status != kExitDone) {
        return failed;
    }
    if (!result.disagreement.empty()) {
        return {kExitVerify, "methods disagree: " + result.disagreement};
    }
    const Result<void> written = writeOutputs(options, result);
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace voxtact::app
