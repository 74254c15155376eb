// SPDX-License-Identifier: MIT
#include "cli/options/opacity_notes.h"
#include "cli/output/text_for_messages.h"
#include "cli/plan/plan_run.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/volume/label_grid.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <iterator>

namespace voxtact::app {

namespace {

constexpr const char* kAvoidOpacity = "--avoid-opacity";

/// `who`: the option with the points. Appends to `notes`.
Result<cpu::TransferFunction> functionOf(const TransferFunctionOptions& how, const ValueRange& domain,
                                         const ValueRange& values, const std::string& source, std::string_view who,
                                         std::vector<std::string>& notes) {
    Result<std::vector<ControlPoint>> points = loadControlPoints(how);
    VOXTACT_TRY(points);
    if (points->empty()) {
        *points = defaultRamp(domain);
    }
    const TransferFunctionDesc desc{*points, domain};
    std::ranges::move(opacityNotes(desc, values, how.threshold, source, false, who), std::back_inserter(notes));
    return cpu::TransferFunction::create(desc);
}

/// `kept`: receives the image; null: not needed.
Result<PlanVolume> readVolumeOf(const std::string& source, bool resample, const TransferFunctionOptions& how,
                                std::string_view who, std::vector<std::string>& notes,
                                std::optional<VolumeData>* kept = nullptr) {
    Result<VolumeData> data = loadVolume(source, {.resample = resample});
    VOXTACT_TRY(data);
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    Result<cpu::Volume> volume = cpu::Volume::create(data->view());
    VOXTACT_TRY(volume);
    Result<cpu::TransferFunction> function =
        functionOf(how, tableDomain(how, data->type, *values), *values, source, who, notes);
    VOXTACT_TRY(function);
    const ScalarType type = data->type;
    const bool isResampled = io::wasResampled(*data);
    if (kept != nullptr) {
        *kept = std::move(*data);
    }
    return PlanVolume{std::move(*volume), std::move(*function), type, *values, isResampled};
}

constexpr std::string_view kNeedle = "builtin:needle";

/// Reads the instrument: a builtin needle becomes a cylinder, any other source a mesh.
Result<void> readInstrument(const PlanOptions& options, PlanInputs& inputs) {
    const std::string& source = options.meshes.sources.front();
    Result<MeshData> data = loadMesh(source, options.meshes);
    VOXTACT_TRY(data);
    if (source.starts_with(kNeedle)) {
        if (options.tip || options.axis) {
            return badArgument(std::string(options.tip ? "--tip" : "--axis") +
                               ": the builtin needle has its own tip and axis; leave it out");
        }
        inputs.task.needle = {kNeedleDiameter, kNeedleLength};
        if (source.size() > kNeedle.size()) {
            const std::string sizes = source.substr(kNeedle.size() + 1);
            const std::size_t colon = sizes.find(':');
            inputs.task.needle = {parseFinite(sizes.substr(0, colon)).value_or(0),
                                  parseFinite(sizes.substr(colon + 1)).value_or(0)};
        }
        return {};
    }
    if (!options.tip || !options.axis) {
        return badArgument(std::string(options.tip ? "--axis" : "--tip") + ": add it to set how " + forMessage(source) +
                           " goes in");
    }
    Result<cpu::Mesh> mesh = cpu::Mesh::create(data->view());
    VOXTACT_TRY(mesh);
    inputs.mesh = std::move(*mesh);
    if (!options.picture.empty()) {
        inputs.shownMesh = std::move(*data);
    }
    inputs.task.mesh = cpu::PlanMesh{&*inputs.mesh, *options.tip, *options.axis};
    return {};
}

/// Reads the opaque obstacle, in the given volume or another one.
Result<void> readAvoided(const PlanOptions& options, const TransferFunctionOptions& how, PlanInputs& inputs) {
    if (options.avoidVolume.empty()) {
        const PlanVolume& head = *inputs.head;
        // Reading the volume has noted values outside the range.
        Result<cpu::TransferFunction> function = functionOf(how, tableDomain(how, head.type, head.values), head.values,
                                                            options.volumes.front(), kAvoidOpacity, inputs.notes);
        VOXTACT_TRY(function);
        inputs.avoidedInHead = std::move(*function);
        inputs.obstacles.push_back({&head.volume, &*inputs.avoidedInHead, how.threshold, nullptr, {}, kAvoidOpacity});
        return {};
    }
    Result<PlanVolume> avoided = readVolumeOf(options.avoidVolume, options.resample, how, kAvoidOpacity, inputs.notes);
    VOXTACT_TRY(avoided);
    inputs.avoided = std::move(*avoided);
    inputs.obstacles.push_back(
        {&inputs.avoided->volume, &inputs.avoided->transferFunction, how.threshold, nullptr, {}, kAvoidOpacity});
    return {};
}

Result<void> readObstacles(const PlanOptions& options, PlanInputs& inputs) {
    if (options.avoid.empty() && !options.avoidOpacity) {
        return badArgument("no obstacle; add --avoid or --avoid-opacity");
    }
    if (!options.avoid.empty() && !inputs.labels) {
        return badArgument("--avoid: it needs a label map; add --labels");
    }
    if (!options.avoidVolume.empty() && !options.avoidOpacity) {
        return badArgument("--avoid-volume: it has no opaque obstacle without --avoid-opacity; add --avoid-opacity");
    }
    if (!options.avoid.empty()) {
        Result<LabelData> onGrid = labelsOnGrid(inputs.labels->labels, inputs.head->volume.grid(),
                                                "--labels: " + forMessage(options.labels.string()));
        VOXTACT_TRY(onGrid);
        inputs.labels->labels = std::move(*onGrid);
        cpu::PlanObstacle labels;
        labels.volume = &inputs.head->volume;
        labels.labels = &inputs.labels->labels;
        labels.name = "--avoid";
        for (const LabelWord& word : options.avoid) {
            const Result<std::vector<std::int32_t>> avoided = labelsOf(*inputs.labels, word, "--avoid");
            VOXTACT_TRY(avoided);
            labels.avoid.insert(labels.avoid.end(), avoided->begin(), avoided->end());
        }
        inputs.obstacles.push_back(labels);
    }
    if (options.avoidOpacity) {
        TransferFunctionOptions how = options.transferFunction;
        how.path.clear();
        how.opacity = options.avoidOpacity;
        how.opacityOption = kAvoidOpacity;
        VOXTACT_TRY(readAvoided(options, how, inputs));
    }
    inputs.task.obstacles = inputs.obstacles;
    return {};
}

Result<void> chooseSurface(const PlanOptions& options, PlanInputs& inputs) {
    cpu::EntrySurface& surface = inputs.task.surface;
    surface.entries = options.entries;
    surface.borderEntries = options.borderEntries;
    if (!options.entryLabel.empty() && options.entryRadius) {
        return badArgument("--entry-radius: --entry-label also places the entries; leave out one of the two");
    }
    if (options.entryRadius) {
        surface.radius = *options.entryRadius;
        return {};
    }
    if (options.entryLabel.empty()) {
        surface.volume = &inputs.head->volume;
        surface.transferFunction = &inputs.head->transferFunction;
        surface.threshold = options.transferFunction.threshold;
        return {};
    }
    if (!inputs.labels) {
        return badArgument("--entry-label: it needs a label map; add --labels");
    }
    const Result<std::int32_t> label = labelOf(*inputs.labels, options.entryLabel, "--entry-label");
    VOXTACT_TRY(label);
    surface.labels = &inputs.labels->labels;
    surface.label = *label;
    return {};
}

} // namespace

Result<std::unique_ptr<PlanInputs>> readPlan(const PlanOptions& options) {
    auto inputs = std::make_unique<PlanInputs>();
    if (options.labels.empty() && !options.labelNames.empty()) {
        return badArgument("--label-names: it needs a label map; add --labels");
    }
    Result<PlanVolume> head =
        readVolumeOf(options.volumes.front(), options.resample, options.transferFunction, "the transfer function",
                     inputs->notes, options.picture.empty() ? nullptr : &inputs->shown);
    VOXTACT_TRY(head);
    inputs->head = std::move(*head);
    if (!options.labels.empty()) {
        Result<NamedLabels> labels = loadNamedLabels(options.labels, options.labelNames,
                                                     [&] { return Result<Grid>(inputs->head->volume.grid()); });
        VOXTACT_TRY(labels);
        inputs->labels = std::move(*labels);
    }
    VOXTACT_TRY(readInstrument(options, *inputs));
    VOXTACT_TRY(readObstacles(options, *inputs));
    if (options.resample) {
        inputs->isResampled = inputs->head->isResampled || (inputs->avoided && inputs->avoided->isResampled);
    }
    VOXTACT_TRY(chooseSurface(options, *inputs));
    VOXTACT_TRY(readTargets(options, *inputs));
    if (inputs->task.surface.volume == nullptr && options.picture.empty() &&
        (options.transferFunction.opacity || !options.transferFunction.path.empty())) {
        inputs->notes.emplace_back("--opacity, --transfer-function are not used: --entry-label or --entry-radius "
                                   "places the entries");
    }
    inputs->task.target = inputs->targets.front().at;
    inputs->task.margin = options.margin;
    inputs->task.longest = options.longest;
    inputs->task.steepest = options.steepest;
    inputs->task.triangleDistances = !options.heatMap.empty();
    return inputs;
}

} // namespace voxtact::app
