// SPDX-License-Identifier: MIT
#include "app/detect/pair_engine.h"
#include "app/options/inputs.h"
#include "core/base/try.h"
#include "core/batch/batch_cutter.h"
#include "voxtact/cpu.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// Of volumes that are kept for a later job.
constexpr std::uint64_t kMostHostVolumeBytes = std::uint64_t{2} << 30U;

struct HostVolume {
    cpu::Volume volume;
    cpu::TransferFunction transferFunction;
    View view;
    std::uint64_t bytes = 0;
};

/// What answers in addition to a detector, where it is asked for.
struct HostMeters {
    std::optional<cpu::ClearanceMeter> clearance{};
    std::optional<cpu::AreaMeter> area{};
    std::optional<cpu::MotionChecker> motion{};
};

class HostEngine : public PairEngine {
  public:
    HostEngine(const DetectOptions& options, const DetectInputs& inputs, cpu::Detector detector, HostMeters meters,
               std::vector<cpu::Mesh> meshes)
        : options_(options), inputs_(inputs), detector_(std::move(detector)), meters_(std::move(meters)),
          meshes_(std::move(meshes)), shelf_(options.jobs, kMostHostVolumeBytes),
          pace_(pairsPerBatch(options, inputs, 1), options.batch.has_value() || options.timing) {}

    [[nodiscard]] std::string device() const override { return "host"; }
    [[nodiscard]] std::string driver() const override {
        return "cpu, " + std::to_string(detector_.threads()) + (detector_.threads() == 1 ? " thread" : " threads");
    }
    [[nodiscard]] PairAnswer untouched() const override {
        PairAnswer answer;
        answer.exactness = options_.yesNo() ? Exactness::LowerBound : Exactness::Exact;
        answer.method = CountingMethod::Cpu;
        answer.projection = *options_.method.projection;
        return answer;
    }
    [[nodiscard]] Result<Grid> use(std::uint32_t job) override;
    [[nodiscard]] Result<void> answer(const Window& window, WindowRows& rows,
                                      const std::function<bool()>& stop) override;

  private:
    [[nodiscard]] Result<HostVolume> make(std::uint32_t volume) const;
    [[nodiscard]] Result<BatchAnswer> answer(const cpu::Batch& batch);
    [[nodiscard]] Result<ClearanceAnswer> measure(const cpu::Batch& batch);
    [[nodiscard]] Result<LabelClearanceAnswer> measureLabels(const cpu::Batch& batch);
    [[nodiscard]] Result<TriangleAreaAnswer> measureArea(const cpu::Batch& batch);
    [[nodiscard]] Result<LabelAreaAnswer> measureLabelAreas(const cpu::Batch& batch);

    const DetectOptions& options_;
    const DetectInputs& inputs_;
    cpu::Detector detector_;
    HostMeters meters_;
    std::vector<cpu::Mesh> meshes_;
    VolumeShelf<HostVolume> shelf_;
    HostVolume* volume_ = nullptr;
    BatchPace pace_;
};

Result<HostVolume> HostEngine::make(std::uint32_t number) const {
    const Result<VolumeData> data = loadVolume(options_.jobs.volumes[number]);
    VOXTACT_TRY(data);
    VOXTACT_TRY(checkMeasuredGrid(options_, inputs_, data->grid));
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    Result<cpu::Volume> volume = cpu::Volume::create(data->view());
    VOXTACT_TRY(volume);
    const VolumeSettings settings = settingsFor(options_, inputs_, number, *data, *values);
    Result<cpu::TransferFunction> function =
        cpu::TransferFunction::create({settings.points, settings.domain, options_.transferFunction.tableSize});
    VOXTACT_TRY(function);
    return HostVolume{std::move(*volume), std::move(*function), settings.view, data->voxels.size()};
}

Result<Grid> HostEngine::use(std::uint32_t job) {
    const Result<HostVolume*> volume = shelf_.get(job, [&] { return make(options_.jobs.jobs[job].volume); });
    VOXTACT_TRY(volume);
    volume_ = *volume;
    return volume_->volume.grid();
}

/// Does it touch, or does what is within the margin, or a pose within the tolerance.
Result<BatchAnswer> HostEngine::answer(const cpu::Batch& batch) {
    const DistanceOptions& distance = options_.distance;
    return distance.margin          ? meters_.clearance->within(batch, *distance.margin)
           : distance.poseTolerance ? meters_.motion->around(batch, *distance.poseTolerance)
                                    : detector_.detect(batch);
}

/// Nothing where clearances are not asked for.
Result<ClearanceAnswer> HostEngine::measure(const cpu::Batch& batch) {
    return options_.distance.clearance ? meters_.clearance->measure(batch) : ClearanceAnswer{};
}

/// Nothing where these are not asked for.
Result<LabelClearanceAnswer> HostEngine::measureLabels(const cpu::Batch& batch) {
    if (options_.distance.labels.empty()) {
        return LabelClearanceAnswer{};
    }
    return meters_.clearance->measureLabels(batch, inputs_.measured);
}

/// Nothing where areas are not asked for, or not those of triangles.
Result<TriangleAreaAnswer> HostEngine::measureArea(const cpu::Batch& batch) {
    if (!options_.distance.area) {
        return TriangleAreaAnswer{};
    }
    if (!options_.distance.triangleAreas.empty()) {
        return meters_.area->measureTriangles(batch);
    }
    Result<AreaAnswer> measured = meters_.area->measure(batch);
    VOXTACT_TRY(measured);
    return TriangleAreaAnswer{std::move(measured->pairs), {}, measured->wallMilliseconds};
}

