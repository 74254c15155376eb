// SPDX-License-Identifier: MIT
#pragma once

#include "host/scene/scene_impl.h"
#include "host/search/cells/vertex_reach.h"

#include <span>
#include <vector>

namespace voxtact::cpu {

/// A mesh between two shapes: each vertex moves on a line, at constant speed.
class Bending {
  public:
    /// The shapes are such as checkMesh() accepts, and live as long as it. The mesh is copied.
    Bending(const MeshImpl& mesh, std::span<const double> from, std::span<const double> to);

    /// Around all shapes on the way.
    [[nodiscard]] const Box& bounds() const noexcept { return shape_.facts.bounds; }
    /// Maximum displacement of the vertices.
    [[nodiscard]] const VertexReach& reach() const noexcept { return reach_; }
    /// Maximum rounding error of a vertex at any parameter, object units.
    [[nodiscard]] double rounding() const noexcept { return rounding_; }
    /// Returns the mesh at a parameter, as in shapeBetween(); valid until the next call.
    [[nodiscard]] const MeshImpl& at(double parameter);

  private:
    void findReach();
    [[nodiscard]] double roundingOf(const Box& bounds) const;

    std::span<const double> from_;
    std::span<const double> to_;
    MeshImpl shape_;
    double parameter_ = -1; ///< of the shape
    std::vector<double> positions_;
    std::vector<float> floats_;
    VertexReach reach_;
    double rounding_ = 0;
};

} // namespace voxtact::cpu
