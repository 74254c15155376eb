// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/motion/motion_table.h"
#include "app/options/inputs.h"
#include "app/options/output_paths.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "core/base/try.h"
#include "voxtact/cpu.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <span>

namespace voxtact::app {

namespace {

constexpr const char* kFooter =
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

Examples:
  voxtact motion --volume head.nii.gz --mesh tool.stl --poses path.txt
  voxtact motion --volume builtin:head:128 --mesh builtin:scalpel --poses path.txt --interpolation slerp --timing)";

/// More only wait for each other.
constexpr std::uint32_t kMostThreads = 1024;
/// Of segments that are checked before an interrupt is looked for.
constexpr std::size_t kBatch = 256;

struct MotionOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    std::filesystem::path poses;
    std::filesystem::path labels;
    std::filesystem::path labelNames;
    std::string interpolation = "screw";
    double resolution = kDefaultMotionResolution;
    std::uint32_t threads = 0;
    bool timing = false;
    OutputOptions output;
};

struct MotionInputs {
    std::vector<cpu::Mesh> meshes;
    std::vector<ControlPoint> points;
    std::vector<Mat4> poses;
    std::optional<LabelData> labels;
    std::map<std::int32_t, std::string> labelNames;
};

Result<void> checkPaths(const MotionOptions& options) {
    ViewOptions view;
    view.poses = options.poses;
    std::vector<NamedPath> inputs = inputPaths(options.volumes, options.meshes, options.transferFunction, view);
    if (!options.labels.empty()) {
        inputs.push_back({"--labels", options.labels});
        inputs.push_back({"--label-names", labelNamesPath(options.labelNames, options.labels)});
    }
    return checkOutputs({{"--output", options.output.path}}, inputs);
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
    MotionInputs inputs;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    inputs.points = std::move(*points);
    Result<std::vector<Mat4>> poses = loadPoses(options.poses);
    VOXTACT_TRY(poses);
    inputs.poses = std::move(*poses);
    if (inputs.poses.size() < 2) {
        return badArgument("--poses: '" + options.poses.string() + "' has " + std::to_string(inputs.poses.size()) +
                           " poses, a motion needs two or more");
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

/// The rows of one volume, some at a time; fewer where an interrupt comes.
class Checking {
  public:
    Checking(const MotionOptions& options, const MotionInputs& inputs, cpu::MotionChecker& checker)
        : options_(options), inputs_(inputs), checker_(checker) {}

    [[nodiscard]] Result<void> add(std::uint32_t number) {
        const std::string& source = options_.volumes[number];
        const Result<VolumeData> data = loadVolume(source);
        VOXTACT_TRY(data);
        const Result<ValueRange> values = checkVolume(data->view());
        VOXTACT_TRY(values);
        const Result<cpu::Volume> volume = cpu::Volume::create(data->view());
        VOXTACT_TRY(volume);
        const TransferFunctionOptions& how = options_.transferFunction;
        const ValueRange domain = usedDomain(how, data->type, *values, source);
        const Result<cpu::TransferFunction> function = cpu::TransferFunction::create(
            {inputs_.points.empty() ? defaultRamp(domain) : inputs_.points, domain, how.tableSize});
        VOXTACT_TRY(function);
        for (std::uint32_t mesh = 0; mesh < inputs_.meshes.size(); ++mesh) {
            VOXTACT_TRY(add(number, mesh, *volume, *function));
        }
        return {};
    }
    [[nodiscard]] const std::vector<MotionRow>& rows() const noexcept { return rows_; }
    [[nodiscard]] double milliseconds() const noexcept { return milliseconds_; }

  private:
    [[nodiscard]] Result<void> add(std::uint32_t volumeNumber, std::uint32_t mesh, const cpu::Volume& volume,
                                   const cpu::TransferFunction& function) {
        const std::span<const Mat4> poses = inputs_.poses;
        for (std::size_t first = 0; first + 1 < poses.size() && !interrupted(); first += kBatch) {
            const cpu::BatchItem item{&inputs_.meshes[mesh], &volume, &function,
                                      poses.subspan(first, std::min(kBatch + 1, poses.size() - first))};
            const Result<MotionAnswer> answer =
                checker_.check({std::span(&item, 1), {}, options_.transferFunction.threshold});
            VOXTACT_TRY(answer);
            milliseconds_ += answer->wallMilliseconds;
            for (SegmentMotion motion : answer->segments) {
                motion.pose += static_cast<std::uint32_t>(first);
                rows_.push_back({mesh, volumeNumber, motion});
            }
        }
        return {};
    }

    const MotionOptions& options_;
    const MotionInputs& inputs_;
    cpu::MotionChecker& checker_;
    std::vector<MotionRow> rows_;
    double milliseconds_ = 0;
};

/// What is less than was asked for.
void noteEnds(const std::vector<MotionRow>& rows) {
    const auto count = [&](MotionEnd end) {
        return std::to_string(
            std::count_if(rows.begin(), rows.end(), [end](const MotionRow& row) { return row.motion.end == end; }));
    };
    if (const std::string grazing = count(MotionEnd::Grazes); grazing != "0") {
        printNote("segments that graze: " + grazing +
                  "; their free_until and touch_at are farther apart than "
                  "--resolution-mm, or there is no touch_at");
    }
    if (const std::string cut = count(MotionEnd::Budget); cut != "0") {
        printNote("segments that took too many steps: " + cut +
                  "; they are free until free_until, and the rest of them "
                  "is not looked at");
    }
}

Outcome runMotion(const MotionOptions& options) {
    VOXTACT_TRY(checkPaths(options));
    const InterruptGuard guard;
    const Result<MotionInputs> inputs = readInputs(options);
    VOXTACT_TRY(inputs);
    Result<cpu::MotionChecker> checker = cpu::MotionChecker::create(
        {.threads = options.threads,
         .interpolation = options.interpolation == "slerp" ? Interpolation::Slerp : Interpolation::Screw,
         .resolution = options.resolution});
    VOXTACT_TRY(checker);
    Checking checking(options, *inputs, *checker);
    for (std::uint32_t volume = 0; volume < options.volumes.size() && !interrupted(); ++volume) {
        VOXTACT_TRY(checking.add(volume));
    }
    if (interrupted()) {
        return interruptOutcome("nothing is written");
    }
    MotionTable table{options.meshes.sources, options.volumes, inputs->labels, inputs->labelNames, checking.rows(), {}};
    if (options.timing) {
        table.wallMilliseconds = checking.milliseconds();
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        io::writeTable(out, options.output.format(), table.table());
        return {};
    });
    VOXTACT_TRY(written);
    noteEnds(checking.rows());
    return {};
}

} // namespace

Command addMotion(CLI::App& program) {
    auto options = std::make_shared<MotionOptions>();
    CLI::App* parser = program.add_subcommand("motion", "whether meshes touch on the way from pose to pose, and where");
    parser->footer(kFooter);
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
    addOutputOptions(*parser, options->output);
    return {parser, [options] { return runMotion(*options); }};
}

} // namespace voxtact::app
