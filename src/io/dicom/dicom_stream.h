// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

struct z_stream_s;

namespace voxtact::io {

/// The bytes of a DICOM file, forward only: a window of them is in memory, the rest is skipped unread, and from a place
/// on they may be deflated.
class DicomStream {
  public:
    [[nodiscard]] static Result<DicomStream> open(const std::filesystem::path& path);

    DicomStream(DicomStream&&) noexcept;
    DicomStream& operator=(DicomStream&&) noexcept;
    ~DicomStream();

    /// The next `count` bytes, or fewer where the file ends before; valid until the next call of anything.
    [[nodiscard]] std::string_view peek(std::size_t count);
    /// Returns false if fewer are left.
    [[nodiscard]] bool read(void* to, std::size_t count);
    [[nodiscard]] bool skip(std::uint64_t count);

    /// Returns true if reading failed before the file's end.
    [[nodiscard]] bool failed() const noexcept { return failed_; }

    /// Bytes taken so far, counted after inflation.
    [[nodiscard]] std::uint64_t position() const noexcept { return position_; }
    /// Returns the maximum number of following bytes: exact for a plain file, a bound for a deflated one.
    [[nodiscard]] std::uint64_t mostLeft() const noexcept;

    /// Begins a raw deflate stream; inflates at most `most` bytes.
    [[nodiscard]] Result<void> inflateFromHere(std::uint64_t most);
    /// Allows inflation of this many bytes more.
    void allow(std::uint64_t bytes) noexcept;
    /// False where the deflate stream did not come to its end, or more than a byte of padding follows it. Once there
    /// are no bytes left.
    [[nodiscard]] bool isWhole() const noexcept;

  private:
    DicomStream(std::ifstream file, std::uint64_t size);
    /// Takes bytes of the file.
    std::size_t take(char* to, std::size_t count);
    /// Appends to the window; false at the end of the file, or where its compressed data is damaged.
    bool fill();
    bool fillInflated();
    void drop(std::size_t count);

    struct InflateEnd {
        void operator()(z_stream_s* stream) const noexcept;
    };

    std::ifstream file_;
    std::uint64_t fileLeft_;
    std::uint64_t position_ = 0;
    std::string window_;
    std::size_t windowAt_ = 0;
    std::string compressed_;
    std::unique_ptr<z_stream_s, InflateEnd> inflate_;
    std::uint64_t maxInflated_ = 0; ///< the position that inflation does not go beyond
    bool ended_ = false;
    bool isInflated_ = false; ///< the deflate stream came to its end
    bool failed_ = false;
};

} // namespace voxtact::io
