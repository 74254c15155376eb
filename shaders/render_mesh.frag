// SPDX-License-Identifier: MIT
// The mesh's colour, and how far it is from the near plane along the pixel's ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"

layout(location = 0) in vec3 world;
#ifdef SMOOTH
layout(location = 1) in vec3 worldNormal;
#endif
layout(location = 0) out vec4 colour;
layout(location = 1) out float distanceFromNear;

void main() {
    const vec4 point = ROWS4(picture.world_from_clip, vec4(clipOf(gl_FragCoord.xy), 0.0, 1.0));
    const vec3 way = world - point.xyz / point.w;
    distanceFromNear = length(way);
    colour = vec4(picture.meshColour.rgb, 1.0);
    if ((picture.switches & PICTURE_LIT_MESH) != 0u) {
#ifdef SMOOTH
        const vec3 normal = worldNormal;
#else
        const vec3 normal = cross(dFdx(world), dFdy(world));
#endif
        const float size = length(normal);
        const vec3 toEye = distanceFromNear > 0.0 ? way / distanceFromNear : vec3(0.0);
        colour.rgb = lit(colour, size > 0.0 ? normal / size : toEye, toEye);
    }
}
