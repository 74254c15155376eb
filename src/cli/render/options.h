// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "cli/render/clip.h"
#include "cli/render/show.h"
#include "cli/render/slice.h"
#include "voxtact/render.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::app {

/// Which of the poses a picture shows.
struct PoseChoice {
    bool all = false;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges; ///< first and last; empty: the first pose
};

struct RenderOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    DeviceChoice device;
    std::filesystem::path output;
    std::string viewName;
    std::optional<double> azimuth;
    std::optional<double> elevation;
    std::string preset;
    ShowOptions show;
    std::optional<PoseChoice> poses;
    Colour background{0, 0, 0};
    std::vector<Colour> meshColours;
    std::vector<ClipOption> clips;
    bool clipMesh = false;
    std::optional<SliceOption> slice;
    std::optional<ValueRange> window;
    std::string lighting = "soft";
    std::optional<bool> annotate;
    std::string title;
    bool resample = false;
    bool progress = true;
};

void addRenderOptions(CLI::App& parser, RenderOptions& options);
/// What a parser cannot see.
[[nodiscard]] Result<void> checkRenderOptions(const RenderOptions& options);

/// What is given, and has no effect on this picture. `annotated`: something is written on it.
[[nodiscard]] std::vector<std::string> unusedNotes(const RenderOptions& options, bool annotated);

/// The numbers of the chosen poses, of so many.
[[nodiscard]] Result<std::vector<std::uint32_t>> chosenPoses(const std::optional<PoseChoice>& choice,
                                                             std::size_t poses);
/// Whether the picture is annotated.
[[nodiscard]] bool isAnnotated(const RenderOptions& options);
/// Where the eye is, when no camera says it.
[[nodiscard]] ViewDirection directionOf(const RenderOptions& options);

} // namespace voxtact::app
