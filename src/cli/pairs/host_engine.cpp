// SPDX-License-Identifier: MIT
#include "cli/options/inputs.h"
#include "cli/pairs/pair_engine.h"
#include "core/base/try.h"
#include "core/batch/batch_cutter.h"
#include "voxtact/cpu.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// Maximum bytes of volumes kept for later jobs.
constexpr std::uint64_t kMaxHostVolumeBytes = std::uint64_t{2} << 30U;

struct HostVolume {
    cpu::Volume volume;
    cpu::TransferFunction transferFunction;
    View view;
    OpaqueVoxels opaque;
    std::uint64_t bytes = 0;
    std::optional<LabelData> labels; ///< replace the labels of all volumes
    bool isResampled = false;
};

class HostPairs : public PairEngine {
  public:
    HostPairs(const PairOptions& options, const PairInputs& inputs, cpu::HostEngine engine,
              std::vector<cpu::Mesh> meshes)
        : options_(options), inputs_(inputs), engine_(std::move(engine)), meshes_(std::move(meshes)),
          shelf_(options.jobs, kMaxHostVolumeBytes),
          pace_(pairsPerBatch(options, inputs, 1), options.batch.has_value() || options.timing) {}

    [[nodiscard]] std::string device() const override { return "host"; }
    [[nodiscard]] std::string driver() const override {
        return "cpu, " + std::to_string(engine_.threads()) + (engine_.threads() == 1 ? " thread" : " threads");
    }
    [[nodiscard]] PairAnswer untouched() const override {
        PairAnswer answer;
        answer.exactness = options_.isTouch() ? Exactness::LowerBound : Exactness::Exact;
        answer.method = CountingMethod::Cpu;
        answer.projection = *options_.method.projection;
        return answer;
    }
    [[nodiscard]] Result<Grid> use(std::uint32_t job) override;
    [[nodiscard]] OpaqueVoxels opaque() const override { return volume_->opaque; }
    [[nodiscard]] bool isResampled() const override { return volume_->isResampled; }
    [[nodiscard]] Result<void> answer(const Window& window, WindowRows& rows,
                                      const std::function<bool()>& stop) override;

  private:
    [[nodiscard]] Result<HostVolume> make(std::uint32_t volume) const;
    /// Add the rows of all pairs of the batch. Return the duration in milliseconds.
    [[nodiscard]] Result<double> addTouches(const cpu::Batch& batch, std::span<const Piece> pieces, WindowRows& rows);
    [[nodiscard]] Result<double> addCounts(const cpu::Batch& batch, std::span<const Piece> pieces, WindowRows& rows);
    [[nodiscard]] Result<double> addMeasured(const cpu::Batch& batch, std::span<const Piece> pieces, WindowRows& rows);

    const PairOptions& options_;
    const PairInputs& inputs_;
    cpu::HostEngine engine_;
    std::vector<cpu::Mesh> meshes_;
    VolumeShelf<HostVolume> shelf_;
    HostVolume* volume_ = nullptr;
    BatchPace pace_;
};

Result<HostVolume> HostPairs::make(std::uint32_t number) const {
    const Result<VolumeData> data = loadVolume(options_.jobs.volumes[number], {.resample = options_.resample});
    VOXTACT_TRY(data);
    Result<std::optional<LabelData>> labels = measuredLabels(options_, inputs_, data->grid);
    VOXTACT_TRY(labels);
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    Result<cpu::Volume> volume = cpu::Volume::create(data->view());
    VOXTACT_TRY(volume);
    const VolumeSettings settings = settingsFor(options_, inputs_, number, *data, *values);
    Result<cpu::TransferFunction> function =
        cpu::TransferFunction::create({settings.points, settings.domain, settings.tableSize});
    VOXTACT_TRY(function);
    return HostVolume{std::move(*volume),  std::move(*function), settings.view,          settings.opaque,
                      data->voxels.size(), std::move(*labels),   io::wasResampled(*data)};
}

Result<Grid> HostPairs::use(std::uint32_t job) {
    const Result<HostVolume*> volume = shelf_.get(job, [&] { return make(options_.jobs.jobs[job].volume); });
    VOXTACT_TRY(volume);
    volume_ = *volume;
    return volume_->volume.grid();
}

/// Adds a row without an answer for each pair.
void addPairs(const BatchAnswer& answer, std::span<const Piece> pieces, WindowRows& rows) {
    device::TimedAnswer timed;
    timed.gpuMilliseconds = 0;
    for (const PairAnswer& pair : answer.pairs) {
        timed.answer = pair;
        timed.item = pieces[pair.item].item;
        timed.pose = pieces[pair.item].firstPose + pair.pose;
        rows.add(timed);
    }
}

/// Ends a batch whose rows are all added. Returns its milliseconds.
double ended(const BatchAnswer& answer, double milliseconds, WindowRows& rows) {
    rows.setTime(milliseconds / static_cast<double>(answer.pairs.size()));
    rows.endBatch(answer);
    return milliseconds;
}

