// SPDX-License-Identifier: MIT
#include "app/commands.h"
#include "app/inputs.h"
#include "app/pair_pipeline.h"
#include "app/progress.h"
#include "app/session.h"
#include "app/standard_streams.h"
#include "app/version.h"
#include "core/text.h"
#include "voxtact/detector.h"
#include "voxtact/io.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace voxtact::app {

namespace {

/// Enough to keep a device busy while the host records; more only costs memory.
constexpr std::uint32_t kSubmissionsInFlight = 3;
constexpr std::uint32_t kDefaultBatch = 1024;

constexpr const char* kFooter =
    R"(--volume and --mesh may be given several times. One row a pair: every pose of every mesh against every volume. Columns:
  pose,mesh,volume             number of the pose in its file from 0; the sources as they were given
  hit,count                    1 when at least one fragment survives; how many do
  exact                        1: the count is exact; 0: only zero or not zero is known (query-any)
  method,projection            what the count comes from
  gpu_ms,wall_ms (--timing)    device time, and time from the start of recording to the results in host memory, of
                               the row's submission divided by its pairs. Submissions overlap: the last line
                               '# pairs= wall_ms= pairs_per_s=' has the time of all. Reading files, uploads and making
                               pipelines are not included; there is no warm-up. With --batch 1 each pair is submitted
                               and waited for alone.

Examples:
  voxtact detect --volume builtin:head:128 --mesh builtin:scalpel
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --opacity "40:0,80:1" --format json
  voxtact detect --volume head.nii.gz --mesh tool.stl --poses poses.txt --count atomic --timing --batch 1)";

struct DetectOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    MethodOptions method;
    DeviceChoice device;
    OutputOptions output;
    bool progress = false;
    bool timing = false;
    std::uint32_t batch = kDefaultBatch;
};

/// What is read before there is a device.
struct DetectInputs {
    std::vector<MeshData> meshes;
    std::vector<ControlPoint> points;
    std::vector<Mat4> poses;
    std::optional<Mat4> clip_from_world;
};

struct Row {
    std::uint32_t volume = 0;
    TimedAnswer timed;
};

struct DetectRun {
    std::vector<Row> rows;
    double wallMilliseconds = 0;
    std::string device;
    std::string driver;
};

Result<DetectInputs> readInputs(const DetectOptions& options) {
    for (const std::string& source : options.volumes) {
        // Volumes are read one at a time, so the last may be late: look now whether it is there at all.
        std::error_code ignored;
        if (!source.starts_with("builtin:") && !std::filesystem::exists(source, ignored)) {
            return Error{ErrorCode::File, 0, "cannot read '" + source + "': there is no such file or folder"};
        }
    }
    DetectInputs inputs;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    if (!points.ok()) {
        return points.error();
    }
    inputs.points = std::move(*points);
    Result<std::vector<Mat4>> poses = loadPoses(options.view.poses);
    if (!poses.ok()) {
        return poses.error();
    }
    inputs.poses = std::move(*poses);
    if (!options.view.camera.empty()) {
        const Result<Mat4> camera = io::readCamera(options.view.camera);
        if (!camera.ok()) {
            return camera.error();
        }
        inputs.clip_from_world = *camera;
    }
    for (const std::string& source : options.meshes.sources) {
        Result<MeshData> mesh = loadMesh(source, options.meshes);
        if (!mesh.ok()) {
            return mesh.error();
        }
        inputs.meshes.push_back(std::move(*mesh));
    }
    return inputs;
}

/// The given method; for auto, the first of the default, atomic and query-any that counts right on this driver.
Result<CountingMethod> chooseMethod(const Session& session, std::optional<CountingMethod> wanted) {
    if (wanted) {
        return *wanted;
    }
    const std::array order{session.context.defaultMethod(), CountingMethod::Query, CountingMethod::Atomic,
                           CountingMethod::QueryAny};
    const Result<std::vector<SelfTestVerdict>> verdicts =
        selfTest(session.context, session.device.queueAccess(), order);
    if (!verdicts.ok()) {
        return verdicts.error();
    }
    const auto trusted = [&](CountingMethod method) {
        return std::any_of(verdicts->begin(), verdicts->end(),
                           [&](const SelfTestVerdict& v) { return v.method == method && v.trusted; });
    };
    for (const CountingMethod method : order) {
        if (trusted(method)) {
            return method;
        }
    }
    return Error{ErrorCode::Unsupported, 0,
                 "no counting method passes its self-test on '" + session.device.physical().name +
                     "': see voxtact devices, and choose another device or driver"};
}

