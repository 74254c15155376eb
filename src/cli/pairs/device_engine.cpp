// SPDX-License-Identifier: MIT
#include "cli/options/inputs.h"
#include "cli/pairs/pair_engine.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "voxtact/detector.h"
#include "voxtact/device_results.h"

#include <algorithm>
#include <optional>

namespace voxtact::app {

namespace {

/// On the device and on the host.
constexpr std::uint64_t kBytesOfContact = 2 * sizeof(ContactResult);

/// Maximum bytes of volumes kept for later jobs: below the memory of all devices.
constexpr std::uint64_t kMaxVolumeBytes = std::uint64_t{512} << 20U;

/// A requested size beyond the device is an unusable argument.
Error blameTable(Error error) {
    if (error.code == ErrorCode::LimitExceeded) {
        return badArgument("--tf-size: " + error.text);
    }
    return error;
}

/// Names --max-contacts, which sets the capacity for contacts.
Error blameContacts(Error error, const PairOptions& options) {
    if (error.code == ErrorCode::LimitExceeded && options.extra.maxContacts) {
        return badArgument("--max-contacts: " + error.text);
    }
    return error;
}

struct DeviceVolume {
    Volume volume;
    TransferFunction transferFunction;
    View view;
    OpaqueVoxels opaque;
    Grid grid;
    std::uint64_t bytes = 0;
    bool isResampled = false;
};

/// Objects uploaded once.
struct DeviceScene {
    std::vector<Mesh> meshes;
    std::optional<LabelMap> labels;
};

class DeviceEngine : public PairEngine {
  public:
    DeviceEngine(const PairOptions& options, const PairInputs& inputs, const device::Session& session,
                 CountingMethod method, const DeviceScene& scene, device::PairPipeline& pipeline, std::uint32_t pairs)
        : options_(options), inputs_(inputs), session_(session), method_(method), scene_(scene), pipeline_(pipeline),
          shelf_(options.jobs, kMaxVolumeBytes), pace_(pairs, options.batch.has_value() || options.timing) {}

    [[nodiscard]] std::string device() const override { return session_.device.physical().name; }
    [[nodiscard]] std::string driver() const override { return session_.device.physical().driver; }
    [[nodiscard]] PairAnswer untouched() const override {
        PairAnswer answer;
        answer.exactness = options_.isTouch() ? Exactness::LowerBound : exactness(method_);
        answer.method = method_;
        answer.projection = *options_.method.projection;
        return answer;
    }
    [[nodiscard]] Result<Grid> use(std::uint32_t job) override;
    [[nodiscard]] OpaqueVoxels opaque() const override { return volume_->opaque; }
    [[nodiscard]] bool isResampled() const override { return volume_->isResampled; }
    [[nodiscard]] Result<void> answer(const Window& window, WindowRows& rows,
                                      const std::function<bool()>& stop) override;

  private:
    [[nodiscard]] Result<DeviceVolume> make(std::uint32_t volume) const;

