// SPDX-License-Identifier: MIT
#include "cli/output/result_file.h"

#include "cli/output/standard_streams.h"
#include "core/base/try.h"

#include <array>
#include <ostream>
#include <streambuf>

namespace voxtact::app {

/// Standard output as a stream that keeps the reason of a failure.
class ResultFile::Standard : std::streambuf {
  public:
    Standard() {
        setp(part_.data(), part_.data() + part_.size());
        stream_.imbue(std::locale::classic());
    }

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
        setp(part_.data(), part_.data() + part_.size());
        return failure_.ok() ? 0 : -1;
    }
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
    static constexpr std::size_t kPart = std::size_t{1} << 16U;

    std::array<char, kPart> part_{};
    Result<void> failure_;
    std::ostream stream_{this};
};

ResultFile::ResultFile() noexcept = default;
ResultFile::ResultFile(ResultFile&&) noexcept = default;
ResultFile& ResultFile::operator=(ResultFile&&) noexcept = default;
ResultFile::~ResultFile() = default;

Result<ResultFile> ResultFile::create(const std::filesystem::path& path) {
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

std::ostream& ResultFile::stream() noexcept {
    return standard_ ? standard_->stream() : file_->stream();
}

Result<void> ResultFile::close() {
    return standard_ ? standard_->close() : file_->close();
}

} // namespace voxtact::app
