// SPDX-License-Identifier: MIT
// Structs shared by GLSL and C++, one definition each.
#ifndef VOXTACT_SHARED_H
#define VOXTACT_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstddef>
#include <cstdint>
namespace voxtact::shader {
using uint = std::uint32_t;
using vec4 = std::array<float, 4>;
#endif

/// What the vertex shader needs of one pair; element `pair` of a std430 buffer.
struct PairTransform {
    vec4 clip_from_object[4];    // rows
    vec4 texture_from_object[3]; // its first three rows: affine
};

/// What the fragment program needs of one batch item; the raster path's push constants.
struct ItemConstants {
    float scalarScale; // normalised scalar = scalarScale * sample + scalarBias; a sample is a texel (hardware filter)
    float scalarBias;  // or the stored value behind it (exact filter)
    float threshold;
    float storedUnit; // the integer behind 1.0 of a normalised texel; 0 for float texels
};

/// Push constants of the compute path.
struct ComputeConstants {
    ItemConstants item;
    float guardX; // EXACT_GUARD_PIXELS in units of half the viewport
    float guardY;
    int width; // of the viewport
    int height;
    uint firstPair;
    uint triangleCount;
    uint vertexOffset; // of the first position, in floats
    uint vertexStride; // in floats
    uint indexOffset;  // in bytes
    uint indexBytes;   // 2, 4, or 0: not indexed
    uint rangeTest;    // 0: clamp
};

/// One surviving fragment of a pair.
struct TracedFragment {
    uint triangle;
    uint x;
    uint y;
};

// Descriptor sets.
#define VOXTACT_SET_VOLUME 0
#define VOXTACT_SET_TRANSFER_FUNCTION 1
#define VOXTACT_SET_PAIRS 2
#define VOXTACT_SET_MESH 3
#define VOXTACT_SET_LABELS 4 // with outputs beside the counts
// Bindings of VOXTACT_SET_PAIRS.
#define VOXTACT_BINDING_TRANSFORMS 0
#define VOXTACT_BINDING_RESULTS 1
#define VOXTACT_BINDING_OUTPUT_PAIRS 2 // with outputs beside the counts
#define VOXTACT_BINDING_OUTPUTS 3
// Bindings of VOXTACT_SET_MESH.
#define VOXTACT_BINDING_VERTICES 0
#define VOXTACT_BINDING_INDICES 1
// The list of surviving fragments, behind VOXTACT_SET_PAIRS.
#define VOXTACT_SET_TRACE 3
// Specialization constants.
#define VOXTACT_CONSTANT_RANGE_TEST 0
#define VOXTACT_CONSTANT_CARRY 1
#define VOXTACT_CONSTANT_EXACT_FILTER 2
#define VOXTACT_CONSTANT_OUTPUTS 16
// Lanes of a work group of the compute path.
#define VOXTACT_COMPUTE_GROUP 64

#ifdef __cplusplus
static_assert(sizeof(PairTransform) == 112 && offsetof(PairTransform, texture_from_object) == 64);
static_assert(sizeof(ItemConstants) == 16);
static_assert(sizeof(ComputeConstants) == 60);
} // namespace voxtact::shader
#endif

#endif
