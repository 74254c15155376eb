// SPDX-License-Identifier: MIT
// Where clearances are measured: blocks of bricks, and which of them may have something opaque. Expects
// certified_scene.glsl.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_BLOCKS_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_BLOCKS_GLSL

/// A block is 2^shift bricks a side.
struct Blocks {
    int shift;
    ivec3 counts;
};

/// The smallest of which the volume has no more than there is room for.
Blocks blocksOfVolume() {
    Blocks blocks;
    int count = 0;
    blocks.shift = VOXTACT_BLOCK_SHIFT - 1;
    do {
        ++blocks.shift;
        blocks.counts = (brickCounts() + (1 << blocks.shift) - 1) >> blocks.shift;
        count = blocks.counts.x * blocks.counts.y * blocks.counts.z;
    } while (count > VOXTACT_BLOCKS);
    return blocks;
}

int numberOfBlocks(Blocks blocks) {
    return blocks.counts.x * blocks.counts.y * blocks.counts.z;
}

/// Its bricks.
CellBox bricksOfBlock(Blocks blocks, int number) {
    const int row = number / blocks.counts.x;
    const ivec3 place = ivec3(number % blocks.counts.x, row % blocks.counts.y, row / blocks.counts.y);
    const ivec3 first = place << blocks.shift;
    return CellBox(first, min(first + (1 << blocks.shift), brickCounts()) - 1);
}

uint blockWord(int number) {
    return constants.queueWord + VOXTACT_WORD_BLOCKS(constants.queueRoom) + uint(number);
}

bool blockMayBeOpaque(int number) {
    return queues[blockWord(number)] != 0;
}

/// Whether the volume may have anything opaque.
bool anyBlock() {
    const int count = numberOfBlocks(blocksOfVolume());
    bool found = false;
    for (int i = 0; i < count && !found; ++i) {
        found = blockMayBeOpaque(i);
    }
    return found;
}

#endif
