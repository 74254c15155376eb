// SPDX-License-Identifier: MIT
#include "cli/render/inputs.h"

#include "cli/options/opacity_notes.h"
#include "cli/output/text_for_messages.h"
#include "core/base/text.h"
#include "voxtact/looks.h"

#include <cmath>

namespace voxtact::app {

namespace {

std::string inTenths(double value) {
    return number(std::round(10 * value) / 10);
}

/// Returns the text for the position of the eye.
std::string viewText(const RenderOptions& options) {
    if (!options.view.camera.empty()) {
        return fileNameOf(options.view.camera.string());
    }
    if (!options.azimuth && !options.elevation) {
        return options.viewName.empty() ? "front" : options.viewName;
    }
    return "azimuth " + inTenths(options.azimuth.value_or(0)) + "\u00b0, elevation " +
           inTenths(options.elevation.value_or(0)) + "\u00b0";
}

std::string sliceText(const RenderOptions& options, const SlicePlane& plane) {
    constexpr const char* kAxes[][2] = {{"axial", "z"}, {"coronal", "y"}, {"sagittal", "x"}};
    for (const auto& [name, axis] : kAxes) {
        if (options.slice->name == name) {
            return std::string(name) + ", " + axis + " = " + inTenths(plane.shown) + " mm";
        }
    }
    return "slice, " + viewText(options) + ", " + inTenths(plane.shown) + " mm";
}

std::string title(const RenderOptions& options, const RenderInputs& inputs) {
    if (!options.title.empty()) {
        return options.title;
    }
    std::string text = fileNameOf(options.volumes.front()) + ", ";
    text += inputs.slice ? sliceText(options, *inputs.slice) : viewText(options);
    for (const ClipOption& clip : options.clips) {
        text += ", clipped " + clip.text;
    }
    if (!options.view.poses.empty()) {
        text += inputs.numbers.size() == 1 ? ", pose " + std::to_string(inputs.numbers.front())
                                           : ", " + std::to_string(inputs.numbers.size()) + " poses";
    }
    return text;
}

/// Returns the meaning of the last colour of distances.
std::string farText(const RenderOptions& options) {
    return number(options.show.maximum.value_or(kDefaultShownDistance)) + " mm or more";
}

std::vector<Swatch> swatches(const RenderOptions& options) {
    std::vector<Swatch> all;
    const std::string& shown = options.show.what;
    const MeshPaint paint;
    constexpr Colour kByOpacity{0.8, 0.8, 0.8};
    if (shown == "contacts") {
        all.push_back({paint.contactColour, "contact"});
    } else if (shown == "triangles") {
        all.push_back({paint.contactColour, "touching triangle"});
    } else if (shown == "discarded") {
        all.push_back(options.slice ? Swatch{paint.contactColour, "contact"} : Swatch{kByOpacity, "contact"});
        all.push_back({paint.discardedColour, "no contact"});
        return all;
    } else if (options.show.isDistance()) {
        return {{paint.contactColour, "touches"}, {distanceLegend(1).colours.back().colour, farText(options)}};
    }
    for (std::size_t mesh = 0; mesh < options.meshes.sources.size(); ++mesh) {
        all.push_back({meshColour(options, mesh), fileNameOf(options.meshes.sources[mesh])});
    }
    return all;
}

} // namespace

Annotation annotationOf(const RenderOptions& options, const RenderInputs& inputs,
                        const std::optional<ValueRange>& window) {
    Annotation annotation;
    annotation.title = title(options, inputs);
    annotation.swatches = swatches(options);
    annotation.clip_from_world = inputs.clip_from_world;
    const LookPreset* preset = findLookPreset(options.preset);
    const bool hounsfield =
        preset != nullptr && preset->hounsfield && presetNote(options.preset, inputs.values).empty();
    Legend legend;
    legend.unit = hounsfield ? "HU" : "value";
    if (inputs.distances) {
        legend = distanceLegend(inputs.distances->maximum);
    } else if (window) {
        legend.opacity = {{window->lo, 1}};
        legend.colours = {{window->lo, {0, 0, 0}}, {window->hi, {1, 1, 1}}};
        legend.range = *window;
    } else {
        legend.opacity = inputs.opacity;
        legend.colours = inputs.colours;
        legend.range = legendRange(inputs.opacity, inputs.domain);
    }
    annotation.legend = std::move(legend);
    return annotation;
}

} // namespace voxtact::app
