// SPDX-License-Identifier: MIT
// Results and rings of them.
#include "c/answer.h"
#include "c/convert_vulkan.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

ResultsDesc toDesc(const vxt_results_desc* given) {
    const vxt_results_desc desc = readOptions(given, zero<vxt_results_desc>(), "results");
    return {.maxPairs = orDefault(desc.max_pairs, 1U),
            .readBack = desc.no_read_back == 0,
            .timestamps = desc.timestamps != 0,
            .queueFamily = desc.queue_family,
            .room = {desc.triangle_room, desc.label_room, orDefault(desc.contact_room, kDefaultContactRoom)},
            .clustersAtOnce = desc.clusters_at_once,
            .staged = desc.staged != 0,
            .into = {desc.into.buffer, desc.into.offset, desc.into.size}};
}

BufferRange rangeOf(const Results& results, vxt_device_part part) {
    switch (part) {
    case VXT_DEVICE_PAIRS:
        return results.pairResults();
    case VXT_DEVICE_TRIANGLE_COUNTS:
        return results.triangleCounts();
    case VXT_DEVICE_TRIANGLE_MASK:
        return results.triangleMask();
    case VXT_DEVICE_CONTACTS:
        return results.contacts();
    case VXT_DEVICE_BOUNDS:
        return results.bounds();
    case VXT_DEVICE_LABEL_COUNTS:
        return results.labelCounts();
    default:
        break;
    }
    refuse(ErrorCode::InvalidArgument,
           "part " + std::to_string(number<std::uint32_t>(part)) + " is none of vxt_device_part");
}

vxt_certified_counters fromCounters(const CertifiedCounters& from) noexcept {
    vxt_certified_counters out = zero<vxt_certified_counters>();
    out.clusters = from.clusters;
    out.clusters_kept = from.clustersKept;
    out.runs_kept = from.runsKept;
    out.large_parts = from.largeParts;
    out.bricks_seen = from.bricksSeen;
    out.cells_seen = from.cellsSeen;
    out.cells_listed = from.cellsListed;
    out.cells_certain = from.cellsCertain;
    out.cells_decided = from.cellsDecided;
    out.lanes = from.lanes;
    out.cells_open = from.cellsOpen;
    out.left = from.left;
    out.bricks_left = from.bricksLeft;
    out.cells_left = from.cellsLeft;
    out.rounds = from.rounds;
    out.room = from.room;
    out.peak_clusters = from.peakClusters;
    out.peak_runs = from.peakRuns;
    out.peak_parts = from.peakParts;
    out.peak_cells = from.peakCells;
    out.peak_open = from.peakOpen;
    out.peak_left = from.peakLeft;
    out.peak_tests = from.peakTests;
    out.peak_tests_left = from.peakTestsLeft;
    return out;
}

/// The host copy of results, which `pairs` is a part of.
AnswerTables answerOf(Results& results, std::span<const PairResult> pairs, bool timestamps) {
    BatchAnswer answer;
    answer.pairs.reserve(pairs.size());
    for (const PairResult& pair : pairs) {
        answer.pairs.push_back(unpack(pair));
    }
    take(results.readOutputs(answer));
    if (results.counted()) {
        answer.counters = take(results.counters());
    }
    if (timestamps) {
        answer.gpuMilliseconds = take(results.gpuMilliseconds());
    }
    return toTables(std::move(answer));
}

} // namespace

vxt_result vxt_results_create(const vxt_detector* detector, const vxt_results_desc* desc, vxt_results** results) {
    return create(detector, "detector", results, [&](const Detector& by) {
        const ResultsDesc made = toDesc(desc);
        return OwnOrSlot{take(Results::create(by, made)), nullptr, made.timestamps};
    });
}

vxt_result vxt_results_on_device(const vxt_results* results, vxt_device_part part, vxt_buffer_range* range) {
    return call(results, [&] {
        const BufferRange found = rangeOf(need(results, "results").object.get(), part);
        need(range, "range") = {found.buffer, found.offset, found.size};
    });
}

vxt_result vxt_results_cmd_read_back(vxt_results* results, VkCommandBuffer commands) {
    return call(results, [&] { take(need(results, "results").object.get().cmdReadBack(commands)); });
}

vxt_result vxt_results_read(vxt_results* results, vxt_answer* answer) {
    return call(results, [&] {
        OwnOrSlot& from = need(results, "results").object;
        vxt_answer& to = need(answer, "answer");
        to.object = answerOf(from.get(), take(from.get().read()), from.timestamps);
    });
}

vxt_result vxt_answer_counters(const vxt_answer* answer, vxt_certified_counters* counters) {
    return call([&] {
        const vxt_answer& from = need(answer, "answer");
        if (!from.object.counters) {
            refuse(ErrorCode::NotReady, "the answer has no counters: its detector was made without them");
        }
        writeStruct(counters, fromCounters(*from.object.counters), "counters");
    });
}

void vxt_results_destroy(vxt_results* results) {
    if (results != nullptr && results->object.own) {
        delete results;
    }
}

vxt_result vxt_result_ring_create(const vxt_detector* detector, uint32_t frames, const vxt_results_desc* desc,
                                  vxt_result_ring** ring) {
    return create(detector, "detector", ring, [&](const Detector& by) {
        const ResultsDesc made = toDesc(desc);
        RingAndSlots out{take(ResultRing::create(by, frames, made)), {}};
        for (std::uint32_t i = 0; i < frames; ++i) {
            out.slots.push_back({{std::nullopt, nullptr, made.timestamps}, detector->errors});
        }
        return out;
    });
}

vxt_result vxt_result_ring_begin(vxt_result_ring* ring, uint64_t frame, vxt_results** results) {
    return call(ring, [&] {
        vxt_results*& place = need(results, "results");
        place = nullptr;
        RingAndSlots& from = need(ring, "ring").object;
        Results* const claimed = take(from.ring.begin(frame));
        vxt_results& slot = from.slots[frame % from.slots.size()];
        slot.object.slot = claimed;
        place = &slot;
    });
}

vxt_result vxt_result_ring_read(vxt_result_ring* ring, uint64_t frame, vxt_answer* answer) {
    return call(ring, [&] {
        RingAndSlots& from = need(ring, "ring").object;
        vxt_answer& to = need(answer, "answer");
        const std::span<const PairResult> pairs = take(from.ring.read(frame));
        OwnOrSlot& slot = from.slots[frame % from.slots.size()].object;
        to.object = answerOf(slot.get(), pairs, slot.timestamps);
    });
}

void vxt_result_ring_destroy(vxt_result_ring* ring) {
    delete ring;
}
