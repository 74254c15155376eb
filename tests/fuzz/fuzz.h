// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

/// libFuzzer's entry point; returns 0. Each target has one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace voxtact::fuzz {

/// A promise that `holds` must keep for every input: ends the process with `promise` when it does not.
inline void require(bool holds, const char* promise) {
    if (!holds) {
        std::fprintf(stderr, "broken promise: %s\n", promise);
        std::abort();
    }
}

/// An error of ours is one line of a bounded length.
inline void requireOneLine(std::string_view text) {
    require(!text.empty(), "an error says something");
    require(text.find('\n') == std::string_view::npos, "an error is one line");
    require(text.size() <= 4096, "an error is at most 4096 bytes long");
}

} // namespace voxtact::fuzz
