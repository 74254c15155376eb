// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/motion/motion_output.h"
#include "app/motion/motion_run.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "core/base/try.h"
#include "core/geometry/rigid_motion.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <span>

namespace voxtact::app {

namespace {

constexpr const char* kMotionFooter =
    R"(Consecutive poses of --poses are joined by rigid motions, and each of these is a row, for every mesh and volume:
  segment,mesh,volume    number of the pose that it begins with, from 0; the sources as they were given
  hit                    1 (yes): it certainly touches on the way; 0 (no): it certainly does not; 2 (possible): neither
                         could be shown
  free_until             certainly nothing touches from 0 to this parameter; 1 is the next pose
  touch_at               at this parameter it certainly touches; the mesh moves no more than --resolution-mm from
                         free_until to there, unless it grazes, which a note says
  x,y,z,triangle,label   a point of that touch, world mm, LPS; the triangle; with --labels the label there

--interpolation screw turns about and moves along one axis; slerp moves the middle of the mesh's box straight and turns
about it. By the host, in double precision; nothing is sampled: a thin plate that crosses a thin sheet is found.

With --resume the run is done in chunks, whose files are in that folder: ended at any moment, the same command goes on
from there; many processes do it together, each one --shard, and voxtact merge writes the output: the manual's page "Many
machines".

Examples:
  voxtact motion --volume head.nii.gz --mesh tool.stl --poses path.txt
  voxtact motion --volume builtin:head:128 --mesh builtin:scalpel --poses path.txt --interpolation slerp --timing
  voxtact motion --volume head.nii.gz --mesh tool.stl --poses path.txt --resume run --shard 2/7)";

/// More only wait for each other.
constexpr std::uint32_t kMostThreads = 1024;

Interpolation interpolationOf(const MotionOptions& options) {
    return options.interpolation == "slerp" ? Interpolation::Slerp : Interpolation::Screw;
}

/// All files and folders that the options read.
std::vector<NamedPath> readPaths(const MotionOptions& options) {
    ViewOptions view;
    view.poses = options.poses;
    std::vector<NamedPath> inputs = inputPaths(options.volumes, options.meshes, options.transferFunction, view);
    if (!options.labels.empty()) {
        inputs.push_back({"--labels", options.labels});
        inputs.push_back({"--label-names", labelNamesPath(options.labelNames, options.labels)});
    }
    return inputs;
}

Result<void> checkPaths(const MotionOptions& options) {
    std::vector<NamedPath> inputs = readPaths(options);
    addInput(inputs, "--resume", options.chunks.folder);
    return checkOutputs({{"--output", options.output.path}}, inputs);
}

/// All at once; a run in chunks has its own way.
Result<void> readPoses(const MotionOptions& options, MotionInputs& inputs) {
    Result<std::vector<Mat4>> poses = loadPoses(options.poses);
    VOXTACT_TRY(poses);
    inputs.poses = std::move(*poses);
    return checkPoseCount(options, inputs.poses.size());
}

Result<void> readLabels(const MotionOptions& options, MotionInputs& inputs) {
    if (options.labels.empty()) {
        return options.labelNames.empty()
                   ? Result<void>()
                   : badArgument("--label-names: it names the labels of a label map, and --labels is not given");
    }
    Result<NamedLabels> named = loadNamedLabels(options.labels, options.labelNames);
    VOXTACT_TRY(named);
    inputs.labels = std::move(named->labels);
    inputs.labelNames = std::move(named->names);
    return {};
}

Result<MotionInputs> readInputs(const MotionOptions& options) {
    VOXTACT_TRY(checkVolumesAreThere(options.volumes));
    MotionInputs inputs;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    inputs.points = std::move(*points);
    if (!options.chunks.asked()) {
        VOXTACT_TRY(readPoses(options, inputs));
    }
    for (const std::string& source : options.meshes.sources) {
        const Result<MeshData> data = loadMesh(source, options.meshes);
        VOXTACT_TRY(data);
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data->view());
        VOXTACT_TRY(mesh);
        inputs.meshes.push_back(std::move(*mesh));
    }
    VOXTACT_TRY(readLabels(options, inputs));
    return inputs;
}

