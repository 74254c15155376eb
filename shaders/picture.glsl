// SPDX-License-Identifier: MIT
// What the passes of a picture share.
#ifndef VOXTACT_PICTURE_GLSL
#define VOXTACT_PICTURE_GLSL

#include "render.h"

layout(set = PICTURE_SET_TARGETS, binding = PICTURE_BINDING_CONSTANTS, std430) readonly buffer Picture {
    PictureConstants picture;
    PictureMesh meshes[];
};

#define ROWS3(rows, v) vec3(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v))
#define ROWS4(rows, v) vec4(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v), dot(rows[3], v))

/// Where a pixel is in clip space: x and y.
vec2 clipOf(vec2 pixel) {
    return 2.0 * pixel / picture.viewport.xy - 1.0;
}

/// Blinn-Phong on both sides of a surface, by the light at the eye and the one at its side. `colour` is times its
/// opacity, as the result is; `away` leads from the eye.
vec3 lit(vec4 colour, vec3 normal, vec3 away) {
    const float towards = dot(normal, away);
    const float facing = abs(towards);
    const vec3 outside = towards > 0.0 ? -normal : normal;
    const float bySide = max(dot(outside, picture.side.xyz), 0.0);
    const vec3 between = picture.side.xyz - away;
    const float size = length(between);
    const float glint = size > 0.0 ? max(dot(outside, between) / size, 0.0) : 0.0;
    return colour.rgb * (picture.light.x + picture.light.y * facing + picture.side.w * bySide) +
           colour.a * picture.light.z *
               (pow(facing, picture.light.w) + picture.side.w * pow(glint, picture.light.w));
}

#endif
