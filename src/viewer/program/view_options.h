// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/shared_options.h"
#include "viewer/model/document/document.h"
#include "viewer/model/document/labels.h"
#include "viewer/model/files/progress.h"
#include "viewer/state.h"

namespace voxtact::app {

/// The options of `voxtact view`.
struct ViewerOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    std::filesystem::path poses;
    std::filesystem::path labels;
    std::filesystem::path labelNames;
    std::string preset;
    MethodOptions method;
    DeviceChoice device;
    std::filesystem::path session;
    std::filesystem::path reportState;
    std::optional<std::uint32_t> frames;
    std::uint32_t maxSide = 0; ///< voxels along a side of the volume; 0: what the device takes
    VkExtent2D size{1280, 800};
};

/// Adds the command `view`.
[[nodiscard]] Command addView(CLI::App& program);
void addViewerOptions(CLI::App& parser, ViewerOptions& options);
/// Refuses an output that is also an input.
[[nodiscard]] Result<void> checkWindowOutput(const std::filesystem::path& output,
                                             const std::vector<std::string>& inputs);
/// Checks beyond the parser's.
[[nodiscard]] Result<void> checkViewerOptions(const ViewerOptions& options);

/// Initial contents, with volume and mesh read.
struct Opened {
    view::Document document;
    VolumeData volume;
    std::vector<MeshData> meshes; ///< of Sources::meshes
    std::optional<view::Labels> labels;
    ValueRange values;
    std::vector<std::string> read; ///< paths of poses and a transfer function
};
[[nodiscard]] Result<Opened> openDocument(const ViewerOptions& options, view::Progress& progress);
/// Returns the session, with the method of the options.
[[nodiscard]] Result<view::Document> sessionOf(const ViewerOptions& options);
/// Like openDocument(), for files opened in the window.
[[nodiscard]] Result<Opened> openWanted(const view::Wanted& wanted, view::Progress& progress);

} // namespace voxtact::app
