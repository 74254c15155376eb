// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/options/output_paths.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "app/plan/plan_colours.h"
#include "app/plan/plan_run.h"
#include "core/base/text.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr const char* kFooter =
    R"(An instrument goes straight from an entry to the target. There is a row for each of --entries directions from the
target along which there is an entry within the limits:
  entry,x,y,z                  number of the direction; the entry, world mm, LPS
  safe                         1 (safe): it certainly keeps more than --margin from all that is to be avoided, all the
                               way; 0 (unsafe): it certainly does not; 2 (possible): neither could be shown
  clearance_lo,clearance_hi    mm: how near it comes on its way is between them; 0 where it touches; hi is inf beyond
                               --max-clearance
  nearest,nearest_x,...        what it comes nearest to, a label's name or opaque; a point of that
  length,angle                 mm from entry to target; degrees between the path and the normal of the entries' surface
  crosses                      the labels that its axis goes through, from the entry on

A builtin needle is round and solid. A mesh needs --tip and --axis, and counts by its surface. --summary and --report
say how many paths are safe, which is the best one, and for a needle the area of the patches all of whose paths certainly
are safe, not only those of the rows.

Examples:
  voxtact plan --volume head.nii.gz --labels atlas.nii.gz --target Thalamus_L --avoid Precentral_L,Insula_L
  voxtact plan --volume head.nii.gz --labels atlas.nii.gz --target -10,20,8 --avoid 1,29 --margin 2 --entries 100000 \
      --mesh builtin:needle:1.5:180 --max-length 90 --surface entries.ply --output paths.csv)";

/// More only wait for each other.
constexpr std::uint32_t kMostThreads = 1024;

Result<void> checkPaths(const PlanOptions& options) {
    std::vector<NamedPath> inputs = inputPaths(options.volumes, options.meshes, options.transferFunction, {});
    addInput(inputs, "--avoid-volume", options.avoidVolume);
    if (!options.labels.empty()) {
        inputs.push_back({"--labels", options.labels});
        inputs.push_back({"--label-names", labelNamesPath(options.labelNames, options.labels)});
    }
    return checkOutputs(
        {{"--output", options.output.path}, {"--surface", options.surface}, {"--report", options.report}}, inputs);
}

Result<void> checkOptions(const PlanOptions& options) {
    if (options.volumes.size() > 1 || options.meshes.sources.size() > 1) {
        return badArgument(std::string(options.volumes.size() > 1 ? "--volume" : "--mesh") +
                           ": a plan is about one; leave out the others");
    }
    if (options.axis && std::hypot((*options.axis)[0], (*options.axis)[1], (*options.axis)[2]) == 0) {
        return badArgument("--axis: 0,0,0 points nowhere; it goes from the tip to where the instrument is held");
    }
    if (!options.surface.empty() && options.surface.extension() != ".ply") {
        return badArgument("--surface: the ending of '" + options.surface.string() + "' must be .ply");
    }
    if (!options.report.empty() && options.report.extension() != ".html") {
        return badArgument("--report: the ending of '" + options.report.string() + "' must be .html");
    }
    return {};
}

/// Of those that are safe the one with the largest clearance, and of these the shortest.
const PlannedPath* bestOf(const PlanAnswer& answer) {
    const PlannedPath* best = nullptr;
    for (const PlannedPath& path : answer.paths) {
        if (path.safety == Safety::Safe && (best == nullptr || isBetter(path, *best))) {
            best = &path;
        }
    }
    return best;
}

std::string tenths(double value) {
    return number(std::round(10 * value) / 10 + 0.0); // 0, not -0
}

std::vector<std::string> notesOf(const PlanInputs& inputs, const PlanAnswer& answer) {
    const auto count = [&](Safety safety) {
        return std::to_string(std::count_if(answer.paths.begin(), answer.paths.end(),
                                            [safety](const PlannedPath& path) { return path.safety == safety; }));
    };
    const std::uint32_t left = answer.noSurface + answer.tooLong + answer.tooOblique;
    std::vector<std::string> notes;
    notes.push_back("paths: " + std::to_string(answer.paths.size()) + "; safe: " + count(Safety::Safe) +
                    ", unsafe: " + count(Safety::Unsafe) + ", possible: " + count(Safety::Possible) +
                    (left == 0 ? ""
                               : "; directions that meet no surface: " + std::to_string(answer.noSurface) +
                                     ", too long: " + std::to_string(answer.tooLong) +
                                     ", too oblique: " + std::to_string(answer.tooOblique)));
    if (!inputs.task.mesh) {
        notes.push_back("every path is safe from " + tenths(answer.safeArea) + " of " + tenths(answer.area) +
                        " mm² of the entries' surface");
    }
    const PlannedPath* best = bestOf(answer);
    notes.push_back(best == nullptr
                        ? "no path is safe"
                        : "best: entry " + std::to_string(best->entry) + " at (" + tenths(best->position[0]) + ", " +
                              tenths(best->position[1]) + ", " + tenths(best->position[2]) + "), clearance at least " +
                              number(std::floor(100 * best->clearance.lo) / 100) + " mm, length " +
                              tenths(best->length) + " mm");
    return notes;
}

