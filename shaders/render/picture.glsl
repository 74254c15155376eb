// SPDX-License-Identifier: MIT
// What the passes of a picture share.
#ifndef VOXTACT_PICTURE_GLSL
#define VOXTACT_PICTURE_GLSL

#include "exact/render.h"

layout(set = PICTURE_SET_TARGETS, binding = PICTURE_BINDING_CONSTANTS, std430) readonly buffer Picture {
    PictureConstants picture;
    PictureMesh meshes[];
};

#define ROWS3(rows, v) vec3(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v))
#define ROWS4(rows, v) vec4(dot(rows[0], v), dot(rows[1], v), dot(rows[2], v), dot(rows[3], v))

/// Returns the clip-space x and y of a pixel.
vec2 clipOf(vec2 pixel) {
    return 2.0 * pixel / picture.viewport.xy - 1.0;
}

// Below this cosine between the view direction and a surface, both sides of the surface are visible.
#define SILHOUETTE 0.25

/// Returns the outside of a surface as the eye sees it: 1 along its normal, -1 against it, in between at a silhouette.
/// `towards`: cosine between the normal and the view direction.
float outwards(float towards) {
    return clamp(-towards / SILHOUETTE, -1.0, 1.0);
}

/// Returns the share of a light that arrives on the outside: a power of the cosine between the normal and its
/// direction.
float bothSides(float towards, float cosine, float power) {
    const float along = 0.5 + 0.5 * outwards(towards);
    return along * pow(max(cosine, 0.0), power) + (1.0 - along) * pow(max(-cosine, 0.0), power);
}

/// Blinn-Phong on both sides of a surface, by the light at the eye and the one at its side. `colour` and the result are
/// premultiplied by opacity; `away` points away from the eye.
vec3 lit(vec4 colour, vec3 normal, vec3 away) {
    const float towards = dot(normal, away);
    const float facing = abs(towards);
    const float bySide = bothSides(towards, dot(normal, picture.side.xyz), 1.0);
    const vec3 between = picture.side.xyz - away;
    const float size = length(between);
    const float glint = size > 0.0 ? bothSides(towards, dot(normal, between) / size, picture.light.w) : 0.0;
    return colour.rgb * (picture.light.x + picture.light.y * facing + picture.side.w * bySide) +
           colour.a * picture.light.z *
               (pow(facing, picture.light.w) + picture.side.w * glint);
}

#endif
