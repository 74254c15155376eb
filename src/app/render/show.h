// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/open_session.h"
#include "app/options/shared_options.h"
#include "voxtact/render.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace voxtact::app {

/// What is painted on the mesh.
struct ShowOptions {
    std::string what; ///< empty: nothing
    std::optional<double> through;
};

/// --show and --through, and that they and --threshold need what they are about. After those options.
void addShowOptions(CLI::App& parser, ShowOptions& options);

/// What is shown, as a detector has it: every mesh at every pose.
struct ShownPairs {
    const VolumeData& volume;
    std::span<const MeshData> meshes;
    std::span<const Mat4> poses;
    TransferFunctionDesc transferFunction;
    double threshold = kDefaultThreshold;
};

/// The triangles that touch for certain, by the projection conservative on the host: of each mesh at each pose, mesh by
/// mesh. Where nothing can touch, a note says so.
[[nodiscard]] Result<std::vector<std::vector<std::uint32_t>>> touchingTriangles(const ShownPairs& pairs, bool progress);
/// Says where nothing can touch.
[[nodiscard]] Result<void> noteWhereNothingIsOpaque(const TransferFunctionDesc& transferFunction, double threshold);

/// What MeshPaints refer to. Must outlive the picture.
struct ShowObjects {
    std::optional<TransferFunction> transferFunction{};
    std::vector<PaintedTriangles> triangles{}; ///< of each mesh at each pose, mesh by mesh
};

/// Decides, and uploads.
[[nodiscard]] Result<ShowObjects> makeShowObjects(const ShowOptions& options, const ShownPairs& pairs, bool progress,
                                                  const device::Session& session, const Renderer& renderer);

/// Of a mesh at a pose, by its number among all.
[[nodiscard]] MeshPaint paintOf(const ShowOptions& options, const ShowObjects& objects, double threshold,
                                std::size_t number);

} // namespace voxtact::app
