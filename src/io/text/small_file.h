// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace voxtact::io {

/// Returns the contents of an ordinary file of at most `most` bytes, else the reason without the file's name (File).
[[nodiscard]] inline Result<std::string> readSmallFile(const std::filesystem::path& path, std::uintmax_t most) {
    const auto refuse = [](std::string why) { return Error{ErrorCode::File, 0, std::move(why)}; };
    std::error_code failed;
    // A pipe would wait for who writes it.
    if (!std::filesystem::is_regular_file(path, failed)) {
        return refuse(failed ? failed.message() : "it is not a file");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed || size > most) {
        return refuse(failed ? failed.message() : "it is longer than " + std::to_string(most >> 20U) + " MiB");
    }
    std::string content(static_cast<std::size_t>(size), '\0');
    errno = 0;
    if (!std::ifstream(path, std::ios::binary).read(content.data(), static_cast<std::streamsize>(content.size()))) {
        return refuse(errno != 0 ? std::generic_category().message(errno) : "reading stopped before its end");
    }
    return content;
}

} // namespace voxtact::io
