// SPDX-License-Identifier: MIT
#include "io/text/base64.h"

#include <cstdint>

namespace voxtact::io {

namespace {

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Appends the 0 to 3 bytes of a group of four digits; false if the group is damaged.
bool appendGroup(std::string_view group, std::string& bytes) {
    const std::size_t digits = std::min(group.find('='), group.size());
    if (digits < 2 || group.substr(digits).find_first_not_of('=') != std::string_view::npos) {
        return false;
    }
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const int digit = i < digits ? base64Digit(group[i]) : 0;
        if (digit < 0) {
            return false;
        }
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
    }
    for (std::size_t i = 0; i + 1 < digits; ++i) {
        bytes += static_cast<char>(bits >> (16 - 8 * i) & 0xFFU);
    }
    return true;
}

} // namespace

std::optional<std::string> decodedBase64(std::string_view text) {
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    for (; text.size() >= 4; text.remove_prefix(4)) {
        const bool isLast = text.size() == 4;
        if (!appendGroup(text.substr(0, 4), bytes) || (text[3] == '=' && !isLast)) {
            return std::nullopt;
        }
    }
    return text.empty() || appendGroup(text, bytes) ? std::optional(bytes) : std::nullopt;
}

std::optional<std::string> takeBase64(std::string_view& text, std::size_t bytes) {
    std::string decoded;
    if (bytes / 3 > text.size() / 4) {
        return std::nullopt;
    }
    decoded.reserve(bytes + 3);
    std::string group;
    std::size_t at = 0;
    for (; at < text.size() && decoded.size() < bytes; ++at) {
        const char c = text[at];
        if (c == ' ' || (c >= '\t' && c <= '\r')) {
            continue;
        }
        group += c;
        if (group.size() < 4) {
            continue;
        }
        if (!appendGroup(group, decoded) || (c == '=' && decoded.size() < bytes)) {
            return std::nullopt;
        }
        group.clear();
    }
    if (decoded.size() < bytes) {
        return std::nullopt;
    }
    text.remove_prefix(at);
    decoded.resize(bytes);
    return decoded;
}

} // namespace voxtact::io
