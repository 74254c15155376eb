// SPDX-License-Identifier: MIT
#include "app/output/text_for_messages.h"
#include "app/plan/plan_run.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace voxtact::app {

namespace {

Result<cpu::TransferFunction> functionOf(const TransferFunctionOptions& how, ScalarType type, const ValueRange& values,
                                         const std::string& source) {
    const Result<std::vector<ControlPoint>> points = loadControlPoints(how);
    VOXTACT_TRY(points);
    const ValueRange domain = usedDomain(how, type, values, source);
    return cpu::TransferFunction::create({points->empty() ? defaultRamp(domain) : *points, domain, how.tableSize});
}

Result<PlanVolume> readVolumeOf(const std::string& source, const TransferFunctionOptions& how) {
    const Result<VolumeData> data = loadVolume(source);
    VOXTACT_TRY(data);
    const Result<ValueRange> values = checkVolume(data->view());
    VOXTACT_TRY(values);
    Result<cpu::Volume> volume = cpu::Volume::create(data->view());
    VOXTACT_TRY(volume);
    Result<cpu::TransferFunction> function = functionOf(how, data->type, *values, source);
    VOXTACT_TRY(function);
    return PlanVolume{std::move(*volume), std::move(*function), data->type, *values};
}

std::string listOf(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 8;
    std::string out;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
        out += (i > 0 ? ", " : "") + names[i];
    }
    return names.size() > kMost ? out + ", ..." : out;
}

/// The labels that voxels have, ascending: 0 may be known and nowhere.
std::vector<std::int32_t> presentLabels(const LabelData& labels) {
    std::vector<bool> seen(labels.values.size());
    for (const std::uint16_t index : labels.indices) {
        seen[index] = true;
    }
    std::vector<std::int32_t> present;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i]) {
            present.push_back(labels.values[i]);
        }
    }
    return present;
}

/// All that voxels have of a number or a name: several may be called the same. Never none.
Result<std::vector<std::int32_t>> labelsOf(const NamedLabels& labels, const std::string& word,
                                           const std::string& option) {
    std::int32_t number = 0;
    const std::from_chars_result read = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool isNumber = !word.empty() && read.ec == std::errc() && read.ptr == word.data() + word.size();
    std::vector<std::string> names;
    std::vector<std::int32_t> found;
    for (const std::int32_t value : presentLabels(labels.labels)) {
        const auto name = labels.names.find(value);
        if (isNumber ? value == number : name != labels.names.end() && name->second == word) {
            found.push_back(value);
        }
        names.push_back(isNumber || name == labels.names.end() ? std::to_string(value) : name->second);
    }
    if (!found.empty()) {
        return found;
    }
    const std::string meant = nearestName(word, names);
    return badArgument(option + ": no voxel of the label map has the label " + forMessage(word) +
                       (meant.empty() ? "; it has " + listOf(names) : ", did you mean " + meant + "?"));
}

/// The only one.
Result<std::int32_t> labelOf(const NamedLabels& labels, const std::string& word, const std::string& option) {
    const Result<std::vector<std::int32_t>> found = labelsOf(labels, word, option);
    VOXTACT_TRY(found);
    if (found->size() > 1) {
        return badArgument(option + ": " + std::to_string(found->size()) + " labels are called " + forMessage(word) +
                           ", " + std::to_string((*found)[0]) + " and " + std::to_string((*found)[1]) +
                           " among them; give the number of one");
    }
    return found->front();
}

/// The centre of the voxel with the label that is nearest to the mean of all of them, so that it is in the label.
Vec3 centreOf(const LabelData& labels, std::int32_t label) {
    const auto& size = labels.grid.size;
    std::vector<Vec3> voxels;
    Vec3 sum{};
    std::size_t at = 0;
    for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
            for (std::uint32_t x = 0; x < size[0]; ++x, ++at) {
                if (labels.values[labels.indices[at]] == label) {
                    voxels.push_back(
                        transformPoint(worldFromIndex(labels.grid),
                                       {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        sum[axis] += voxels.back()[axis];
                    }
                }
            }
        }
    }
    for (double& component : sum) {
        component /= static_cast<double>(voxels.size());
    }
    const auto far = [&](const Vec3& voxel) {
        return std::hypot(voxel[0] - sum[0], voxel[1] - sum[1], voxel[2] - sum[2]);
    };
    return *std::min_element(voxels.begin(), voxels.end(),
                             [&](const Vec3& a, const Vec3& b) { return far(a) < far(b); });
}

