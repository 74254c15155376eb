// SPDX-License-Identifier: MIT
#include "voxtact/render.h"
#include "cli/commands.h"
#include "cli/options/open_session.h"
#include "cli/output/interrupt.h"
#include "cli/output/standard_streams.h"
#include "cli/render/device_picture.h"
#include "core/base/try.h"
#include "voxtact/io.h"
#include "voxtact/looks.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

/// Refuses sizes beyond our PNG writer before the work; the host has no limit of its own.
Result<void> checkSliceSize(VkExtent2D size) {
    constexpr std::uint32_t kMaxPixels = 16384;
    if (size.width > kMaxPixels || size.height > kMaxPixels) {
        return badArgument("--size " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                           " exceeds the limit of a slice, " + std::to_string(kMaxPixels) + "x" +
                           std::to_string(kMaxPixels));
    }
    return {};
}

ValueRange windowOf(const RenderOptions& options, const RenderInputs& inputs) {
    if (options.window) {
        return *options.window;
    }
    const LookPreset* preset = findLookPreset(options.preset);
    return preset != nullptr && preset->window ? *preset->window : usualWindow(inputs.volume.view(), inputs.values);
}

Result<Picture> renderSlice(const RenderOptions& options, const RenderInputs& inputs, const ValueRange& window) {
    VOXTACT_TRY(checkSliceSize(options.view.size));
    SliceScene scene;
    scene.volume = &inputs.volume;
    scene.plane = *inputs.slice;
    scene.clip_from_world = inputs.clip_from_world;
    scene.window = window;
    scene.background = options.background;
    scene.threshold = options.transferFunction.threshold;
    // Picture pixels per pixel of outline thickness.
    constexpr double kPixelsOfOutline = 300;
    scene.thickness = std::max(1.0, std::min(options.view.size.width, options.view.size.height) / kPixelsOfOutline);
    std::vector<std::vector<std::uint32_t>> touching(inputs.meshes.size() * inputs.poses.size());
    if (!options.show.what.empty() && !inputs.distances) {
        const TransferFunctionDesc function = inputs.transferFunction(options);
        if (options.show.what == "triangles") {
            Result<std::vector<std::vector<std::uint32_t>>> found = touchingTriangles(
                {inputs.volume, inputs.meshes, inputs.poses, function, scene.threshold}, options.progress);
            VOXTACT_TRY(found);
            touching = std::move(*found);
        } else {
            scene.transferFunction = function;
            scene.elsewhere =
                options.show.what == "discarded" ? std::optional(MeshPaint{}.discardedColour) : std::nullopt;
        }
    }
    for (std::size_t i = 0; i < touching.size(); ++i) {
        const std::size_t mesh = i / inputs.poses.size();
        scene.meshes.push_back(
            {&inputs.meshes[mesh], inputs.poses[i % inputs.poses.size()], meshColour(options, mesh), touching[i],
             inputs.distances ? std::span<const Colour>(inputs.distances->colours[i]) : std::span<const Colour>()});
    }
    return makeSlice(scene, options.view.size);
}

/// Draws on the device. Validation messages are complete after all device objects are destroyed.
Result<Picture> renderVolume(const RenderOptions& options, const RenderInputs& inputs, Outcome& invalid) {
    std::shared_ptr<const device::ValidationMessages> messages;
    Result<Picture> picture = [&]() -> Result<Picture> {
        const Result<device::Session> session = openSession(options.device);
        VOXTACT_TRY(session);
        messages = session->instance.messages();
        return renderOn(options, inputs, *session);
    }();
    if (picture.ok()) {
        invalid = validationOutcome(*messages);
    }
    return picture;
}

/// Draws the annotations, then writes the file.
Result<void> finish(const RenderOptions& options, const RenderInputs& inputs, const std::optional<ValueRange>& window,
                    Picture& picture) {
    if (inputs.distances) {
        drawClosest(picture, *inputs.distances, inputs.clip_from_world);
    }
    if (inputs.room) {
        VOXTACT_TRY(annotate(picture, annotationOf(options, inputs, window), *inputs.room));
    }
    return io::writePng(options.output, picture.width, picture.height, picture.rgba,
                        [](std::uint32_t, std::uint32_t) { return !interrupted(); });
}

Outcome drawAndWrite(const RenderOptions& options, const RenderInputs& inputs) {
    std::optional<ValueRange> window;
    if (inputs.slice) {
        window = windowOf(options, inputs);
    }
    Outcome invalid;
    Result<Picture> picture = window ? renderSlice(options, inputs, *window) : renderVolume(options, inputs, invalid);
    VOXTACT_TRY(picture);
    if (invalid.status != kExitDone) {
        return invalid;
    }
    const Result<void> finished = finish(options, inputs, window, *picture);
    return finished.ok() ? Outcome() : Outcome(finished.error());
}

Outcome runRender(const RenderOptions& options) {
    VOXTACT_TRY(checkRenderOptions(options));
    const Result<RenderInputs> inputs = readRenderInputs(options);
    VOXTACT_TRY(inputs);
    for (const std::string& note : unusedNotes(options, inputs->room.has_value())) {
        printNote(note);
    }
    const InterruptGuard guard; // an earlier signal also leaves no file
    const Outcome outcome = drawAndWrite(options, *inputs);
    // Otherwise the file was complete before the signal.
    return interrupted() && outcome.status != kExitDone ? interruptOutcome("nothing is written") : outcome;
}

} // namespace

Command addRender(CLI::App& program) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* parser = program.add_subcommand("render", "draw a PNG of a volume and of meshes in it");
    addRenderOptions(*parser, *options);
    return {parser, [options] { return runRender(*options); }};
}

} // namespace voxtact::app