/// Of every volume and mesh, until it is done or interrupted.
Result<void> checkAll(const MotionOptions& options, const MotionInputs& inputs, SegmentChecker& checking,
                      const std::function<Result<void>(std::span<const MotionRow>)>& visit) {
    for (std::uint32_t number = 0; number < options.volumes.size() && !interrupted(); ++number) {
        const Result<MotionVolume> volume = loadMotionVolume(options, inputs, number);
        VOXTACT_TRY(volume);
        for (std::uint32_t mesh = 0; mesh < inputs.meshes.size(); ++mesh) {
            VOXTACT_TRY(checking.check(*volume, number, mesh, inputs.poses, 0, visit));
        }
    }
    return {};
}

Outcome writeMotions(const MotionOptions& options, const MotionInputs& inputs, cpu::MotionChecker& checker) {
    const Result<std::unique_ptr<MotionOutput>> output = MotionOutput::create(options, inputs);
    VOXTACT_TRY(output);
    Progress progress(options.progress, "voxtact motion: segments",
                      (inputs.poses.size() - 1) * inputs.meshes.size() * options.volumes.size());
    SegmentChecker checking(options, inputs, checker);
    const Result<void> done = checkAll(options, inputs, checking, [&](std::span<const MotionRow> rows) -> Result<void> {
        VOXTACT_TRY((*output)->add(rows));
        progress.update((*output)->rows());
        return {};
    });
    if (!done.ok()) {
        VOXTACT_TRY((*output)->fail());
        return done.error();
    }
    if (interrupted()) {
        VOXTACT_TRY((*output)->breakOff());
        return interruptOutcome(options.output.path.empty()
                                    ? std::to_string((*output)->rows()) + " segments are written"
                                    : "'" + options.output.path.string() + "' is not written");
    }
    VOXTACT_TRY((*output)->finish(checking.milliseconds()));
    std::vector<std::string> notes;
    (*output)->ends().addTo(notes);
    for (const std::string& note : notes) {
        printNote(note);
    }
    return {};
}

Outcome runMotion(const CLI::App& parser, MotionOptions options) {
    if (options.output.path == "-") {
        options.output.path.clear();
    }
    if (options.chunks.asked() && options.output.formatName.empty()) {
        options.output.formatName = "csv"; // whoever looks on: the chunks are the same
    }
    VOXTACT_TRY(checkMotionChunks(options));
    VOXTACT_TRY(checkPaths(options));
    const InterruptGuard guard;
    const Result<MotionInputs> inputs = readInputs(options);
    VOXTACT_TRY(inputs);
    Result<cpu::MotionChecker> checker = cpu::MotionChecker::create(
        {.threads = options.threads, .interpolation = interpolationOf(options), .resolution = options.resolution});
    VOXTACT_TRY(checker);
    if (options.chunks.asked()) {
        return runMotionChunks(parser, options, *inputs, *checker, readPaths(options));
    }
    return writeMotions(options, *inputs, *checker);
}

} // namespace

Result<void> checkPoseCount(const MotionOptions& options, std::uint64_t poses) {
    return poses >= 2 ? Result<void>()
                      : badArgument("--poses: '" + options.poses.string() + "' has " + std::to_string(poses) +
                                    " poses, a motion needs two or more");
}

Result<MotionVolume> loadMotionVolume(const MotionOptions& options, const MotionInputs& inputs, std::uint32_t number) {
    const std::string& source = options.volumes[number];
    const Result<VolumeData> data = loadVolume(source);
    VOXTACT_TRY(data);
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    Result<cpu::Volume> volume = cpu::Volume::create(data->view());
    VOXTACT_TRY(volume);
    const TransferFunctionOptions& how = options.transferFunction;
    const ValueRange domain = usedDomain(how, data->type, *values, source);
    Result<cpu::TransferFunction> function = cpu::TransferFunction::create(
        {inputs.points.empty() ? defaultRamp(domain) : inputs.points, domain, how.tableSize});
    VOXTACT_TRY(function);
    return MotionVolume{std::move(*volume), std::move(*function)};
}

