// SPDX-License-Identifier: MIT
#pragma once

#include "fuzz.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace voxtact::fuzz {

/// A folder for files whose names matter: one a process, removed at its end.
inline const std::filesystem::path& folder() {
    namespace fs = std::filesystem;
    static const fs::path path = [] {
        std::string name = (fs::temp_directory_path() / "voxtact-fuzz-XXXXXX").string();
        require(::mkdtemp(name.data()) != nullptr, "there is room for a folder");
        return fs::path(name);
    }();
    static const struct Removal {
        const fs::path& path;
        ~Removal() {
            std::error_code ignored;
            fs::remove_all(path, ignored);
        }
    } removal{path};
    return path;
}

inline void write(const std::filesystem::path& path, std::string_view content) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

} // namespace voxtact::fuzz
