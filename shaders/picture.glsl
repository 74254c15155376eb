// SPDX-License-Identifier: MIT
// What the passes of a picture share.
#ifndef VOXTACT_PICTURE_GLSL
#define VOXTACT_PICTURE_GLSL

#include "render.h"

layout(set = PICTURE_SET_TARGETS, binding = PICTURE_BINDING_CONSTANTS, std430) readonly buffer Picture {
    PictureConstants picture;
};

#define ROWS3(rows, v) vec3(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v))
#define ROWS4(rows, v) vec4(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v), dot(rows[3], v))

/// Where a pixel is in clip space: x and y.
vec2 clipOf(vec2 pixel) {
    return 2.0 * pixel / picture.viewport.xy - 1.0;
}

/// Blinn-Phong with the light at the eye, on both sides of a surface. `colour` is times its opacity, as the result is.
vec3 lit(vec4 colour, vec3 normal, vec3 toEye) {
    const float facing = abs(dot(normal, toEye));
    return colour.rgb * (picture.light.x + picture.light.y * facing) +
           colour.a * picture.light.z * pow(facing, picture.light.w);
}

#endif
