// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/motion/motion_output.h"
#include "cli/motion/motion_run.h"
#include "cli/options/opacity_notes.h"
#include "cli/options/placement.h"
#include "cli/output/interrupt.h"
#include "cli/output/standard_streams.h"
#include "core/base/try.h"
#include "core/geometry/rigid_motion.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace voxtact::app {

namespace {

/// Radians, 0.0001 degrees: the error of half a turn whose pose has six decimals in a file.
constexpr double kHalfTurnRounding = 1e-4 / 180 * std::numbers::pi;

Interpolation interpolationOf(const MotionOptions& options) {
    return options.interpolation == "slerp" ? Interpolation::Slerp : Interpolation::Screw;
}

Result<void> checkPaths(const MotionOptions& options) {
    return checkOutputs(
        {{"--output", options.output.path}},
        inputPaths(options.volumes, options.meshes, options.transferFunction, options.view, options.labels));
}

Result<void> readPoses(const MotionOptions& options, MotionInputs& inputs) {
    Result<std::vector<Mat4>> poses = loadPoses(options.view);
    VOXTACT_TRY(poses);
    inputs.poses = std::move(*poses);
    return inputs.poses.size() >= 2
               ? Result<void>()
               : badArgument("--poses: '" + options.view.poses.string() + "' has " +
                             std::to_string(inputs.poses.size()) + " poses; a motion needs at least two");
}

Result<void> readLabels(const MotionOptions& options, MotionInputs& inputs) {
    if (options.labels.path.empty()) {
        return options.labels.names.empty() ? Result<void>()
                                            : badArgument("--label-names: it needs a label map; add --labels");
    }
    Result<NamedLabels> named = loadNamedLabels(options.labels.path, options.labels.names, [&] {
        return gridOfVolume(options.volumes.front(), options.resample);
    });
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
    VOXTACT_TRY(readPoses(options, inputs));
    VOXTACT_TRY(readLabels(options, inputs));
    return inputs;
}

/// Returns the first row of the shard and the end of its rows.
std::pair<std::uint64_t, std::uint64_t> rowRange(const MotionOptions& options, const MotionInputs& inputs) {
    return options.shard.range((inputs.poses.size() - 1) * options.meshes.sources.size() * options.volumes.size());
}

/// Visits the rows of the shard by volume, mesh and segment, until all are done or the user interrupts.
Result<void> checkAll(const MotionOptions& options, const MotionInputs& inputs, SegmentChecker& checking,
                      const std::function<Result<void>(std::span<const MotionRow>)>& visit) {
    const std::uint64_t segments = inputs.poses.size() - 1;
    const auto [first, end] = rowRange(options, inputs);
    std::optional<std::uint32_t> volume;
    for (std::uint64_t row = first; row < end && !interrupted();) {
        const std::uint64_t run = row / segments; // of a mesh and a volume
        const std::uint64_t segment = row % segments;
        const std::uint64_t count = std::min(segments - segment, end - row);
        const auto number = static_cast<std::uint32_t>(run / options.meshes.sources.size());
        if (volume != number) {
            VOXTACT_TRY(checking.setVolume(number));
            volume = number;
        }
        VOXTACT_TRY(checking.check(static_cast<std::uint32_t>(run % options.meshes.sources.size()),
                                   std::span<const Mat4>(inputs.poses).subspan(segment, count + 1), segment, visit));
        row += count;
    }
    return {};
}

Outcome writeMotions(const MotionOptions& options, MotionInputs& inputs, MotionEngine& engine) {
    const Result<std::unique_ptr<MotionOutput>> output = MotionOutput::create(options, inputs);
    VOXTACT_TRY(output);
    const auto [first, end] = rowRange(options, inputs);
    Progress progress(options.progress, "voxtact motion: segments", end - first);
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
    std::vector<std::string> notes = checking.notes();
    (*output)->ends().addTo(notes);
    for (const std::string& note : notes) {
        printNote(note);
    }
    if (options.summary) {
        printSummary((*output)->ends().summary());
    }
    return {};
}

Result<MotionEngine> makeEngine(const MotionOptions& options, MotionInputs& inputs) {
    std::vector<MeshData> meshes;
    for (const std::string& source : options.meshes.sources) {
        Result<MeshData> data = loadMesh(source, options.meshes);
        VOXTACT_TRY(data);
        const Result<MeshFacts> facts = checkMesh(data->view());
        VOXTACT_TRY(facts);
        inputs.bounds.push_back(facts->bounds);
        meshes.push_back(std::move(*data));
    }
    return MotionEngine::create({.interpolation = interpolationOf(options), .resolution = options.resolution},
                                options.threads, meshes);
}

Outcome runMotion(MotionOptions options) {
    if (options.output.path == "-") {
        options.output.path.clear();
    }
    VOXTACT_TRY(
        checkShard(options.shard, options.output, {{options.timing, "--timing"}, {options.summary, "--summary"}}));
    VOXTACT_TRY(checkPaths(options));
    const InterruptGuard guard;
    Result<MotionInputs> inputs = readInputs(options);
    VOXTACT_TRY(inputs);
    Result<MotionEngine> engine = makeEngine(options, *inputs);
    VOXTACT_TRY(engine);
    return writeMotions(options, *inputs, *engine);
}

} // namespace

