// SPDX-License-Identifier: MIT
#include "bench/compare/compare.h"
#include "bench/compare/output.h"
#include "bench/program/bench.h"
#include "bench/program/compare_inputs.h"
#include "bench/program/lab_run.h"
#include "bench/report/report.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace voxtact::app {

using namespace lab;

namespace {

constexpr const char* kCompareFooter =
    R"(Counts the pairs by every method, verifies the counts, then times the methods.
Exit status 3: the methods disagree; the error has a command that reproduces it.
docs/lab.md describes the rules, the times and the columns.

Examples:
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel
  voxtact compare --volume head.nii.gz --mesh tool.stl --poses poses.txt \
      --format json --output compare.json
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel --localize)";

Result<void> writeOutputs(const CompareOptions& options, const lab::Scene& scene, const CompareResult& result) {
    std::vector<Delivery> deliveries{{options.output.path, [&](std::ostream& out) -> Result<void> {
                                          writeOutput(out, options.output.format(), compareOutput(scene, result));
                                          return {};
                                      }}};
    if (!options.report.empty()) {
        deliveries.push_back({options.report, [&](std::ostream& out) -> Result<void> {
                                  writeReport(out, "voxtact compare: the same pairs by every method",
                                              jsonOf(compareOutput(scene, result)));
                                  return {};
                              }});
    }
    return deliverAll(std::move(deliveries));
}

Outcome outcomeOf(const CompareOptions& options, const CLI::App& parser, const CompareResult& result) {
    const CompareVerdict* failure = result.firstFailure();
    if (failure == nullptr) {
        return {};
    }
    const std::string again = commandLine(parser, {"--output", "--report", "--format", "--only-pose", "--sweep",
                                                   "--oracle", "--keep-going", "--progress"}) +
                              " --only-pose " + std::to_string(failure->first->pose) + " --oracle " +
                              (options.settings.oraclePoses > 0 ? "1" : "0") + " --sweep " + failure->sweep;
    return {kExitVerify, disagreementOf(*failure) + "; reproduce with: " + again};
}

Outcome runCompare(const CompareOptions& given, const CLI::App& parser) {
    if (given.localize) {
        return runLocalize(given, parser);
    }
    CompareOptions options = given;
    options.settings.load = loaders();
    if (!options.report.empty() && !options.sweepsGiven) {
        options.settings.sweeps.assign(kSweeps.begin(), kSweeps.end());
    }
    if (const Result<void> writable =
            checkReportPaths(options.output.path, options.report,
                             inputPaths(options.volumes, options.meshes, options.transferFunction, options.view));
        !writable.ok()) {
        return writable.error();
    }
    const Result<lab::Scene> scene = readScene(options);
    VOXTACT_TRY(scene);
    CompareResult result;
    const auto measure = [&](const device::Session& session) {
        const DeviceStay stay(*scene);
        result.machine = describeMachine(session, scene->volume->data.type, provenanceOf(parser));
        ShownSteps shown(options.progress, "voxtact compare");
        return compare(options.settings, *scene, session, shown.steps(), result);
    };
    if (Outcome failed = measureOn(options.device, measure); failed.status != kExitDone) {
        return failed;
    }
    Outcome outcome = outcomeOf(options, parser, result);
    if (outcome.status != kExitDone && !options.settings.keepGoing) {
        return outcome;
    }
    const Result<void> written = writeOutputs(options, *scene, result);
    return written.ok() ? outcome : Outcome(written.error());
}

} // namespace

Command addCompare(CLI::App& program) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* parser = program.add_subcommand("compare", "verify and time the counting methods");
    parser->footer(kCompareFooter);
    addCompareOptions(*parser, *options);
    return {parser, [options, parser] { return runCompare(*options, *parser); }};
}

} // namespace voxtact::app
