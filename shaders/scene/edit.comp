// SPDX-License-Identifier: MIT
// Gives the voxels of rows one value, in texels that were copied out of an image and go back there: a lane per word.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "exact/shared.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

layout(set = 0, binding = VOXTACT_BINDING_EDIT_ROWS, std430) readonly buffer Rows {
    uvec2 rows[]; // first texel, and the one beyond the last
};
layout(set = 0, binding = VOXTACT_BINDING_EDIT_TEXELS, std430) buffer Texels { uint words[]; };
layout(push_constant) uniform Edit { EditConstants constants; };

void main() {
    const uint group = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
    const uint word = group * VOXTACT_COMPUTE_GROUP + gl_LocalInvocationIndex;
    const uint texelsOfWord = 4 / constants.texelBytes;
    if (word * texelsOfWord >= constants.rowTexels * constants.rows) {
        return;
    }
    const uint bits = 8 * constants.texelBytes;
    const uint one = 0xffffffffu >> (32 - bits);
    uint changed = 0;
    for (uint i = 0; i < texelsOfWord; ++i) {
        const uint texel = word * texelsOfWord + i;
        const uint row = texel / constants.rowTexels;
        const uint x = texel % constants.rowTexels;
        if (row < constants.rows && x >= rows[row].x && x < rows[row].y) {
            changed |= one << (i * bits);
        }
    }
    words[word] = (words[word] & ~changed) | (constants.value & changed);
}
