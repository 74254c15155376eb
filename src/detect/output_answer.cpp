// SPDX-License-Identifier: MIT
#include "core/sort_contacts.h"
#include "detect/output_store.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace voxtact {

namespace {

/// Goes through the pairs of a batch in their order, each with its item.
template <class Visitor> void forEachPair(const OutputStore& store, Visitor&& visitor) {
    std::uint32_t pair = 0;
    for (const OutputItem& item : store.items) {
        for (std::uint32_t pose = 0; pose < item.pairs; ++pose) {
            visitor(pair++, item);
        }
    }
}

const std::uint32_t* wordsAt(const OutputStore& store, std::uint64_t first) {
    return static_cast<const std::uint32_t*>(store.readBack.mapped) + first;
}

void unpackTriangles(const OutputStore& store, BatchAnswer& answer) {
    const std::uint32_t* counts = wordsAt(store, store.layout.triangles);
    forEachPair(store, [&](std::uint32_t pair, const OutputItem& item) {
        for (std::uint32_t triangle = 0; triangle < item.triangles; ++triangle) {
            if (counts[triangle] > 0) {
                answer.triangles.push_back({pair, triangle, counts[triangle]});
            }
        }
        counts += item.triangles;
    });
}

double boundOf(std::uint32_t word) {
    return static_cast<double>(std::bit_cast<float>(VOXTACT_BOUND_BITS(word)));
}

void unpackBounds(const OutputStore& store, BatchAnswer& answer) {
    const std::uint32_t* words = wordsAt(store, store.layout.bounds);
    forEachPair(store, [&](std::uint32_t, const OutputItem&) {
        if (words[0] == 0) {
            answer.bounds.emplace_back();
        } else {
            answer.bounds.emplace_back(Box{{-boundOf(words[0]), -boundOf(words[1]), -boundOf(words[2])},
                                           {boundOf(words[3]), boundOf(words[4]), boundOf(words[5])}});
        }
        words += OUTPUT_BOUND_WORDS;
    });
}

void unpackLabels(const OutputStore& store, BatchAnswer& answer) {
    const std::uint32_t* counts = wordsAt(store, store.layout.labels);
    forEachPair(store, [&](std::uint32_t pair, const OutputItem& item) {
        for (std::size_t label = 0; label < item.labels->size(); ++label) {
            if (counts[label] > 0) {
                answer.labels.push_back({pair, (*item.labels)[label], counts[label]});
            }
        }
        counts += item.labels->size();
    });
}

Contact contactOf(const ContactResult& result, const std::vector<std::int32_t>* labels) {
    return {.pair = result.pair,
            .triangle = result.triangle,
            .position = {result.x, result.y, result.z},
            .normal = {result.nx, result.ny, result.nz},
            .depth = result.depth,
            .value = result.value,
            .opacity = result.opacity,
            .label = labels == nullptr ? 0 : (*labels)[result.label]};
}

void unpackContacts(const OutputStore& store, BatchAnswer& answer) {
    std::vector<const std::vector<std::int32_t>*> labels;
    forEachPair(store, [&](std::uint32_t, const OutputItem& item) { labels.push_back(item.labels.get()); });
    const std::uint32_t* header = wordsAt(store, store.layout.contacts);
    answer.contactsFound = (std::uint64_t{header[1]} << 32U) | header[0];
    const std::uint64_t listed = std::min<std::uint64_t>(answer.contactsFound, store.room.contacts);
    const std::uint32_t* words = header + OUTPUT_HEADER_WORDS;
    answer.contacts.reserve(listed);
    for (std::uint64_t i = 0; i < listed; ++i, words += OUTPUT_CONTACT_WORDS) {
        ContactResult result{};
        static_assert(sizeof result == OUTPUT_CONTACT_WORDS * sizeof *words);
        std::memcpy(&result, words, sizeof result);
        answer.contacts.push_back(contactOf(result, labels[result.pair]));
    }
    sortContacts(answer.contacts);
}

} // namespace

void unpackOutputs(const OutputStore& store, BatchAnswer& answer) {
    const Outputs& outputs = store.recorded;
    if (outputs.triangles) {
        unpackTriangles(store, answer);
    }
    if (outputs.bounds) {
        unpackBounds(store, answer);
    }
    if (outputs.labels) {
        unpackLabels(store, answer);
    }
    if (outputs.contacts) {
        unpackContacts(store, answer);
    }
}

} // namespace voxtact
