// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/compare_localize.h"
#include "app/compare_output.h"
#include "app/compare_timing.h"
#include "app/output_paths.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/standard_streams.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

constexpr const char* kFooter =
    R"(The same pairs, one mesh at many poses against one volume, by every method: verified first, then timed.

Agreement. query = atomic = subgroup on every pose, query-any hits where they do, compute = cpu on every pose bit for
bit. On --oracle poses each fragment of the device's rasteriser is compared with an oracle in double precision; one
that only one side has must be within rounding of an edge, of the volume's boundary or of the threshold. Otherwise the
exit status is 3, with the first pose and a command line that shows it again, and nothing is written.

Times, after a warm-up. wall_ms is of a batch of pairs, gpu_ms the device's part. Mode sync: each pair is submitted and
waited for alone, which is the paper's way, over all poses. Mode pipelined: a batch a submission, three in flight (cpu:
a batch a call). Poses go round, so that none is warm in a cache.

With --localize instead: which triangles touch, by the paper's two ways (an occlusion query a triangle; one a leaf of
an OBB tree that meets the volume's box, or what its bricks hold), by the fragments of one pass, and by bounds, which
miss none. The ways that look through the camera must agree, triangle by triangle; otherwise the exit status is 3.

Columns of CSV: sweep,method,mode,batch,width,height,triangles,fragments (survivors of a pair, on average),samples,
wall_ms_median,wall_ms_p10,wall_ms_p90,gpu_ms_median,pairs_per_s,fragments_per_s,voxels; then comments with what was
found.

Examples:
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel
  voxtact compare --volume head.nii.gz --mesh tool.stl --poses poses.txt --format json --output compare.json
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel --report report.html
  voxtact compare --volume builtin:head:128 --mesh builtin:scalpel --localize)";

struct Bench {
    const CompareOptions& options;
    const CompareData& data;
    const Session& session;
    const Surroundings& surroundings;
    const Subject& subject;
    Runners runners;
    Progress progress;
    std::uint64_t steps = 0;

    [[nodiscard]] std::function<void()> step() {
        return [this] { progress.update(++steps); };
    }
};

Result<void> verify(Bench& bench, CompareResult& result) {
    const Work work{&bench.subject, bench.data.poses, bench.data.view};
    Result<std::vector<NamedCounts>> counts = countAll(bench.runners, work);
    if (!counts.ok()) {
        return counts.error();
    }
    result.counts = std::move(*counts);
    result.verdicts = judgeCounts(result.counts, bench.data.poseNumbers);
    bench.step()();
    return checkFragments(bench.session, bench.options, bench.data, bench.surroundings, bench.subject, result,
                          bench.step());
}

Result<void> timeSweep(Bench& bench, Sweep sweep, CompareResult& result) {
    switch (sweep) {
    case Sweep::Batch:
        return timeBatches(bench.options, bench.runners, {&bench.subject, bench.data.poses, bench.data.view}, result,
                           bench.step());
    case Sweep::Triangles:
        return timeTriangles(bench.session, bench.options, bench.data, bench.runners, result, bench.step());
    case Sweep::Fragments:
        return timeFragments(bench.session, bench.options, bench.data, bench.subject, bench.runners, result,
                             bench.step());
    case Sweep::Voxels:
        return timeVoxels(bench.session, bench.options, bench.data, bench.subject, bench.runners, result, bench.step());
    }
    return {};
}

/// The oracle's time is that of its checks: one thread, one pose after the other.
void addOracleSeries(const CompareData& data, CompareResult& result) {
    if (!result.oracleMilliseconds) {
        return;
    }
    double fragments = 0;
    for (const FragmentCheck& check : result.fragmentChecks) {
        fragments += static_cast<double>(check.byOracle);
    }
    const auto poses = static_cast<std::uint32_t>(result.fragmentChecks.size());
    result.series.push_back({.sweep = Sweep::Batch,
                             .method = "oracle",
                             .mode = Mode::Sync,
                             .batch = 1,
                             .width = data.view.width,
                             .height = data.view.height,
                             .triangles = result.triangles,
                             .pairs = poses,
                             .fragments = fragments / poses,
                             .wall = {*result.oracleMilliseconds},
                             .gpu = {},
                             .voxels = data.volume.grid.size});
}

