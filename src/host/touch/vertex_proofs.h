// SPDX-License-Identifier: MIT
#pragma once

#include "host/touch/cells/volume_cells.h"
#include "host/touch/placed_vertices.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// Finds the vertices that prove a touch; tests each once for all of its triangles. Not thread-safe.
template <class Kept> class VertexProofs {
  public:
    /// All must outlive it. `delta`: no triangle of the mesh has a larger one.
    VertexProofs(const VolumeCells<Kept>& cells, const PlacedVertices& placed, const shader::OpacityBounds& bounds,
                 float delta)
        : cells_(cells), placed_(placed), bounds_(bounds), delta_(delta) {}

    /// Tests a vertex of the current cluster: true only if certifiedSettle() finds each of its triangles certain in its
    /// cell.
    [[nodiscard]] bool prove(std::size_t vertex) {
        if (placed_.firstVertex() != first_) {
            found_.fill(Found::kNotAsked);
            first_ = placed_.firstVertex();
        }
        Found& found = found_[vertex];
        if (found == Found::kNotAsked) {
            found = proves(placed_.at(vertex).point) ? Found::kProves : Found::kNot;
        }
        return found == Found::kProves;
    }

  private:
    enum class Found : std::uint8_t { kNotAsked, kProves, kNot };

    /// Same as certifiedVertexProves(), by bounds alone: a bound of a range holds for each part, and triangles with a
    /// smaller delta have such parts.
    [[nodiscard]] bool proves(const shader::VoxelPoint& vertex) const {
        const auto place = cells_.cellWith(vertex);
        if (!place) {
            return false;
        }
        const auto [x, y, z] = *place;
        const shader::CertifiedCell cell = cells_.cell(x, y, z, cells_.ofCell(*place), delta_);
        const shader::VoxelPoint at =
            shader::voxelDifference(vertex, {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        const float entry = shader::certifiedInterpolate(cell, at.x, at.y, at.z);
        return shader::certifiedSafe(cell, at) && bounds_.all(entry - cell.margin, entry + cell.margin);
    }

    const VolumeCells<Kept>& cells_;
    const PlacedVertices& placed_;
    const shader::OpacityBounds& bounds_;
    float delta_;
    std::size_t first_ = SIZE_MAX; ///< vertex of that cluster
    std::array<Found, PlacedVertices::kMost> found_{};
};

} // namespace voxtact::cpu
