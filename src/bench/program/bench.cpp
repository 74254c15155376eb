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
    R"(Measurements that compare engines on one scene in one run. The answers of every engine are checked before it is
timed; rounds take a sample of every engine in turn, so that what else the machine does falls on all alike.

--certified: does the mesh touch, and how much, by the projection certified, which misses no contact: the host on one
thread and on all, the device's compute path, and with them the projection view and FCL (a mesh against an octree of
the opaque voxels; where it is built in), with the share of certified contacts that each misses and of the poses that
certainly do not touch and that it reports as contacts. Poses at large, and poses around the onset of contact, from 0.75
voxels inside to 0.25 outside. Default scene: builtin:scalpel:3068 and builtin:ellipsoid:49998 against builtin:head:256
with --opacity "40:0,80:1". Exit status 3 when engines that must agree do not.

--outputs: what each projection costs compared with the view, by the host and by the methods of the device, and what
each of the outputs (touched triangles, bounds, labels, contacts) costs compared with the bare count of the same method
and projection. Labels are of a map with a label for each octant of the volume. The counts with an output must be those
without. Default scene: builtin:scalpel:3068 against builtin:head:128.

--latency: how long a loop that moves a mesh, such as one that drives a haptic device, waits for one answer: 10000 ticks
(--number) of strokes from 10 voxels outside to 2 voxels inside and on to the next place, one pair per tick. The
certified yes or no and count, and the count in the view, by the host on one thread and on all, and by every method of
the device: its command buffer is recorded each tick, that of compute also once, with the pose in mapped memory; it is
submitted alone, and polled for or waited for; nothing is allocated and no timestamp written. Poses are rounded to
floats. In addition an empty submission on the same queue. The answer of every tick is held against the host's after its
clock has stopped: certified ones and those of compute must be it, those of the rasteriser must be each other's and
differ from it by roundings alone (by no more than half and 64 fragments). A wrong one ends the measurement with exit
status 3; what was measured before is still written. Engines take turns of 250 ticks, after 10 that are not timed. An
engine takes fewer ticks where its share of --time-limit (60 s, of all) is used up. Default scene: builtin:scalpel:3068
against builtin:head:256 with --opacity "40:0,80:1".

--batches: what a batch costs by its size: random poses, 1, 10, 100 and so on up to 100000 (--number) in a submission
that is waited for, or in a call of the host; the certified yes or no, and the count in the view. The answers of every
batch are held against the host's as with --latency. It takes 3 samples of each (--repetitions), and leaves
out batches that do not fit in --time-limit (60 s). The default scene is that of --latency.

--paper, the default: the tables of the paper (Volume-Surface Collision Detection, Tables 1 and 2) measured again: what
detection adds to a frame, in the scenes v1s1, v1s2, v2s1 and v2s2. v1 is a head of 256x256x256 voxels, v2 a sparse
volume of 256x256x128, s1 an instrument of 3068 triangles, s2 a body of 49998; every pose touches. The frame is of
--size, from the front: the mesh in the volume by ray casting and, with detection, one pair by one method in the same
submission. The counts of every method are checked before frames are timed, and in them. Then the sweeps: times against
the volume's size, the triangles, the viewport and the pairs in a batch, as voxtact compare takes them; which triangles
touch, by one query a polygon and by better ways; and the making of the pre-integrated table. --data DIR: a folder with
any of volumes/mrhead_256.nii.gz, volumes/bonsai_256x256x128.nrrd and meshes/armadillo_49998.ply, which then stand for
v1, v2 and s2; else builtins do, with transfer functions that make as many of their voxels opaque. It needs a device, and
takes 7 poses and, as far as they fit in --time-limit, 7 repetitions unless told otherwise.

