// SPDX-License-Identifier: MIT
#include "io/text/text_lines.h"

#include "core/base/escaped.h"
#include "core/base/try.h"
#include "io/errors.h"

#include <charconv>
#include <cmath>

namespace voxtact::io {

namespace {

constexpr std::string_view kBlanks = " \t\v\f\r\n";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

} // namespace

std::string inQuotes(std::string_view token) {
    constexpr std::size_t kLongest = 40;
    return "'" + escaped(token.substr(0, kLongest)) + (token.size() > kLongest ? "...'" : "'");
}

Result<LineReader> LineReader::open(const std::filesystem::path& path) {
    VOXTACT_TRY(readableFile(path));
    LineReader reader;
    reader.file_ = std::make_unique<std::ifstream>(path, std::ios::binary);
    reader.stream_ = reader.file_.get();
    return reader;
}

LineReader LineReader::over(std::istream& stream) {
    LineReader reader;
    reader.stream_ = &stream;
    return reader;
}

std::optional<std::string_view> LineReader::next() {
    if (!std::getline(*stream_, line_)) {
        return std::nullopt;
    }
    ++number_;
    std::string_view line = line_;
    if (number_ == 1 && line.starts_with(kByteOrderMark)) {
        line.remove_prefix(kByteOrderMark.size());
    }
    return trimmed(line.substr(0, line.find('#')));
}

void splitTokens(std::string_view line, std::vector<std::string_view>& tokens) {
    tokens.clear();
    for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;
         begin = line.find_first_not_of(kBlanks, begin)) {
        const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
        tokens.push_back(line.substr(begin, end - begin));
        begin = end;
    }
}

std::optional<std::string> parseNumber(std::string_view token, double& value) {
    // from_chars takes no leading plus; after one it would take a minus.
    const bool plus = token.starts_with('+');
    const std::string_view digits = token.substr(plus ? 1 : 0);
    const std::from_chars_result end = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end.ptr != digits.data() + digits.size() || digits.empty() || (plus && digits.starts_with('-'))) {
        return inQuotes(token) + " is not a number";
    }
    if (end.ec == std::errc::result_out_of_range) {
        return inQuotes(token) + " is outside what a double holds";
    }
    if (end.ec != std::errc{}) {
        return inQuotes(token) + " is not a number";
    }
    if (!std::isfinite(value)) {
        return inQuotes(token) + " is not a finite number";
    }
    return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) {
        return {};
    }
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

} // namespace voxtact::io
