// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "voxtact/io.h"

#include <png.h>

#include <csetjmp>
#include <ostream>

namespace voxtact::io {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kChannels = 4;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

Result<void> checkPicture(std::uint32_t width, std::uint32_t height, Bytes rgba) {
    const std::uint64_t bytes = std::uint64_t{kChannels} * width * height;
    if (bytes == 0 || bytes != rgba.size()) {
        return refuse("a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels has " +
                      std::to_string(rgba.size()) + " bytes, four a pixel are needed");
    }
    if (bytes > kMostBytes) {
        return refuse("a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels has " +
                      std::to_string(bytes) + " bytes, a PNG file of ours has at most " + std::to_string(kMostBytes));
    }
    return {};
}

void putBytes(png_structp png, png_bytep bytes, std::size_t size) {
    bool thrown = false; // which is not for libpng, written in C
    try {
        static_cast<std::ostream*>(png_get_io_ptr(png))
            ->write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    } catch (...) {
        thrown = true;
    }
    if (thrown) {
        png_longjmp(png, 1);
    }
}

/// The stream's owner flushes it.
void flushNothing(png_structp /*png*/) {}

[[noreturn]] void fail(png_structp png, png_const_charp /*text*/) {
    png_longjmp(png, 1);
}

void warnNobody(png_structp /*png*/, png_const_charp /*text*/) {}

/// libpng's writer. It fails without memory, by a long jump, which must skip no destructor.
class PngWriter {
  public:
    explicit PngWriter(std::ostream& out)
        : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, warnNobody)),
          info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
        if (info_ != nullptr) {
            png_set_write_fn(png_, &out, putBytes, flushNothing);
        }
    }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

    [[nodiscard]] bool begin(std::uint32_t width, std::uint32_t height) {
        constexpr int kBits = 8;
        if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // else a million
        png_set_IHDR(png_, info_, width, height, kBits, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_write_info(png_, info_);
        return true;
    }
    [[nodiscard]] bool row(const std::uint8_t* rgba) {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_write_row(png_, rgba);
        return true;
    }
    [[nodiscard]] bool end() {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_write_end(png_, info_);
        return true;
    }

  private:
    png_structp png_;
    png_infop info_;
};

Error noMemory() {
    return {ErrorCode::OutOfMemory, 0, "out of host memory"};
}

} // namespace

Result<void> writePng(std::ostream& out, std::uint32_t width, std::uint32_t height, Bytes rgba,
                      const WriteProgress& progress) {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(checkPicture(width, height, rgba));
        PngWriter png(out);
        if (!png.begin(width, height)) {
            return noMemory();
        }
        const std::size_t bytes = kChannels * width;
        for (std::uint32_t y = 0; y < height; ++y) {
            if (!png.row(rgba.subspan(y * bytes, bytes).data())) {
                return noMemory();
            }
            if (progress && !progress(y + 1, height)) {
                return Error{ErrorCode::Cancelled, 0, "writing the picture was cancelled"};
            }
        }
        return png.end() ? Result<void>() : noMemory();
    });
}

Result<void> writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, Bytes rgba,
                      const WriteProgress& progress) {
    return guard([&]() -> Result<void> {
        if (lowerEnding(path) != ".png") {
            return cannotWrite(path, "the ending of a picture is .png", ErrorCode::InvalidArgument);
        }
        VOXTACT_TRY(checkPicture(width, height, rgba));
        return writeFile(path, [&](std::ostream& stream) { return writePng(stream, width, height, rgba, progress); });
    });
}

} // namespace voxtact::io
