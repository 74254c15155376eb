// SPDX-License-Identifier: MIT
#include "io/mesh/mesh_text.h"

#include "io/errors.h"
#include "io/text/text_lines.h"

#include <charconv>

namespace voxtact::io {

bool TextLines::next(std::string_view& line) {
    if (rest_.empty()) {
        return false;
    }
    // The line feed first: looking for either character at once is several times slower.
    std::size_t end = std::min(rest_.find('\n'), rest_.size());
    end = std::min(rest_.substr(0, end).find('\r'), end);
    line = rest_.substr(0, end);
    const bool both = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (both ? 2 : 1), rest_.size()));
    ++number_;
    return true;
}

Result<std::string_view> meshText(const std::filesystem::path& path, std::string_view content) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (content.starts_with("\xFE\xFF") || content.starts_with("\xFF\xFE")) {
        return cannotRead(path, "its text is UTF-16; save it as UTF-8");
    }
    if (content.find('\0') != std::string_view::npos) {
        return cannotRead(path, "it is not text, or it is damaged (it holds a zero byte)");
    }
    return content.substr(content.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
}

std::optional<std::uint64_t> parseNatural(std::string_view token) {
    std::uint64_t value = 0;
    const std::from_chars_result end = std::from_chars(token.data(), token.data() + token.size(), value);
    return end.ec == std::errc{} && end.ptr == token.data() + token.size() ? std::optional(value) : std::nullopt;
}

} // namespace voxtact::io
