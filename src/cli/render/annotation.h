// SPDX-License-Identifier: MIT
#pragma once

#include "cli/draw/canvas.h"
#include "voxtact/looks.h"
#include "voxtact/render.h"

#include <optional>
#include <string>
#include <vector>

/// Text on a picture: title, sides, scale and legend.
namespace voxtact::app {

/// Default minimum side of annotated pictures, pixels.
inline constexpr std::uint32_t kAnnotatedFrom = 320;

/// Space for annotations. The volume is framed in the rest, so nothing covers it.
struct AnnotationRoom {
    double text = 0; ///< pixels of an em
    Box2 frame;      ///< for the volume
    std::optional<Box2> title;
    std::optional<Box2> swatches;
    std::optional<Box2> bar;
    std::optional<Box2> legend;
    std::optional<Box2> cube;
    bool letters = false;
};

/// Omits annotations for which a small picture has no space: first legend and cube, then the title, then the rest.
[[nodiscard]] AnnotationRoom roomFor(std::uint32_t width, std::uint32_t height, bool swatches, bool legend);

struct Swatch {
    Colour colour{};
    std::string text;
};

/// Opacity and colours of values.
struct Legend {
    std::vector<ControlPoint> opacity;
    std::vector<ColourPoint> colours;
    ValueRange range{};
    std::string unit;
};

struct Annotation {
    std::string title;
    std::vector<Swatch> swatches;
    std::optional<Legend> legend;
    Mat4 clip_from_world{};
};

/// Returns the values that a legend shows: from the first visible value to the last point.
[[nodiscard]] ValueRange legendRange(const std::vector<ControlPoint>& opacity, const ValueRange& domain);

/// Draws on a finished picture.
[[nodiscard]] Result<void> annotate(Picture& picture, const Annotation& annotation, const AnnotationRoom& room);

} // namespace voxtact::app
