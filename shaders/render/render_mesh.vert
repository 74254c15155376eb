// SPDX-License-Identifier: MIT
// The numbers are those of view.vert, bit for bit: what is painted by fragment is decided from them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "picture.glsl"
#include "exact/exact.h"

layout(location = 0) in vec3 position;
#ifdef SMOOTH
layout(location = 1) in vec3 normal;
layout(location = 1) out vec3 worldNormal;
#endif
layout(location = 0) out vec3 world;
layout(push_constant) uniform Which { uint which; };
#if defined(PAINT_FRAGMENTS)
layout(location = 2) out vec3 textureCoordinate;
#elif defined(PAINT_VERTICES)
layout(location = 2) out vec3 vertexColour;
layout(set = PICTURE_SET_PAINT, binding = 0, std430) readonly buffer Vertices { uint painted[]; };
#endif

void main() {
    const PairTransform transform = PairTransform(meshes[which].clip_from_object, meshes[which].texture_from_object);
    const ExactCorner corner = exactVertex(transform, position.x, position.y, position.z);
    const vec4 point = vec4(position, 1.0);
    world = ROWS3(meshes[which].world_from_object, point);
#ifdef SMOOTH
    worldNormal = ROWS3(meshes[which].normal_from_object, vec4(normal, 0.0));
#endif
#if defined(PAINT_FRAGMENTS)
    textureCoordinate = vec3(corner.tx, corner.ty, corner.tz);
#elif defined(PAINT_VERTICES)
    vertexColour = unpackUnorm4x8(painted[gl_VertexIndex]).rgb;
#endif
    gl_Position = vec4(corner.x, corner.y, corner.z, corner.w);
}
