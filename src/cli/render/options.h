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

/// The poses of a picture.
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
/// Checks that the parser cannot do.
[[nodiscard]] Result<void> checkRenderOptions(const RenderOptions& options);

/// Returns notes on options without effect on this picture. `annotated`: the picture has text.
[[nodiscard]] std::vector<std::string> unusedNotes(const RenderOptions& options, bool annotated);

/// Returns the indices of the chosen poses.
[[nodiscard]] Result<std::vector<std::uint32_t>> chosenPoses(const std::optional<PoseChoice>& choice,
                                                             std::size_t poses);
/// Returns true if the picture is annotated.
[[nodiscard]] bool isAnnotated(const RenderOptions& options);
/// Returns the position of the eye without a camera.
[[nodiscard]] ViewDirection directionOf(const RenderOptions& options);

} // namespace voxtact::app