Result<void> checkViewport(const Session& session, const VkExtent2D& size) {
    const VkExtent2D most = session.context.maxViewport();
    if (size.width <= most.width && size.height <= most.height) {
        return {};
    }
    const auto text = [](const VkExtent2D& extent) {
        return std::to_string(extent.width) + "x" + std::to_string(extent.height);
    };
    return badArgument("--size: " + text(size) + " is beyond what '" + session.device.physical().name + "' can do, " +
                       text(most));
}

/// A size that the user chose and the device has not is an unusable argument.
Error blameTable(Error error) {
    if (error.code == ErrorCode::LimitExceeded) {
        return badArgument("--tf-size: " + error.text);
    }
    return error;
}

/// A domain that leaves out some of the data is the user's right, and easily a slip.
void noteValuesOutside(const ValueRange& domain, const ValueRange& data, const std::string& source) {
    if (data.lo < domain.lo || data.hi > domain.hi) {
        printNote(source + ": its values " + number(data.lo) + ":" + number(data.hi) +
                  " go beyond --tf-domain; they take the opacity at its ends");
    }
}

/// What stays the same while the volumes come and go.
struct DetectTools {
    const DetectOptions& options;
    const DetectInputs& inputs;
    const Session& session;
    const std::vector<Mesh>& meshes;
    PairPipeline& pipeline;
    Progress& progress;
};

/// All meshes and poses against one volume.
Result<void> detectVolume(const DetectTools& tools, std::uint32_t index, DetectRun& run) {
    const DetectOptions& options = tools.options;
    const std::string& source = options.volumes[index];
    const Result<VolumeData> data = loadVolume(source);
    if (!data.ok()) {
        return data.error();
    }
    const QueueAccess queue = tools.session.device.queueAccess();
    const Result<Volume> volume = Volume::upload(tools.session.context, queue, data->view(), source.c_str());
    if (!volume.ok()) {
        return volume.error();
    }
    const ValueRange values = volume->valueRange().value_or(ValueRange{});
    const ValueRange domain = tableDomain(options.transferFunction, data->type, values);
    const std::vector<ControlPoint> points = tools.inputs.points.empty() ? defaultRamp(domain) : tools.inputs.points;
    noteValuesOutside(domain, values, source);
    const Result<TransferFunction> transferFunction =
        TransferFunction::upload(tools.session.context, queue, {points, domain, options.transferFunction.tableSize});
    if (!transferFunction.ok()) {
        return blameTable(transferFunction.error());
    }
    std::vector<BatchItem> items;
    for (const Mesh& mesh : tools.meshes) {
        items.push_back({&mesh, &*volume, &*transferFunction, tools.inputs.poses});
    }
    const VkExtent2D size = options.view.size;
    const Mat4 clip_from_world = tools.inputs.clip_from_world ? *tools.inputs.clip_from_world
                                                              : framingCamera(volume->grid(), size.width, size.height);
    const auto begun = std::chrono::steady_clock::now();
    Result<void> done =
        tools.pipeline.run({items, {clip_from_world, size.width, size.height}, options.transferFunction.threshold},
                           [&](const TimedAnswer& timed) {
                               run.rows.push_back({index, timed});
                               tools.progress.update(run.rows.size());
                           });
    run.wallMilliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    return done;
}

Result<void> detectAll(const DetectOptions& options, const DetectInputs& inputs, const Session& session,
                       DetectRun& run) {
    if (Result<void> fits = checkViewport(session, options.view.size); !fits.ok()) {
        return fits;
    }
    run.device = session.device.physical().name;
    run.driver = session.device.physical().driver;
    const Result<CountingMethod> method = chooseMethod(session, options.method.count);
    if (!method.ok()) {
        return method.error();
    }
    const Result<Detector> detector = Detector::create(
        session.context, {*method, options.method.projection, options.method.filter.value_or(defaultFilter(*method)),
                          options.method.boundary});
    if (!detector.ok()) {
        return detector.error();
    }
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < inputs.meshes.size(); ++i) {
        Result<Mesh> mesh = Mesh::upload(session.context, session.device.queueAccess(), inputs.meshes[i].view(),
                                         options.meshes.sources[i].c_str());
        if (!mesh.ok()) {
            return mesh.error();
        }
        meshes.push_back(std::move(*mesh));
    }
    const std::uint64_t pairsOfVolume = static_cast<std::uint64_t>(meshes.size()) * inputs.poses.size();
    const auto perSubmission = static_cast<std::uint32_t>(std::min<std::uint64_t>(options.batch, pairsOfVolume));
    Result<PairPipeline> pipeline = PairPipeline::create(session.device, session.context, *detector,
                                                         {.frames = options.batch == 1 ? 1 : kSubmissionsInFlight,
                                                          .pairsPerSubmission = perSubmission,
                                                          .timestamps = options.timing});
    if (!pipeline.ok()) {
        return pipeline.error();
    }
    Progress progress(options.progress, "voxtact detect: pairs", pairsOfVolume * options.volumes.size());
    const DetectTools tools{options, inputs, session, meshes, *pipeline, progress};
    for (std::uint32_t index = 0; index < options.volumes.size(); ++index) {
        if (Result<void> done = detectVolume(tools, index, run); !done.ok()) {
            return done;
        }
    }
    return {};
}

