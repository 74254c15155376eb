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
    R"(The same pairs, one mesh at many poses against one volume, by every method: verified first, then timed.

Agreement. query = atomic = subgroup on every pose, query-any hits where they do, compute = cpu on every pose bit for
bit; the two groups apart by no more than (half of cpu's count + 64 fragments). On --oracle poses each fragment of the
device's rasteriser is compared with an oracle in double precision; one that only one side has must be within rounding
of an edge, of the volume's boundary or of the threshold. Otherwise the exit status is 3, with the first pose and a
command line that shows it again, and nothing is written.

Times, after a warm-up. wall_ms is of a batch of pairs, gpu_ms the device's part. Mode sync: each pair is submitted and
waited for alone, which is the paper's way. Mode pipelined: a batch a submission, three in flight (cpu: a batch a call).
Of one mode and batch all methods take the same poses, as many as the slowest can do in its share of --time-limit
(pairs_a_sample); faster ones take them again and again. Where a batch has more pairs than there are poses, they go
round.

With --localize instead: which triangles touch, by the paper's two ways (an occlusion query a triangle; one a leaf of
an OBB tree that meets the volume's box, or what its bricks hold), by the fragments of one pass, and by bounds, which
miss none. The ways that look through the camera must agree, triangle by triangle; otherwise the exit status is 3.

Columns of CSV: sweep,method,mode,batch,width,height,triangles,fragments (survivors of a pair, on average),samples,
wall_ms_median,wall_ms_p10,wall_ms_p90,gpu_ms_median,pairs_per_s,fragments_per_s,voxels,pairs_a_sample; then comments
with what was found.

Examples:
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel
  voxtact compare --volume head.nii.gz --mesh tool.stl --poses poses.txt --format json --output compare.json
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel --report report.html
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
    return {kExitVerify, disagreementOf(*failure) + "; again with: " + again};
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
    CLI::App* parser = program.add_subcommand("compare", "the same pairs by every method: agreement and time");
    parser->footer(kCompareFooter);
    addCompareOptions(*parser, *options);
    return {parser, [options, parser] { return runCompare(*options, *parser); }};
}

} // namespace voxtact::app
