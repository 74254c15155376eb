// SPDX-License-Identifier: MIT
#pragma once

#include "exact/pair_setup.h"
#include "voxtact/data.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// Origin of a mesh's floats: a vertex is its float position plus the offset, object space.
struct MeshOrigin {
    Vec3 offset{};
    double rounding = 0; ///< object units: no vertex is farther from there
};

/// A mesh in the floats that the engines keep, in the space of its MeshOrigin.
struct FloatMesh {
    std::span<const float> positions;
    std::span<const std::uint32_t> indices;
};

/// Vertices as floats. Coordinates that floats represent have no offset. For others, if the box is farther from the
/// origin than it is long, the box's centre, rounded to a few bits, is subtracted.
struct Recentred {
    MeshOrigin origin;
    std::vector<float> positions;
};
/// Expects three coordinates per vertex that are finite in single precision.
[[nodiscard]] Recentred recentred(std::span<const double> positions);
/// The offset for vertices in a box.
[[nodiscard]] Vec3 offsetOf(const Box& bounds);
/// Rounds the positions less the offset. Returns MeshOrigin::rounding.
[[nodiscard]] double roundPositions(std::span<const double> positions, const Vec3& offset, std::vector<float>& out);

/// Facts of checkMesh(), and the vertices as floats. MeshFacts::degenerate refers to the floats.
struct CheckedMesh {
    MeshFacts facts;
    MeshOrigin origin;
    std::vector<float> positions;
};
/// Refuses what checkMesh() refuses.
[[nodiscard]] Result<CheckedMesh> checkedMesh(const MeshView& mesh);

/// In the form that shaders share.
[[nodiscard]] inline shader::PairOrigin toPairOrigin(const MeshOrigin& origin) noexcept {
    return {{origin.offset[0], origin.offset[1], origin.offset[2]}, origin.rounding};
}

/// Returns the pose of the floats of a mesh; without an offset, the pose itself.
[[nodiscard]] Mat4 worldFromFloats(const Mat4& world_from_object, const MeshOrigin& origin) noexcept;

} // namespace voxtact