Outcome runPlan(const PlanOptions& options) {
    VOXTACT_TRY(checkOptions(options));
    VOXTACT_TRY(checkPaths(options));
    const InterruptGuard guard;
    const Result<std::unique_ptr<PlanInputs>> read = readPlan(options);
    VOXTACT_TRY(read);
    PlanInputs& inputs = **read;
    inputs.task.cancel = &interruptFlag();
    Result<cpu::Planner> planner =
        cpu::Planner::create({.threads = options.threads, .tolerance = options.tolerance, .maximum = options.maximum});
    VOXTACT_TRY(planner);
    const Result<PlanAnswer> answer = planner->plan(inputs.task);
    if (interrupted()) {
        return interruptOutcome("nothing is written");
    }
    VOXTACT_TRY(answer);
    const io::Table table = planTable(inputs, *answer, options.timing);
    const std::vector<std::string> notes = notesOf(inputs, *answer);
    std::vector<Delivery> deliveries;
    deliveries.push_back({options.output.path, [&](std::ostream& out) -> Result<void> {
                              io::writeTable(out, options.output.format(), table);
                              return {};
                          }});
    if (!options.surface.empty()) {
        deliveries.push_back({options.surface, [&](std::ostream& out) -> Result<void> {
                                  writePlanSurface(out, *answer, !inputs.task.mesh, options.maximum);
                                  return {};
                              }});
    }
    if (!options.report.empty()) {
        deliveries.push_back({options.report, [&](std::ostream& out) -> Result<void> {
                                  writePlanReport(out, inputs, *answer, notes, options.maximum);
                                  return {};
                              }});
    }
    VOXTACT_TRY(deliverAll(std::move(deliveries)));
    for (const std::string& note : notes) {
        if (options.summary) {
            printNote(note);
        }
    }
    return {};
}

void addVector(CLI::App& parser, const char* option, std::optional<Vec3>& value, const std::string& help) {
    addTexts(
        parser, option,
        [&value](const std::string& text) -> std::optional<std::string> {
            value = parsePoint(text);
            return value ? std::nullopt : std::optional<std::string>("is not three numbers x,y,z");
        },
        help, "x,y,z");
}

void addObstacleOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addPath(parser, "--labels", options->labels, "a label map (an image of whole numbers) on the volume's grid");
    addPath(parser, "--label-names", options->labelNames,
            "lines 'number name'; default: the label map's path without .gz, with .txt, where that file is");
    parser.add_option("--avoid", options->avoid, "labels that must not be touched, by number or name, opaque or not")
        ->delimiter(',')
        ->type_name("LABEL,...");
    parser
        .add_option("--avoid-opacity", options->avoidOpacity,
                    "what must not be touched besides: all that is opaque under this list \"v:a,v:a,...\"")
        ->type_name("LIST");
    parser.add_option("--avoid-volume", options->avoidVolume, "in this volume; default: the one of --volume")
        ->type_name("PATH");
    parser.add_option("--target", options->target, "where the tip goes: x,y,z in world mm, or a label's middle")
        ->type_name("x,y,z|LABEL")
        ->required();
    addVector(parser, "--tip", options->tip, "the tip of a mesh, in its coordinates");
    addVector(parser, "--axis", options->axis, "from the tip of a mesh to where it is held, in its coordinates");
}

void addEntryOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addWholeNumber(
        parser, "--entries", [options](std::uint32_t entries) { options->entries = entries; },
        {.least = 12, .most = kMostEntries},
        "directions from the target, evenly spread: the least 10 n^2 + 2 that is no fewer", options->entries);
    parser
        .add_option("--entry-label", options->entryLabel,
                    "entries are on the outside of this label; default: of what is opaque")
        ->type_name("LABEL");
    addNumber(
        parser, "--entry-radius", [options](double mm) { options->entryRadius = mm; },
        "entries are all so far from the target, mm", [](double mm) { return mm > 0; }, "above 0", "none");
    addNumber(
        parser, "--max-length", [options](double mm) { options->longest = mm; }, "mm: longer paths are left out",
        [](double mm) { return mm > 0; }, "above 0", "none");
    addNumber(
        parser, "--max-angle", [options](double degrees) { options->steepest = degrees; },
        "degrees between a path and the normal of the entries' surface: more are left out",
        [](double degrees) { return degrees >= 0 && degrees <= 90; }, "from 0 to 90", "none");
    addNumber(
        parser, "--margin", [options](double mm) { options->margin = mm; },
        "mm that a safe path keeps from all that is to be avoided", [](double mm) { return mm >= 0; }, "at least 0",
        "0");
    addNumber(
        parser, "--tolerance", [options](double mm) { options->tolerance = mm; },
        "mm, how near to each other clearance_lo and clearance_hi are brought", [](double mm) { return mm >= 1e-6; },
        "at least 1e-6", "0.05");
    addNumber(
        parser, "--max-clearance", [options](double mm) { options->maximum = mm; },
        "mm: what is farther from a path is not measured", [](double mm) { return mm > 0; }, "above 0", "10");
}

} // namespace

Command addPlan(CLI::App& program) {
    auto options = std::make_shared<PlanOptions>();
    options->meshes.sources = {"builtin:needle"};
    CLI::App* parser =
        program.add_subcommand("plan", "which straight paths to a target keep clear of what must not be touched");
    parser->footer(kFooter);
    addVolumeOption(*parser, options->volumes);
    addMeshOptions(*parser, options->meshes, false);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addObstacleOptions(*parser, options);
    addEntryOptions(*parser, options);
    addPath(*parser, "--surface", options->surface,
            "a .ply file for the entries and the triangles between them, in colours");
    addPath(*parser, "--report", options->report,
            "an .html file that needs no network: the notes, the entries in colours, the best paths");
    addWholeNumber(
        *parser, "--threads", [options](std::uint32_t threads) { options->threads = threads; },
        {.least = 0, .most = kMostThreads}, "0: one for each processor", 0);
    parser->add_flag("--summary", options->summary,
                     "says on standard error how many paths are safe, the area that is, and the best path");
    parser->add_flag("--timing", options->timing, "adds a last line: # entries= wall_ms= entries_per_s=");
    addOutputOptions(*parser, options->output);
    return {parser, [options] { return runPlan(*options); }};
}

} // namespace voxtact::app
