// SPDX-License-Identifier: MIT
#include "io/text/text_lines.h"

#include "core/base/escaped.h"
#include "core/base/try.h"
#include "io/errors.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <ios>
#include <system_error>
#include <utility>

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
    const Result<std::uint64_t> size = readableFile(path);
    VOXTACT_TRY(size);
    auto file = std::make_unique<std::filebuf>();
    errno = 0;
    if (file->open(path, std::ios::in | std::ios::binary) == nullptr) {
        return cannotOpen(path, errno);
    }
    LineReader reader(*file, path);
    reader.left_ = *size;
    reader.file_ = std::move(file);
    return reader;
}

LineReader LineReader::over(std::istream& stream, std::filesystem::path name) {
    return {*stream.rdbuf(), std::move(name)};
}

LineReader::LineReader(std::streambuf& buffer, std::filesystem::path name) : buffer_(&buffer), name_(std::move(name)) {}

std::streambuf::int_type LineReader::get() {
    const auto c = buffer_->sbumpc();
    if (std::streambuf::traits_type::eq_int_type(c, std::streambuf::traits_type::eof())) {
        // Not every standard library throws on read errors.
        if (left_ > 0) {
            throw std::ios_base::failure("", std::make_error_code(std::errc::io_error));
        }
        return c;
    }
    left_ -= left_ > 0 ? 1 : 0;
    return c;
}

// std::getline() treats any failure, even a lack of memory, as the end of the stream.
bool LineReader::read() {
    using Traits = std::streambuf::traits_type;
    line_.clear();
    auto c = get();
    if (Traits::eq_int_type(c, Traits::eof())) {
        return false;
    }
    for (; !Traits::eq_int_type(c, Traits::eof()) && Traits::to_char_type(c) != '\n'; c = get()) {
        line_.push_back(Traits::to_char_type(c));
    }
    return true;
}

Result<std::optional<std::string_view>> LineReader::next() {
    if (std::exchange(stopped_, true)) {
        return readingStopped(name_);
    }
    try {
        const bool some = read();
        stopped_ = false;
        if (!some) {
            return std::optional<std::string_view>();
        }
    } catch (const std::ios_base::failure& failure) {
        return cannotRead(name_, failure.code().message(), ErrorCode::File);
    }
    ++number_;
    std::string_view line = line_;
    if (number_ == 1 && line.starts_with(kByteOrderMark)) {
        line.remove_prefix(kByteOrderMark.size());
    }
    return std::optional(trimmed(line.substr(0, line.find('#'))));
}

Result<void> forWords(const std::filesystem::path& path, const TakeWords& take) {
    Result<LineReader> lines = LineReader::open(path);
    VOXTACT_TRY(lines);
    std::vector<std::string_view> words;
    while (true) {
        const Result<std::optional<std::string_view>> line = lines->next();
        VOXTACT_TRY(line);
        if (!line->has_value()) {
            return {};
        }
        splitTokens(**line, words);
        if (!words.empty()) {
            VOXTACT_TRY(take(words, lines->lineNumber()));
        }
    }
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

Error formatByName(const std::filesystem::path& path, Error error, std::string_view use) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kFormats{
        {{".xml", "XML"}, {".xmlcolormap", "ParaView's colour map"}, {".h5", "HDF5"}}};
    const std::string name = lowered(path.filename().string());
    for (const auto& [ending, format] : kFormats) {
        if (name.ends_with(ending) && error.code == ErrorCode::Format) {
            return cannotRead(path, "it is " + std::string(format) + " (" + std::string(ending) +
                                        "), which is not supported; " + std::string(use));
        }
    }
    return error;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) {
        return {};
    }
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

} // namespace voxtact::io
