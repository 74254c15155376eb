// SPDX-License-Identifier: MIT
#include "ledger.h"

#include <algorithm>

namespace voxtact::test {

bool Ledger::ends(const char* kind, std::uint64_t bits) {
    if (bits == 0) {
        return false; // Vulkan allows it, and nothing happens
    }
    if (alive_.erase({kind, bits}) == 1) {
        return true;
    }
    complain(std::string("a ") + kind + " is destroyed that was never made, or not any more: " + std::to_string(bits));
    return false;
}

std::vector<std::string> Ledger::alive() const {
    std::vector<std::pair<std::uint64_t, std::string>> byAge;
    for (const auto& [handle, when] : alive_) {
        byAge.emplace_back(when, handle.first + " " + std::to_string(handle.second) + " was never destroyed");
    }
    std::ranges::sort(byAge);
    std::vector<std::string> out;
    for (auto& [when, text] : byAge) {
        out.push_back(std::move(text));
    }
    return out;
}

} // namespace voxtact::test
