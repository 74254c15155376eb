// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace voxtact::test {

struct PngPicture {
    int width = 0; ///< 0: it could not be read
    int height = 0;
    std::vector<std::uint8_t> rgba;
};
PngPicture readPng(const std::filesystem::path& path);

} // namespace voxtact::test
