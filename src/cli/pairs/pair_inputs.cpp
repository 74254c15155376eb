// SPDX-License-Identifier: MIT
#include "cli/options/inputs.h"
#include "cli/options/opacity_notes.h"
#include "cli/output/standard_streams.h"
#include "cli/output/text_for_messages.h"
#include "cli/pairs/pair_run.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "core/volume/label_grid.h"
#include "voxtact/io.h"

#include <algorithm>

namespace voxtact::app {

namespace {

std::string labelOption(const PairOptions& options) {
    return optionOf(*labelFact(options.question.name));
}

/// Notes labels that no voxel has; they are no error.
void noteAbsent(const PairOptions& options, const std::vector<LabelWord>& absent) {
    constexpr std::size_t kMaxNamed = 10;
    if (absent.empty()) {
        return;
    }
    std::string names;
    for (std::size_t i = 0; i < std::min(absent.size(), kMaxNamed); ++i) {
        names += (i == 0 ? "" : ", ") + absent[i];
    }
    if (absent.size() > kMaxNamed) {
        names += " and " + std::to_string(absent.size() - kMaxNamed) + " more";
    }
    const bool several = absent.size() > 1;
    printNote(labelOption(options) + ": no voxel of the label map has the label" + (several ? "s " : " ") + names +
              "; the " + std::string(options.question.name) +
              (options.question.isLeastWorst ? " is infinite" : " is 0"));
}

/// Resolves label words. A number may be absent from the voxels, a name may not. "all": all labels but 0.
Result<std::vector<std::int32_t>> chosenLabels(const PairOptions& options, const NamedLabels& labels) {
    std::vector<std::int32_t> measured;
    std::vector<LabelWord> absent;
    const auto add = [&measured](std::int32_t label) {
        if (std::ranges::find(measured, label) == measured.end()) {
            measured.push_back(label);
        }
    };
    for (const LabelWord& word : options.measure.settings.labels) {
        const std::optional<std::int32_t> number = labelNumber(word);
        Result<std::vector<std::int32_t>> meant = labelsOf(labels, word, labelOption(options));
        if (!meant.ok() && word == "all") {
            meant = labels.labels.values;
            std::erase(*meant, 0);
        } else if (!meant.ok() && number) {
            absent.push_back(word);
            meant = std::vector<std::int32_t>{*number};
        }
        VOXTACT_TRY(meant);
        std::ranges::for_each(*meant, add);
    }
    if (measured.empty()) {
        return badArgument(labelOption(options) + " all: the label map has no label but 0");
    }
    VOXTACT_TRY(checkMeasuredLabels(measured));
    noteAbsent(options, absent);
    return measured;
}

Result<void> readLabels(const PairOptions& options, PairInputs& inputs) {
    if (options.labels.path.empty()) {
        return {};
    }
    Result<NamedLabels> named = loadNamedLabels(options.labels.path, options.labels.names, [&] {
        return gridOfVolume(options.jobs.volumes.front(), options.resample);
    });
    VOXTACT_TRY(named);
    if (options.byLabel()) {
        Result<std::vector<std::int32_t>> measured = chosenLabels(options, *named);
        VOXTACT_TRY(measured);
        inputs.measured = std::move(*measured);
    }
    inputs.labels = std::move(named->labels);
    inputs.labelNames = std::move(named->names);
    return {};
}

/// Fills holes, or refuses a mesh with holes.
Result<void> makeSolid(const PairOptions& options, const std::string& source, MeshData& mesh) {
    Result<SolidFacts> facts = checkSolid(mesh.view());
    VOXTACT_TRY(facts);
    const std::string name = forMessage(fileNameOf(source));
    if (facts->holes > 0 && !options.measure.fillHoles) {
        return badArgument("--mesh: " + name + " has " + holesText(*facts) +
                           ": only a closed mesh has an inside; close the mesh" +
                           (options.question.needsSolid ? ", or add --fill-holes" : ""));
    }
    if (facts->holes > 0) {
        Result<FilledMesh> filled = fillHoles(mesh.view());
        VOXTACT_TRY(filled);
        printNote(name + ": " + std::to_string(filled->holes) + (filled->holes == 1 ? " hole" : " holes") +
                  " filled, which added " + number(filled->area) + " mm^2 of surface");
        mesh.positions = std::move(filled->mesh.positions);
        mesh.indices = std::move(filled->mesh.indices);
        facts = checkSolid(mesh.view());
        VOXTACT_TRY(facts);
    }
    if (facts->inward) {
        printNote(name + ": its triangles face inwards; this does not change its inside");
    }
    return {};
}

} // namespace

std::optional<std::uint64_t> PairInputs::pairs(const PairJobs& jobs) const {
    const std::optional<std::uint64_t> count = poses->count();
    return count ? std::optional(*count * jobs.jobs.size()) : std::nullopt;
}

Result<PairInputs> readPairInputs(const PairOptions& options) {
    VOXTACT_TRY(checkVolumesAreThere(options.jobs.volumes));
    PairInputs inputs;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    inputs.points = std::move(*points);
    Result<PoseSource> poses = PoseSource::open(options.view, options.hasSeveralJobs() || options.shard.isPart());
    VOXTACT_TRY(poses);
    inputs.poses = std::move(*poses);
    if (!options.view.camera.empty()) {
        const Result<Mat4> camera = io::readCamera(options.view.camera);
        VOXTACT_TRY(camera);
        inputs.clip_from_world = *camera;
    }
    for (const std::string& source : options.jobs.meshes) {
        Result<MeshData> mesh = loadMesh(source, options.meshes);
        VOXTACT_TRY(mesh);
        if (mesh->deflection > 0 && options.isTouch() && !isForHost(options)) {
            return badArgument("--mesh: the touch of " + forMessage(fileNameOf(source)) +
                               ", a curved surface, needs the host engine; leave out --on device and --device");
        }
        if (options.isSolid()) {
            VOXTACT_TRY(makeSolid(options, source, *mesh));
        }
        const Result<MeshFacts> facts = checkMesh(mesh->view());
        VOXTACT_TRY(facts);
        inputs.bounds.push_back(facts->bounds);
        inputs.meshes.push_back(std::move(*mesh));
    }
    VOXTACT_TRY(readLabels(options, inputs));
    inputs.isResampled.resize(options.jobs.volumes.size());
    return inputs;
}

Result<std::optional<LabelData>> measuredLabels(const PairOptions& options, const PairInputs& inputs,
                                                const Grid& volume) {
    const std::string which = "--labels: " + forMessage(options.labels.path.string());
    if (!options.byLabel() || checkLabelGrid(inputs.labels->grid, volume, which).ok()) {
        return std::optional<LabelData>();
    }
    Result<LabelData> labels = labelsOnGrid(*inputs.labels, volume, which);
    VOXTACT_TRY(labels);
    return std::optional(std::move(*labels));
}

VolumeSettings settingsFor(const PairOptions& options, const PairInputs& inputs, std::uint32_t volume,
                           const VolumeData& data, const ValueRange& values) {
    const auto [width, height] = options.view.size;
    const std::string& source = options.jobs.volumes[volume];
    const TransferFunctionOptions& function = options.transferFunction;
    const bool certified = rowOf(*options.method.projection).certified;
    const ValueRange domain =
        certified ? tableDomain(function, data.type, values) : usedDomain(function, data.type, values, source);
    std::vector<ControlPoint> points = inputs.points.empty() ? defaultRamp(domain) : inputs.points;
    const std::uint32_t tableSize = tableSizeFor(function, data.type);
    printOpacityNotes({points, domain, tableSize}, values, function.threshold, source, !certified);
    OpaqueVoxels opaque = someOpaqueVoxels(data.view(), points, function.threshold);
    return {.domain = domain,
            .tableSize = tableSize,
            .points = std::move(points),
            .view = {inputs.clip_from_world ? *inputs.clip_from_world : framingCamera(data.grid, width, height), width,
                     height},
            .opaque = std::move(opaque)};
}

Result<void> checkViewport(const VkExtent2D& size, const VkExtent2D& max, const std::string& who) {
    if (size.width <= max.width && size.height <= max.height) {
        return {};
    }
    const auto text = [](const VkExtent2D& extent) {
        return std::to_string(extent.width) + "x" + std::to_string(extent.height);
    };
    return badArgument("--size: " + text(size) + " exceeds the limit of " + who + ", " + text(max));
}

} // namespace voxtact::app