Result<void> SegmentChecker::setVolume(std::uint32_t number) {
    engine_.dropVolume();
    const std::string& source = options_.volumes[number];
    const Result<VolumeData> data = loadVolume(source, {.resample = options_.resample});
    VOXTACT_TRY(data);
    grid_ = data->grid;
    inputs_.isResampled.resize(options_.volumes.size());
    inputs_.isResampled[number] = io::wasResampled(*data) ? 1 : 0;
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    const TransferFunctionOptions& how = options_.transferFunction;
    const ValueRange domain = tableDomain(how, data->type, *values);
    const std::vector<ControlPoint> points = inputs_.points.empty() ? defaultRamp(domain) : inputs_.points;
    const TransferFunctionDesc function{points, domain};
    printOpacityNotes(function, *values, how.threshold, source, false);
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
    bool isNear = false;
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
            isNear = isNear || motion.touch || motion.possible;
        }
        VOXTACT_TRY(visit(rows));
        first += count;
    }
    if (!isNear && !interrupted()) {
        noteFar(mesh, poses);
    }
    return {};
}

void SegmentChecker::noteFar(std::uint32_t mesh, std::span<const Mat4> poses) {
    const ReadMesh read{options_.meshes.sources[mesh], options_.meshes, inputs_.bounds[mesh], poses,
                        options_.view.posesSpace};
    if (placementOf(read, grid_).distance > 0) {
        notes_.push_back(farNote(read, options_.volumes[volume_], grid_, poses.size()));
    }
}

Command addMotion(CLI::App& program, const NamedQuestion& question) {
    auto options = std::make_shared<MotionOptions>();
    CLI::App* parser = program.add_subcommand(std::string(question.name), std::string(question.text));
    parser->footer(std::string(question.help));
    addVolumeOption(*parser, options->volumes);
    addResampleOption(*parser, options->resample);
    addMeshOptions(*parser, options->meshes);
    addPosesOptions(*parser, options->view);
    parser->get_option("--poses")->required();
    addTransferFunctionOptions(*parser, options->transferFunction);
    addLabelOptions(*parser, options->labels);
    addName(*parser, "--interpolation", options->interpolation, {"screw", "slerp"}, "screw or slerp; default: screw");
    addFact(*parser, factOf("motion", "resolution"), [options](double mm) { options->resolution = mm; });
    addThreadsOption(*parser, options->threads);
    addShardOption(*parser, options->shard);
    addOutputOptions(*parser, options->output);
    parser->add_flag("--summary", options->summary, "totals and the first touch on standard error");
    parser->add_flag("--timing", options->timing, "add a line of totals");
    setRare(*parser, "--timing");
    addProgressOption(*parser, options->progress);
    return {parser, [options] { return runMotion(*options); }};
}

} // namespace voxtact::app
