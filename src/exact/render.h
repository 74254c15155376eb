// SPDX-License-Identifier: MIT
// Structs of the renderer, shared by GLSL and C++.
#ifndef VOXTACT_RENDER_SHARED_H
#define VOXTACT_RENDER_SHARED_H

#include "shared.h"

#ifdef __cplusplus
namespace voxtact::shader {
#endif

// Clipping planes of a picture.
#define PICTURE_PLANES 6
// Meshes whose constants fit beside each other: more are drawn in groups.
#define PICTURE_MESHES 64

/// Constants of a picture except for its meshes: the beginning of a std430 buffer. Matrices by rows.
struct PictureConstants {
    vec4 world_from_clip[4];
    vec4 texture_from_clip[4];
    vec4 world_from_texture[3];         // of directions; w is 0
    vec4 texture_from_world[3];         // of directions; w is 0
    vec4 planes[PICTURE_PLANES];        // world space: normal, offset; removes points beyond the plane
    vec4 texturePlanes[PICTURE_PLANES]; // the same in texture space; not of unit length
    vec4 light;                         // ambient, diffuse, specular, shininess
    vec4 side;                          // the second light: direction in world space, and its share
    vec4 viewport;                      // width, height
    float scalarScale;                  // normalised scalar = scalarScale * texel + scalarBias
    float scalarBias;
    float entryScale; // place in the table = entryScale * stored + entryBias
    float entryBias;
    float step;  // mm
    int bricksX; // 0: nothing is skipped
    int bricksY;
    uint switches; // PICTURE_...
    int tableSize;
    int planeCount;
    float faceDepth; // mm: depth of the face shading
    float occlusion; // darkness of completely enclosed places
    float reach;     // mm
    float spare[3];
};

/// Constants of a mesh: the rest of that buffer.
struct PictureMesh {
    vec4 clip_from_object[4];
    vec4 world_from_object[3];
    vec4 texture_from_object[3];
    vec4 normal_from_object[3]; // of directions; w is 0
    vec4 colour;
    vec4 contactColour; // and its visibility through the volume
    vec4 discardedColour;
    ItemConstants item; // of the detector that decides what is painted
    uint switches;      // PICTURE_MESH_...
    uint unused[3];
};

/// Push constants of the pass that makes the pre-integrated table.
struct PreintegrateConstants {
    int size;
    float step; // mm
};

#define PICTURE_LIT_VOLUME 1u
#define PICTURE_LIT_MESH 2u
#define PICTURE_JITTER 4u
#define PICTURE_FACES 8u
#define PICTURE_MESH_DISCARDED 1u
#define PICTURE_MESH_CLIPPED 2u
// Descriptor sets of the volume pass, beside VOXTACT_SET_VOLUME.
#define PICTURE_SET_FUNCTION 1
#define PICTURE_SET_TARGETS 2
#define PICTURE_SET_BRICKS 3
// Descriptor sets of a painted mesh, in addition to VOXTACT_SET_VOLUME, VOXTACT_SET_TRANSFER_FUNCTION and
// PICTURE_SET_TARGETS.
#define PICTURE_SET_PAINT 3
// Bindings of PICTURE_SET_FUNCTION: the table, and the extremes of the opacity.
#define PICTURE_BINDING_TABLE 0
#define PICTURE_BINDING_OPACITY 1
// Bindings of PICTURE_SET_TARGETS: PictureConstants, and the outputs of the mesh pass.
#define PICTURE_BINDING_CONSTANTS 0
#define PICTURE_BINDING_MESH_COLOUR 1
#define PICTURE_BINDING_MESH_DISTANCE 2
// Specialization constants of the volume pass.
#define PICTURE_CONSTANT_OCCLUSION 0
// Lanes along each side of a work group of the table's pass.
#define PREINTEGRATE_SIDE 8
// The distance where there is no mesh.
#define PICTURE_NOTHING 1e30

#ifdef __cplusplus
static_assert(sizeof(PictureConstants) == 528 && sizeof(PictureMesh) == 288, "multiples of 16: as std430 has them");
static_assert(sizeof(PreintegrateConstants) == 8);
} // namespace voxtact::shader
#endif

#endif
