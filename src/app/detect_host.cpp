// SPDX-License-Identifier: MIT
#include "app/batch_cutter.h"
#include "app/detect_run.h"
#include "app/inputs.h"
#include "app/pair_rows.h"
#include "app/progress.h"
#include "voxtact/cpu.h"

#include <chrono>

namespace voxtact::app {

namespace {

using Clock = std::chrono::steady_clock;

/// The table is in memory, which has no limit that could be named; beyond this one it is a slip.
constexpr std::uint32_t kMostTableEntries = 1U << 24U;

/// What stays the same while the volumes come and go.
struct HostTools {
    const DetectOptions& options;
    const DetectInputs& inputs;
    const std::vector<cpu::Mesh>& meshes;
    cpu::Detector& detector;
    Progress& progress;
};

/// `progress` is what the volumes before this one have done.
Result<void> runBatch(const HostTools& tools, const cpu::Batch& batch, PairRows& rows, std::uint64_t progress) {
    BatchCutter<cpu::BatchItem> cutter(batch.items, pairsPerBatch(tools.options, tools.inputs, 1));
    std::vector<cpu::BatchItem> items;
    std::vector<Piece> pieces;
    while (cutter.next(items, pieces)) {
        const Result<BatchAnswer> answer = tools.detector.detect({items, batch.view, batch.threshold});
        if (!answer.ok()) {
            return answer.error();
        }
        TimedAnswer timed;
        timed.gpuMilliseconds = 0;
        timed.wallMilliseconds = answer->wallMilliseconds / static_cast<double>(answer->pairs.size());
        for (const PairAnswer& pair : answer->pairs) {
            timed.answer = pair;
            timed.item = pieces[pair.item].item;
            timed.pose = pieces[pair.item].firstPose + pair.pose;
            rows.add(timed);
        }
        rows.addOutputs(*answer);
        progress += answer->pairs.size();
        tools.progress.update(progress);
    }
    return {};
}

/// All meshes and poses against one volume.
Result<void> detectVolume(const HostTools& tools, std::uint32_t index, DetectRun& run) {
    const DetectOptions& options = tools.options;
    const Result<VolumeData> data = loadVolume(options.volumes[index]);
    if (!data.ok()) {
        return data.error();
    }
    const Result<ValueRange> values = checkVolume(data->view());
    if (!values.ok()) {
        return values.error();
    }
    const Result<cpu::Volume> volume = cpu::Volume::create(data->view());
    if (!volume.ok()) {
        return volume.error();
    }
    const VolumeSettings settings = settingsFor(options, tools.inputs, index, *data, *values);
    const Result<cpu::TransferFunction> transferFunction =
        cpu::TransferFunction::create({settings.points, settings.domain, options.transferFunction.tableSize});
    if (!transferFunction.ok()) {
        return transferFunction.error();
    }
    const LabelData* labels = tools.inputs.labels ? &*tools.inputs.labels : nullptr;
    const std::vector<SelectedPoses> selected = selectPoses(options, tools.inputs, data->grid);
    std::vector<cpu::BatchItem> items;
    for (std::size_t mesh = 0; mesh < selected.size(); ++mesh) {
        items.push_back({&tools.meshes[mesh], &*volume, &*transferFunction, selected[mesh].world_from_object, labels});
    }
    const std::size_t before = run.rows.size();
    PairAnswer untouched;
    untouched.method = CountingMethod::Cpu;
    untouched.projection = *options.method.projection;
    PairRows rows(options, tools.inputs, selected, index, untouched, run);
    const auto begun = Clock::now();
    Result<void> done = runBatch(tools, {items, settings.view, options.transferFunction.threshold}, rows, before);
    run.wallMilliseconds += std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
    return done;
}

Result<void> checkLimits(const DetectOptions& options) {
    if (options.transferFunction.tableSize > kMostTableEntries) {
        return badArgument("--tf-size: " + std::to_string(options.transferFunction.tableSize) +
                           " is beyond what the counting method cpu can do, " + std::to_string(kMostTableEntries));
    }
    return !usesView(*options.method.projection)
               ? Result<void>()
               : checkViewport(options.view.size, {cpu::kMaxViewport, cpu::kMaxViewport}, "the counting method cpu");
}

} // namespace

Result<void> detectOnHost(const DetectOptions& options, const DetectInputs& inputs, DetectRun& run) {
    if (Result<void> possible = checkLimits(options); !possible.ok()) {
        return possible;
    }
    const MethodOptions& method = options.method;
    Result<cpu::Detector> detector =
        cpu::Detector::create({.boundary = method.boundary,
                               .projection = *method.projection,
                               .outputs = options.extra.outputs(),
                               .samplesPerVoxel = method.samplesPerVoxel.value_or(kDefaultSamplesPerVoxel),
                               .resolution = method.resolution.value_or(kDefaultResolution),
                               .mostContacts = options.extra.contactRoom()});
    if (!detector.ok()) {
        return detector.error();
    }
    run.device = "host";
    run.driver = "cpu, " + std::to_string(detector->threads()) + (detector->threads() == 1 ? " thread" : " threads");
    std::vector<cpu::Mesh> meshes;
    for (const MeshData& data : inputs.meshes) {
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        if (!mesh.ok()) {
            return mesh.error();
        }
        meshes.push_back(std::move(*mesh));
    }
    Progress progress(options.progress, "voxtact detect: pairs",
                      static_cast<std::uint64_t>(meshes.size()) * inputs.poses.size() * options.volumes.size());
    const HostTools tools{options, inputs, meshes, *detector, progress};
    for (std::uint32_t index = 0; index < options.volumes.size(); ++index) {
        if (Result<void> done = detectVolume(tools, index, run); !done.ok()) {
            return done;
        }
    }
    return {};
}

} // namespace voxtact::app
