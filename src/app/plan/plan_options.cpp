// SPDX-License-Identifier: MIT
#include "app/plan/plan_run.h"

#include <CLI/CLI.hpp>

namespace voxtact::app {

namespace {

/// More only wait for each other.
constexpr std::uint32_t kMostThreads = 1024;

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
        ->type_name("PATH")
        ->check(refuseEmpty);
    addVector(parser, "--tip", options->tip, "the tip of a mesh, in its coordinates");
    addVector(parser, "--axis", options->axis, "from the tip of a mesh to where it is held, in its coordinates");
}

void addTargetOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addTexts(
        parser, "--target",
        [options](const std::string& text) -> std::optional<std::string> {
            options->targets.push_back(text);
            return {};
        },
        "where the tip goes: x,y,z in world mm, or a label's middle; may be repeated", "x,y,z|LABEL");
    parser.add_option("--target-label", options->targetLabels, "the same: the middles of these labels")
        ->delimiter(',')
        ->type_name("LABEL,...");
    addPath(parser, "--targets", options->targetFile, "the same: a line 'x y z' or 'x y z name' each, world mm");
}

void addEntryOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addWholeNumber(
        parser, "--entries", [options](std::uint32_t entries) { options->entries = entries; },
        {.least = 12, .most = kMostEntries},
        "directions from the target, evenly spread: the least 10 n^2 + 2 that is no fewer", options->entries);
    parser
        .add_option("--entry-label", options->entryLabel,
                    "entries are on the outside of this label; default: of what is opaque")
        ->type_name("LABEL")
        ->check(refuseEmpty);
    addNumber(
        parser, "--entry-radius", [options](double mm) { options->entryRadius = mm; },
        "entries are all so far from the target, mm", [](double mm) { return mm > kNearestEntry; }, "above 0.001",
        "none");
    parser.add_flag("--border-entries", options->borderEntries,
                    "paths may begin where the image ends within what is opaque, or within --entry-label, too; without "
                    "it they are left out: there the image was cut, and not the body");
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

void addPlanOptions(CLI::App& parser, const std::shared_ptr<PlanOptions>& options) {
    addVolumeOption(parser, options->volumes);
    addMeshOptions(parser, options->meshes, false);
    addTransferFunctionOptions(parser, options->transferFunction);
    addTargetOptions(parser, options);
    addObstacleOptions(parser, options);
    addEntryOptions(parser, options);
    addPath(parser, "--by-target", options->byTarget,
            "a CSV file with a row for each target: how many paths are safe, the area, the best path");
    addPath(parser, "--surface", options->surface,
            "a .ply file for the entries and the triangles between them, in colours; of several targets a path with "
            "{target}, which becomes the target's name");
    addPath(
        parser, "--heat-map", options->heatMap,
        "a volume (.nii.gz, .nii, .nrrd, .mha) on the grid of --volume: the mm that every path which enters through a "
        "voxel certainly keeps, -1 where none does; of several targets a path with {target}");
    addPath(parser, "--picture", options->picture,
            "a .png file: the head with the entries in colours and the best path, from outside and cut open; needs a "
            "Vulkan device");
    addSize(
        parser,
        [options](const VkExtent2D& size) {
            options->half = size;
            options->sizeGiven = true;
        },
        "of each half of the picture, in pixels");
    addDeviceOptions(parser, options->device);
    addPath(parser, "--report", options->report,
            "an .html file that needs no network: the notes, the best paths, and for each target the entries in "
            "colours");
    addWholeNumber(
        parser, "--threads", [options](std::uint32_t threads) { options->threads = threads; },
        {.least = 0, .most = kMostThreads}, "0: one for each processor", 0);
    parser.add_flag("--summary", options->summary,
                    "says on standard error how many paths are safe, the area that is, and the best path");
    parser.add_flag("--timing", options->timing, "adds a last line: # entries= wall_ms= entries_per_s=");
    options->chunks.rows = "targets";
    options->chunks.standard = 1;
    addChunkOptions(parser, options->chunks);
    addOutputOptions(parser, options->output);
    addProgressOption(parser, options->progress);
}

} // namespace voxtact::app
