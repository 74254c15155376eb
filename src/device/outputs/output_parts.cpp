// SPDX-License-Identifier: MIT
#include "device/outputs/output_parts.h"
#include "core/base/live.h"
#include "core/batch/sort_contacts.h"
#include "device/outputs/output_store.h"
#include "device/results/results_impl.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

namespace voxtact {

namespace {

/// Goes through the pairs of a batch in their order, each with its item.
template <class Visitor> void forEachPair(std::span<const OutputItem> items, Visitor&& visitor) {
    std::uint32_t pair = 0;
    for (const OutputItem& item : items) {
        for (std::uint32_t pose = 0; pose < item.pairs; ++pose) {
            visitor(pair++, item);
        }
    }
}

Result<void> unpackTriangles(const OutputWords& of, BatchAnswer& answer) {
    const std::uint32_t* counts = of.words;
    forEachPair(of.items, [&](std::uint32_t pair, const OutputItem& item) {
        for (std::uint32_t triangle = 0; triangle < item.triangles; ++triangle) {
            if (counts[triangle] > 0) {
                answer.triangles.push_back({pair, triangle, counts[triangle]});
            }
        }
        counts += item.triangles;
    });
    return {};
}

double boundOf(std::uint32_t word) {
    return static_cast<double>(std::bit_cast<float>(VOXTACT_BOUND_BITS(word)));
}

Result<void> unpackBounds(const OutputWords& of, BatchAnswer& answer) {
    const std::uint32_t* words = of.words;
    forEachPair(of.items, [&](std::uint32_t, const OutputItem&) {
        if (words[0] == 0) {
            answer.bounds.emplace_back();
        } else {
            answer.bounds.emplace_back(Box{{-boundOf(words[0]), -boundOf(words[1]), -boundOf(words[2])},
                                           {boundOf(words[3]), boundOf(words[4]), boundOf(words[5])}});
        }
        words += OUTPUT_BOUND_WORDS;
    });
    return {};
}

Result<void> unpackLabels(const OutputWords& of, BatchAnswer& answer) {
    const std::uint32_t* counts = of.words;
    forEachPair(of.items, [&](std::uint32_t pair, const OutputItem& item) {
        for (std::size_t label = 0; label < item.labels->size(); ++label) {
            if (counts[label] > 0) {
                answer.labels.push_back({pair, (*item.labels)[label], counts[label]});
            }
        }
        counts += item.labels->size();
    });
    return {};
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

Result<void> unpackContacts(const OutputWords& of, BatchAnswer& answer) {
    std::vector<const OutputItem*> items;
    forEachPair(of.items, [&](std::uint32_t, const OutputItem& item) { items.push_back(&item); });
    const std::uint32_t* header = of.words;
    answer.contactsFound = (std::uint64_t{header[1]} << 32U) | header[0];
    const std::uint64_t listed = std::min<std::uint64_t>(answer.contactsFound, of.room.contacts);
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

constexpr std::uint64_t kMaskBits = 32;

/// Their order.
enum Part : std::size_t { kTriangles, kMask, kBounds, kLabels, kContacts, kPartCount };
static_assert(kPartCount <= kMostOutputParts);

constexpr std::array<OutputPartRow, kPartCount> kParts{{
    {.name = "triangles",
     .output = &Outputs::triangles,
     .bit = OUTPUT_TRIANGLES,
     .first = &shader::OutputPair::firstTriangle,
     .room = [](const OutputRoom& room, std::uint64_t) -> std::uint64_t { return room.triangles; },
     .ofPair = [](const OutputItem& item) -> std::uint64_t { return item.triangles; },
     .unpack = unpackTriangles},
    // Each pair begins with a word of its own.
    {.name = nullptr,
     .output = &Outputs::triangles,
     .bit = OUTPUT_TRIANGLES,
     .first = &shader::OutputPair::firstMask,
     .room = [](const OutputRoom& room, std::uint64_t pairs) -> std::uint64_t {
         return room.triangles == 0 ? 0 : room.triangles / kMaskBits + pairs;
     },
     .ofPair = [](const OutputItem& item) -> std::uint64_t { return (item.triangles + kMaskBits - 1) / kMaskBits; }},
    {.name = "bounds",
     .output = &Outputs::bounds,
     .bit = OUTPUT_BOUNDS,
     .first = &shader::OutputPair::firstBound,
     .room = [](const OutputRoom&, std::uint64_t pairs) -> std::uint64_t { return pairs * OUTPUT_BOUND_WORDS; },
     .ofPair = [](const OutputItem&) -> std::uint64_t { return OUTPUT_BOUND_WORDS; },
     .unpack = unpackBounds},
    {.name = "labels",
     .output = &Outputs::labels,
     .bit = OUTPUT_LABELS,
     .first = &shader::OutputPair::firstLabel,
     .room = [](const OutputRoom& room, std::uint64_t) -> std::uint64_t { return room.labels; },
     .ofPair = [](const OutputItem& item) -> std::uint64_t { return item.labels == nullptr ? 0 : item.labels->size(); },
     .unpack = unpackLabels},
    {.name = "contacts",
     .output = &Outputs::contacts,
     .bit = OUTPUT_CONTACTS,
     .first = &shader::OutputPair::contacts,
     .room = [](const OutputRoom& room, std::uint64_t) -> std::uint64_t {
         return OUTPUT_HEADER_WORDS + std::uint64_t{room.contacts} * OUTPUT_CONTACT_WORDS;
     },
     .ofPair = nullptr,
     .unpack = unpackContacts},
}};

} // namespace

std::span<const OutputPartRow> outputParts() noexcept {
    return kParts;
}

std::uint32_t outputsConstant(const Outputs& outputs) noexcept {
    std::uint32_t bits = 0;
    for (const OutputPartRow& part : kParts) {
        bits |= outputs.*part.output ? part.bit : 0U;
    }
    return bits;
}

void clearOutputs(BatchAnswer& answer) noexcept {
    answer.triangles.clear();
    answer.contacts.clear();
    answer.contactsFound = 0;
    answer.bounds.clear();
    answer.labels.clear();
}

BufferRange Results::triangleCounts() const noexcept {
    return rangeOf(live(impl_).outputs.get(), kTriangles);
}

BufferRange Results::triangleMask() const noexcept {
    return rangeOf(live(impl_).outputs.get(), kMask);
}

BufferRange Results::contacts() const noexcept {
    return rangeOf(live(impl_).outputs.get(), kContacts);
}

BufferRange Results::bounds() const noexcept {
    return rangeOf(live(impl_).outputs.get(), kBounds);
}

BufferRange Results::labelCounts() const noexcept {
    return rangeOf(live(impl_).outputs.get(), kLabels);
}

} // namespace voxtact
