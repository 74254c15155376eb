// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/motion/motion_output.h"
#include "app/motion/motion_run.h"
#include "app/options/opacity_notes.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "core/base/try.h"
#include "core/geometry/rigid_motion.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <numbers>
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
about it. Both turn by no more than half a turn; near half a turn rounding may decide which way round, and a note says
so. Nothing is sampled: a thin plate that crosses a thin sheet is found. By the host, in double precision; with
--count compute by a device, in single precision: hundredths of a voxel.

With --resume the run is done in chunks, whose files are in that folder: ended at any moment, the same command goes on
from there; many processes do it together, each one --shard, and voxtact merge writes the output: the manual's page "Many
machines".

Examples:
  voxtact motion --volume head.nii.gz --mesh tool.stl --poses path.txt
  voxtact motion --volume builtin:head:128 --mesh builtin:scalpel --poses path.txt --interpolation slerp --timing
  voxtact motion --volume head.nii.gz --mesh tool.stl --poses path.txt --resume run --shard 2/7)";

/// More only wait for each other.
constexpr std::uint32_t kMostThreads = 1024;

/// Radians, 0.0001 degrees: poses that a file has with six decimals may be this far from half a turn.
constexpr double kHalfTurnRounding = 1e-4 / 180 * std::numbers::pi;

Interpolation interpolationOf(const MotionOptions& options) {
    return options.interpolation == "slerp" ? Interpolation::Slerp : Interpolation::Screw;
}

bool isOnDevice(const MotionOptions& options) {
    return options.count == "compute";
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
    VOXTACT_TRY(readLabels(options, inputs));
    return inputs;
}

/// Of every volume and mesh, until it is done or interrupted.
Result<void> checkAll(const MotionOptions& options, const MotionInputs& inputs, SegmentChecker& checking,
                      const std::function<Result<void>(std::span<const MotionRow>)>& visit) {
    for (std::uint32_t number = 0; number < options.volumes.size() && !interrupted(); ++number) {
        VOXTACT_TRY(checking.setVolume(number));
        for (std::uint32_t mesh = 0; mesh < options.meshes.sources.size(); ++mesh) {
            VOXTACT_TRY(checking.check(mesh, inputs.poses, 0, visit));
        }
    }
    return {};
}

