// SPDX-License-Identifier: MIT
// Where clearances are measured: which cells of a brick may have something opaque, and which certainly have, a bit each.
// Bricks that any pair comes near have a slot of them, for all pairs and steps of an item. Of a brick that found no slot
// any cell may have something, and none is certain to. Expects certified_scene.glsl.
#ifndef VOXTACT_CERTIFIED_CLEARANCE_BITS_GLSL
#define VOXTACT_CERTIFIED_CLEARANCE_BITS_GLSL

const uint kCellWords = VOXTACT_BITS_WORDS / 2; // of one bit per cell
/// Slots that a brick may have.
const uint kSlotTries = 8;

uint slotWord(uint slot) {
    return constants.queueWord + VOXTACT_WORD_BITS(constants.queueRoom) + slot;
}

uint wantedWord(uint number) {
    return constants.queueWord + VOXTACT_WORD_BITS_WANTED(constants.queueRoom) + number;
}

uint bitsWord(uint slot) {
    return constants.queueWord + VOXTACT_WORD_BITS_WORDS(constants.queueRoom) + VOXTACT_BITS_WORDS * slot;
}

/// Of the numbers of entries that are near, and of those of them that are nearest.
uint nearWord(uint number) {
    return constants.queueWord + VOXTACT_WORD_NEAR(constants.queueRoom) + number;
}

uint nearestWord(uint number) {
    return constants.queueWord + VOXTACT_WORD_NEAREST(constants.queueRoom) + number;
}

/// A brick as an entry has it, whose bits are known to the next pass: by its slot, if it found one.
uint wantBits(uint brick) {
    const uint room = VOXTACT_ROOM_BITS(constants.queueRoom);
    uint slot = (brick * 2654435761u >> 8) % room;
    for (uint turn = 0; turn < min(kSlotTries, room); ++turn) {
        const uint before = atomicCompSwap(queues[slotWord(slot)], 0u, brick + 1);
        if (before == 0) {
            queues[wantedWord(reserve(VOXTACT_QUEUE_BITS, 1, room, 1))] = slot;
        }
        if (before == 0 || before == brick + 1) {
            return slot | VOXTACT_HAS_SLOT;
        }
        slot = slot + 1 == room ? 0 : slot + 1;
    }
    return brick;
}

uint slotOf(uint z) {
    return z & (1u << VOXTACT_FIRST_CELL_SHIFT) - 1;
}

/// The number of an entry's brick.
uint brickOfEntry(uint z) {
    return (z & VOXTACT_HAS_SLOT) != 0 ? queues[slotWord(slotOf(z))] - 1 : z;
}

/// Of 32 cells of an entry's brick, four rows of eight: those that may have something opaque.
uint mayBits(uint z, uint word) {
    return (z & VOXTACT_HAS_SLOT) != 0 ? queues[bitsWord(slotOf(z)) + word] : 0xffffffffu;
}

/// Those that certainly have.
uint hasBits(uint z, uint word) {
    return (z & VOXTACT_HAS_SLOT) != 0 ? queues[bitsWord(slotOf(z)) + kCellWords + word] : 0u;
}

/// The place of a cell in its brick.
ivec3 cellInBrick(uint number) {
    const uint mask = (1u << VOXTACT_BRICK_SHIFT) - 1;
    return ivec3(number & mask, number >> VOXTACT_BRICK_SHIFT & mask, number >> 2 * VOXTACT_BRICK_SHIFT & mask);
}

/// Above the lowest bits of a word: what something of a pair is no nearer than, as it is farther than what the pair is
/// known to be, which does not change during a step.
uint withBelow(uint pair, uint word, float below) {
    const float most = float((1u << (32 - VOXTACT_BELOW_SHIFT)) - 1);
    const float farther = clamp((below - clearanceLo(pair)) * VOXTACT_BELOW_PARTS, 0.0, most);
    return word & (1u << VOXTACT_BELOW_SHIFT) - 1 | uint(farther) << VOXTACT_BELOW_SHIFT;
}

float belowOf(uint pair, uint word) {
    return (clearanceLo(pair) + float(word >> VOXTACT_BELOW_SHIFT) / VOXTACT_BELOW_PARTS) * MARGIN_INWARD;
}

#endif