/// To so many parts of one, so that the shortest text for it is short.
double rounded(double value, double parts) {
    return std::round(value * parts) / parts;
}

Cell cellOf(const DetectOptions& options, const Row& row, std::size_t column) {
    const PairAnswer& answer = row.timed.answer;
    switch (column) {
    case 0:
        return std::uint64_t{row.timed.pose};
    case 1:
        return options.meshes.sources[row.timed.item];
    case 2:
        return options.volumes[row.volume];
    case 3:
        return std::uint64_t{answer.hit ? 1U : 0U};
    case 4:
        return answer.count;
    case 5:
        return std::uint64_t{answer.exactness == Exactness::Exact ? 1U : 0U};
    case 6:
        return std::string(toString(answer.method));
    case 7:
        return std::string(toString(answer.projection));
    case 8:
        return row.timed.gpuMilliseconds ? Cell(rounded(*row.timed.gpuMilliseconds, 1e6)) : Cell();
    default:
        return rounded(row.timed.wallMilliseconds, 1e6);
    }
}

Table makeTable(const DetectOptions& options, const DetectRun& run) {
    Table table;
    table.columns = {"pose", "mesh", "volume", "hit", "count", "exact", "method", "projection"};
    table.rows = run.rows.size();
    table.cell = [&](std::size_t row, std::size_t column) { return cellOf(options, run.rows[row], column); };
    table.facts = {{"voxtact", programVersion()}, {"device", run.device}, {"driver", run.driver}};
    if (options.timing) {
        table.columns.insert(table.columns.end(), {"gpu_ms", "wall_ms"});
        const double seconds = run.wallMilliseconds / 1000;
        const double rate = seconds > 0 ? static_cast<double>(run.rows.size()) / seconds : 0;
        table.timing = {{"pairs", std::uint64_t{run.rows.size()}},
                        {"wall_ms", rounded(run.wallMilliseconds, 1e6)},
                        {"pairs_per_s", rounded(rate, 10)}};
    }
    return table;
}

Outcome runDetect(const DetectOptions& options) {
    if (const Result<void> writable = checkOutput(options.output.path); !writable.ok()) {
        return writable.error();
    }
    const Result<DetectInputs> inputs = readInputs(options);
    if (!inputs.ok()) {
        return inputs.error();
    }
    DetectRun run;
    std::shared_ptr<const ValidationMessages> messages;
    {
        const Result<Session> session = openSession(options.device);
        if (!session.ok()) {
            return session.error();
        }
        messages = session->instance.messages();
        if (const Result<void> done = detectAll(options, *inputs, *session, run); !done.ok()) {
            return done.error();
        }
    }
    if (Outcome invalid = validationOutcome(*messages); invalid.status != kExitDone) {
        return invalid;
    }
    const Result<void> written = deliver(options.output.path, [&](std::ostream& out) -> Result<void> {
        writeTable(out, options.output.format(), makeTable(options, run));
        return {};
    });
    return written.ok() ? Outcome() : Outcome(written.error());
}

} // namespace

Command addDetect(CLI::App& program) {
    auto options = std::make_shared<DetectOptions>();
    CLI::App* parser = program.add_subcommand("detect", "which pairs of mesh and volume touch, and how much");
    parser->footer(kFooter);
    addVolumeOption(*parser, options->volumes);
    addMeshOptions(*parser, options->meshes);
    addTransferFunctionOptions(*parser, options->transferFunction);
    addViewOptions(*parser, options->view);
    addMethodOptions(*parser, options->method);
    addWholeNumber(*parser, "--batch", options->batch, 1, "pairs a submission");
    parser->add_flag("--timing", options->timing, "adds gpu_ms and wall_ms to each row, and a last line; see below");
    addDeviceOptions(*parser, options->device);
    addOutputOptions(*parser, options->output);
    addProgressOption(*parser, options->progress);
    return {parser, [options] { return runDetect(*options); }};
}

} // namespace voxtact::app
