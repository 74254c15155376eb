// SPDX-License-Identifier: MIT
// How the pass between two steps of a search lists the pairs that are still open: open_pairs.h says where. Expects
// shared.h, and `words` of the transforms' buffer.
#ifndef VOXTACT_OPEN_PAIRS_GLSL
#define VOXTACT_OPEN_PAIRS_GLSL

#include "open_pairs.h"

/// One pair more for a round that has those from an entry of the list on. The first pair of a round says the rest.
void addToRound(uint command, bool first, uint groups) {
    if (first) {
        words[command] = groups;
        words[command + 2] = 1;
    }
    atomicAdd(words[command + 1], 1u);
}

void listPair(OpenPairs open, uint pair) {
    const uint entry = atomicAdd(words[open.set], 1u);
    words[open.list + entry] = pair;
    if (open.touchPairs > 0) {
        addToRound(open.set + VOXTACT_OPEN_TOUCH(entry / open.touchPairs), entry % open.touchPairs == 0,
                   open.touchGroups);
    }
    addToRound(open.set + VOXTACT_OPEN_LOOK(open.slots, entry / open.lookPairs), entry % open.lookPairs == 0,
               open.lookGroups);
}

/// Empties what the step after the next will list. `lane`: of the dispatch; each has one slot of each kind.
void emptyNext(OpenPairs open, uint lane) {
    const uint slot = open.before + lane;
    if (slot == 0) {
        words[open.nextSet] = 0;
    }
    words[open.nextSet + VOXTACT_OPEN_TOUCH(slot) + 1] = 0;
    words[open.nextSet + VOXTACT_OPEN_LOOK(open.slots, slot) + 1] = 0;
}

#endif
