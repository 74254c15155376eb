#version 460
// SPDX-License-Identifier: MIT
// A gray slice of the volume, and tinted where the transfer function is opaque.

layout(set = 0, binding = 0) uniform sampler3D volume;

layout(push_constant) uniform Slice {
    mat4 texture_from_clip;
    vec2 units;  // value = units.x * texel + units.y
    vec2 window; // values that are black and white
    vec4 opaque[2]; // up to four ranges of values, each lo and hi; empty where lo > hi
};

layout(location = 0) in vec2 clip;
layout(location = 0) out vec4 outColour;

bool isIn(float value, vec2 range) {
    return value >= range.x && value <= range.y;
}

void main() {
    vec3 place = (texture_from_clip * vec4(clip, 0.0, 1.0)).xyz;
    if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) {
        outColour = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    float value = units.x * textureLod(volume, place, 0.0).r + units.y;
    vec3 gray = vec3(clamp((value - window.x) / (window.y - window.x), 0.0, 1.0));
    bool seen = isIn(value, opaque[0].xy) || isIn(value, opaque[0].zw) || isIn(value, opaque[1].xy) ||
                isIn(value, opaque[1].zw);
    outColour = vec4(seen ? mix(gray, vec3(0.95, 0.72, 0.35), 0.22) : gray, 1.0);
}
