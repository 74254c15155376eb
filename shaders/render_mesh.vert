// SPDX-License-Identifier: MIT
// The expressions are those of view.vert: what is painted by fragment is decided from the same numbers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"

layout(location = 0) in vec3 position;
#ifdef SMOOTH
layout(location = 1) in vec3 normal;
layout(location = 1) out vec3 worldNormal;
#endif
invariant gl_Position;
layout(location = 0) out vec3 world;
#ifdef PAINT_FRAGMENTS
layout(location = 2) invariant out vec3 textureCoordinate;
#endif

void main() {
    const vec4 point = vec4(position, 1.0);
    world = ROWS3(picture.world_from_object, point);
#ifdef SMOOTH
    worldNormal = ROWS3(picture.normal_from_object, vec4(normal, 0.0));
#endif
#ifdef PAINT_FRAGMENTS
    textureCoordinate = ROWS3(picture.texture_from_object, point);
#endif
    gl_Position = ROWS4(picture.clip_from_object, point);
}