Result<void> SegmentChecker::checkRigid(std::span<const Mat4> poses, std::uint64_t firstPose) const {
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
        const std::uint64_t number = firstPose + i;
        VOXTACT_TRY(
            RigidMotion::between(poses[i], poses[i + 1], interpolationOf(options_), {},
                                 "--poses: poses " + std::to_string(number) + " and " + std::to_string(number + 1)));
    }
    return {};
}

Result<void> SegmentChecker::check(const MotionVolume& volume, std::uint32_t volumeNumber, std::uint32_t mesh,
                                   std::span<const Mat4> poses, std::uint64_t firstPose,
                                   const std::function<Result<void>(std::span<const MotionRow>)>& visit) {
    VOXTACT_TRY(checkRigid(poses, firstPose));
    std::vector<MotionRow> rows;
    for (std::size_t first = 0; first + 1 < poses.size() && !interrupted();) {
        const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(pace_.size(), poses.size() - 1 - first));
        const cpu::BatchItem item{&inputs_.meshes[mesh], &volume.volume, &volume.transferFunction,
                                  poses.subspan(first, count + 1)};
        const Result<MotionAnswer> answer = checker_.check({.items = std::span(&item, 1),
                                                            .threshold = options_.transferFunction.threshold,
                                                            .cancel = &interruptFlag()});
        if (!answer.ok() && answer.error().code == ErrorCode::Cancelled) {
            return {};
        }
        VOXTACT_TRY(answer);
        milliseconds_ += answer->wallMilliseconds;
        pace_.took(count, answer->wallMilliseconds);
        rows.clear();
        for (SegmentMotion motion : answer->segments) {
            motion.pose += static_cast<std::uint32_t>(firstPose + first);
            rows.push_back({mesh, volumeNumber, motion});
        }
        VOXTACT_TRY(visit(rows));
        first += count;
    }
    return {};
}

void MotionEnds::add(std::span<const MotionRow> rows) {
    for (const MotionRow& row : rows) {
        grazing += row.motion.end == MotionEnd::Grazes ? 1 : 0;
        cut += row.motion.end == MotionEnd::Budget ? 1 : 0;
    }
}

void MotionEnds::addTo(std::vector<std::string>& notes) const {
    if (grazing > 0) {
        notes.push_back("segments that graze: " + std::to_string(grazing) +
                        "; their free_until and touch_at are farther apart than "
                        "--resolution-mm, or there is no touch_at");
    }
    if (cut > 0) {
        notes.push_back("segments that took too many steps: " + std::to_string(cut) +
                        "; they are free until free_until, and the rest of them "
                        "is not looked at");
    }
}

Command addMotion(CLI::App& program) {
    auto options = std::make_shared<MotionOptions>();
    CLI::App* parser = program.add_subcommand("motion", "whether meshes touch on the way from pose to pose, and where");
    parser->footer(kMotionFooter);
    addVolumeOption(*parser, options->volumes);
    addMeshOptions(*parser, options->meshes);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addPath(*parser, "--poses", options->poses,
            "a world_from_object matrix a line: 16 numbers, row by row; -: from standard input; at least two");
    parser->get_option("--poses")->required();
    addName(*parser, "--interpolation", options->interpolation, {"screw", "slerp"},
            "the motion between two poses: screw or slerp; default: screw");
    addNumber(
        *parser, "--resolution-mm", [options](double mm) { options->resolution = mm; },
        "mm that the mesh moves at most from free_until to touch_at", [](double mm) { return mm >= 1e-6; },
        "at least 1e-6", "0.01");
    addPath(*parser, "--labels", options->labels, "a label map (an image of whole numbers): names what is touched");
    addPath(*parser, "--label-names", options->labelNames,
            "lines 'number name'; default: the label map's path without .gz, with .txt, where that file is");
    addWholeNumber(
        *parser, "--threads", [options](std::uint32_t threads) { options->threads = threads; },
        {.least = 0, .most = kMostThreads}, "0: one for each processor", 0);
    parser->add_flag("--timing", options->timing, "adds a last line: # segments= wall_ms= segments_per_s=");
    addChunkOptions(*parser, options->chunks);
    addOutputOptions(*parser, options->output);
    addProgressOption(*parser, options->progress);
    return {parser, [options, parser] { return runMotion(*parser, *options); }};
}

} // namespace voxtact::app
