// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/kernel.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

inline constexpr std::size_t kMaxLanes = kMeshAlignment;
/// Vertices of several clusters, so that their triangles can be rasterised in full vectors.
inline constexpr std::size_t kScratchVertices = 2048;
/// Three for each triangle of a cluster, no more.
inline constexpr std::size_t kMostClusterVertices = 3 * std::size_t{kClusterTriangles};
/// Pixels of the side of a box of pixels, up to which a triangle takes one lane.
inline constexpr int kSmallPixels = 16;

/// Transformed vertices.
struct VertexLanes {
    std::int32_t x[kScratchVertices]; ///< sub-pixels
    std::int32_t y[kScratchVertices];
    float tx[kScratchVertices]; ///< texture coordinate, times q
    float ty[kScratchVertices];
    float tz[kScratchVertices];
    float q[kScratchVertices];            ///< 1/w
    std::int32_t state[kScratchVertices]; ///< VertexState
};

enum VertexState : std::int32_t {
    kOutsideBits = 0x3f, ///< outside of that clipping plane
    kBadW = 0x40,
    kNotAffine = 0x80,    ///< w is not 1
    kBeyondBits = 0x3f00, ///< two for each axis, where there is a range test: below the image, above it
};

/// Small triangles that wait for a full vector: sub-pixels and vertices (indices into VertexLanes).
struct PendingTriangles {
    std::int32_t x[3][2 * kMaxLanes];
    std::int32_t y[3][2 * kMaxLanes];
    std::int32_t vertex[3][2 * kMaxLanes];
    std::size_t count = 0;
};

/// Brick boxes of kMaxLanes clusters.
struct CullLanes {
    std::int32_t lo[3][kMaxLanes];
    std::int32_t hi[3][kMaxLanes];
    std::int32_t verdict[kMaxLanes]; ///< CullVerdict
};

enum CullVerdict : std::int32_t {
    kCullSkip = 1,   ///< no pixel or no coordinate in the image
    kCullInside = 2, ///< every coordinate in the image
    kCullUnsure = 4, ///< the box is undefined
};

/// A triangle for the scalar set-up: large, with a corner outside, or without a camera.
struct LoneTriangle {
    std::uint32_t cluster;
    std::uint32_t triangle; ///< of MeshImpl's arrays
};

struct alignas(64) Scratch {
    VertexLanes vertices;
    PendingTriangles pending;
    CullLanes cull;
    /// Covered pixels of a vector of small triangles: lane | column << 4 | row << 8.
    std::int32_t fragments[kMaxLanes * kSmallPixels * kSmallPixels + kMaxLanes];
    std::vector<std::uint32_t> certainClusters;
    std::vector<std::uint32_t> mixedClusters;
    std::vector<LoneTriangle> lone;
};

} // namespace voxtact::cpu
