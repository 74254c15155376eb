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
    // The instance index counts from firstInstance: it is the number of the view in the batch. The pipeline of a
    // picture (render_mesh.vert) decides the same fragments in exact arithmetic. `invariant` gl_Position would
    // guarantee this, but lavapipe reports a message for it.
    const ExactCorner corner = exactVertex(transforms[gl_InstanceIndex], position.x, position.y, position.z);
    gl_Position = vec4(corner.x, corner.y, corner.z, corner.w);
    textureCoordinate = vec3(corner.tx, corner.ty, corner.tz);
    pair = uint(gl_InstanceIndex) / kViews;
}
