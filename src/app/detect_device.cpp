// SPDX-License-Identifier: MIT
#include "app/detect_run.h"
#include "app/inputs.h"
#include "app/pair_rows.h"
#include "app/progress.h"
#include "voxtact/contact_result.h"
#include "voxtact/detector.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace voxtact::app {

namespace {

/// Enough to keep a device busy while the host records; more only costs memory.
constexpr std::uint32_t kSubmissionsInFlight = 3;

/// On the device and on the host.
constexpr std::uint64_t kBytesOfContact = 2 * sizeof(ContactResult);

/// A size that the user chose and the device has not is an unusable argument.
Error blameTable(Error error) {
    if (error.code == ErrorCode::LimitExceeded) {
        return badArgument("--tf-size: " + error.text);
    }
    return error;
}

/// What stays the same while the volumes come and go.
struct DetectTools {
    const DetectOptions& options;
    const DetectInputs& inputs;
    const Session& session;
    const std::vector<Mesh>& meshes;
    const LabelMap* labels; ///< may be null
    const DetectorDesc& desc;
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
    const Result<Volume> volume =
        Volume::upload(tools.session.context, queue, data->view(),
                       {.name = source.c_str(), .bricks = tools.desc.projection == Projection::Conservative});
    if (!volume.ok()) {
        return volume.error();
    }
    const VolumeSettings settings =
        settingsFor(options, tools.inputs, index, *data, volume->valueRange().value_or(ValueRange{}));
    const Result<TransferFunction> transferFunction = TransferFunction::upload(
        tools.session.context, queue, {settings.points, settings.domain, options.transferFunction.tableSize});
    if (!transferFunction.ok()) {
        return blameTable(transferFunction.error());
    }
    const std::vector<SelectedPoses> selected = selectPoses(options, tools.inputs, data->grid);
    std::vector<BatchItem> items;
    for (std::size_t mesh = 0; mesh < selected.size(); ++mesh) {
        items.push_back(
            {&tools.meshes[mesh], &*volume, &*transferFunction, selected[mesh].world_from_object, tools.labels});
    }
    std::uint64_t progress = run.rows.size();
    PairAnswer untouched;
    untouched.exactness = exactness(tools.desc.method);
    untouched.method = tools.desc.method;
    untouched.projection = tools.desc.projection;
    PairRows rows(options, tools.inputs, selected, index, untouched, run);
    const auto begun = std::chrono::steady_clock::now();
    Result<void> done = tools.pipeline.run(
        {items, settings.view, options.transferFunction.threshold},
        [&](const TimedAnswer& timed) {
            rows.add(timed);
            tools.progress.update(++progress);
        },
        [&](const BatchAnswer& answer) { rows.addOutputs(answer); });
    run.wallMilliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    return done;
}

DetectorDesc descOf(const DetectOptions& options, CountingMethod method) {
    DetectorDesc desc;
    desc.method = method;
    desc.projection = *options.method.projection;
    desc.filter = options.method.filter.value_or(defaultFilter(method));
    desc.boundary = options.method.boundary;
    desc.outputs = options.extra.outputs();
    desc.samplesPerVoxel = options.method.samplesPerVoxel.value_or(kDefaultSamplesPerVoxel);
    desc.resolution = options.method.resolution.value_or(kDefaultResolution);
    return desc;
}

/// Submissions so large, and so many of them, that the answers beside the counts keep within what they may take.
PipelineDesc pipelineDescOf(const DetectOptions& options, const DetectInputs& inputs, std::uint64_t pairsOfVolume) {
    const Outputs outputs = options.extra.outputs();
    const std::uint64_t contactBytes = outputs.contacts ? options.extra.contactRoom() * kBytesOfContact : 0;
    const bool oneAtATime = options.batch == 1 || contactBytes * kSubmissionsInFlight > kMostOutputBytes;
    PipelineDesc desc;
    desc.frames = oneAtATime ? 1 : kSubmissionsInFlight;
    desc.pairsPerSubmission =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(pairsPerBatch(options, inputs, desc.frames), pairsOfVolume));
    desc.timestamps = options.timing;
    if (outputs.any()) {
        desc.room = OutputRoom{
            .triangles = outputs.triangles ? desc.pairsPerSubmission * mostTriangles(inputs) : 0,
            .labels = outputs.labels ? desc.pairsPerSubmission * std::uint64_t{inputs.labels->values.size()} : 0,
            .contacts = outputs.contacts ? options.extra.contactRoom() : 0};
    }
    return desc;
}

/// The room for contacts is what the user chose.
Error blameContacts(Error error, const DetectOptions& options) {
    if (error.code == ErrorCode::LimitExceeded && options.extra.mostContacts) {
        return badArgument("--most-contacts: " + error.text);
    }
    return error;
}

} // namespace

Result<void> detectOnDevice(const DetectOptions& options, const DetectInputs& inputs, const Session& session,
                            CountingMethod method, DetectRun& run) {
    const PhysicalDevice& physical = session.device.physical();
    if (Result<void> fits =
            usesView(*options.method.projection)
                ? checkViewport(options.view.size, session.context.maxViewport(), "'" + physical.name + "'")
                : Result<void>();
        !fits.ok()) {
        return fits;
    }
    run.device = physical.name;
    run.driver = physical.driver;
    const Result<Detector> detector = Detector::create(session.context, descOf(options, method));
    if (!detector.ok()) {
        return detector.error();
    }
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < inputs.meshes.size(); ++i) {
        Result<Mesh> mesh = Mesh::upload(session.context, session.device.queueAccess(), inputs.meshes[i].view(),
                                         {.name = options.meshes.sources[i].c_str(), .clusters = true});
        if (!mesh.ok()) {
            return mesh.error();
        }
        meshes.push_back(std::move(*mesh));
    }
    std::optional<LabelMap> labels;
    if (inputs.labels) {
        Result<LabelMap> uploaded = LabelMap::upload(session.context, session.device.queueAccess(), *inputs.labels,
                                                     options.extra.labels.string().c_str());
        if (!uploaded.ok()) {
            return uploaded.error();
        }
        labels = std::move(*uploaded);
    }
    const std::uint64_t pairsOfVolume = static_cast<std::uint64_t>(meshes.size()) * inputs.poses.size();
    Result<PairPipeline> pipeline = PairPipeline::create(session.device, session.context, *detector,
                                                         pipelineDescOf(options, inputs, pairsOfVolume));
    if (!pipeline.ok()) {
        return blameContacts(pipeline.error(), options);
    }
    Progress progress(options.progress, "voxtact detect: pairs", pairsOfVolume * options.volumes.size());
    const DetectTools tools{options,          inputs,    session, meshes, labels ? &*labels : nullptr,
                            detector->desc(), *pipeline, progress};
    for (std::uint32_t index = 0; index < options.volumes.size(); ++index) {
        if (Result<void> done = detectVolume(tools, index, run); !done.ok()) {
            return done;
        }
    }
    return {};
}

} // namespace voxtact::app
