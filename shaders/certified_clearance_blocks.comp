// SPDX-License-Identifier: MIT
// Where clearances are measured: which blocks of bricks may have something opaque, a lane each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define MARGIN
#define CLEARANCE
#include "shared.h"
#include "voxtact/device_results.h"

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;
#include "certified_scene.glsl"
#include "certified_clearance_blocks.glsl"

void main() {
    const Blocks blocks = blocksOfVolume();
    const int number = int(gl_GlobalInvocationID.x);
    if (number >= numberOfBlocks(blocks)) {
        return;
    }
    const CellBox bricks = bricksOfBlock(blocks, number);
    const int count = volumeOf(bricks);
    bool found = false;
    for (int i = 0; i < count && !found; ++i) {
        found = brickMayBeOpaque(brickAt(placeIn(bricks, i)));
    }
    queues[blockWord(number)] = found || isCut() ? 1 : 0;
}