/// Nothing where these are not asked for.
Result<LabelAreaAnswer> HostEngine::measureLabelAreas(const cpu::Batch& batch) {
    if (options_.distance.labelAreas.empty()) {
        return LabelAreaAnswer{};
    }
    return meters_.area->measureLabels(batch, inputs_.measured);
}

Result<void> HostEngine::answer(const Window& window, WindowRows& rows, const std::function<bool()>& stop) {
    std::vector<cpu::BatchItem> all;
    for (const WindowItem& item : window.items) {
        all.push_back({&meshes_[options_.jobs.jobs[item.job].mesh], &volume_->volume, &volume_->transferFunction,
                       item.selected, inputs_.labels ? &*inputs_.labels : nullptr});
    }
    BatchCutter<cpu::BatchItem> cutter(all);
    std::vector<cpu::BatchItem> items;
    std::vector<Piece> pieces;
    while (!stop() && cutter.next(pace_.size(), items, pieces)) {
        const cpu::Batch batch{items, volume_->view, options_.transferFunction.threshold};
        const Result<BatchAnswer> answered = answer(batch);
        VOXTACT_TRY(answered);
        const Result<ClearanceAnswer> measured = measure(batch);
        VOXTACT_TRY(measured);
        const Result<LabelClearanceAnswer> labels = measureLabels(batch);
        VOXTACT_TRY(labels);
        const Result<TriangleAreaAnswer> areas = measureArea(batch);
        VOXTACT_TRY(areas);
        const Result<LabelAreaAnswer> labelAreas = measureLabelAreas(batch);
        VOXTACT_TRY(labelAreas);
        const double milliseconds = answered->wallMilliseconds + measured->wallMilliseconds + labels->wallMilliseconds +
                                    areas->wallMilliseconds + labelAreas->wallMilliseconds;
        device::TimedAnswer timed;
        timed.gpuMilliseconds = 0;
        timed.wallMilliseconds = milliseconds / static_cast<double>(answered->pairs.size());
        for (const PairAnswer& pair : answered->pairs) {
            timed.answer = pair;
            timed.item = pieces[pair.item].item;
            timed.pose = pieces[pair.item].firstPose + pair.pose;
            rows.add(timed);
        }
        for (const PairClearance& clearance : measured->pairs) {
            rows.addClearance(clearance);
        }
        for (const LabelClearance& clearance : labels->labels) {
            rows.addClearance(clearance);
        }
        for (const PairArea& area : areas->pairs) {
            rows.addArea(area);
        }
        for (const LabelArea& area : labelAreas->labels) {
            rows.addArea(area);
        }
        for (const TriangleArea& area : areas->triangles) {
            rows.addArea(area);
        }
        rows.endBatch(*answered);
        pace_.took(static_cast<std::uint32_t>(answered->pairs.size()), milliseconds);
    }
    return {};
}

Result<void> checkLimits(const DetectOptions& options) {
    return !usesView(*options.method.projection)
               ? Result<void>()
               : checkViewport(options.view.size, {cpu::kMaxViewport, cpu::kMaxViewport}, "the counting method cpu");
}

Result<HostMeters> metersFor(const DetectOptions& options) {
    const double resolution = options.method.resolution.value_or(kDefaultResolution);
    const DistanceOptions& distance = options.distance;
    HostMeters meters;
    if (distance.poseTolerance) {
        Result<cpu::MotionChecker> made =
            cpu::MotionChecker::create({.threads = options.threads, .touchResolution = resolution});
        VOXTACT_TRY(made);
        meters.motion = std::move(*made);
    }
    if (distance.clearance || distance.margin) {
        const ClearanceSearch search = distance.search();
        Result<cpu::ClearanceMeter> made = cpu::ClearanceMeter::create({.threads = options.threads,
                                                                        .tolerance = search.tolerance,
                                                                        .maximum = search.maximum,
                                                                        .resolution = resolution,
                                                                        .labelsAtAnyOpacity = distance.toAnyOpacity});
        VOXTACT_TRY(made);
        meters.clearance = std::move(*made);
    }
    if (distance.area) {
        Result<cpu::AreaMeter> made = cpu::AreaMeter::create(
            {.threads = options.threads, .tolerance = distance.areaGoal(), .resolution = resolution});
        VOXTACT_TRY(made);
        meters.area = std::move(*made);
    }
    return meters;
}

} // namespace

Result<void> withHostEngine(const DetectOptions& options, const DetectInputs& inputs, const UseEngine& answer) {
    VOXTACT_TRY(checkLimits(options));
    const MethodOptions& method = options.method;
    Result<cpu::Detector> detector =
        cpu::Detector::create({.threads = options.threads,
                               .boundary = method.boundary,
                               .stopAtFirst = options.yesNo(),
                               .projection = *method.projection,
                               .outputs = options.extra.outputs(),
                               .samplesPerVoxel = method.samplesPerVoxel.value_or(kDefaultSamplesPerVoxel),
                               .resolution = method.resolution.value_or(kDefaultResolution),
                               .mostContacts = options.extra.contactRoom()});
    VOXTACT_TRY(detector);
    std::vector<cpu::Mesh> meshes;
    for (const MeshData& data : inputs.meshes) {
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        meshes.push_back(std::move(*mesh));
    }
    Result<HostMeters> meters = metersFor(options);
    VOXTACT_TRY(meters);
    HostEngine engine(options, inputs, std::move(*detector), std::move(*meters), std::move(meshes));
    return answer(engine);
}

} // namespace voxtact::app