Outcome writeMotions(const MotionOptions& options, const MotionInputs& inputs, MotionEngine& engine) {
    const Result<std::unique_ptr<MotionOutput>> output = MotionOutput::create(options, inputs);
    VOXTACT_TRY(output);
    Progress progress(options.progress, "voxtact motion: segments",
                      (inputs.poses.size() - 1) * options.meshes.sources.size() * options.volumes.size());
    SegmentChecker checking(options, inputs, engine);
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

/// Calls `use` with the host, or with the device that the options name.
Outcome withEngine(const MotionOptions& options, const std::function<Outcome(MotionEngine&)>& use) {
    const MotionSearch search{options.resolution, interpolationOf(options)};
    std::vector<MeshData> meshes;
    for (const std::string& source : options.meshes.sources) {
        Result<MeshData> data = loadMesh(source, options.meshes);
        VOXTACT_TRY(data);
        meshes.push_back(std::move(*data));
    }
    if (!isOnDevice(options)) {
        const Result<std::unique_ptr<MotionEngine>> host =
            hostMotionEngine(search, options.threads.value_or(0), meshes);
        VOXTACT_TRY(host);
        return use(**host);
    }
    std::shared_ptr<const device::ValidationMessages> messages;
    Outcome outcome;
    {
        const Result<device::Session> session = openSession(options.device);
        VOXTACT_TRY(session);
        messages = session->instance.messages();
        const Result<std::unique_ptr<MotionEngine>> engine = deviceMotionEngine(search, *session, meshes);
        VOXTACT_TRY(engine);
        outcome = use(**engine);
    }
    const Outcome validated = validationOutcome(*messages); // complete once the device is closed
    return outcome.status == kExitDone ? validated : outcome;
}

Result<void> checkEngine(const MotionOptions& options) {
    if (isOnDevice(options) && options.threads) {
        return badArgument("--threads is of the host, and --count compute asks a device; leave out one of the two");
    }
    if (!isOnDevice(options) && !options.device.wanted.empty()) {
        return badArgument("--device: motions are checked by the host unless --count compute says so");
    }
    if (!isOnDevice(options) && options.device.validate) {
        return badArgument("--validate: motions are checked by the host, which uses no Vulkan, unless --count compute "
                           "says so");
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
    VOXTACT_TRY(checkEngine(options));
    VOXTACT_TRY(checkMotionChunks(options));
    VOXTACT_TRY(checkPaths(options));
    const InterruptGuard guard;
    const Result<MotionInputs> inputs = readInputs(options);
    VOXTACT_TRY(inputs);
    return withEngine(options, [&](MotionEngine& engine) {
        return options.chunks.asked() ? runMotionChunks(parser, options, *inputs, engine, readPaths(options))
                                      : writeMotions(options, *inputs, engine);
    });
}

} // namespace

Result<void> checkPoseCount(const MotionOptions& options, std::uint64_t poses) {
    return poses >= 2 ? Result<void>()
                      : badArgument("--poses: '" + options.poses.string() + "' has " + std::to_string(poses) +
                                    " poses, a motion needs two or more");
}

Result<void> SegmentChecker::setVolume(std::uint32_t number) {
    engine_.dropVolume();
    const std::string& source = options_.volumes[number];
    const Result<VolumeData> data = loadVolume(source);
    VOXTACT_TRY(data);
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    const TransferFunctionOptions& how = options_.transferFunction;
    const ValueRange domain = usedDomain(how, data->type, *values, source);
    const std::vector<ControlPoint> points = inputs_.points.empty() ? defaultRamp(domain) : inputs_.points;
    const TransferFunctionDesc function{points, domain, how.tableSize};
    printOpacityNotes(function, *values, how.threshold, source);
    volume_ = number;
    return engine_.setVolume(data->view(), function);
}

Result<std::vector<bool>> SegmentChecker::checkRigid(std::span<const Mat4> poses, std::uint64_t firstPose) const {
    std::vector<bool> halfTurns;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
        const std::uint64_t number = firstPose + i;
        const Result<RigidMotion> motion =
            RigidMotion::between(poses[i], poses[i + 1], interpolationOf(options_), {},
                                 "--poses: poses " + std::to_string(number) + " and " + std::to_string(number + 1));
        VOXTACT_TRY(motion);
        halfTurns.push_back(motion->angle() >= std::numbers::pi - kHalfTurnRounding);
    }
    return halfTurns;
}

Result<void> SegmentChecker::check(std::uint32_t mesh, std::span<const Mat4> poses, std::uint64_t firstPose,
                                   const std::function<Result<void>(std::span<const MotionRow>)>& visit) {
    const Result<std::vector<bool>> halfTurns = checkRigid(poses, firstPose);
    VOXTACT_TRY(halfTurns);
    std::vector<MotionRow> rows;
    for (std::size_t first = 0; first + 1 < poses.size() && !interrupted();) {
        const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(pace_.size(), poses.size() - 1 - first));
        const Result<MotionAnswer> answer =
            engine_.check(mesh, poses.subspan(first, count + 1), options_.transferFunction.threshold);
        if (!answer.ok() && answer.error().code == ErrorCode::Cancelled) {
            return {};
        }
        VOXTACT_TRY(answer);
        milliseconds_ += answer->wallMilliseconds;
        pace_.took(count, answer->wallMilliseconds);
        rows.clear();
        for (SegmentMotion motion : answer->segments) {
            const bool halfTurn = (*halfTurns)[first + motion.pose];
            motion.pose += static_cast<std::uint32_t>(firstPose + first);
            rows.push_back({mesh, volume_, motion, halfTurn});
        }
        VOXTACT_TRY(visit(rows));
        first += count;
    }
    return {};
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
    addName(*parser, "--count", options->count, {"cpu", "compute"},
            "by what it is checked: cpu, the host, or compute, a device; default: cpu");
    addDeviceOptions(*parser, options->device);
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
