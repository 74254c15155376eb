// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "exact/exact.h"

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) readonly buffer Transforms {
    PairTransform transforms[];
};

layout(constant_id = VOXTACT_CONSTANT_VIEWS) const uint kViews = 1; // of a pair

layout(location = 0) in vec3 position; // object space

layout(location = 0) out vec3 textureCoordinate;
layout(location = 1) flat out uint pair;

void main() {
    // The instance index counts from firstInstance: it is the number of the view in the batch.
    // In exact arithmetic a picture decides the same fragments, by a pipeline of its own (render_mesh.vert). What
    // `invariant` promises of gl_Position is that too, but lavapipe complains about it in every messenger.
    const ExactCorner corner = exactVertex(transforms[gl_InstanceIndex], position.x, position.y, position.z);
    gl_Position = vec4(corner.x, corner.y, corner.z, corner.w);
    textureCoordinate = vec3(corner.tx, corner.ty, corner.tz);
    pair = uint(gl_InstanceIndex) / kViews;
}