    const PairOptions& options_;
    const PairInputs& inputs_;
    const device::Session& session_;
    CountingMethod method_;
    const DeviceScene& scene_;
    device::PairPipeline& pipeline_;
    VolumeShelf<DeviceVolume> shelf_;
    DeviceVolume* volume_ = nullptr;
    BatchPace pace_;
};

Result<DeviceVolume> DeviceEngine::make(std::uint32_t number) const {
    const std::string& source = options_.jobs.volumes[number];
    const Result<VolumeData> data = loadVolume(source, {.resample = options_.resample});
    VOXTACT_TRY(data);
    const QueueAccess queue = session_.device.queueAccess();
    Result<Volume> volume =
        Volume::upload(session_.context, queue, data->view(),
                       {.name = source.c_str(), .bricks = rowOf(*options_.method.projection).certified});
    VOXTACT_TRY(volume);
    const VolumeSettings settings =
        settingsFor(options_, inputs_, number, *data, volume->valueRange().value_or(ValueRange{}));
    Result<TransferFunction> function =
        TransferFunction::upload(session_.context, queue, {settings.points, settings.domain, settings.tableSize});
    if (!function.ok()) {
        return blameTable(function.error());
    }
    return DeviceVolume{std::move(*volume), std::move(*function), settings.view,          settings.opaque,
                        data->grid,         data->voxels.size(),  io::wasResampled(*data)};
}

Result<Grid> DeviceEngine::use(std::uint32_t job) {
    const Result<DeviceVolume*> volume = shelf_.get(job, [&] { return make(options_.jobs.jobs[job].volume); });
    VOXTACT_TRY(volume);
    volume_ = *volume;
    return volume_->grid;
}

Result<void> DeviceEngine::answer(const Window& window, WindowRows& rows, const std::function<bool()>& stop) {
    std::vector<BatchItem> items;
    for (const WindowItem& item : window.items) {
        items.push_back({&scene_.meshes[options_.jobs.jobs[item.job].mesh], &volume_->volume,
                         &volume_->transferFunction, item.selected, scene_.labels ? &*scene_.labels : nullptr});
    }
    return pipeline_.run({items, volume_->view, options_.transferFunction.threshold},
                         {.pair = [&](const device::TimedAnswer& timed) { rows.add(timed); },
                          .submission = [&](const BatchAnswer& answer) { rows.endBatch(answer); },
                          .stop = stop,
                          .pace = &pace_});
}

DetectorDesc descOf(const PairOptions& options, CountingMethod method) {
    if (rowOf(*options.method.projection).certified) {
        return CertifiedDesc{.resolution = options.method.resolution.value_or(kDefaultResolution),
                             .outputs = options.extra.outputs(),
                             .stopAtFirst = options.isTouch(),
                             .counters = options.stats};
    }
    return RasterDesc{.method = method,
                      .projection = *options.method.projection,
                      .filter = options.method.filter.value_or(defaultFilter(method)),
                      .boundary = options.method.boundary,
                      .outputs = options.extra.outputs(),
                      .samplesPerVoxel = options.method.samplesPerVoxel.value_or(kDefaultSamplesPerVoxel)};
}

/// Limits size and number of submissions, so that additional outputs stay within their memory.
device::PipelineDesc pipelineDescOf(const PairOptions& options, const PairInputs& inputs) {
    const Outputs outputs = options.extra.outputs();
    const std::uint64_t contactBytes = outputs.contacts ? options.extra.contactRoom() * kBytesOfContact : 0;
    const bool oneAtATime = options.maxPairs() == 1 || contactBytes * kSubmissionsInFlight > kMaxOutputBytes;
    device::PipelineDesc desc;
    desc.frames = oneAtATime ? 1 : kSubmissionsInFlight;
    desc.pairsPerSubmission = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        pairsPerBatch(options, inputs, desc.frames),
        std::clamp<std::uint64_t>(inputs.pairs(options.jobs).value_or(kDefaultBatch), 1, kWindowPairs)));
    desc.timestamps = options.timing;
    desc.room = {.triangles = desc.pairsPerSubmission * maxTriangles(inputs),
                 .labels = inputs.labels ? desc.pairsPerSubmission * std::uint64_t{inputs.labels->values.size()} : 0,
                 .contacts = options.extra.contactRoom()};
    return desc;
}

Result<DeviceScene> uploadScene(const PairOptions& options, const PairInputs& inputs, const device::Session& session) {
    DeviceScene scene;
    const QueueAccess queue = session.device.queueAccess();
    for (std::size_t i = 0; i < inputs.meshes.size(); ++i) {
        Result<Mesh> mesh = Mesh::upload(session.context, queue, inputs.meshes[i].view(),
                                         {.name = options.jobs.meshes[i].c_str(), .clusters = true});
        VOXTACT_TRY(mesh);
        scene.meshes.push_back(std::move(*mesh));
    }
    if (inputs.labels) {
        Result<LabelMap> labels =
            LabelMap::upload(session.context, queue, *inputs.labels, options.labels.path.string().c_str());
        VOXTACT_TRY(labels);
        scene.labels = std::move(*labels);
    }
    return scene;
}

} // namespace

Result<void> withDeviceEngine(const PairOptions& options, const PairInputs& inputs, const device::Session& session,
                              CountingMethod method, const UseEngine& answer) {
    if (usesView(*options.method.projection)) {
        VOXTACT_TRY(checkViewport(options.view.size, session.context.maxViewport(),
                                  "'" + session.device.physical().name + "'"));
    }
    const Result<Detector> detector = Detector::create(session.context, descOf(options, method));
    VOXTACT_TRY(detector);
    const Result<DeviceScene> scene = uploadScene(options, inputs, session);
    VOXTACT_TRY(scene);
    const device::PipelineDesc desc = pipelineDescOf(options, inputs);
    Result<device::PairPipeline> pipeline =
        device::PairPipeline::create(session.device, session.context, *detector, desc);
    if (!pipeline.ok()) {
        return blameContacts(pipeline.error(), options);
    }
    DeviceEngine engine(options, inputs, session, method, *scene, *pipeline, desc.pairsPerSubmission);
    return answer(engine);
}

} // namespace voxtact::app
