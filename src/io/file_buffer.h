// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <streambuf>
#include <vector>

namespace voxtact::io {

/// Bytes on their way into a file. It remembers the first reason why some did not get there, which a std::filebuf
/// forgets.
class FileBuffer : public std::streambuf {
  public:
    FileBuffer();
    FileBuffer(const FileBuffer&) = delete;
    FileBuffer& operator=(const FileBuffer&) = delete;
    ~FileBuffer() override;

    /// A new file, which must not be there yet.
    bool create(const std::filesystem::path& path);
    /// A device or a pipe that is there.
    bool openSpecial(const std::filesystem::path& path);
    /// Writes the rest, and closes. Returns false if any operation since the opening failed.
    bool close();
    /// Returns the errno of the first failure; 0: none.
    [[nodiscard]] int reason() const noexcept { return reason_; }

  protected:
    int_type overflow(int_type byte) override;
    std::streamsize xsputn(const char* bytes, std::streamsize count) override;
    int sync() override;

  private:
    bool open(const std::filesystem::path& path, int flags);
    bool writeOut(const char* bytes, std::size_t count);
    bool flushBuffer();

    std::vector<char> buffer_;
    int file_ = -1;
    int reason_ = 0;
};

} // namespace voxtact::io
