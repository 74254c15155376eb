// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"
#include "voxtact/io.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// The bytes of a file or of memory, in order, each read once; decompresses compressed data.
class ByteReader {
  public:
    [[nodiscard]] static Result<ByteReader> ofFile(const std::filesystem::path& path, ReadProgress progress = {});
    /// `bytes` must outlive the reader; `name` stands in messages.
    [[nodiscard]] static ByteReader ofMemory(std::filesystem::path name, std::span<const std::byte> bytes);

    ByteReader(ByteReader&&) noexcept;
    ByteReader& operator=(ByteReader&&) noexcept;
    ~ByteReader();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    enum class Packing {
        GzipOrPlain, ///< gzip where it begins as gzip does
        Gzip,
        ZlibOrGzip
    };
    /// Declares the following bytes as packed. Once per reader.
    [[nodiscard]] Result<void> unpack(Packing packing);

    /// Returns the remaining bytes of the file, packed or not.
    [[nodiscard]] std::uint64_t stored() const noexcept;
    /// Fewer than `length` only where the bytes end. Refuses packed bytes that are cut off or damaged.
    [[nodiscard]] Result<std::size_t> read(std::byte* to, std::size_t length);
    [[nodiscard]] Result<std::string> head(std::size_t length);
    /// Returns the number of skipped bytes: fewer only at the end.
    [[nodiscard]] Result<std::uint64_t> skip(std::uint64_t length);
    /// Returns a line without its line feed, at most `longest` bytes; empty at the end. Only for unpacked data.
    [[nodiscard]] Result<std::optional<std::string>> line(std::size_t longest);
    /// Returns true if the last line ended in a line feed.
    [[nodiscard]] bool lineEnded() const noexcept { return lineEnded_; }
    /// Reads `needed` bytes of voxels; refuses a shorter file. Memory grows with the data, so a false header costs at
    /// most twice the file's bytes, unpacked (deflate packs at most 1032 bytes into one).
    [[nodiscard]] Result<std::vector<std::byte>> take(std::uint64_t needed);
    /// Goes to the end, where the checksum of packed bytes is. Returns how many bytes were left.
    [[nodiscard]] Result<std::uint64_t> finish();

  private:
    struct Stored;
    struct Inflater;

    ByteReader(std::filesystem::path path, std::unique_ptr<Stored> stored);
    [[nodiscard]] Result<std::size_t> inflate(std::byte* to, std::size_t length);

    std::filesystem::path path_;
    std::unique_ptr<Stored> stored_;
    std::unique_ptr<Inflater> inflater_; ///< none while bytes are plain
    bool lineEnded_ = false;
};

} // namespace voxtact::io
