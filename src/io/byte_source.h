// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/result.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace voxtact::io {

using ByteVisitor = std::function<void(std::string_view)>;

/// The length of a file after decompression when it is gzip, and its length when it is not. Decompresses everything,
/// so that a cut-off or damaged gzip file (its checksum is at the end) is refused. `visit` is given all of it in turn.
[[nodiscard]] Result<std::uint64_t> contentLength(const std::filesystem::path& path, const ByteVisitor& visit = {});

/// The first `length` bytes, or fewer where the file is shorter; decompressed when it is gzip.
[[nodiscard]] Result<std::string> contentHead(const std::filesystem::path& path, std::size_t length);

enum class Compression { Gzip, Zlib };
/// The length that the compressed stream at `offset` of the file decompresses to; refuses one that is cut off or
/// damaged.
[[nodiscard]] Result<std::uint64_t> inflatedLength(const std::filesystem::path& path, std::uint64_t offset,
                                                   Compression compression);

/// The number at `offset`, which must lie inside `bytes`.
template <class Number>
[[nodiscard]] Number numberAt(std::string_view bytes, std::size_t offset, bool swapped = false) {
    char raw[sizeof(Number)];
    for (std::size_t i = 0; i < sizeof raw; ++i) {
        raw[i] = bytes[offset + (swapped ? sizeof raw - 1 - i : i)];
    }
    Number value;
    std::memcpy(&value, raw, sizeof raw);
    return value;
}

} // namespace voxtact::io
