// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/open_session.h"
#include "app/options/shared_options.h"
#include "voxtact/render.h"

#include <optional>
#include <string>

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

/// The pair that is shown, as a detector has it.
struct ShownPair {
    const VolumeData& volume;
    const MeshData& mesh;
    TransferFunctionDesc transferFunction;
    double threshold;
    Mat4 world_from_object;
};

/// What a MeshPaint refers to. Must outlive the picture.
struct ShowObjects {
    std::optional<TransferFunction> transferFunction{};
    std::optional<PaintedTriangles> triangles{};
};

/// Decides, for the triangles by the certified projection on the host, and uploads. Says where nothing can touch.
[[nodiscard]] Result<ShowObjects> makeShowObjects(const ShowOptions& options, const ShownPair& pair,
                                                  const Session& session, const Renderer& renderer);

[[nodiscard]] MeshPaint paintOf(const ShowOptions& options, const ShowObjects& objects, double threshold);

} // namespace voxtact::app
