// SPDX-License-Identifier: MIT
#include "core/batch/sort_contacts.h"
#include "detect/output_store.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

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

Contact contactOf(const ContactResult& result, const OutputItem& item) {
    return {.pair = result.pair,
            .triangle = result.triangle,
            .position = {result.x, result.y, result.z},
            .normal = {result.nx, result.ny, result.nz},
            .depth = result.depth,
            .value = result.value,
            .opacity = result.opacity,
            .label = item.labels == nullptr ? 0 : (*item.labels)[result.label]};
}

/// The item of a contact's pair; null where the batch has no such contact.
const OutputItem* itemOf(const ContactResult& result, std::span<const OutputItem* const> items) {
    if (result.pair >= items.size()) {
        return nullptr;
    }
    const OutputItem& item = *items[result.pair];
    const bool known =
        result.triangle < item.triangles && (item.labels == nullptr || result.label < item.labels->size());
    return known ? &item : nullptr;
}

Result<void> unpackContacts(const OutputStore& store, BatchAnswer& answer) {
    std::vector<const OutputItem*> items;
    forEachPair(store, [&](std::uint32_t, const OutputItem& item) { items.push_back(&item); });
    const std::uint32_t* header = wordsAt(store, store.layout.contacts);
    answer.contactsFound = (std::uint64_t{header[1]} << 32U) | header[0];
    const std::uint64_t listed = std::min<std::uint64_t>(answer.contactsFound, store.room.contacts);
    const std::uint32_t* words = header + OUTPUT_HEADER_WORDS;
    answer.contacts.reserve(listed);
    for (std::uint64_t i = 0; i < listed; ++i, words += OUTPUT_CONTACT_WORDS) {
        ContactResult result{};
        static_assert(sizeof result == OUTPUT_CONTACT_WORDS * sizeof *words);
        std::memcpy(&result, words, sizeof result);
        const OutputItem* item = itemOf(result, items);
        if (item == nullptr) {
            answer.contacts.clear();
            return Error{ErrorCode::Internal, 0,
                         "contact " + std::to_string(i) + " of the list is of pair " + std::to_string(result.pair) +
                             ", triangle " + std::to_string(result.triangle) + ", label number " +
                             std::to_string(result.label) +
                             ", which the batch does not have: its buffer was overwritten"};
        }
        answer.contacts.push_back(contactOf(result, *item));
    }
    sortContacts(answer.contacts);
    return {};
}

} // namespace

Result<void> unpackOutputs(const OutputStore& store, BatchAnswer& answer) {
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
    return outputs.contacts ? unpackContacts(store, answer) : Result<void>();
}

} // namespace voxtact