Result<void> compareAll(const CompareOptions& options, const CompareData& data, const Session& session,
                        CompareResult& result) {
    if (Result<void> fits = checkViewport(session, options.view.size); !fits.ok()) {
        return fits;
    }
    result.machine = describeMachine(session, data.volume.type);
    result.poseNumbers = data.poseNumbers;
    result.triangles = static_cast<std::uint32_t>(data.mesh.indices.size() / 3);
    const Result<Surroundings> surroundings =
        makeSurroundings(session, data.volume.view(), data.transferFunction(options));
    if (!surroundings.ok()) {
        return surroundings.error();
    }
    const Result<Subject> subject = makeSubject(session, data.mesh);
    if (!subject.ok()) {
        return subject.error();
    }
    Result<Runners> runners = makeRunners(session, options, *surroundings, result);
    if (!runners.ok()) {
        return runners.error();
    }
    std::uint64_t steps = 1 + std::min<std::uint64_t>(options.oraclePoses, data.poses.size());
    for (const Sweep sweep : options.sweeps) {
        steps += stepsOf(sweep, options.repeats);
    }
    Bench bench{options,
                data,
                session,
                *surroundings,
                *subject,
                std::move(*runners),
                Progress(options.progress, "voxtact compare", steps)};
    if (Result<void> verified = verify(bench, result); !verified.ok()) {
        return verified;
    }
    for (const Sweep sweep : options.sweeps) {
        if (result.firstFailure() != nullptr && !options.keepGoing) {
            break;
        }
        if (Result<void> timed = timeSweep(bench, sweep, result); !timed.ok()) {
            return timed;
        }
        if (sweep == Sweep::Batch) {
            addOracleSeries(data, result);
        }
    }
    return {};
}

Result<void> writeOutputs(const CompareOptions& options, const CompareData& data, const CompareResult& result) {
    std::vector<Delivery> deliveries{{options.output.path, [&](std::ostream& out) -> Result<void> {
                                          writeCompare(out, options, data, result);
                                          return {};
                                      }}};
    if (!options.report.empty()) {
        deliveries.push_back({options.report, [&](std::ostream& out) {
                                  return writeReport(out, ReportKind::Compare, summarize(result),
                                                     compareJson(options, data, result));
                              }});
    }
    return deliverAll(std::move(deliveries));
}

Outcome outcomeOf(const CompareOptions& options, const CLI::App& parser, const CompareResult& result) {
    const Verdict* failure = result.firstFailure();
    if (failure == nullptr) {
        return {};
    }
    const std::string again = commandLine(parser, {"--output", "--report", "--format", "--only-pose", "--sweep",
                                                   "--oracle", "--keep-going", "--progress"}) +
                              " --only-pose " + std::to_string(failure->first->pose) + " --oracle " +
                              (options.oraclePoses > 0 ? "1" : "0") + " --sweep " + failure->sweep;
    return {kExitVerify, failure->rule + ": disagreement on pose " + std::to_string(failure->first->pose) + ": " +
                             failure->first->text + "; again with: " + again};
}

Outcome runCompare(const CompareOptions& given, const CLI::App& parser) {
    if (given.localize) {
        return runLocalize(given, parser);
    }
    CompareOptions options = given;
    options.command = commandLine(parser);
    if (!options.report.empty() && !options.sweepsGiven) {
        options.sweeps.assign(kSweeps.begin(), kSweeps.end());
    }
    if (const Result<void> writable =
            checkReportPaths(options.output.path, options.report,
                             inputPaths(options.volumes, options.meshes, options.transferFunction, options.view));
        !writable.ok()) {
        return writable.error();
    }
    const Result<CompareData> data = readCompareData(options);
    if (!data.ok()) {
        return data.error();
    }
    CompareResult result;
    std::shared_ptr<const ValidationMessages> messages;
    {
        const Result<Session> session = openSession(options.device);
        if (!session.ok()) {
            return session.error();
        }
        messages = session->instance.messages();
        if (const Result<void> done = compareAll(options, *data, *session, result); !done.ok()) {
            return done.error();
        }
    }
    if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
        return invalid;
    }
    Outcome outcome = outcomeOf(options, parser, result);
    if (outcome.status != kExitDone && !options.keepGoing) {
        return outcome;
    }
    const Result<void> written = writeOutputs(options, *data, result);
    return written.ok() ? outcome : Outcome(written.error());
}

} // namespace

Command addCompare(CLI::App& program) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* parser = program.add_subcommand("compare", "the same pairs by every method: agreement and time");
    parser->footer(kFooter);
    addCompareOptions(*parser, *options);
    return {parser, [options, parser] { return runCompare(*options, *parser); }};
}

} // namespace voxtact::app
