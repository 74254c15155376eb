// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/pairs/pair_run.h"

#include <CLI/CLI.hpp>

#include <memory>

/// The subcommands touch, count, distance, area and overlap.
namespace voxtact::app {

namespace {

constexpr const char* kTouchFooter =
    R"(Output: pose,mesh,volume,touch,x,y,z,triangle,label
  touch     0 no, 1 yes: both proven; 2 undecided: rounding decides, or the
            deflection of STEP and IGES, whose yes is about the triangles
  x,y,z     witness point: opaque, on the triangle or within --margin of it, to
            rounding; by the host engine, without --uncertainty
  triangle  empty: with --solid, the point is inside the mesh
  label     of the label map at that point
Without --solid only the surface counts: a mesh that encloses an opaque region
does not touch it.

Examples:
  voxtact touch --volume head.nii.gz --mesh tool.stl --poses poses.txt --iso 40
  voxtact touch --volume ct.nrrd --mesh screw.stl --iso 300 --margin 2 --summary)";

constexpr const char* kCountFooter =
    R"(Output: pose,mesh,volume,touch,count,count_exact,method,projection
  touch   0 no, 1 yes, 2 undecided (certified only)
  count   passing fragments; count_exact 0: a lower bound
  then    triangles; contacts,depth; labels; min_x,...,max_z; gpu_ms,wall_ms

Example:
  voxtact count --volume ct.nrrd --mesh tool.stl --contacts contacts.ply)";

constexpr const char* kDistanceFooter =
    R"(Output: pose,mesh,volume,lower,upper; with --to also label before lower
  lower,upper   bounds of the distance from surface to opaque region, mm;
                0,0: a touch (with --to: 0 and at most --tolerance);
                inf,inf: nothing is opaque; upper inf: at least --max

Examples:
  voxtact distance --volume ct.nrrd --mesh screw.stl --poses poses.txt --iso 300
  voxtact distance --volume t1.nii --mesh probe.stl --labels aal.nii.gz --to 3)";

constexpr const char* kAreaFooter =
    R"(Output: pose,mesh,volume,lower,upper; with --in also label before lower
  lower,upper   bounds of the area of the surface that is opaque, mm^2

Examples:
  voxtact area --volume ct.nrrd --mesh cup.stl --poses poses.txt --iso 300
  voxtact area --volume ct.nrrd --mesh cup.stl --iso 300 --triangles area.csv)";

constexpr const char* kOverlapFooter =
    R"(Output: pose,mesh,volume,lower,upper,inside,solid_lower,solid_upper
  lower,upper   bounds of the opaque volume inside the closed mesh, mm^3
  inside        none, some or all of the opaque region, or undecided
  solid_...     bounds of the volume of the mesh
With --in the column label precedes lower, and inside refers to that label.
With --bands a row is the volume of the values of one band, opaque or not.

Examples:
  voxtact overlap --volume ct.nrrd --mesh screw.stl --poses poses.txt --iso 300
  voxtact overlap --volume ct.nrrd --mesh screw.stl --bands 130,250,600)";

struct Subcommand {
    CLI::App* parser;
    std::shared_ptr<PairOptions> options;
};

/// Adds the options of the scene.
Subcommand begin(CLI::App& program, Question question, const char* help, const char* footer) {
    auto options = std::make_shared<PairOptions>(question);
    CLI::App* parser = program.add_subcommand(toString(question), help);
    parser->footer(footer);
    addVolumeOption(*parser, options->volumes);
    addResampleOption(*parser, options->resample);
    addMeshOptions(*parser, options->meshes);
    addPosesOptions(*parser, options->view);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addLabelOptions(*parser, options->labels);
    return {parser, std::move(options)};
}

/// Adds the option of questions about the surface.
void addSolid(const Subcommand& command) {
    command.parser->add_flag("--solid", command.options->solid, "the inside of the closed mesh, too: what it encloses");
}

/// Adds the options of engines that may be a device.
void addEngine(const Subcommand& command) {
    addName(*command.parser, "--on", command.options->engine, {"host", "device"}, "host or device; default: host");
    addDeviceOptions(*command.parser, command.options->device);
}

/// Adds the options of the run and of the output.
Command end(const Subcommand& command) {
    CLI::App& parser = *command.parser;
    const std::shared_ptr<PairOptions> options = command.options;
    addThreadsOption(parser, options->threads);
    addWholeNumber(
        parser, "--batch", [options](std::uint32_t pairs) { options->batch = pairs; }, {.least = 1},
        "maximum pairs of a submission", kDefaultBatch);
    setRare(parser, "--batch");
    addShardOption(parser, options->shard);
    addOutputOptions(parser, options->output);
    parser.add_flag("--summary", options->summary, "totals and the worst pair on standard error");
    parser.add_flag("--timing", options->timing, "add gpu_ms, wall_ms and a line of totals");
    if (options->question != Question::Count) {
        setRare(parser, "--timing");
    }
    addProgressOption(parser, options->progress);
    return {&parser, [options] { return runPairs(*options); }};
}

