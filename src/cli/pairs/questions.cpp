// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/files/pair_files.h"
#include "cli/pairs/pair_run.h"

#include <CLI/CLI.hpp>

#include <memory>

/// Subcommands of the questions about pairs.
namespace voxtact::app {

namespace {

struct Subcommand {
    CLI::App* parser;
    std::shared_ptr<PairOptions> options;
};

/// Adds the options of the scene.
Subcommand begin(CLI::App& program, const NamedQuestion& question) {
    auto options = std::make_shared<PairOptions>(question);
    CLI::App* parser = program.add_subcommand(std::string(question.name), std::string(question.text));
    parser->footer(std::string(question.help));
    addVolumeOption(*parser, options->volumes);
    addResampleOption(*parser, options->resample);
    addMeshOptions(*parser, options->meshes);
    addPosesOptions(*parser, options->view);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addLabelOptions(*parser, options->labels);
    return {parser, std::move(options)};
}

/// Adds the options of questions that a device can answer.
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
        "maximum pairs per submission", kDefaultBatch);
    setRare(parser, "--batch");
    addShardOption(parser, options->shard);
    addOutputOptions(parser, options->output);
    parser.add_flag("--summary", options->summary, "totals and the worst pair on standard error");
    parser.add_flag("--timing", options->timing, "add gpu_ms, wall_ms and a line of totals");
    if (!options->isCount()) {
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

Command addTouch(CLI::App& program, const NamedQuestion& question) {
    const Subcommand command = begin(program, question);
    TouchOptions& touch = command.options->touch;
    addFact(*command.parser, factOf("touch", "margin"), [&touch](double mm) { touch.margin = mm; });
    addText(
        *command.parser, "--uncertainty",
        [&touch](const std::string& text) { return parseUncertainty(text, touch.uncertainty); },
        "does it touch at any pose within MM and DEG?", "MM,DEG");
    command.parser->get_option("--uncertainty")->excludes("--margin");
    command.parser->add_flag("--solid", touch.solid, std::string(factOf("touch", "solid").text));
    addEngine(command);
    return end(command);
}

Command addCount(CLI::App& program, const NamedQuestion& question) {
    const Subcommand command = begin(program, question);
    addMethodOptions(*command.parser, command.options->method);
    addTableOptions(*command.parser, command.options->transferFunction);
    addExtraOptions(*command.parser, command.options->extra);
    addCameraOptions(*command.parser, command.options->view);
    addEngine(command);
    command.parser->add_flag("--stats", command.options->stats, "append the device's counters of the certified passes");
    for (const char* rare : {"--camera", "--size", "--stats"}) {
        setRare(*command.parser, rare);
    }
    return end(command);
}

/// Adds a measuring question; its facts are its options.
Command addMeasure(CLI::App& program, const NamedQuestion& question) {
    const Subcommand command = begin(program, question);
    MeasureOptions& measure = command.options->measure;
    addSettings(*command.parser, measure.settings);
    if (hasWitness(question)) {
        addPath(*command.parser, "--witness", measure.witness, "file of witness points: .csv, .ply");
    }
    if (question.table("triangles") != nullptr) {
        addPath(*command.parser, "--triangles", measure.triangles,
                "CSV file of the area of each triangle, with bounds");
    }
    if (question.needsSolid) {
        command.parser->add_flag("--fill-holes", measure.fillHoles, "close holes of the mesh with flat triangle fans");
    }
    return end(command);
}

} // namespace

std::vector<Command> addQuestions(CLI::App& program) {
    std::vector<Command> commands;
    for (const NamedQuestion& question : namedQuestions()) {
        const auto add = question.name == "touch"    ? addTouch
                         : question.name == "count"  ? addCount
                         : question.name == "motion" ? addMotion
                         : question.measures         ? addMeasure
                                                     : nullptr; // vxt_ask() answers it, the program does not
        if (add != nullptr) {
            commands.push_back(add(program, question));
        }
    }
    return commands;
}

} // namespace voxtact::app
