// SPDX-License-Identifier: MIT
// Structs of the renderer, shared by GLSL and C++.
#ifndef VOXTACT_RENDER_SHARED_H
#define VOXTACT_RENDER_SHARED_H

#include "shared.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

/// Everything that changes from picture to picture: a std430 buffer. Matrices by rows.
struct PictureConstants {
    vec4 clip_from_object[4];
    vec4 world_from_object[3];
    vec4 texture_from_object[3];
    vec4 normal_from_object[3]; // of directions; w is 0
    vec4 world_from_clip[4];
    vec4 texture_from_clip[4];
    vec4 world_from_texture[3]; // of directions; w is 0
    vec4 texture_from_world[3]; // of directions; w is 0
    vec4 meshColour;
    vec4 contactColour; // and how much of it is seen through the volume
    vec4 discardedColour;
    vec4 light;        // ambient, diffuse, specular, shininess
    vec4 viewport;     // width, height
    float scalarScale; // normalised scalar = scalarScale * texel + scalarBias
    float scalarBias;
    float entryScale; // entry coordinate (opacity_ranges.h) = entryScale * stored + entryBias
    float entryBias;
    float step;  // mm
    int bricksX; // 0: nothing is skipped
    int bricksY;
    uint switches; // PICTURE_...
    int tableSize;
    int tableLevels;
    ItemConstants item; // of the detector that decides what is painted
};

/// Push constants of the pass that makes the pre-integrated table.
struct PreintegrateConstants {
    int size;
    float step; // mm
};

#define PICTURE_LIT_VOLUME 1u
#define PICTURE_LIT_MESH 2u
#define PICTURE_JITTER 4u
#define PICTURE_DISCARDED 8u
// Descriptor sets of the volume pass, beside VOXTACT_SET_VOLUME.
#define PICTURE_SET_FUNCTION 1
#define PICTURE_SET_TARGETS 2
#define PICTURE_SET_BRICKS 3
// Those of a mesh that is painted, beside VOXTACT_SET_VOLUME, VOXTACT_SET_TRANSFER_FUNCTION and PICTURE_SET_TARGETS.
#define PICTURE_SET_TRIANGLES 3
// Bindings of PICTURE_SET_FUNCTION: the table, and the extremes of the opacity.
#define PICTURE_BINDING_TABLE 0
#define PICTURE_BINDING_OPACITY 1
// Bindings of PICTURE_SET_TARGETS: PictureConstants, and what the mesh pass leaves.
#define PICTURE_BINDING_CONSTANTS 0
#define PICTURE_BINDING_MESH_COLOUR 1
#define PICTURE_BINDING_MESH_DISTANCE 2
// Lanes along each side of a work group of the table's pass.
#define PREINTEGRATE_SIDE 8
// The distance where there is no mesh.
#define PICTURE_NOTHING 1e30

#ifdef __cplusplus
static_assert(sizeof(PictureConstants) % 4 == 0 && sizeof(PictureConstants) <= 65536, "one vkCmdUpdateBuffer");
static_assert(sizeof(PreintegrateConstants) == 8);
} // namespace voxtact::shader
#endif

#endif
