// SPDX-License-Identifier: MIT
#include "app/bench.h"

#include "app/commands.h"
#include "app/compare_options.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

constexpr const char* kFooter =
    R"(Measurements that compare engines on one scene in one run. The answers of every engine are checked before it is
timed; rounds take a sample of every engine in turn, so that what else the machine does falls on all alike.

--certified: does the mesh touch, and how much, by the projection conservative, which misses no contact: the host on
one thread and on all, the device's compute path, and beside them the projection view and FCL (a mesh against an octree
of the opaque voxels; where it is built in), with the share of certified contacts that each misses and of certified
misses that it calls contacts. Poses at large, and poses around the onset of contact, from 0.75 voxels inside to 0.25
outside. Default scene: builtin:scalpel:3068 and builtin:ellipsoid:49998 against builtin:head:256 with --opacity
"40:0,80:1". Exit status 3 when engines that must agree do not.

--outputs: what each projection costs beside the view, by the host and by the methods of the device, and what each of
the outputs (touched triangles, bounds, labels, contacts) costs beside the bare count of the same method and projection.
Labels are of a map with a label for each octant of the volume. The counts with an output must be those without. Default
scene: builtin:scalpel:3068 against builtin:head:128.

Columns of CSV: mesh,triangles,poses,engine,projection,question,threads,pairs,contacts,missed_percent,false_percent,
samples,pairs_per_s,pairs_per_s_min,pairs_per_s_max,pairs_per_cpu_s,pairs_per_cpu_s_min,pairs_per_cpu_s_max,wall_ratio,
wall_ratio_min,wall_ratio_max,cpu_ratio,cpu_ratio_min,cpu_ratio_max; medians, and of the ratios of pairs a second to
the first engine of the same scene in the same round (--outputs: projections to the view by the same method, outputs to
the bare count).

Examples:
  voxtact bench --certified
  voxtact bench --outputs --repetitions 3
  voxtact bench --certified --volume head.nii.gz --mesh tool.stl --format json --output bench.json)";

void addOptions(CLI::App& parser, BenchOptions& options) {
    CLI::Option* certified =
        parser.add_flag("--certified", options.certified, "yes or no, and counts, that miss no contact");
    parser.add_flag("--outputs", options.outputs, "what each projection and each output costs beside the bare count")
        ->excludes(certified);
    addVolumeOption(parser, options.volumes);
    parser.get_option("--volume")->required(false);
    addMeshOptions(parser, options.meshes);
    parser.get_option("--mesh")->required(false);
    addTransferFunctionOptions(parser, options.transferFunction);
    addWholeNumber(parser, "--poses", options.poses, 1, "how many poses of each kind");
    parser.add_option("--seed", options.seed, "of the poses, from 0 to 2^64-1")->type_name("S")->capture_default_str();
    addWholeNumber(parser, "--repetitions", options.repetitions, 1, "samples of each time, after a warm-up");
    addDeviceOptions(parser, options.device);
    addOutputOptions(parser, options.output);
    addProgressOption(parser, options.progress);
}

Outcome runBench(const BenchOptions& given, const CLI::App& parser) {
    BenchOptions options = given;
    options.command = commandLine(parser);
    if (!options.certified && !options.outputs) {
        return {kExitArguments, "say what to measure: --certified or --outputs; see voxtact bench --help"};
    }
    options.mode = options.outputs ? BenchMode::Outputs : BenchMode::Certified;
    return runBenchEngines(options);
}

} // namespace

Command addBench(CLI::App& program) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App* parser = program.add_subcommand("bench", "measurements: engines side by side, checked and timed");
    parser->footer(kFooter);
    addOptions(*parser, *options);
    return {parser, [options, parser] { return runBench(*options, *parser); }};
}

} // namespace voxtact::app
