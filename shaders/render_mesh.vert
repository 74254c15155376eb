// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"

layout(location = 0) in vec3 position;
#ifdef SMOOTH
layout(location = 1) in vec3 normal;
layout(location = 1) out vec3 worldNormal;
#endif
layout(location = 0) out vec3 world;

void main() {
    const vec4 point = vec4(position, 1.0);
    world = ROWS3(picture.world_from_object, point);
#ifdef SMOOTH
    worldNormal = ROWS3(picture.normal_from_object, vec4(normal, 0.0));
#endif
    gl_Position = ROWS4(picture.clip_from_object, point);
}
