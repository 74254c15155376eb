// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>

namespace voxtact {

/// The shortest text that reads back as the same number; the same in every locale.
inline std::string number(double value) {
    char text[32];
    const std::to_chars_result end = std::to_chars(text, text + sizeof text, value);
    return {text, end.ptr};
}

} // namespace voxtact
