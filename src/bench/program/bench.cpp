// SPDX-License-Identifier: MIT
#include "bench/program/bench.h"

#include "bench/program/lab_run.h"
#include "cli/make/poses.h"
#include "core/base/try.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

namespace voxtact::app {

using namespace lab;

namespace {

constexpr const char* kBenchFooter =
    R"(Compares engines on one scene in one run: verifies their answers, then times
them in turn. Exit status 3: the engines disagree. docs/lab.md describes the
measurements and their columns.

Examples:
  voxtact bench --certified
  voxtact bench --latency --format text
  voxtact bench --paper --format text
  voxtact bench --certified --volume head.nii.gz --mesh tool.stl --format json)";

struct ModeFlag {
    const char* name;
    std::optional<BenchMode> mode; ///< none: --paper
    const char* help;
};
constexpr std::array<ModeFlag, 5> kModes{{
    {"--certified", BenchMode::Certified, "certified touches and counts"},
    {"--outputs", BenchMode::Outputs, "cost of each projection and output"},
    {"--latency", BenchMode::Latency, "latency of one pair"},
    {"--batches", BenchMode::Batches, "cost of a batch, by batch size"},
    {"--paper", std::nullopt, "the paper's tables and sweeps; default"},
}};

void addPaperOptions(CLI::App& parser, BenchOptions& options) {
    addPath(parser, "--data", options.paperSettings.data,
            "--paper: folder with files of its scenes; default: builtins");
    addWholeNumber(
        parser, "--scale", [&options](std::uint32_t scale) { options.paperSettings.scale = scale; },
        {.least = 1, .most = 16}, "--paper: divisor of the sides of its builtin volumes, for trials",
        options.paperSettings.scale);
    addTimeLimit(parser, options.paperSettings.timeLimit,
                 "time for all samples, seconds; may reduce their number; with --latency or --batches 60");
    parser.add_flag("--no-sweeps", options.paperSettings.noSweeps, "--paper: tables only");
    addSize(
        parser, [&options](const VkExtent2D& size) { options.paperSettings.size = size; }, "--paper: frames, pixels");
    addPath(parser, "--report", options.report, "--paper: HTML page of tables");
}

void addOptions(CLI::App& parser, BenchOptions& options) {
    for (const ModeFlag& flag : kModes) {
        CLI::Option* const added = parser.add_flag(flag.name, flag.help);
        for (const ModeFlag* other = kModes.data(); other != &flag; ++other) {
            added->excludes(other->name);
        }
    }
    addVolumeOption(parser, options.volumes);
    parser.get_option("--volume")->required(false);
    addMeshOptions(parser, options.meshes);
    parser.get_option("--mesh")->required(false);
    addTransferFunctionOptions(parser, options.transferFunction);
    addTableOptions(parser, options.transferFunction);
    addWholeNumber(
        parser, "--number", [&options](std::uint32_t number) { options.settings.number = number; },
        {.least = 1, .most = kMostPoses},
        "poses per kind; --paper 7; --latency: ticks, 10000; --batches: largest batch, 100000",
        options.settings.number);
    addSeed(parser, options.settings.seed);
    addWholeNumber(parser, "--repetitions", options.settings.repetitions, 1, "samples per time; --batches 3");
    addPaperOptions(parser, options);
    addDeviceOptions(parser, options.device);
    addOutputOptions(parser, options.output);
    addProgressOption(parser, options.progress);
    for (const char* rare : {"--seed", "--data", "--scale", "--time-limit", "--no-sweeps", "--size"}) {
        setRare(parser, rare);
    }
}

/// Refuses options without effect in the mode.
Result<void> checkTogether(const BenchOptions& options, const CLI::App& parser) {
    constexpr const char* kOfScenes[] = {
        "--volume",  "--mesh",      "--mesh-space", "--mesh-scale",       "--transfer-function",
        "--opacity", "--tf-domain", "--tf-size",    "--opacity-threshold"};
    constexpr const char* kOfPaper[] = {"--data", "--scale", "--no-sweeps", "--size", "--report"};
    const bool paper = !options.mode;
    const bool latency = options.mode == BenchMode::Latency;
    for (const char* option : paper ? std::span<const char* const>(kOfScenes) : kOfPaper) {
        if (parser.count(option) > 0) {
            return badArgument(paper ? std::string("--paper has its own scenes; leave out ") + option +
                                           ", or add --certified, --outputs, --latency or --batches"
                                     : std::string(option) + " needs --paper");
        }
    }
    if (parser.count("--time-limit") > 0 && !paper && !latency && options.mode != BenchMode::Batches) {
        return badArgument("--time-limit needs --paper, --latency or --batches");
    }
    if (parser.count("--repetitions") > 0 && latency) {
        return badArgument("--repetitions: not with --latency; use --number for the number of ticks");
    }
    if (options.paperSettings.scale > 1 && !options.paperSettings.data.empty()) {
        return badArgument("--scale needs builtin volumes; leave out --data");
    }
    return {};
}

Outcome runBench(const BenchOptions& given, const CLI::App& parser) {
    BenchOptions options = given;
    const auto* const asked =
        std::ranges::find_if(kModes, [&](const ModeFlag& flag) { return parser.count(flag.name) > 0; });
    options.mode = asked == kModes.end() ? std::nullopt : asked->mode;
    VOXTACT_TRY(checkTogether(options, parser));
    const auto take = [&parser](const char* option, auto from, auto& to) { to = parser.count(option) > 0 ? from : to; };
    if (!options.mode) {
        take("--number", options.settings.number, options.paperSettings.poses);
        take("--repetitions", options.settings.repetitions, options.paperSettings.repetitions);
        options.paperSettings.seed = options.settings.seed;
        return runPaper(options, parser);
    }
    const BenchDefaults defaults = defaultsOf(*options.mode);
    options.settings = {.mode = *options.mode,
                        .number = defaults.number,
                        .seed = given.settings.seed,
                        .repetitions = defaults.repetitions};
    take("--number", given.settings.number, options.settings.number);
    take("--repetitions", given.settings.repetitions, options.settings.repetitions);
    take("--time-limit", given.paperSettings.timeLimit, options.settings.timeLimit);
    return runBenchEngines(options, parser);
}

} // namespace

Command addBench(CLI::App& program) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App* parser = program.add_subcommand("bench", "verify and time the engines");
    parser->footer(kBenchFooter);
    addOptions(*parser, *options);
    return {parser, [options, parser] { return runBench(*options, *parser); }};
}

} // namespace voxtact::app
