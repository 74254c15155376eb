// SPDX-License-Identifier: MIT
// The projection `certified`, what its passes did in the rounds so far: the sums and peaks of their queue headers,
// added to the CertifiedCounters of the batch. A lane a counter.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "exact/shared.h"

const uint kTotals = 14;
const uint kPeaks = 8;

layout(local_size_x = VOXTACT_COMPUTE_GROUP) in;

layout(set = VOXTACT_SET_PAIRS, binding = VOXTACT_BINDING_TRANSFORMS, std430) buffer Queues { uint queues[]; };
layout(push_constant) uniform Tally { TallyConstants constants; };

/// The number of entries of a queue, in its header.
#define ENTRIES(queue) (4 * (queue) + 3)

/// In the order of CertifiedCounters: the header word that each total sums.
const uint kWordOfTotal[kTotals] =
    uint[](VOXTACT_WORK_CLUSTERS, ENTRIES(VOXTACT_QUEUE_CLUSTERS), ENTRIES(VOXTACT_QUEUE_RUNS),
           ENTRIES(VOXTACT_QUEUE_LARGE), VOXTACT_WORK_BRICKS, VOXTACT_WORK_CELLS, ENTRIES(VOXTACT_QUEUE_CELLS),
           VOXTACT_WORK_CERTAIN, VOXTACT_WORK_DECIDED, 4 * VOXTACT_QUEUE_CELLS, ENTRIES(VOXTACT_QUEUE_OPEN), ENTRIES(VOXTACT_QUEUE_LEFT),
           VOXTACT_WORK_BRICKS_LEFT, VOXTACT_WORK_CELLS_LEFT);
/// The total that counts lanes but is stored in work groups.
const uint kLanes = 9;

/// The header words, one or the sum of two, whose maximum is a peak.
const uvec2 kWordsOfPeak[kPeaks] =
    uvec2[](uvec2(ENTRIES(VOXTACT_QUEUE_CLUSTERS)), uvec2(ENTRIES(VOXTACT_QUEUE_RUNS)),
            uvec2(ENTRIES(VOXTACT_QUEUE_LARGE)), uvec2(ENTRIES(VOXTACT_QUEUE_CELLS)), uvec2(ENTRIES(VOXTACT_QUEUE_OPEN)),
            uvec2(ENTRIES(VOXTACT_QUEUE_LEFT)), uvec2(VOXTACT_WORK_BRICKS, VOXTACT_WORK_CELLS),
            uvec2(VOXTACT_WORK_BRICKS_LEFT, VOXTACT_WORK_CELLS_LEFT));

uint wordOf(uint round, uint word) {
    return queues[constants.queueWord + round * VOXTACT_HEADER_WORDS + word];
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint counters = constants.queueWord + VOXTACT_WORD_COUNTERS;
    const uint rounds = counters + 2 * kTotals;
    if (lane < kTotals) {
        const uint at = counters + 2 * lane;
        uint low = queues[at];
        uint high = queues[at + 1];
        for (uint round = 0; round < constants.rounds; ++round) {
            const uint term = wordOf(round, kWordOfTotal[lane]) * (lane == kLanes ? VOXTACT_COMPUTE_GROUP : 1);
            low += term;
            high += low < term ? 1 : 0;
        }
        queues[at] = low;
        queues[at + 1] = high;
    } else if (lane < kTotals + kPeaks) {
        const uint number = lane - kTotals;
        const uvec2 words = kWordsOfPeak[number];
        uint peak = queues[rounds + 2 + number];
        for (uint round = 0; round < constants.rounds; ++round) {
            peak = max(peak, wordOf(round, words.x) + (words.y == words.x ? 0 : wordOf(round, words.y)));
        }
        queues[rounds + 2 + number] = peak;
    } else if (lane == kTotals + kPeaks) {
        queues[rounds] += constants.rounds;
        queues[rounds + 1] = constants.queueRoom;
    }
}
