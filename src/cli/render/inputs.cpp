// SPDX-License-Identifier: MIT
#include "cli/render/inputs.h"

#include "cli/options/inputs.h"
#include "cli/options/opacity_notes.h"
#include "cli/output/standard_streams.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/io.h"
#include "voxtact/looks.h"

#include <algorithm>

namespace voxtact::app {

namespace {

double shownMaximum(const RenderOptions& options) {
    return options.show.maximum.value_or(kDefaultShownDistance);
}

Result<void> readMeshes(const RenderOptions& options, RenderInputs& inputs) {
    if (options.meshes.sources.empty()) {
        return {};
    }
    const Result<std::vector<Mat4>> poses = loadPoses(options.view);
    VOXTACT_TRY(poses);
    Result<std::vector<std::uint32_t>> numbers = chosenPoses(options.poses, poses->size());
    VOXTACT_TRY(numbers);
    inputs.numbers = std::move(*numbers);
    for (const std::uint32_t number : inputs.numbers) {
        inputs.poses.push_back((*poses)[number]);
    }
    for (const std::string& source : options.meshes.sources) {
        const Result<MeshData> mesh = loadMesh(source, options.meshes);
        VOXTACT_TRY(mesh);
        const Result<MeshFacts> facts = checkMesh(mesh->view());
        VOXTACT_TRY(facts);
        Result<MeshData> creased = splitAtCreases(mesh->view());
        VOXTACT_TRY(creased);
        inputs.bounds.push_back(facts->bounds);
        inputs.meshes.push_back(options.show.isDistance()
                                    ? meshForDistances(std::move(*creased), inputs.poses, shownMaximum(options))
                                    : std::move(*creased));
    }
    return {};
}

Result<void> readVolume(const RenderOptions& options, RenderInputs& inputs) {
    Result<VolumeData> volume = loadVolume(options.volumes.front(), {.resample = options.resample});
    VOXTACT_TRY(volume);
    inputs.volume = std::move(*volume);
    const Result<ValueRange> values = checkVolume(inputs.volume.view());
    VOXTACT_TRY(values);
    inputs.values = *values;
    return {};
}

/// Returns the smallest box that holds both boxes.
Box around(const Box& a, const Box& b) {
    Box out = a;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.lo[axis] = std::min(a.lo[axis], b.lo[axis]);
        out.hi[axis] = std::max(a.hi[axis], b.hi[axis]);
    }
    return out;
}

/// Bounding box of all meshes at all poses.
std::optional<Box> boxOfMeshes(const RenderInputs& inputs) {
    std::optional<Box> all;
    for (const Box& bounds : inputs.bounds) {
        for (const Mat4& pose : inputs.poses) {
            const Box box = transformBox(pose, bounds);
            all = all ? around(*all, box) : box;
        }
    }
    return all;
}

Result<void> setCamera(const RenderOptions& options, RenderInputs& inputs) {
    const VkExtent2D& size = options.view.size;
    if (isAnnotated(options)) {
        const bool swatches = !options.meshes.sources.empty();
        inputs.room = roomFor(size.width, size.height, swatches, true);
    }
    if (!options.view.camera.empty()) {
        const Result<Mat4> camera = io::readCamera(options.view.camera);
        VOXTACT_TRY(camera);
        inputs.clip_from_world = *camera;
        return {};
    }
    const ViewFrame all{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    const Box2 room = inputs.room ? inputs.room->frame : Box2{};
    const ViewFrame frame = inputs.room ? ViewFrame{room.left, room.top, room.right, room.bottom} : all;
    const ViewDirection direction = inputs.slice ? inputs.slice->direction : directionOf(options);
    inputs.clip_from_world =
        viewFrom(direction, inputs.volume.grid, boxOfMeshes(inputs), size.width, size.height, frame);
    return {};
}

Result<void> setCuts(const RenderOptions& options, RenderInputs& inputs) {
    if (options.slice) {
        std::optional<Box> first;
        if (!inputs.bounds.empty()) {
            // The part of the mesh in the volume, if any.
            const Box mesh = transformBox(inputs.poses.front(), inputs.bounds.front());
            const Box volume = transformBox(worldFromTexture(inputs.volume.grid), {{0, 0, 0}, {1, 1, 1}});
            first = mesh;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                first->lo[axis] = std::clamp(mesh.lo[axis], volume.lo[axis], volume.hi[axis]);
                first->hi[axis] = std::clamp(mesh.hi[axis], volume.lo[axis], volume.hi[axis]);
            }
        }
        const Result<SlicePlane> plane = slicePlane(*options.slice, directionOf(options), inputs.volume.grid, first);
        VOXTACT_TRY(plane);
        inputs.slice = *plane;
    }
    VOXTACT_TRY(setCamera(options, inputs));
    Result<std::vector<ClipPlane>> planes = clipPlanes(options.clips, inputs.volume.grid, inputs.clip_from_world);
    VOXTACT_TRY(planes);
    inputs.clips = std::move(*planes);
    return {};
}

Result<void> setLook(const RenderOptions& options, RenderInputs& inputs) {
    Result<std::vector<ControlPoint>> points = loadControlPoints(options.transferFunction);
    VOXTACT_TRY(points);
    inputs.domain = tableDomain(options.transferFunction, inputs.volume.type, inputs.values);
    inputs.opacity = std::move(*points);
    if (!options.transferFunction.path.empty()) {
        Result<std::vector<ColourPoint>> colours = io::readColours(options.transferFunction.path);
        VOXTACT_TRY(colours);
        inputs.colours = std::move(*colours);
    }
    if (const std::string note = presetNote(options.preset, inputs.values); !note.empty()) {
        printNote(note);
    }
    Result<Look> look = options.preset.empty() ? Look{defaultRamp(inputs.domain), plainColours()}
                                               : lookNamed(options.preset, inputs.values);
    VOXTACT_TRY(look);
    inputs.colours = inputs.colours.empty() ? std::move(look->colours) : inputs.colours;
    inputs.opacity = inputs.opacity.empty() ? std::move(look->opacity) : inputs.opacity;
    return {};
}

/// Prints opacity notes, which matter only for shown contacts.
Result<void> noteOpacity(const RenderOptions& options, RenderInputs& inputs) {
    if (!options.show.what.empty()) {
        printOpacityNotes(inputs.transferFunction(options), inputs.values, options.transferFunction.threshold,
                          options.volumes.front(), true);
    }
    return {};
}

Result<void> setDistances(const RenderOptions& options, RenderInputs& inputs) {
    if (!options.show.isDistance()) {
        return {};
    }
    const TransferFunctionDesc function = inputs.transferFunction(options);
    const double threshold = options.transferFunction.threshold;
    Result<MeshDistances> measured = measureMeshes({inputs.volume, inputs.meshes, inputs.poses, function, threshold},
                                                   shownMaximum(options), options.progress);
    VOXTACT_TRY(measured);
    inputs.distances = std::move(*measured);
    return {};
}

} // namespace

Result<RenderInputs> readRenderInputs(const RenderOptions& options) {
    RenderInputs inputs;
    for (const auto read : {readMeshes, readVolume, setCuts, setLook, noteOpacity, setDistances}) {
        VOXTACT_TRY(read(options, inputs));
    }
    return inputs;
}

Colour meshColour(const RenderOptions& options, std::size_t mesh) {
    if (mesh < options.meshColours.size()) {
        return options.meshColours[mesh];
    }
    return voxtact::meshColour(mesh);
}

} // namespace voxtact::app