/// Returns the pairs of the batch, not answered yet.
BatchAnswer pairsOf(const cpu::Batch& batch) {
    BatchAnswer answer;
    for (std::uint32_t item = 0; item < batch.items.size(); ++item) {
        for (std::uint32_t pose = 0; pose < batch.items[item].world_from_object.size(); ++pose) {
            answer.pairs.push_back(
                {.pair = static_cast<std::uint32_t>(answer.pairs.size()), .item = item, .pose = pose});
        }
    }
    return answer;
}

Result<double> HostPairs::addTouches(const cpu::Batch& batch, std::span<const Piece> pieces, WindowRows& rows) {
    const Result<TouchAnswer> touched = engine_.ask(Touch{.margin = options_.touch.margin.value_or(0),
                                                          .uncertainty = options_.touch.uncertainty,
                                                          .witness = true,
                                                          .solid = options_.touch.solid},
                                                    batch);
    VOXTACT_TRY(touched);
    BatchAnswer answer;
    for (const PairTouch& pair : touched->pairs) {
        PairAnswer row = untouched();
        row.pair = pair.pair;
        row.item = pair.item;
        row.pose = pair.pose;
        row.hit = pair.touch == Verdict::Yes;
        row.possible = pair.touch == Verdict::Undecided;
        row.count = row.hit ? 1 : 0;
        answer.pairs.push_back(row);
    }
    addPairs(answer, pieces, rows);
    for (const PairTouch& pair : touched->pairs) {
        if (pair.witness) {
            rows.addWitness(pair.pair, *pair.witness);
        }
    }
    return ended(answer, touched->wallMilliseconds, rows);
}

Result<double> HostPairs::addCounts(const cpu::Batch& batch, std::span<const Piece> pieces, WindowRows& rows) {
    const MethodOptions& method = options_.method;
    const Result<BatchAnswer> counted =
        engine_.ask(Count{.projection = *method.projection,
                          .boundary = method.boundary,
                          .outputs = options_.extra.outputs(),
                          .samplesPerVoxel = method.samplesPerVoxel.value_or(kDefaultSamplesPerVoxel),
                          .resolution = method.resolution.value_or(kDefaultResolution),
                          .maxContacts = options_.extra.contactRoom()},
                    batch);
    VOXTACT_TRY(counted);
    addPairs(*counted, pieces, rows);
    return ended(*counted, counted->wallMilliseconds, rows);
}

Result<double> HostPairs::addMeasured(const cpu::Batch& batch, std::span<const Piece> pieces, WindowRows& rows) {
    const MeasureOptions& measure = options_.measure;
    std::vector<Setting> settings = measure.settings.all(inputs_.measured);
    if (!measure.triangles.empty()) {
        settings.push_back({"triangles", 1.0});
    }
    Result<AnswerTables> measured = ask(engine_, options_.question.name, settings, batch);
    VOXTACT_TRY(measured);
    const BatchAnswer pairs = pairsOf(batch);
    addPairs(pairs, pieces, rows);
    rows.addMeasured(*measured);
    return ended(pairs, measured->find("totals")->number("wall_milliseconds", 0), rows);
}

Result<void> HostPairs::answer(const Window& window, WindowRows& rows, const std::function<bool()>& stop) {
    const LabelData* const labels = volume_->labels ? &*volume_->labels : inputs_.labels ? &*inputs_.labels : nullptr;
    std::vector<cpu::BatchItem> all;
    for (const WindowItem& item : window.items) {
        all.push_back({&meshes_[options_.jobs.jobs[item.job].mesh], &volume_->volume, &volume_->transferFunction,
                       item.selected, labels});
    }
    const auto add = options_.isTouch()   ? &HostPairs::addTouches
                     : options_.isCount() ? &HostPairs::addCounts
                                          : &HostPairs::addMeasured;
    BatchCutter<cpu::BatchItem> cutter(all);
    std::vector<cpu::BatchItem> items;
    std::vector<Piece> pieces;
    while (!stop() && cutter.next(pace_.size(), items, pieces)) {
        const cpu::Batch batch{items, volume_->view, options_.transferFunction.threshold};
        std::size_t pairs = 0;
        for (const cpu::BatchItem& item : items) {
            pairs += item.world_from_object.size();
        }
        const Result<double> took = (this->*add)(batch, pieces, rows);
        VOXTACT_TRY(took);
        pace_.took(static_cast<std::uint32_t>(pairs), *took);
    }
    return {};
}

Result<void> checkLimits(const PairOptions& options) {
    return !usesView(*options.method.projection)
               ? Result<void>()
               : checkViewport(options.view.size, {cpu::kMaxViewport, cpu::kMaxViewport}, "the counting method cpu");
}

} // namespace

Result<void> withHostEngine(const PairOptions& options, const PairInputs& inputs, const UseEngine& answer) {
    VOXTACT_TRY(checkLimits(options));
    Result<cpu::HostEngine> host = cpu::HostEngine::create(options.threads);
    VOXTACT_TRY(host);
    std::vector<cpu::Mesh> meshes;
    for (const MeshData& data : inputs.meshes) {
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        meshes.push_back(std::move(*mesh));
    }
    HostPairs engine(options, inputs, std::move(*host), std::move(meshes));
    return answer(engine);
}

} // namespace voxtact::app
