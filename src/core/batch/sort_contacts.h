// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/results.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace voxtact {

/// The order of BatchAnswer::contacts, which does not depend on who found which first: cells that share a place may
/// each have a contact there, and those differ in the last bits of their values.
inline void sortContacts(std::vector<Contact>& contacts) {
    std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
        return std::tie(a.pair, a.triangle, a.position, a.value, a.depth, a.normal, a.label) <
               std::tie(b.pair, b.triangle, b.position, b.value, b.depth, b.normal, b.label);
    });
}

} // namespace voxtact
