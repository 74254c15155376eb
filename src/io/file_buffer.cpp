// SPDX-License-Identifier: MIT
#include "io/file_buffer.h"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace voxtact::io {

namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16U;
constexpr mode_t kMode = 0666; // limited by the user's mask

} // namespace

FileBuffer::FileBuffer() : buffer_(kBufferBytes) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
}

FileBuffer::~FileBuffer() {
    if (file_ >= 0) {
        ::close(file_);
    }
}

bool FileBuffer::create(const std::filesystem::path& path) {
    return open(path, O_CREAT | O_EXCL);
}

bool FileBuffer::openSpecial(const std::filesystem::path& path) {
    return open(path, 0);
}

bool FileBuffer::open(const std::filesystem::path& path, int flags) {
    file_ = ::open(path.c_str(), flags | O_WRONLY | O_CLOEXEC, kMode);
    reason_ = file_ < 0 ? errno : 0;
    return file_ >= 0;
}

bool FileBuffer::close() {
    if (file_ < 0) {
        return reason_ == 0;
    }
    flushBuffer();
    // A file system may report write errors only now. The descriptor is closed in any case.
    if (::close(file_) != 0 && errno != EINTR && reason_ == 0) {
        reason_ = errno;
    }
    file_ = -1;
    return reason_ == 0;
}

bool FileBuffer::writeOut(const char* bytes, std::size_t count) {
    while (count > 0 && reason_ == 0) {
        const ssize_t written = ::write(file_, bytes, count);
        if (written >= 0) {
            bytes += written;
            count -= static_cast<std::size_t>(written);
        } else if (errno != EINTR) {
            reason_ = errno;
        }
    }
    return reason_ == 0;
}

bool FileBuffer::flushBuffer() {
    const bool written = writeOut(pbase(), static_cast<std::size_t>(pptr() - pbase()));
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return written;
}

FileBuffer::int_type FileBuffer::overflow(int_type byte) {
    if (!flushBuffer()) {
        return traits_type::eof();
    }
    if (!traits_type::eq_int_type(byte, traits_type::eof())) {
        *pptr() = traits_type::to_char_type(byte);
        pbump(1);
    }
    return traits_type::not_eof(byte);
}

std::streamsize FileBuffer::xsputn(const char* bytes, std::streamsize count) {
    if (count >= epptr() - pptr()) {
        const bool written = flushBuffer() && writeOut(bytes, static_cast<std::size_t>(count));
        return written ? count : 0;
    }
    traits_type::copy(pptr(), bytes, static_cast<std::size_t>(count));
    pbump(static_cast<int>(count));
    return count;
}

int FileBuffer::sync() {
    return flushBuffer() ? 0 : -1;
}

} // namespace voxtact::io
