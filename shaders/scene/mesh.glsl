// SPDX-License-Identifier: MIT
// Reads a mesh from its storage buffers. Expects `vertices` and `indices`.
#ifndef VOXTACT_MESH_GLSL
#define VOXTACT_MESH_GLSL

#include "exact/exact.h"

uint vertexOf(MeshConstants mesh, uint corner) {
    if (mesh.indexBytes == 0) {
        return corner;
    }
    const uint at = mesh.indexOffset + corner * mesh.indexBytes;
    const uint word = indices[at >> 2];
    return mesh.indexBytes == 4 ? word : (word >> (8 * (at & 2))) & 0xffffu;
}

/// `corner` counts the corners of all triangles. Object space.
vec3 positionOf(MeshConstants mesh, uint corner) {
    const uint at = mesh.vertexOffset + vertexOf(mesh, corner) * mesh.vertexStride;
    return vec3(vertices[at], vertices[at + 1], vertices[at + 2]);
}

ExactCorner cornerOf(MeshConstants mesh, PairTransform transform, uint corner) {
    const vec3 position = positionOf(mesh, corner);
    return exactVertex(transform, position.x, position.y, position.z);
}

#endif