std::optional<std::string> parseUncertainty(const std::string& text, std::optional<PoseTolerance>& uncertainty) {
    const std::size_t comma = text.find(',');
    const std::optional<double> mm = parseFinite(std::string_view(text).substr(0, comma));
    const std::optional<double> degrees =
        comma == std::string::npos ? std::nullopt : parseFinite(std::string_view(text).substr(comma + 1));
    if (!mm || !degrees || !isInRange(factOf("touch", "uncertainty_distance"), *mm) ||
        !isInRange(factOf("touch", "uncertainty_angle"), *degrees)) {
        return "is not MM,DEG: MM " + rangeText(factOf("touch", "uncertainty_distance")) + ", DEG " +
               rangeText(factOf("touch", "uncertainty_angle"));
    }
    uncertainty = PoseTolerance{*mm, *degrees};
    return {};
}

std::optional<std::string> parseBands(const std::string& text, std::vector<double>& limits) {
    limits.clear();
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const std::optional<double> limit = parseFinite(std::string_view(text).substr(begin, comma - begin));
        if (!limit || (!limits.empty() && *limit <= limits.back())) {
            return "is not a list of ascending numbers, as 130,250,600";
        }
        limits.push_back(*limit);
        begin = comma + 1;
    }
    return limits.size() <= kMaxBandLimits
               ? std::optional<std::string>()
               : "has " + std::to_string(limits.size()) + " limits; the maximum is " + std::to_string(kMaxBandLimits);
}

void addLabelChoice(CLI::App& parser, const char* option, std::vector<LabelWord>& labels, const char* help) {
    parser.add_option(option, labels, help)->delimiter(',')->type_name("LABEL,...");
}

} // namespace

Command addTouch(CLI::App& program) {
    const Subcommand command = begin(program, Question::Touch, "does it touch?", kTouchFooter);
    TouchOptions& touch = command.options->touch;
    addFact(*command.parser, factOf("touch", "margin"), [&touch](double mm) { touch.margin = mm; });
    addText(
        *command.parser, "--uncertainty",
        [&touch](const std::string& text) { return parseUncertainty(text, touch.uncertainty); },
        "does it touch at any pose within MM and DEG?", "MM,DEG");
    command.parser->get_option("--uncertainty")->excludes("--margin");
    addSolid(command);
    addEngine(command);
    return end(command);
}

Command addCount(CLI::App& program) {
    const Subcommand command = begin(program, Question::Count, "how many fragments pass, and where?", kCountFooter);
    addMethodOptions(*command.parser, command.options->method);
    addTableOptions(*command.parser, command.options->transferFunction);
    addExtraOptions(*command.parser, command.options->extra);
    addCameraOptions(*command.parser, command.options->view);
    addEngine(command);
    command.parser->add_flag("--stats", command.options->stats,
                             "append the counters of the certified passes on a device");
    for (const char* rare : {"--camera", "--size", "--stats"}) {
        setRare(*command.parser, rare);
    }
    return end(command);
}

Command addDistance(CLI::App& program) {
    const Subcommand command = begin(program, Question::Distance, "how near is it?", kDistanceFooter);
    MeasureOptions& measure = command.options->measure;
    measure.tolerance = *factOf("distance", "tolerance").standard;
    addFact(*command.parser, factOf("distance", "tolerance"), [&measure](double mm) { measure.tolerance = mm; });
    addFact(*command.parser, factOf("distance", "max"), [&measure](double mm) { measure.maximum = mm; });
    addPath(*command.parser, "--witness", measure.witness, "file of witness points: .csv, .ply");
    addLabelChoice(*command.parser, "--to", measure.labels, "one row per label: numbers, names, or all");
    addSolid(command);
    command.parser->add_flag("--any-opacity", measure.anyOpacity, "with --to: the whole label, opaque or not");
    return end(command);
}

Command addArea(CLI::App& program) {
    const Subcommand command = begin(program, Question::Area, "how much of the surface is inside?", kAreaFooter);
    MeasureOptions& measure = command.options->measure;
    measure.tolerance = *factOf("area", "tolerance").standard;
    addFact(*command.parser, factOf("area", "tolerance"), [&measure](double mm2) { measure.tolerance = mm2; });
    addPath(*command.parser, "--triangles", measure.triangles, "CSV file of the area of each triangle");
    addLabelChoice(*command.parser, "--in", measure.labels, "one row per label: numbers, names, or all");
    return end(command);
}

Command addOverlap(CLI::App& program) {
    const Subcommand command =
        begin(program, Question::Overlap, "how much of the opaque region is inside the mesh?", kOverlapFooter);
    MeasureOptions& measure = command.options->measure;
    measure.tolerance = *factOf("overlap", "tolerance").standard;
    addFact(*command.parser, factOf("overlap", "tolerance"), [&measure](double mm3) { measure.tolerance = mm3; });
    addText(
        *command.parser, "--bands", [&measure](const std::string& text) { return parseBands(text, measure.bands); },
        "one row per band of values: ascending limits", "V,V,...");
    addLabelChoice(*command.parser, "--in", measure.labels, "one row per label: numbers, names, or all");
    command.parser->add_flag("--fill-holes", measure.fillHoles, "close holes of the mesh by flat fans");
    return end(command);
}

} // namespace voxtact::app
