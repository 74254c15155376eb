// SPDX-License-Identifier: MIT
#include "cli/output/text_for_messages.h"

#include "core/base/escaped.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <utility>

namespace voxtact::app {

namespace {

/// Returns the end of the longest valid prefix of at most `max` bytes; `text` is valid.
std::size_t cutBefore(std::string_view text, std::size_t max) {
    std::size_t end = max;
    while (end > 0 && (static_cast<std::uint8_t>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    return end;
}

} // namespace

std::string shortened(std::string_view text) {
    constexpr std::size_t kMost = 120;
    constexpr std::size_t kBegin = 70;
    constexpr std::size_t kEnd = 40;
    // Shortens before escaping: an argument may have a megabyte.
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

std::string fileNameOf(const std::string& source) {
    if (source.starts_with("builtin:")) {
        return source;
    }
    const std::filesystem::path path(source);
    const std::filesystem::path name = (path.has_filename() ? path : path.parent_path()).filename();
    return name.empty() ? source : name.string();
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

/// Returns the number of omitted, added, changed or swapped letters (optimal string alignment).
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
    constexpr std::size_t kLongest = 64; // all our names are much shorter
    constexpr std::size_t kShare = 3;
    std::string nearest;
    std::size_t minDistance = word.size() / kShare + 1;
    for (const std::string& name : names) {
        if (word.size() > kLongest) {
            break;
        }
        // "--label" for "--labels", "--threshold" for "--opacity-threshold": prefers a substring to a misspelling.
        const bool isPart = name.starts_with(word) || (word.starts_with("--") && name.ends_with(word.substr(1)));
        const std::size_t far = isPart && word.size() > 3 ? 1 : distance(word, name);
        if (far < minDistance || (far == minDistance && !nearest.empty() && name.size() < nearest.size())) {
            minDistance = far;
            nearest = name;
        }
    }
    return nearest;
}

} // namespace voxtact::app
