// SPDX-License-Identifier: MIT
#include "app/detect/detect_run.h"
#include "app/options/inputs.h"
#include "app/options/opacity_notes.h"
#include "app/output/standard_streams.h"
#include "app/output/text_for_messages.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/volume/label_grid.h"
#include "voxtact/io.h"

#include <algorithm>
#include <iterator>

namespace voxtact::app {

namespace {

/// That no voxel has some labels, which is no error.
void noteAbsent(const DistanceOptions& options, const std::vector<LabelWord>& absent) {
    constexpr std::size_t kMostNamed = 10;
    if (absent.empty()) {
        return;
    }
    const bool several = absent.size() > 1;
    std::string names;
    for (std::size_t i = 0; i < std::min(absent.size(), kMostNamed); ++i) {
        names += (i == 0 ? "" : ", ") + absent[i];
    }
    if (absent.size() > kMostNamed) {
        names += " and " + std::to_string(absent.size() - kMostNamed) + " more";
    }
    const std::string them = several ? "them" : "it";
    const std::string clearances = "clearances to " + them + " are infinite";
    const std::string areas = "areas in " + them + " are 0";
    printNote("--to: no voxel of the label map has the label" + std::string(several ? "s " : " ") + names + "; " +
              (options.labels.empty()       ? areas
               : options.labelAreas.empty() ? clearances
                                            : clearances + ", and " + areas));
}

/// The labels that are measured: a number need not be one that voxels have, a name must be.
Result<std::vector<std::int32_t>> measuredLabels(const DistanceOptions& options, const NamedLabels& labels) {
    std::vector<std::int32_t> measured;
    std::vector<LabelWord> absent;
    if (options.to.empty()) {
        measured = labels.labels.values;
        std::erase(measured, 0);
    }
    for (const LabelWord& word : options.to) {
        const std::optional<std::int32_t> number = labelNumber(word);
        Result<std::vector<std::int32_t>> meant = labelsOf(labels, word, "--to");
        if (number && !meant.ok()) {
            absent.push_back(word);
            meant = std::vector<std::int32_t>{*number};
        }
        VOXTACT_TRY(meant);
        std::ranges::copy_if(*meant, std::back_inserter(measured), [&measured](std::int32_t label) {
            return std::ranges::find(measured, label) == measured.end();
        });
    }
    if (options.byLabel()) {
        VOXTACT_TRY(checkMeasuredLabels(measured));
    }
    noteAbsent(options, absent);
    return measured;
}

Result<void> readLabels(const DetectOptions& options, DetectInputs& inputs) {
    const ExtraOptions& extra = options.extra;
    if (extra.labels.empty()) {
        return {};
    }
    Result<NamedLabels> named = loadNamedLabels(extra.labels, extra.labelNames);
    VOXTACT_TRY(named);
    Result<std::vector<std::int32_t>> measured = measuredLabels(options.distance, *named);
    VOXTACT_TRY(measured);
    inputs.measured = std::move(*measured);
    inputs.labels = std::move(named->labels);
    inputs.labelNames = std::move(named->names);
    return {};
}

} // namespace

std::optional<std::uint64_t> DetectInputs::pairs(const PairJobs& jobs) const {
    std::uint64_t sum = 0;
    for (const Job& job : jobs.jobs) {
        const std::optional<std::uint64_t> count = poses[job.poses].count();
        if (!count) {
            return std::nullopt;
        }
        sum += *count;
    }
    return sum;
}

Result<DetectInputs> readDetectInputs(const DetectOptions& options) {
    VOXTACT_TRY(checkVolumesAreThere(options.jobs.volumes));
    DetectInputs inputs;
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    inputs.points = std::move(*points);
    for (std::uint32_t i = 0; i < options.jobs.poses.size(); ++i) {
        Result<PoseSource> poses = PoseSource::open(options.jobs.poses[i], options.jobs.uses(i) > 1);
        VOXTACT_TRY(poses);
        inputs.poses.push_back(std::move(*poses));
    }
    if (!options.view.camera.empty()) {
        const Result<Mat4> camera = io::readCamera(options.view.camera);
        VOXTACT_TRY(camera);
        inputs.clip_from_world = *camera;
    }
    for (const std::string& source : options.jobs.meshes) {
        Result<MeshData> mesh = loadMesh(source, options.meshes);
        VOXTACT_TRY(mesh);
        const Result<MeshFacts> facts = checkMesh(mesh->view());
        VOXTACT_TRY(facts);
        inputs.bounds.push_back(facts->bounds);
        inputs.meshes.push_back(std::move(*mesh));
    }
    VOXTACT_TRY(readLabels(options, inputs));
    return inputs;
}

Result<void> checkMeasuredGrid(const DetectOptions& options, const DetectInputs& inputs, const Grid& volume) {
    if (!options.distance.byLabel()) {
        return {};
    }
    const char* const option = options.distance.labels.empty() ? "--label-area: " : "--label-clearance: ";
    return checkLabelGrid(inputs.labels->grid, volume, option + forMessage(options.extra.labels.string()));
}

VolumeSettings settingsFor(const DetectOptions& options, const DetectInputs& inputs, std::uint32_t volume,
                           const VolumeData& data, const ValueRange& values) {
    const auto [width, height] = options.view.size;
    const std::string& source = options.jobs.volumes[volume];
    const TransferFunctionOptions& function = options.transferFunction;
    const ValueRange domain = usedDomain(function, data.type, values, source);
    std::vector<ControlPoint> points = inputs.points.empty() ? defaultRamp(domain) : inputs.points;
    printOpacityNotes({points, domain, function.tableSize}, values, function.threshold, source);
    return {.domain = domain,
            .points = std::move(points),
            .view = {inputs.clip_from_world ? *inputs.clip_from_world : framingCamera(data.grid, width, height), width,
                     height}};
}

Result<void> checkViewport(const VkExtent2D& size, const VkExtent2D& most, const std::string& who) {
    if (size.width <= most.width && size.height <= most.height) {
        return {};
    }
    const auto text = [](const VkExtent2D& extent) {
        return std::to_string(extent.width) + "x" + std::to_string(extent.height);
    };
    return badArgument("--size: " + text(size) + " is beyond what " + who + " can do, " + text(most));
}

} // namespace voxtact::app
