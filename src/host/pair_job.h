// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"
#include "host/cancel.h"
#include "host/count/occupancy.h"
#include "host/scene/scene_impl.h"

#include <atomic>
#include <cstdint>

namespace voxtact::cpu {

/// Data that all pairs of a batch item share.
struct ViewFacts {
    ViewFacts(const View& view, bool withRangeTest);

    int width;
    int height;
    float guardX; ///< as exactPlane() takes them
    float guardY;
    float scaleX; ///< as exactSubpixel() takes them
    float scaleY;
    bool rangeTest;
};

/// An affine function of a point, and how far its value, and that of the exact arithmetic, may be off.
struct Form {
    float x = 0;
    float y = 0;
    float z = 0;
    float constant = 0;
    float margin = 0;
};

/// Inputs of cluster culling for a pair.
struct CullForms {
    CullForms(const MeshImpl& mesh, const shader::PairTransform& transform);

    bool usable = false; ///< false: the numbers are too large for floats, nothing may be culled
    Form outside[6];     ///< if one is negative over a whole box, it covers no pixel: near, far, the viewport's sides
    Form w;
    Form texture[3];
};

/// One mesh at one pose against one volume, in one view; or some of its clusters.
struct PairJob {
    const MeshImpl& mesh;
    const VolumeImpl& volume;
    const Occupancy& occupancy;
    const ViewFacts& view;
    shader::PairTransform transform;
    const shader::DominantGrid* dominantAxis; ///< of the projection dominant-axis; null: through a camera
    bool orthographic;                        ///< w is 1 everywhere
    CullForms cull;
    std::uint32_t clusterBegin;
    std::uint32_t clusterEnd;
    bool stopAtFirst;
    CancelFlag cancel;
};

[[nodiscard]] bool isOrthographic(const shader::PairTransform& transform) noexcept;

} // namespace voxtact::cpu
