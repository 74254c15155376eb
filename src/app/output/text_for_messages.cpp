// SPDX-License-Identifier: MIT
#include "app/output/text_for_messages.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

namespace voxtact::app {

namespace {

/// Bytes of the UTF-8 character that begins here; 0: none does. Neither overlong forms nor surrogates are characters.
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
        for (std::size_t i = 2; i < form.length; ++i) {
            good = good && byte(i) >= 0x80 && byte(i) <= 0xBF;
        }
        return good ? form.length : 0;
    }
    return 0;
}

/// Where the longest whole character sequence of at most `most` bytes ends; `text` is valid.
std::size_t cutBefore(std::string_view text, std::size_t most) {
    std::size_t end = most;
    while (end > 0 && (static_cast<std::uint8_t>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    return end;
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

std::string shortened(std::string_view text) {
    constexpr std::size_t kMost = 120;
    constexpr std::size_t kBegin = 70;
    constexpr std::size_t kEnd = 40;
    // What is cut away need not be escaped: an argument may have a megabyte.
    if (text.size() > 8 * kMost) {
        const std::string begin = escaped(text.substr(0, kMost));
        const std::string end = escaped(text.substr(text.size() - kMost));
        return begin.substr(0, cutBefore(begin, kBegin)) + "..." + end.substr(cutBefore(end, end.size() - kEnd));
    }
    const std::string whole = escaped(text);
    return whole.size() <= kMost ? whole
                                 : whole.substr(0, cutBefore(whole, kBegin)) + "..." +
                                       whole.substr(cutBefore(whole, whole.size() - kEnd));
}

std::string forMessage(std::string_view text) {
    return "'" + shortened(text) + "'";
}

std::string messageLine(std::string_view text) {
    constexpr std::size_t kLongWord = 400;
    constexpr std::size_t kMost = 4000;
    std::string out;
    while (!text.empty() && out.size() < kMost) {
        const std::size_t end = std::min(text.find(' '), text.size());
        out += end > kLongWord ? shortened(text.substr(0, end)) : escaped(text.substr(0, end));
        const std::size_t next = end == text.size() ? end : end + 1;
        out += std::string(next - end, ' ');
        text.remove_prefix(next);
    }
    return text.empty() ? out : out + "...";
}

namespace {

/// Letters left out, added, changed, or swapped with the next one (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before;
    std::vector<std::size_t> last;
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = std::exchange(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

} // namespace

std::string nearestName(std::string_view word, const std::vector<std::string>& names) {
    constexpr std::size_t kLongest = 64; // no name of ours is nearly so long
    constexpr std::size_t kShare = 3;
    std::string nearest;
    std::size_t least = word.size() / kShare + 1;
    for (const std::string& name : names) {
        if (word.size() > kLongest) {
            break;
        }
        // "--label" for "--labels": what is only cut off is nearer than what differs.
        const std::size_t far = name.starts_with(word) && word.size() > 3 ? 1 : distance(word, name);
        if (far < least) {
            least = far;
            nearest = name;
        }
    }
    return nearest;
}

} // namespace voxtact::app
