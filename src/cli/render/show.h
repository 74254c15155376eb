// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/open_session.h"
#include "cli/options/shared_options.h"
#include "cli/render/mesh_distance.h"
#include "voxtact/render.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace voxtact::app {

/// Paint options of the mesh.
struct ShowOptions {
    std::string what; ///< empty: nothing
    std::optional<double> through;
    std::optional<double> maximum; ///< distance of the last colour, mm

    [[nodiscard]] bool isDistance() const { return what == "distance"; }
};

/// Adds --show, --through and --max-distance, and their dependencies with --opacity-threshold. Call after the options
/// that they depend on.
void addShowOptions(CLI::App& parser, ShowOptions& options);
/// Checks that the parser cannot do.
[[nodiscard]] Result<void> checkShowOptions(const ShowOptions& options);

/// Returns the triangles with a certified touch, computed on the host: of each mesh at each pose, mesh by mesh.
[[nodiscard]] Result<std::vector<std::vector<std::uint32_t>>> touchingTriangles(const ShownPairs& pairs, bool progress);

/// Objects that MeshPaints reference. Must outlive the picture.
struct ShowObjects {
    std::optional<TransferFunction> transferFunction{};
    std::vector<PaintedTriangles> triangles{}; ///< of each mesh at each pose, mesh by mesh
    std::vector<PaintedVertices> vertices{};   ///< likewise
};

/// Uploads the colours of `distances`, or decides and uploads the touched triangles.
[[nodiscard]] Result<ShowObjects> makeShowObjects(const ShowOptions& options, const ShownPairs& pairs,
                                                  const std::optional<MeshDistances>& distances, bool progress,
                                                  const device::Session& session, const Renderer& renderer);

/// Returns the paint of a mesh at a pose, by its index.
[[nodiscard]] MeshPaint paintOf(const ShowOptions& options, const ShowObjects& objects, double threshold,
                                std::size_t number);

} // namespace voxtact::app
