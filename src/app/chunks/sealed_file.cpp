// SPDX-License-Identifier: MIT
#include "app/chunks/sealed_file.h"

#include "app/output/standard_streams.h"
#include "core/base/try.h"

#include <array>
#include <fstream>
#include <ostream>
#include <streambuf>
#include <system_error>
#include <vector>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPart = std::size_t{1} << 16U;

/// Of so many characters whatever it says, so that it can be found from the end.
std::string sealOf(const ContentHash& hash) {
    constexpr std::size_t kLengthDigits = 20; // of 2^64
    std::string length = std::to_string(hash.length());
    length.insert(0, kLengthDigits - length.size(), '0');
    return "\nvoxtact end " + length + " " + hash.hex() + "\n";
}

std::size_t sealLength() {
    static const std::size_t length = sealOf({}).size();
    return length;
}

} // namespace

// Members and bases of ResultFile's own classes are of these two, so they are in no unnamed namespace.

/// Holds a part of what it takes until sync() hands it on, and begin() makes room for the next.
class PartBuffer : public std::streambuf {
  public:
    PartBuffer() { begin(); }

  protected:
    void begin() { setp(part_.data(), part_.data() + part_.size()); }
    int_type overflow(int_type character) override {
        if (sync() != 0) {
            return traits_type::eof();
        }
        if (!traits_type::eq_int_type(character, traits_type::eof())) {
            *pptr() = traits_type::to_char_type(character);
            pbump(1);
        }
        return traits_type::not_eof(character);
    }

  private:
    std::array<char, kPart> part_{};
};

/// Hands on to another buffer what it takes, and hashes it.
class HashingBuffer : public PartBuffer {
  public:
    explicit HashingBuffer(std::streambuf& sink) : sink_(sink) {}

    [[nodiscard]] const ContentHash& hash() const noexcept { return hash_; }

  protected:
    int sync() override {
        const std::string_view held(pbase(), static_cast<std::size_t>(pptr() - pbase()));
        hash_.add(held);
        const auto size = static_cast<std::streamsize>(held.size());
        begin();
        return sink_.sputn(held.data(), size) == size ? 0 : -1;
    }

  private:
    std::streambuf& sink_;
    ContentHash hash_;
};

class ResultFile::Sealing {
  public:
    explicit Sealing(std::streambuf& sink) : buffer_(sink) { stream_.imbue(std::locale::classic()); }

    [[nodiscard]] std::ostream& stream() noexcept { return stream_; }
    /// Empty where it cannot be written any more.
    [[nodiscard]] std::string seal() {
        stream_.flush();
        return stream_ ? sealOf(buffer_.hash()) : std::string();
    }

  private:
    HashingBuffer buffer_;
    std::ostream stream_{&buffer_};
};

/// Standard output as a stream that keeps why it failed.
class ResultFile::Standard : PartBuffer {
  public:
    Standard() { stream_.imbue(std::locale::classic()); }

    [[nodiscard]] std::ostream& stream() noexcept { return stream_; }
    [[nodiscard]] Result<void> close() {
        stream_.flush();
        return failure_;
    }

  protected:
    int sync() override {
        if (failure_.ok()) {
            failure_ = writeStandardOutput({pbase(), static_cast<std::size_t>(pptr() - pbase())});
        }
        begin();
        return failure_.ok() ? 0 : -1;
    }

  private:
    Result<void> failure_;
    std::ostream stream_{this};
};

ResultFile::ResultFile() noexcept = default;
ResultFile::ResultFile(ResultFile&&) noexcept = default;
ResultFile& ResultFile::operator=(ResultFile&&) noexcept = default;
ResultFile::~ResultFile() = default;

Result<ResultFile> ResultFile::create(const fs::path& path) {
    ResultFile out;
    if (path == "-") {
        out.standard_ = std::make_unique<Standard>();
        return out;
    }
    Result<io::OutputFile> file = io::OutputFile::create(path);
    VOXTACT_TRY(file);
    out.file_ = std::move(*file);
    return out;
}

Result<ResultFile> ResultFile::createSealed(const fs::path& path, const std::string& firstLine) {
    std::error_code ignored;
    if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
        return Error{ErrorCode::File, 0, "cannot write '" + path.string() + "': what is there is not a file"};
    }
    Result<ResultFile> file = create(path);
    VOXTACT_TRY(file);
    std::ostream& out = file->file_->stream();
    out << firstLine << '\n';
    file->sealing_ = std::make_unique<Sealing>(*out.rdbuf());
    return file;
}

std::ostream& ResultFile::stream() noexcept {
    return sealing_ ? sealing_->stream() : standard_ ? standard_->stream() : file_->stream();
}

Result<void> ResultFile::close() {
    if (sealing_) {
        const std::string seal = sealing_->seal();
        if (seal.empty()) {
            file_->stream().setstate(std::ios::badbit);
        }
        file_->stream() << seal;
    }
    return standard_ ? standard_->close() : file_->close();
}

Result<void> ResultFile::commit() {
    return standard_ ? Result<void>() : file_->commit();
}

SealState readSealed(const fs::path& path, const std::string& firstLine,
                     const std::function<void(std::string_view)>& take) {
    std::error_code problem;
    const std::uintmax_t size = fs::file_size(path, problem);
    if (problem) {
        return fs::exists(path, problem) ? SealState::Damaged : SealState::Missing;
    }
    std::ifstream file(path, std::ios::binary);
    std::string first(firstLine.size() + 1, '\0');
    if (size < first.size() + sealLength() || !file.read(first.data(), static_cast<std::streamsize>(first.size())) ||
        first != firstLine + "\n") {
        return SealState::Damaged;
    }
    ContentHash hash;
    std::vector<char> part(kPart);
    for (std::uintmax_t left = size - first.size() - sealLength(); left > 0;) {
        const std::size_t wanted = static_cast<std::size_t>(std::min<std::uintmax_t>(left, part.size()));
        if (!file.read(part.data(), static_cast<std::streamsize>(wanted))) {
            return SealState::Damaged;
        }
        const std::string_view taken(part.data(), wanted);
        hash.add(taken);
        if (take) {
            take(taken);
        }
        left -= wanted;
    }
    std::string seal(sealLength(), '\0');
    return file.read(seal.data(), static_cast<std::streamsize>(seal.size())) && seal == sealOf(hash)
               ? SealState::Whole
               : SealState::Damaged;
}

} // namespace voxtact::app
