// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/outputs.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace voxtact {

/// The order of BatchAnswer::contacts, which does not depend on who found which first.
inline void sortContacts(std::vector<Contact>& contacts) {
    std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
        return std::tie(a.pair, a.triangle, a.position) < std::tie(b.pair, b.triangle, b.position);
    });
}

} // namespace voxtact
