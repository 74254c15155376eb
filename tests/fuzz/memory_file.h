// SPDX-License-Identifier: MIT
#pragma once

#include "fuzz.h"

#include <filesystem>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace voxtact::fuzz {

/// The path of a file in memory that holds the input, until the next call.
inline std::filesystem::path fileOf(const std::uint8_t* data, std::size_t size) {
    static const int file = ::memfd_create("input", 0);
    require(file >= 0 && ::ftruncate(file, 0) == 0 && ::pwrite(file, data, size, 0) == static_cast<ssize_t>(size),
            "there is a file in memory (Linux)");
    return "/proc/self/fd/" + std::to_string(file);
}

} // namespace voxtact::fuzz
