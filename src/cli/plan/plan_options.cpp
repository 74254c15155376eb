// SPDX-License-Identifier: MIT
#include "cli/plan/plan_run.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

void addVector(CLI::App& parser, const char* option, std::optional<Vec3>& value, const std::string& help) {
    addText(
        parser, option,
        [&value](const std::string& text) -> std::optional<std::string> {
            value = parsePoint(text);
            return value ? std::nullopt : std::optional<std::string>("is not three numbers x,y,z");
        },
        help, "x,y,z");
}

void addObstacleOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addPath(parser, "--labels", options->labels, "label map on the volume's grid or a part of it");
    addPath(parser, "--label-names", options->labelNames,
            "lines 'number name'; default: the label map's path with .txt, if it exists");
    parser.add_option("--avoid", options->avoid, "labels to avoid, opaque or not: numbers or names")
        ->delimiter(',')
        ->type_name("LABEL,...");
    parser.add_option("--avoid-opacity", options->avoidOpacity, "transfer function of a further opaque obstacle")
        ->type_name("LIST");
    parser.add_option("--avoid-volume", options->avoidVolume, "volume of --avoid-opacity; default: --volume")
        ->type_name("PATH")
        ->check(refuseEmpty);
    addVector(parser, "--tip", options->tip, "tip of a mesh, object space");
    addVector(parser, "--axis", options->axis, "direction of a mesh from its tip to its handle, object space");
}

void addTargetOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addTexts(
        parser, "--target",
        [options](const std::string& text) -> std::optional<std::string> {
            options->targets.push_back(text);
            return {};
        },
        "target: a point (mm) or a label's centre; repeatable", "x,y,z|LABEL");
    parser.add_option("--target-label", options->targetLabels, "targets: the centres of these labels")
        ->delimiter(',')
        ->type_name("LABEL,...");
    addPath(parser, "--targets", options->targetFile, "targets: lines 'x y z [name]' in mm, .fcsv, .mrk.json");
    addSpace(parser, "--space", options->space, "space of targets: lps or ras; default: as --targets states, else lps",
             "");
}

void addEntryOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addWholeNumber(
        parser, "--entries", [options](std::uint32_t entries) { options->entries = entries; },
        {.least = 12, .most = kMaxEntries}, "directions, rounded up to 10 n^2 + 2", options->entries);
    parser
        .add_option("--entry-label", options->entryLabel,
                    "place entries on the outside of this label; default: of the opaque region")
        ->type_name("LABEL")
        ->check(refuseEmpty);
    addNumber(
        parser, "--entry-radius", [options](double mm) { options->entryRadius = mm; },
        "place entries at this distance from the target, mm", [](double mm) { return mm > kNearestEntry; },
        "above 0.001", "none");
    parser.add_flag("--border-entries", options->borderEntries, "allow entries where the image cuts the body");
    addFact(parser, factOf("plan", "max_length"), [options](double mm) { options->longest = mm; });
    addFact(parser, factOf("plan", "max_angle"), [options](double degrees) { options->steepest = degrees; });
    addFact(parser, factOf("plan", "margin"), [options](double mm) { options->margin = mm; });
    addFact(parser, factOf("plan", "tolerance"), [options](double mm) { options->tolerance = mm; });
    addFact(parser, factOf("plan", "max"), [options](double mm) { options->maximum = mm; });
}

} // namespace

void addPlanOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addVolumeOption(parser, options->volumes);
    addResampleOption(parser, options->resample);
    addMeshOptions(parser, options->meshes, false);
    addTransferFunctionOptions(parser, options->transferFunction);
    addTargetOptions(parser, options);
    addObstacleOptions(parser, options);
    addEntryOptions(parser, options);
    addPath(parser, "--by-target", options->byTarget, "CSV file, one row per target: safe paths, area, best path");
    addPath(parser, "--surface", options->surface,
            ".ply file of the entries, coloured; several targets: a path with {target}");
    addPath(parser, "--heat-map", options->heatMap,
            "volume file: distance of the paths through each voxel, mm; several targets: a path with {target}");
    addPath(parser, "--picture", options->picture, "PNG of entries and best path; needs a Vulkan device");
    addSize(
        parser,
        [options](const VkExtent2D& size) {
            options->half = size;
            options->sizeGiven = true;
        },
        "size of each half of the picture, pixels");
    addDeviceOptions(parser, options->device);
    addPath(parser, "--report", options->report, "HTML report: notes, best paths, entries");
    addThreadsOption(parser, options->threads);
    parser.add_flag("--summary", options->summary, "print totals and the best path to standard error");
    parser.add_flag("--timing", options->timing, "append a line with the totals");
    addShardOption(parser, options->shard);
    addOutputOptions(parser, options->output);
    addProgressOption(parser, options->progress);
    for (const char* rare : {"--entry-radius", "--border-entries", "--by-target", "--surface", "--heat-map", "--size",
                             "--timing", "--avoid-volume", "--tip", "--axis", "--device", "--tolerance", "--max",
                             "--targets", "--space", "--entry-label", "--label-names"}) {
        setRare(parser, rare);
    }
}

} // namespace voxtact::app
