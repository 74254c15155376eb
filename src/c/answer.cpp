// SPDX-License-Identifier: MIT
#include "c/answer.h"

#include "c/convert.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace voxtact::c {
namespace {

vxt_pair toPair(const PairAnswer& pair) noexcept {
    vxt_pair out{};
    out.count = pair.count;
    out.pair = pair.pair;
    out.item = pair.item;
    out.pose = pair.pose;
    out.hit = pair.hit ? 1 : 0;
    out.possible = pair.possible ? 1 : 0;
    out.exactness = number<vxt_exactness>(pair.exactness);
    out.method = number<vxt_method>(pair.method);
    out.projection = number<vxt_projection>(pair.projection);
    return out;
}

vxt_touched_triangle toTriangle(const TouchedTriangle& triangle) noexcept {
    return {triangle.pair, triangle.triangle, triangle.count};
}

vxt_contact toContact(const Contact& contact) noexcept {
    vxt_contact out{};
    std::ranges::copy(contact.position, out.position);
    std::ranges::copy(contact.normal, out.normal);
    out.depth = contact.depth;
    out.value = contact.value;
    out.opacity = contact.opacity;
    out.pair = contact.pair;
    out.triangle = contact.triangle;
    out.label = contact.label;
    return out;
}

/// Nothing is the box that overlaps nothing.
vxt_box toBounds(const std::optional<Box>& bounds) noexcept {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return bounds ? fromBox(*bounds) : vxt_box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
}

vxt_label_count toLabelCount(const LabelCount& label) noexcept {
    return {label.count, label.pair, label.label};
}

template <class From, class To>
void convert(const std::vector<From>& from, std::vector<To>& to, To (*each)(const From&)) {
    to.reserve(from.size());
    std::ranges::transform(from, std::back_inserter(to), each);
}

} // namespace

vxt_answer toAnswer(const BatchAnswer& answer) {
    vxt_answer out;
    convert<PairAnswer, vxt_pair>(answer.pairs, out.pairs, toPair);
    convert<TouchedTriangle, vxt_touched_triangle>(answer.triangles, out.triangles, toTriangle);
    convert<Contact, vxt_contact>(answer.contacts, out.contacts, toContact);
    convert<std::optional<Box>, vxt_box>(answer.bounds, out.bounds, toBounds);
    convert<LabelCount, vxt_label_count>(answer.labels, out.labels, toLabelCount);
    out.contactsFound = answer.contactsFound;
    out.counters = answer.counters;
    if (answer.clearances.size() == answer.pairs.size()) { // of none there may be none
        out.clearances = answer.clearances;
    }
    out.labelClearances = answer.labelClearances;
    out.motions = answer.motions;
    out.gpuMilliseconds = answer.gpuMilliseconds;
    out.wallMilliseconds = answer.wallMilliseconds;
    return out;
}

} // namespace voxtact::c

using namespace voxtact;
using namespace voxtact::c;

static_assert(sizeof(vxt_device_pair) == sizeof(PairResult) && sizeof(vxt_device_contact) == sizeof(ContactResult));

vxt_result vxt_unpack(const vxt_device_pair* packed, vxt_pair* pair) {
    return call([&] {
        const vxt_device_pair& from = need(packed, "packed");
        need(pair, "pair") =
            toPair(unpack({from.count_low, from.count_high, from.pair, from.item, from.pose, from.how}));
    });
}

vxt_result vxt_answer_create(vxt_answer** answer) {
    return create(answer, [] { return vxt_answer(); });
}

vxt_result vxt_answer_get(const vxt_answer* answer, vxt_answer_view* view) {
    return call([&] {
        const vxt_answer& from = need(answer, "answer");
        vxt_answer_view out = vxt_answer_view_init();
        out.pairs = handOut<vxt_pair>(from.pairs, &out.pair_count);
        out.triangles = handOut<vxt_touched_triangle>(from.triangles, &out.triangle_count);
        out.contacts = handOut<vxt_contact>(from.contacts, &out.contact_count);
        out.bounds = handOut<vxt_box>(from.bounds, &out.bounds_count);
        out.labels = handOut<vxt_label_count>(from.labels, &out.label_count);
        out.contacts_found = from.contactsFound;
        out.gpu_milliseconds = from.gpuMilliseconds;
        out.wall_milliseconds = from.wallMilliseconds;
        writeStruct(view, out, "view");
    });
}

void vxt_answer_destroy(vxt_answer* answer) {
    delete answer;
}
