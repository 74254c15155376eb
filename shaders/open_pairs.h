// SPDX-License-Identifier: MIT
// The pairs of an item that a search still looks at. The pass between two of its steps lists them, with the commands of
// the rounds that follow, so that these have work groups for no others. One text for GLSL and C++.
#ifndef VOXTACT_OPEN_PAIRS_H
#define VOXTACT_OPEN_PAIRS_H

// Two sets, one for every other step: while one is filled, the other is emptied for the step after it. Each has the
// number of pairs that are listed, and then for each round the VkDispatchIndirectCommand of its first pass: those of
// the touch, and those that look around. Behind the sets is the list, which both have.
#define VOXTACT_COMMAND_WORDS 3
#define VOXTACT_OPEN_SET_WORDS(pairs) (1 + 2 * VOXTACT_COMMAND_WORDS * (pairs))
#define VOXTACT_OPEN_SETS_WORDS(pairs) (2 * VOXTACT_OPEN_SET_WORDS(pairs))
#define VOXTACT_OPEN_PAIRS_WORDS(pairs) (VOXTACT_OPEN_SETS_WORDS(pairs) + (pairs))
// From the beginning of a set: the command of a round of the touch, or of one that looks around.
#define VOXTACT_OPEN_TOUCH(round) (1 + VOXTACT_COMMAND_WORDS * (round))
#define VOXTACT_OPEN_LOOK(pairs, round) (1 + VOXTACT_COMMAND_WORDS * ((pairs) + (round)))

#endif
