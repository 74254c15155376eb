// SPDX-License-Identifier: MIT
#include "core/base/escaped.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact {

namespace {

/// Returns the bytes of the UTF-8 character that begins here; 0 if none does. Overlong forms, surrogates, U+FFFE and
/// U+FFFF (invalid in XML) are no characters.
std::size_t characterAt(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    struct Form {
        std::uint8_t firstLeast, firstMost;
        std::uint8_t secondLeast, secondMost;
        std::size_t length;
    };
    constexpr std::array<Form, 9> kForms{{{0x20, 0x7E, 0, 0, 1},
                                          {0xC2, 0xDF, 0x80, 0xBF, 2},
                                          {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                          {0xE1, 0xEC, 0x80, 0xBF, 3},
                                          {0xED, 0xED, 0x80, 0x9F, 3},
                                          {0xEE, 0xEF, 0x80, 0xBF, 3},
                                          {0xF0, 0xF0, 0x90, 0xBF, 4},
                                          {0xF1, 0xF3, 0x80, 0xBF, 4},
                                          {0xF4, 0xF4, 0x80, 0x8F, 4}}};
    for (const Form& form : kForms) {
        if (byte(0) < form.firstLeast || byte(0) > form.firstMost || text.size() < form.length) {
            continue;
        }
        bool good = form.length == 1 || (byte(1) >= form.secondLeast && byte(1) <= form.secondMost);
        // U+0080 to U+009F are control characters, too.
        good = good && !(byte(0) == 0xC2 && byte(1) < 0xA0);
        good = good && !(byte(0) == 0xEF && byte(1) == 0xBF && byte(2) >= 0xBE);
        for (std::size_t i = 2; i < form.length; ++i) {
            good = good && byte(i) >= 0x80 && byte(i) <= 0xBF;
        }
        return good ? form.length : 0;
    }
    return 0;
}

} // namespace

std::string escaped(std::string_view text) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string out;
    while (!text.empty()) {
        const std::size_t length = characterAt(text);
        if (length > 0) {
            out += text.substr(0, length);
        } else {
            const auto byte = static_cast<std::uint8_t>(text.front());
            out += "\\x";
            out += kDigits[byte >> 4U];
            out += kDigits[byte & 15U];
        }
        text.remove_prefix(length > 0 ? length : 1);
    }
    return out;
}

std::string inHtml(std::string_view text) {
    constexpr std::string_view kReplacement = "\uFFFD";
    std::string out;
    while (!text.empty()) {
        const char first = text.front();
        const bool isSpace = first == '\n' || first == '\t';
        const std::size_t length = isSpace ? 1 : characterAt(text);
        out += first == '&'   ? "&amp;"
               : first == '<' ? "&lt;"
               : first == '>' ? "&gt;"
               : first == '"' ? "&quot;"
               : length > 0   ? text.substr(0, length)
                              : kReplacement;
        text.remove_prefix(length > 0 ? length : 1);
    }
    return out;
}

} // namespace voxtact
