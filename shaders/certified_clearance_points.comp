// SPDX-License-Identifier: MIT
// Where the closest points of pairs are wanted, the end: a lane per pair makes its ClosestResult of an opaque point and
// a triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "clearance_words.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    CertifiedPair transforms[];
};
layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Words { uint words[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_VERTICES, std430) readonly buffer Vertices { float vertices[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_INDICES, std430) readonly buffer Indices { uint indices[]; };
// certified_margin.h names them.
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = VOXTACT_BINDING_EXTREMES, std430) readonly buffer Extremes {
    float extremes[];
};
layout(push_constant) uniform Points { ClosestConstants constants; };

#include "certified_margin.h"
#include "mesh.glsl"

MarginSpace space() {
    MarginSpace by;
    by.xx = constants.toFlat[0];
    by.xy = constants.toFlat[1];
    by.xz = constants.toFlat[2];
    by.yy = constants.toFlat[3];
    by.yz = constants.toFlat[4];
    by.zz = constants.toFlat[5];
    return by;
}

/// A vector of voxel space, in the world.
vec3 worldOf(VoxelPoint v) {
    const vec3 from = vec3(v.x, v.y, v.z);
    return vec3(dot(vec3(constants.rows[0], constants.rows[1], constants.rows[2]), from),
                dot(vec3(constants.rows[3], constants.rows[4], constants.rows[5]), from),
                dot(vec3(constants.rows[6], constants.rows[7], constants.rows[8]), from));
}

VoxelPoint vertexAt(CertifiedPair transform, uint corner) {
    const vec3 position = positionOf(constants.mesh, corner);
    return certifiedVertex(transform, position.x, position.y, position.z).point;
}

/// The point of a triangle that is closest to one of voxel space, from there.
VoxelPoint closestOf(CertifiedPair transform, uint triangle, VoxelPoint cell, VoxelPoint at) {
    VoxelPoint corners[3];
    for (uint i = 0; i < 3; ++i) {
        // Less the whole numbers first.
        corners[i] = voxelDifference(voxelDifference(vertexAt(transform, 3 * triangle + i), cell), at);
    }
    const MarginTriangle about = MarginTriangle(corners[0], corners[1], corners[2], voxelPoint(0.0, 0.0, 0.0), 0.0);
    return marginNear(space(), about, voxelPoint(0.0, 0.0, 0.0)).at;
}

void writeVector(uint word, vec3 vector) {
    words[word] = floatBitsToUint(vector.x);
    words[word + 1] = floatBitsToUint(vector.y);
    words[word + 2] = floatBitsToUint(vector.z);
}

void write(uint word, vec3 mesh, uint triangle, vec3 way, uint some, vec3 arm) {
    writeVector(word, mesh);
    words[word + 3] = triangle;
    writeVector(word + 4, way);
    words[word + 7] = some;
    writeVector(word + 8, arm);
    words[word + 11] = 0;
}

void main() {
    if (gl_GlobalInvocationID.x >= constants.pairs) {
        return;
    }
    const uint pair = constants.firstPair + gl_GlobalInvocationID.x;
    const uint word = constants.closestWord + VOXTACT_CLOSEST_WORDS * pair;
    const float hi =
        uintBitsToFloat(words[constants.clearanceWord + VOXTACT_CLEARANCE_WORDS * pair + VOXTACT_CLEARANCE_HI]);
    if (isinf(hi)) {
        write(word, vec3(0.0), 0, vec3(0.0), 0, vec3(0.0));
        return;
    }
    const CertifiedPair transform = transforms[pair];
    const uint triangle = words[word + VOXTACT_CLOSEST_TRIANGLE];
    const uint cellWord = word + VOXTACT_CLOSEST_CELL;
    const uint atWord = word + VOXTACT_CLOSEST_FROM;
    const vec3 whole = vec3(ivec3(words[cellWord], words[cellWord + 1], words[cellWord + 2]));
    const VoxelPoint cell = voxelPoint(whole.x, whole.y, whole.z);
    const VoxelPoint at = voxelPoint(uintBitsToFloat(words[atWord]), uintBitsToFloat(words[atWord + 1]),
                                     uintBitsToFloat(words[atWord + 2]));
    // Of a touch the two are one.
    const VoxelPoint near = hi > 0.0 ? closestOf(transform, triangle, cell, at) : voxelPoint(0.0, 0.0, 0.0);
    const VoxelPoint mesh = voxelStep(voxelStep(at, near, 1.0), cell, 1.0);
    write(word, vec3(constants.origin[0], constants.origin[1], constants.origin[2]) + worldOf(mesh), triangle,
          worldOf(voxelPoint(-near.x, -near.y, -near.z)), 1,
          worldOf(voxelDifference(mesh, certifiedVertex(transform, 0.0, 0.0, 0.0).point)));
}
