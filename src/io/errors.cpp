// SPDX-License-Identifier: MIT
#include "io/errors.h"

#include "core/base/escaped.h"
#include "core/base/try.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace voxtact::io {

namespace {

/// Returns the kind of a path that is no file; null for a file or if unknown.
const char* kindOfNoFile(std::filesystem::file_type type) {
    switch (type) {
    case std::filesystem::file_type::directory:
        return "it is a folder, not a file";
    case std::filesystem::file_type::fifo:
        return "it is a pipe, not a file; write what it gives to a file first";
    case std::filesystem::file_type::socket:
        return "it is a socket, not a file";
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block:
        return "it is a device, not a file";
    default:
        return nullptr;
    }
}

} // namespace

Error cannotRead(const std::filesystem::path& path, std::string_view reason, ErrorCode code) {
    return Error{code, 0, "cannot read '" + path.string() + "': " + std::string(reason)};
}

Error cannotOpen(const std::filesystem::path& path, int reason) {
    return cannotRead(path, reason != 0 ? std::generic_category().message(reason) : "it cannot be opened",
                      ErrorCode::File);
}

Error readingStopped(const std::filesystem::path& path) {
    return cannotRead(path, "reading stopped before its end", ErrorCode::File);
}

Error cannotWrite(const std::filesystem::path& path, std::string_view reason, ErrorCode code) {
    return Error{code, 0, "cannot write '" + path.string() + "': " + std::string(reason)};
}

Error badLine(const std::filesystem::path& path, std::uint64_t line, std::string_view reason) {
    return Error{ErrorCode::Format, 0, path.string() + " line " + std::to_string(line) + ": " + std::string(reason)};
}

std::string printable(std::string_view text) {
    constexpr std::size_t kLongest = 64;
    return escaped(text.substr(0, kLongest)) + (text.size() > kLongest ? "..." : "");
}

std::string oneLine(std::string_view text) {
    std::string line;
    for (const char c : text) {
        const bool blank = c == ' ' || (c >= '\t' && c <= '\r');
        if (!blank) {
            line += c;
        } else if (!line.empty() && line.back() != ' ') {
            line += ' ';
        }
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == '.')) {
        line.pop_back();
    }
    return line;
}

std::string jsonReason(std::string_view text) {
    constexpr std::size_t kLongest = 240;
    constexpr std::size_t kEnd = 80; // where it went wrong, and what was expected there
    // "[json.exception.parse_error.101] parse error at line 2, column 5: ..."
    const std::size_t name = text.find("] ");
    std::string reason = escaped(oneLine(name == std::string_view::npos ? text : text.substr(name + 2)));
    if (reason.size() <= kLongest) {
        return reason;
    }
    return reason.substr(0, kLongest - kEnd) + " ... " + reason.substr(reason.size() - kEnd);
}

Result<std::uint64_t> readableFile(const std::filesystem::path& path) {
    std::error_code problem;
    const std::filesystem::file_status status = std::filesystem::status(path, problem);
    if (status.type() == std::filesystem::file_type::none) {
        return cannotRead(path, problem.message(), ErrorCode::File);
    }
    if (status.type() == std::filesystem::file_type::not_found) {
        return cannotRead(path, "there is no such file", ErrorCode::File);
    }
    // Opening a pipe waits for a writer, and a device may give bytes for ever.
    if (const char* const kind = kindOfNoFile(status.type())) {
        return cannotRead(path, kind, ErrorCode::File);
    }
    errno = 0;
    const std::ifstream file(path, std::ios::binary);
    if (!file) {
        return cannotOpen(path, errno);
    }
    const std::uint64_t size = std::filesystem::file_size(path, problem);
    return problem ? cannotRead(path, problem.message(), ErrorCode::File) : Result<std::uint64_t>(size);
}

Result<std::string> readWholeFile(const std::filesystem::path& path) {
    const Result<std::uint64_t> size = readableFile(path);
    VOXTACT_TRY(size);
    std::string content(*size, '\0');
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return cannotOpen(path, errno);
    }
    if (!file.read(content.data(), static_cast<std::streamsize>(content.size()))) {
        return readingStopped(path);
    }
    return content;
}

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

std::string lowerEnding(const std::filesystem::path& path) {
    const std::string last = lowered(path.extension().string());
    return last == ".gz" ? lowered(path.stem().extension().string()) + last : last;
}

} // namespace voxtact::io
