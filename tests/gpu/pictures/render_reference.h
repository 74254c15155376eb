// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/render.h"

#include <vector>

namespace voxtact::test {

/// What the reference sees: a Scene in host memory.
struct ReferenceScene {
    const VolumeData* volume = nullptr;
    RenderTransferFunctionDesc function{}; ///< its step is the ray's
    const MeshData* mesh = nullptr;
    Mat4 world_from_object = identity();
    Colour meshColour{};
    Mat4 clip_from_world{}; ///< the near plane at depth 0, the far plane not at infinity
    Colour background{};
    std::vector<ClipPlane> clipPlanes;
    bool clippedMesh = false;
    Lighting lighting{.volume = false, .mesh = false}; ///< the mesh is never lit
};

using ReferencePicture = std::vector<Colour>; ///< row by row, the uppermost first

/// A ray caster in double: each step has the extinction of the sample in its middle, nothing is pre-integrated, no ray
/// ends early, triangles are intersected one by one.
ReferencePicture castReference(const ReferenceScene& scene, std::uint32_t width, std::uint32_t height);

struct PictureError {
    double mean = 0; ///< over pixels and channels, of channels 0..1
    double most = 0;
};
/// Pixels whose neighbours in the reference are farther than `edge` from them are left out: there a rasteriser may
/// decide either way.
PictureError compare(const Picture& picture, const ReferencePicture& reference, double edge = 2);

} // namespace voxtact::test