Columns of CSV: mesh,triangles,poses,engine,projection,question,threads,pairs,contacts,missed_percent,false_percent,
samples,pairs_per_s,pairs_per_s_min,pairs_per_s_max,pairs_per_cpu_s,pairs_per_cpu_s_min,pairs_per_cpu_s_max,wall_ratio,
wall_ratio_min,wall_ratio_max,cpu_ratio,cpu_ratio_min,cpu_ratio_max,no_contacts,possible; medians, and of the ratios of
pairs per second to the first engine of the same scene in the same round (--outputs: projections to the view by the same
method, outputs to the bare count). With --latency:
mesh,triangles,engine,projection,question,threads,recorded,awaited,ticks,touching (ticks that do),rounding (ticks that
the device's rasteriser counts otherwise than cpu),p50_us,p99_us (from 100 ticks on),p99_9_us (from 1000
on),max_us,record_p50_us (of it, recording). With --batches:
mesh,triangles,engine,projection,question,threads,poses_on,batch,samples,rounding,wall_ms_median,wall_ms_min,
wall_ms_max,gpu_ms_median,pairs_per_s. With --paper: scene,method,clock (gpu or wall),width,height,triangles,poses,
survivors (of a pair, on average; empty where a method does not count),hits (poses),samples,mesh_ms,volume_ms,
collision_ms,collision_ms_p10,collision_ms_p90,rendering_ms,rendering_ms_p10,rendering_ms_p90,total_ms,total_ms_p10,total_ms_p90,collision_percent (collision/rendering),
overhead_percent ((total-rendering)/rendering, round by round),overhead_low,overhead_high,confidence (of the interval
that has the median); the scenes and what else was measured are in comments.

Examples:
  voxtact bench --certified
  voxtact bench --outputs --repetitions 3
  voxtact bench --latency --format text
  voxtact bench --batches --number 10000
  voxtact bench --paper --format text
  voxtact bench --certified --volume head.nii.gz --mesh tool.stl --format json --output bench.json)";

struct ModeFlag {
    const char* name;
    std::optional<BenchMode> mode; ///< none: --paper
    const char* help;
};
constexpr std::array<ModeFlag, 5> kModes{{
    {"--certified", BenchMode::Certified, "yes or no, and counts, that miss no contact"},
    {"--outputs", BenchMode::Outputs, "what each projection and each output costs compared with the bare count"},
    {"--latency", BenchMode::Latency, "one pair, now: how long a loop waits for each answer"},
    {"--batches", BenchMode::Batches, "what a batch costs by how many pairs it has"},
    {"--paper", std::nullopt,
     "the paper's tables and sweeps, measured again: what detection adds to a frame; the default"},
}};

void addPaperOptions(CLI::App& parser, BenchOptions& options) {
    addPath(parser, "--data", options.paperSettings.data,
            "with --paper: a folder with files of its scenes; default: builtins");
    addWholeNumber(
        parser, "--scale", [&options](std::uint32_t scale) { options.paperSettings.scale = scale; },
        {.least = 1, .most = 16}, "with --paper: the sides of its builtin volumes are divided by so many, for trying",
        options.paperSettings.scale);
    addTimeLimit(
        parser, options.paperSettings.timeLimit,
        "with --paper: seconds for all samples: fewer than --repetitions are taken where they do not fit; with "
        "--latency or --batches, 60 unless given: fewer ticks or batches");
    parser.add_flag("--no-sweeps", options.paperSettings.noSweeps, "with --paper: the tables alone");
    addSize(
        parser, [&options](const VkExtent2D& size) { options.paperSettings.size = size; },
        "with --paper: of frames, in pixels");
    addPath(parser, "--report", options.report, "with --paper: an HTML page of tables, in one file");
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
        "how many poses of each kind; with --paper 7; with --latency ticks, 10000; with --batches of the largest, "
        "100000",
        options.settings.number);
    addSeed(parser, options.settings.seed);
    addWholeNumber(parser, "--repetitions", options.settings.repetitions, 1,
                   "samples of each time, after a warm-up; with --paper 7, with --batches 3");
    addPaperOptions(parser, options);
    addDeviceOptions(parser, options.device);
    addOutputOptions(parser, options.output);
    addProgressOption(parser, options.progress);
}

/// Options that the mode has no use for are refused: they would silently do nothing.
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
                                           ", or ask for --certified, --outputs, --latency or --batches"
                                     : std::string(option) + " is for --paper");
        }
    }
    if (parser.count("--time-limit") > 0 && !paper && !latency && options.mode != BenchMode::Batches) {
        return badArgument("--time-limit is for --paper, --latency and --batches");
    }
    if (parser.count("--repetitions") > 0 && latency) {
        return badArgument("--repetitions is not for --latency; --number says how many ticks there are");
    }
    if (options.paperSettings.scale > 1 && !options.paperSettings.data.empty()) {
        return badArgument("--scale is for builtin volumes; leave out --data");
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
    CLI::App* parser = program.add_subcommand("bench", "measurements: engines side by side, checked and timed");
    parser->footer(kBenchFooter);
    addOptions(*parser, *options);
    return {parser, [options, parser] { return runBench(*options, *parser); }};
}

} // namespace voxtact::app