bool isInside(const Grid& grid, const Vec3& world) {
    const Result<Mat4> texture = textureFromWorld(grid);
    const Vec3 at = texture.ok() ? transformPoint(*texture, world) : Vec3{-1, -1, -1};
    return std::all_of(at.begin(), at.end(), [](double one) { return one >= 0 && one <= 1; });
}

Result<Vec3> targetOf(const PlanOptions& options, const PlanInputs& inputs) {
    Vec3 target{};
    if (const std::optional<Vec3> given = parsePoint(options.target)) {
        target = *given;
    } else if (!inputs.labels) {
        return badArgument("--target: " + forMessage(options.target) +
                           " is not a point x,y,z, and there are no --labels that could have one of this name");
    } else {
        const Result<std::int32_t> label = labelOf(*inputs.labels, options.target, "--target");
        VOXTACT_TRY(label);
        target = centreOf(inputs.labels->labels, *label);
    }
    if (!isInside(inputs.head->volume.grid(), target)) {
        const Mat4 box = worldFromTexture(inputs.head->volume.grid());
        const Vec3 lo = transformPoint(box, {0, 0, 0});
        const Vec3 hi = transformPoint(box, {1, 1, 1});
        return badArgument("--target: (" + number(target[0]) + ", " + number(target[1]) + ", " + number(target[2]) +
                           ") is outside of the volume, whose opposite corners are (" + number(lo[0]) + ", " +
                           number(lo[1]) + ", " + number(lo[2]) + ") and (" + number(hi[0]) + ", " + number(hi[1]) +
                           ", " + number(hi[2]) + ")");
    }
    return target;
}

constexpr std::string_view kNeedle = "builtin:needle";

