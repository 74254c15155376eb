// SPDX-License-Identifier: MIT
// The cells that a work group finds, collected in shared memory and put into the queue of cells at once; and what is
// certain without a decision. Expects certified_scene.glsl, and VOXTACT_CELL_LIST, the most cells of a list.
#ifndef VOXTACT_CERTIFIED_CELLS_GLSL
#define VOXTACT_CERTIFIED_CELLS_GLSL

layout(constant_id = VOXTACT_CONSTANT_OUTPUTS) const uint kOutputs = 0;
/// With outputs, every certain fragment needs a witness point, which only a decision finds.
const bool kWitnesses = kOutputs != 0;

shared uint certainOfGroup; // fragments of one pair
shared uint listed;
shared uint list[VOXTACT_CELL_LIST];
shared uint firstOfList; // in the queue

/// Reserves room for the listed cells. All lanes call it together, after a barrier. Returns false if the queue has no
/// room for all; then add none.
bool reserveList() {
    if (gl_LocalInvocationIndex == 0 && listed > 0) {
        firstOfList =
            reserve(VOXTACT_QUEUE_CELLS, listed, VOXTACT_ROOM_CELLS(constants.queueRoom), VOXTACT_COMPUTE_GROUP);
    }
    barrier();
    const uint room = VOXTACT_ROOM_CELLS(constants.queueRoom);
    if (listed == 0 || firstOfList + listed <= room) {
        return true;
    }
    for (uint entry = firstOfList + gl_LocalInvocationIndex; entry < room; entry += VOXTACT_COMPUTE_GROUP) {
        quads[quadOf(VOXTACT_WORD_CELLS, entry)] = uvec4(kNoPair, 0, 0, 0);
    }
    return false;
}

void putCell(uint place, uint pair, uint triangle, ivec3 cell) {
    quads[quadOf(VOXTACT_WORD_CELLS, firstOfList + place)] = uvec4(pair, triangle, packCell(cell));
}

#endif
