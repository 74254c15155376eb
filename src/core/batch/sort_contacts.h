// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/results.h"

#include <algorithm>
#include <array>
#include <compare>
#include <vector>

namespace voxtact {

/// A total order that includes NaN: with infinite voxels, values, depths and normals may be NaN of either sign.
inline bool contactBefore(const Contact& a, const Contact& b) {
    if (a.pair != b.pair || a.triangle != b.triangle) {
        return a.pair != b.pair ? a.pair < b.pair : a.triangle < b.triangle;
    }
    const auto numbers = [](const Contact& of) {
        return std::array{of.position[0], of.position[1], of.position[2], of.value,  of.depth,
                          of.normal[0],   of.normal[1],   of.normal[2],   of.opacity};
    };
    const auto one = numbers(a);
    const auto other = numbers(b);
    const std::strong_ordering order = std::lexicographical_compare_three_way(
        one.begin(), one.end(), other.begin(), other.end(), [](double x, double y) { return std::strong_order(x, y); });
    return order != std::strong_ordering::equal ? order == std::strong_ordering::less : a.label < b.label;
}

/// The order of BatchAnswer::contacts, independent of the order of discovery: cells that share a position may each have
/// a contact there, with values that differ in the last bits.
inline void sortContacts(std::vector<Contact>& contacts) {
    std::sort(contacts.begin(), contacts.end(), contactBefore);
}

} // namespace voxtact
