// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    PairTransform transforms[];
};

layout(constant_id = VOXTACT_CONSTANT_VIEWS) const uint kViews = 1; // of a pair

layout(location = 0) in vec3 position; // object space

// Invariant: a picture decides the same fragments in a pipeline of its own (render_mesh.vert).
invariant gl_Position;
layout(location = 0) invariant out vec3 textureCoordinate;
layout(location = 1) flat out uint pair;

void main() {
    // The instance index counts from firstInstance: it is the number of the view in the batch.
    const PairTransform transform = transforms[gl_InstanceIndex];
    const vec4 point = vec4(position, 1.0);
    gl_Position = vec4(dot(transform.clip_from_object[0], point), dot(transform.clip_from_object[1], point),
                       dot(transform.clip_from_object[2], point), dot(transform.clip_from_object[3], point));
    textureCoordinate = vec3(dot(transform.texture_from_object[0], point), dot(transform.texture_from_object[1], point),
                             dot(transform.texture_from_object[2], point));
    pair = uint(gl_InstanceIndex) / kViews;
}
