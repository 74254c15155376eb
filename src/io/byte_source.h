// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <string_view>

namespace voxtact::io {

/// The number at `offset`, which must lie inside `bytes`.
template <class Number>
[[nodiscard]] Number numberAt(std::string_view bytes, std::size_t offset, bool swapped = false) {
    char raw[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof raw; ++i) {
        raw[i] = bytes[offset + (swapped ? sizeof raw - 1 - i : i)];
    }
    Number value;
    std::memcpy(&value, raw, sizeof raw);
    return value;
}

} // namespace voxtact::io