/// The sizes of a builtin needle, which is round here; any other is a mesh.
Result<void> readInstrument(const PlanOptions& options, PlanInputs& inputs) {
    const std::string& source = options.meshes.sources.front();
    const Result<MeshData> data = loadMesh(source, options.meshes);
    VOXTACT_TRY(data);
    if (source.starts_with(kNeedle)) {
        if (options.tip || options.axis) {
            return badArgument(std::string(options.tip ? "--tip" : "--axis") +
                               ": a builtin needle has its own tip and axis; leave it out");
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
        return badArgument(std::string(options.tip ? "--axis" : "--tip") + ": it is needed to know how " +
                           forMessage(source) + " goes in");
    }
    Result<cpu::Mesh> mesh = cpu::Mesh::create(data->view());
    VOXTACT_TRY(mesh);
    inputs.mesh = std::move(*mesh);
    inputs.task.mesh = cpu::PlanMesh{&*inputs.mesh, *options.tip, *options.axis};
    return {};
}

/// What is opaque in the volume, as it was read, or in another one.
Result<void> readAvoided(const PlanOptions& options, const TransferFunctionOptions& how, PlanInputs& inputs) {
    if (options.avoidVolume.empty()) {
        const PlanVolume& head = *inputs.head;
        Result<cpu::TransferFunction> function = functionOf(how, head.type, head.values, options.volumes.front());
        VOXTACT_TRY(function);
        inputs.avoidedInHead = std::move(*function);
        inputs.obstacles.push_back({&head.volume, &*inputs.avoidedInHead, how.threshold, nullptr, {}});
        return {};
    }
    Result<PlanVolume> avoided = readVolumeOf(options.avoidVolume, how);
    VOXTACT_TRY(avoided);
    inputs.avoided = std::move(*avoided);
    inputs.obstacles.push_back(
        {&inputs.avoided->volume, &inputs.avoided->transferFunction, how.threshold, nullptr, {}});
    return {};
}

Result<void> readObstacles(const PlanOptions& options, PlanInputs& inputs) {
    if (options.avoid.empty() && !options.avoidOpacity) {
        return badArgument("--avoid, --avoid-opacity: one of them must say what is not to be touched");
    }
    if (!options.avoid.empty() && !inputs.labels) {
        return badArgument("--avoid: it is about labels, and --labels is not given");
    }
    if (!options.avoidVolume.empty() && !options.avoidOpacity) {
        return badArgument("--avoid-volume: --avoid-opacity must say what of it is not to be touched");
    }
    if (!options.avoid.empty()) {
        cpu::PlanObstacle labels;
        labels.volume = &inputs.head->volume;
        labels.labels = &inputs.labels->labels;
        for (const LabelWord& word : options.avoid) {
            const Result<std::vector<std::int32_t>> found = labelsOf(*inputs.labels, word, "--avoid");
            VOXTACT_TRY(found);
            labels.avoid.insert(labels.avoid.end(), found->begin(), found->end());
        }
        inputs.obstacles.push_back(labels);
    }
    if (options.avoidOpacity) {
        TransferFunctionOptions how = options.transferFunction;
        how.path.clear();
        how.opacity = options.avoidOpacity;
        VOXTACT_TRY(readAvoided(options, how, inputs));
    }
    inputs.task.obstacles = inputs.obstacles;
    return {};
}

Result<void> chooseSurface(const PlanOptions& options, PlanInputs& inputs) {
    cpu::EntrySurface& surface = inputs.task.surface;
    surface.entries = options.entries;
    if (!options.entryLabel.empty() && options.entryRadius) {
        return badArgument("--entry-radius: --entry-label says already where entries are; leave out one of the two");
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
        return badArgument("--entry-label: it is about labels, and --labels is not given");
    }
    const Result<std::int32_t> label = labelOf(*inputs.labels, options.entryLabel, "--entry-label");
    VOXTACT_TRY(label);
    surface.labels = &inputs.labels->labels;
    surface.label = *label;
    return {};
}

} // namespace

std::optional<Vec3> parsePoint(const std::string& text) {
    Vec3 out{};
    std::size_t from = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t comma = text.find(',', from);
        if ((comma == std::string::npos) != (axis == 2)) {
            return {};
        }
        const std::optional<double> read = parseFinite(std::string_view(text).substr(from, comma - from));
        if (!read) {
            return {};
        }
        out[axis] = *read;
        from = comma + 1;
    }
    return out;
}

std::string labelText(const NamedLabels& labels, std::int32_t label) {
    const auto name = labels.names.find(label);
    return name == labels.names.end() ? std::to_string(label) : name->second;
}

Result<std::unique_ptr<PlanInputs>> readPlan(const PlanOptions& options) {
    auto inputs = std::make_unique<PlanInputs>();
    if (options.labels.empty() && !options.labelNames.empty()) {
        return badArgument("--label-names: it names the labels of a label map, and --labels is not given");
    }
    Result<PlanVolume> head = readVolumeOf(options.volumes.front(), options.transferFunction);
    VOXTACT_TRY(head);
    inputs->head = std::move(*head);
    if (!options.labels.empty()) {
        Result<NamedLabels> labels = loadNamedLabels(options.labels, options.labelNames);
        VOXTACT_TRY(labels);
        inputs->labels = std::move(*labels);
    }
    VOXTACT_TRY(readInstrument(options, *inputs));
    VOXTACT_TRY(readObstacles(options, *inputs));
    VOXTACT_TRY(chooseSurface(options, *inputs));
    const Result<Vec3> target = targetOf(options, *inputs);
    VOXTACT_TRY(target);
    inputs->task.target = *target;
    inputs->task.margin = options.margin;
    inputs->task.longest = options.longest;
    inputs->task.steepest = options.steepest;
    return inputs;
}

} // namespace voxtact::app
