// SPDX-License-Identifier: MIT
// The table of pre-integrated classification: for the scalars at both ends of a step the colour, times opacity, and the
// opacity of what lies between. From integrals of extinction, and of extinction times colour, up to each entry (Engel,
// Kraus and Ertl 2001, section 4.2): a difference of two gives the mean over the scalars between. The colour is weighted
// by extinction; that what is in front hides what is behind within one step is neglected.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "exact/render.h"

layout(local_size_x = PREINTEGRATE_SIDE, local_size_y = PREINTEGRATE_SIDE) in;

layout(set = 0, binding = 0, rgba16f) uniform writeonly image2D table;
layout(set = 0, binding = 1, std430) readonly buffer Integrals {
    vec4 integrals[]; // up to each entry; then the values at each: extinction times colour, extinction (1/mm)
};
layout(push_constant) uniform Item { PreintegrateConstants constants; };

void main() {
    const ivec2 ends = ivec2(gl_GlobalInvocationID.xy); // front, back
    if (ends.x >= constants.size || ends.y >= constants.size) {
        return;
    }
    const vec4 mean = ends.x == ends.y
                          ? integrals[constants.size + ends.x]
                          : (integrals[ends.y] - integrals[ends.x]) / float(ends.y - ends.x);
    const float opacity = mean.a > 0.0 ? 1.0 - exp(-mean.a * constants.step) : 0.0;
    const vec3 colour = mean.a > 0.0 ? clamp(mean.rgb / mean.a, 0.0, 1.0) : vec3(0.0);
    imageStore(table, ends, vec4(colour * opacity, opacity));
}
