// SPDX-License-Identifier: MIT
#pragma once

#include "cli/draw/canvas.h"
#include "voxtact/looks.h"
#include "voxtact/render.h"

#include <optional>
#include <string>
#include <vector>

/// What is written on a picture: from where it looks, how large things are, and what the colours mean.
namespace voxtact::app {

/// Pictures are annotated from so many pixels on along each side, where nothing else is said.
inline constexpr std::uint32_t kAnnotatedFrom = 320;

/// Where it is written. The volume is framed in what is left, so that nothing covers it.
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

/// What a small picture has no room for is left out: first legend and cube, then the title, then the rest.
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

/// The part of a transfer function that a legend shows: from where something is seen to its last point.
[[nodiscard]] ValueRange legendRange(const std::vector<ControlPoint>& opacity, const ValueRange& domain);

/// Draws on a finished picture.
[[nodiscard]] Result<void> annotate(Picture& picture, const Annotation& annotation, const AnnotationRoom& room);

} // namespace voxtact::app
