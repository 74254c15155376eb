// SPDX-License-Identifier: MIT
// Where clearances are measured: the bits of the bricks that want them, a work group per brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define MARGIN
#define CLEARANCE
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_clearance_bits.glsl"

shared uint bits[VOXTACT_BITS_WORDS];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint slot = queues[wantedWord(gl_WorkGroupID.x)];
    const ivec3 brick = brickOf(int(queues[slotWord(slot)]) - 1);
    if (lane < VOXTACT_BITS_WORDS) {
        bits[lane] = 0;
    }
    barrier();
    const vec4 range = brickAt(brick);
    const ivec3 last = ivec3(constants.item.sizeX, constants.item.sizeY, constants.item.sizeZ) - 1;
    for (uint i = lane; i < 32 * kCellWords; i += VOXTACT_COMPUTE_GROUP) {
        const ivec3 cell = (brick << VOXTACT_BRICK_SHIFT) - 1 + cellInBrick(i);
        const CertifiedCell known = certifiedCell(constants.item, cornersOf(cell, range), cell.x, cell.y, cell.z, 0.0);
        bool may = all(lessThanEqual(cell, last)) && marginCellMay(opacities(), known);
#ifdef OF_LABEL
        const LabelOctants octants = octantsOf(cell);
        may = may && octants.own != 0;
        const bool has = labelledCellHas(octants, marginCellHas(opacities(), known));
#else
        const bool has = marginCellHas(opacities(), known) != 0;
#endif
        if (may) {
            const uint bit = 1u << (i & 31u);
            atomicOr(bits[i >> 5], bit);
            if (has) {
                atomicOr(bits[kCellWords + (i >> 5)], bit);
            }
        }
    }
    barrier();
    if (lane < VOXTACT_BITS_WORDS) {
        queues[bitsWord(slot) + lane] = bits[lane];
    }
}
