// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_stream.h"

#include "core/base/try.h"
#include "io/errors.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>

#include <zlib.h>

namespace voxtact::io {

namespace {

constexpr std::size_t kInflatedChunk = std::size_t{1} << 16;
/// Maximum bytes of a deflated byte.
constexpr std::uint64_t kMostInflation = 1032;

} // namespace

void DicomStream::InflateEnd::operator()(z_stream_s* stream) const noexcept {
    inflateEnd(stream);
    delete stream;
}

DicomStream::DicomStream(std::ifstream file, std::uint64_t size) : file_(std::move(file)), fileLeft_(size) {}
DicomStream::DicomStream(DicomStream&&) noexcept = default;
DicomStream& DicomStream::operator=(DicomStream&&) noexcept = default;
DicomStream::~DicomStream() = default;

Result<DicomStream> DicomStream::open(const std::filesystem::path& path) {
    const Result<std::uint64_t> size = readableFile(path);
    VOXTACT_TRY(size);
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return cannotOpen(path, errno);
    }
    return DicomStream(std::move(file), *size);
}

void DicomStream::drop(std::size_t count) {
    windowAt_ += count;
    position_ += count;
}

std::size_t DicomStream::take(char* to, std::size_t count) {
    file_.read(to, static_cast<std::streamsize>(count));
    const auto got = static_cast<std::size_t>(file_.gcount());
    fileLeft_ -= got;
    failed_ = failed_ || got < count;
    return got;
}

bool DicomStream::fill() {
    window_.erase(0, windowAt_);
    windowAt_ = 0;
    if (ended_) {
        return false;
    }
    if (inflate_) {
        return fillInflated();
    }
    const std::size_t before = window_.size();
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(kInflatedChunk, fileLeft_));
    window_.resize(before + wanted);
    const std::size_t got = take(window_.data() + before, wanted);
    window_.resize(before + got);
    ended_ = got == 0;
    return !ended_;
}

bool DicomStream::fillInflated() {
    const std::size_t before = window_.size();
    if (position_ + before >= maxInflated_) {
        return false;
    }
    window_.resize(before + kInflatedChunk);
    inflate_->next_out = reinterpret_cast<Bytef*>(window_.data() + before);
    inflate_->avail_out = static_cast<uInt>(kInflatedChunk);
    int state = Z_OK;
    while (inflate_->avail_out == kInflatedChunk && state == Z_OK) {
        if (inflate_->avail_in == 0) {
            compressed_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kInflatedChunk, fileLeft_)));
            const std::size_t got = take(compressed_.data(), compressed_.size());
            inflate_->next_in = reinterpret_cast<Bytef*>(compressed_.data());
            inflate_->avail_in = static_cast<uInt>(got);
        }
        state = inflate(inflate_.get(), Z_NO_FLUSH);
        if (state == Z_MEM_ERROR) {
            throw std::bad_alloc();
        }
    }
    window_.resize(before + kInflatedChunk - inflate_->avail_out);
    ended_ = state != Z_OK;
    isInflated_ = state == Z_STREAM_END;
    return window_.size() > before;
}

void DicomStream::allow(std::uint64_t bytes) noexcept {
    maxInflated_ += std::min(bytes, std::numeric_limits<std::uint64_t>::max() - maxInflated_);
}

bool DicomStream::isWhole() const noexcept {
    return !inflate_ || (isInflated_ && fileLeft_ + inflate_->avail_in <= 1);
}

Result<void> DicomStream::inflateFromHere(std::uint64_t most) {
    auto stream = std::make_unique<z_stream>();
    *stream = {};
    if (inflateInit2(stream.get(), -MAX_WBITS) != Z_OK) {
        return Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
    }
    inflate_.reset(stream.release());
    compressed_ = window_.substr(windowAt_);
    window_.clear();
    windowAt_ = 0;
    inflate_->next_in = reinterpret_cast<Bytef*>(compressed_.data());
    inflate_->avail_in = static_cast<uInt>(compressed_.size());
    ended_ = false;
    maxInflated_ = position_;
    allow(most);
    return {};
}

std::uint64_t DicomStream::mostLeft() const noexcept {
    const std::uint64_t here = window_.size() - windowAt_;
    if (!inflate_) {
        return here + fileLeft_;
    }
    const std::uint64_t packed = ended_ ? 0 : kMostInflation * (fileLeft_ + inflate_->avail_in) + kInflatedChunk;
    return std::min(here + packed, maxInflated_ - std::min(maxInflated_, position_));
}

std::string_view DicomStream::peek(std::size_t count) {
    while (window_.size() - windowAt_ < count && fill()) {
    }
    return std::string_view(window_).substr(windowAt_, count);
}

bool DicomStream::read(void* to, std::size_t count) {
    auto* out = static_cast<char*>(to);
    while (count > 0) {
        if (windowAt_ == window_.size() && !fill()) {
            return false;
        }
        const std::size_t part = std::min(count, window_.size() - windowAt_);
        std::memcpy(out, window_.data() + windowAt_, part);
        drop(part);
        out += part;
        count -= part;
    }
    return true;
}

bool DicomStream::skip(std::uint64_t count) {
    const std::uint64_t here = std::min<std::uint64_t>(count, window_.size() - windowAt_);
    drop(static_cast<std::size_t>(here));
    count -= here;
    if (!inflate_) {
        if (count > fileLeft_) {
            return false;
        }
        file_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
        fileLeft_ -= count;
        position_ += count;
        return true;
    }
    while (count > 0) {
        if (windowAt_ == window_.size() && !fill()) {
            return false;
        }
        const std::uint64_t part = std::min<std::uint64_t>(count, window_.size() - windowAt_);
        drop(static_cast<std::size_t>(part));
        count -= part;
    }
    return true;
}

} // namespace voxtact::io
