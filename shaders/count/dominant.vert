// SPDX-License-Identifier: MIT
// The projection `dominant-axis` for the rasteriser. Each corner needs its whole triangle, so it is read from the mesh's
// storage buffers: the draw has neither vertex nor index buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/shared.h"

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    PairTransform transforms[];
};
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_VERTICES, std430) readonly buffer Vertices { float vertices[]; };
layout(set = VOXTACT_SET_MESH, binding = VOXTACT_BINDING_INDICES, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Draw { layout(offset = VOXTACT_OFFSET_DOMINANT) DominantConstants constants; };

layout(location = 0) out vec3 textureCoordinate;
layout(location = 1) flat out uint pair;

#include "exact/dominant.h"
#include "scene/mesh.glsl"

void main() {
    const PairTransform transform = transforms[gl_InstanceIndex];
    const uint first = uint(gl_VertexIndex) / 3 * 3;
    ExactCorner corners[3];
    for (uint i = 0; i < 3; ++i) {
        corners[i] = cornerOf(constants.mesh, transform, first + i);
    }
    const bool seen = dominantProject(corners[0], corners[1], corners[2], constants.grid);
    const ExactCorner corner = corners[uint(gl_VertexIndex) - first];
    // An invisible triangle goes outside the viewport, where it has no fragments.
    gl_Position = seen ? vec4(corner.x, corner.y, corner.z, corner.w) : vec4(-3.0, -3.0, 0.5, 1.0);
    textureCoordinate = vec3(corner.tx, corner.ty, corner.tz);
    pair = gl_InstanceIndex;
}
