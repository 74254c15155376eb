// SPDX-License-Identifier: MIT
// The mesh's colour and, for what is painted, how much of it is seen through the volume; and how far it is from the near plane along the pixel's ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#ifdef PAINT_FRAGMENTS
#endif
#include "picture.glsl"

layout(location = 0) in vec3 world;
#ifdef SMOOTH
layout(location = 1) in vec3 worldNormal;
#endif
layout(location = 0) out vec4 colour;
layout(location = 1) out float distanceFromNear;
layout(push_constant) uniform Which { uint which; };

#if defined(PAINT_FRAGMENTS)
layout(location = 2) in vec3 textureCoordinate;
layout(set = VOXTACT_SET_VOLUME, binding = 0) uniform sampler3D volume;
layout(set = VOXTACT_SET_TRANSFER_FUNCTION, binding = 0) uniform sampler1D transferFunction;
#include "count/survives.glsl"

#define DARKEST 0.25

vec4 paint() {
    // A detector that clamps has proven that the range test would change nothing.
    const bool survivor = survives(textureCoordinate, meshes[which].item, true, false);
    if ((meshes[which].switches & PICTURE_MESH_DISCARDED) == 0u) {
        return survivor ? meshes[which].contactColour : meshes[which].colour;
    }
    const float above = hardwareOpacity(textureCoordinate, meshes[which].item) - meshes[which].item.threshold;
    const float share = clamp(above / max(1.0 - meshes[which].item.threshold, 1e-6), 0.0, 1.0);
    return vec4(survivor ? vec3(mix(DARKEST, 1.0, share)) : meshes[which].discardedColour.rgb, meshes[which].contactColour.a);
}
#elif defined(PAINT_TRIANGLES)
layout(set = PICTURE_SET_PAINT, binding = 0, std430) readonly buffer Triangles { uint painted[]; };

vec4 paint() {
    const uint triangle = uint(gl_PrimitiveID);
    const bool chosen = (painted[triangle >> 5u] >> (triangle & 31u) & 1u) != 0u;
    return chosen ? meshes[which].contactColour : meshes[which].colour;
}
#elif defined(PAINT_VERTICES)
layout(location = 2) in vec3 vertexColour;

vec4 paint() {
    return vec4(vertexColour, meshes[which].contactColour.a);
}
#else
vec4 paint() {
    return meshes[which].colour;
}
#endif

bool isClipped() {
    for (int i = 0; i < picture.planeCount; ++i) {
        if (dot(picture.planes[i].xyz, world) > picture.planes[i].w) {
            return true;
        }
    }
    return false;
}

void main() {
    if ((meshes[which].switches & PICTURE_MESH_CLIPPED) != 0u && isClipped()) {
        discard;
    }
    const vec4 point = ROWS4(picture.world_from_clip, vec4(clipOf(gl_FragCoord.xy), 0.0, 1.0));
    const vec3 way = world - point.xyz / point.w;
    distanceFromNear = length(way);
    colour = paint();
    if ((picture.switches & PICTURE_LIT_MESH) != 0u) {
#ifdef SMOOTH
        const vec3 normal = worldNormal;
#else
        const vec3 normal = cross(dFdx(world), dFdy(world));
#endif
        const float size = length(normal);
        const vec3 away = distanceFromNear > 0.0 ? way / distanceFromNear : vec3(0.0);
        colour.rgb = lit(vec4(colour.rgb, 1.0), size > 0.0 ? normal / size : away, away);
    }
}
