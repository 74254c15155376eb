// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <span>

namespace voxtact::test {

/// One pair, and the control points and the threshold that its voxels are opaque by.
struct JudgedPair {
    MeshView mesh;
    VolumeView volume;
    Mat4 world_from_object;
    std::span<const ControlPoint> points;
    double threshold;
};

enum class Judgement { None, Touches, Undecidable };
[[nodiscard]] const char* toString(Judgement judgement) noexcept;

/// Whether the surface touches a point of the volume whose opacity reaches the threshold (docs/projections.md), from
/// the numbers of the pair as real numbers. Shares no code with the engine nor with its oracle: the interpolant along a
/// piece of a triangle is bounded by its Taylor polynomial, which is finite, and all of it is __float128 wherever
/// double precision cannot tell. Undecidable is what lies within the bound of its own rounding, some 1e-30 of a voxel,
/// and what it gives up on.
[[nodiscard]] Judgement judge(const JudgedPair& pair);

} // namespace voxtact::test
