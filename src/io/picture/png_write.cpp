// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "voxtact/io.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ostream>
#include <string_view>
#include <vector>

namespace voxtact::io {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kChannels = 4;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

Error refuse(std::string text) {
    return {ErrorCode::InvalidArgument, 0, std::move(text)};
}

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

std::array<std::uint8_t, 4> bigEndian(std::uint32_t number) {
    return {static_cast<std::uint8_t>(number >> 24U), static_cast<std::uint8_t>(number >> 16U),
            static_cast<std::uint8_t>(number >> 8U), static_cast<std::uint8_t>(number)};
}

void put(std::ostream& out, Bytes bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Its length, its name of four letters, what it holds, and the checksum of both.
void putChunk(std::ostream& out, std::string_view name, Bytes holds) {
    const auto sum = [](uLong begun, const void* from, std::size_t bytes) {
        return ::crc32(begun, static_cast<const Bytef*>(from), static_cast<uInt>(bytes));
    };
    put(out, bigEndian(static_cast<std::uint32_t>(holds.size())));
    out << name;
    put(out, holds);
    const uLong named = sum(0, name.data(), name.size());
    put(out, bigEndian(static_cast<std::uint32_t>(holds.empty() ? named : sum(named, holds.data(), holds.size()))));
}

/// Compresses, and writes what that gives in chunks.
class Deflated {
  public:
    explicit Deflated(std::ostream& out) : out_(&out), room_(kRoom) { made_ = ::deflateInit(&stream_, kLevel) == Z_OK; }
    Deflated(const Deflated&) = delete;
    Deflated& operator=(const Deflated&) = delete;
    ~Deflated() {
        if (made_) {
            ::deflateEnd(&stream_);
        }
    }

    [[nodiscard]] bool made() const { return made_; }
    void add(Bytes bytes) { push(bytes, Z_NO_FLUSH); }
    void end() { push({}, Z_FINISH); }

  private:
    static constexpr std::size_t kRoom = std::size_t{1} << 16U;
    static constexpr int kLevel = 6;

    void push(Bytes bytes, int flush) {
        stream_.next_in = const_cast<Bytef*>(bytes.data()); // it only reads them
        stream_.avail_in = static_cast<uInt>(bytes.size());
        do {
            stream_.next_out = room_.data();
            stream_.avail_out = static_cast<uInt>(room_.size());
            ::deflate(&stream_, flush);
            const std::size_t given = room_.size() - stream_.avail_out;
            if (given > 0) {
                putChunk(*out_, "IDAT", Bytes(room_).first(given));
            }
        } while (stream_.avail_out == 0);
    }

    std::ostream* out_;
    std::vector<std::uint8_t> room_;
    z_stream stream_{};
    bool made_ = false;
};

std::uint8_t paeth(int left, int above, int corner) {
    const int guess = left + above - corner;
    const int toLeft = std::abs(guess - left);
    const int toAbove = std::abs(guess - above);
    const int toCorner = std::abs(guess - corner);
    return static_cast<std::uint8_t>(toLeft <= toAbove && toLeft <= toCorner ? left
                                     : toAbove <= toCorner                   ? above
                                                                             : corner);
}

/// A row as what its pixels differ by from what is guessed from their neighbours, by one of PNG's five ways.
template <int kWay> void filter(Bytes row, const std::uint8_t* above, std::vector<std::uint8_t>& out) {
    out[0] = kWay;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const int left = i < kChannels ? 0 : row[i - kChannels];
        const int up = above[i];
        const int corner = i < kChannels ? 0 : above[i - kChannels];
        const int guess = kWay == 1   ? left
                          : kWay == 2 ? up
                          : kWay == 3 ? (left + up) / 2
                          : kWay == 4 ? paeth(left, up, corner)
                                      : 0;
        out[i + 1] = static_cast<std::uint8_t>(row[i] - guess);
    }
}

/// What is near 0, either way round, compresses well.
std::uint64_t sizeOf(const std::vector<std::uint8_t>& filtered) {
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < filtered.size(); ++i) {
        sum += static_cast<std::uint64_t>(std::min<int>(filtered[i], 256 - filtered[i]));
    }
    return sum;
}

/// Rows, each by the way that suits it best.
class Filters {
  public:
    explicit Filters(std::size_t rowBytes) : none_(rowBytes), best_(rowBytes + 1), other_(rowBytes + 1) {}

    /// `above`: the row before it; empty for the first one.
    Bytes best(Bytes row, Bytes above) {
        const std::uint8_t* up = above.empty() ? none_.data() : above.data();
        filter<0>(row, up, best_);
        std::uint64_t least = sizeOf(best_);
        for (const auto& way : {filter<1>, filter<2>, filter<3>, filter<4>}) {
            way(row, up, other_);
            if (const std::uint64_t size = sizeOf(other_); size < least) {
                least = size;
                std::swap(best_, other_);
            }
        }
        return best_;
    }

  private:
    std::vector<std::uint8_t> none_;
    std::vector<std::uint8_t> best_;
    std::vector<std::uint8_t> other_;
};

void putHeader(std::ostream& out, std::uint32_t width, std::uint32_t height) {
    constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    constexpr std::array<std::uint8_t, 5> kKind{8, 6, 0, 0, 0}; // bits a channel, RGBA, not interlaced
    put(out, kSignature);
    std::vector<std::uint8_t> header;
    for (const std::uint32_t side : {width, height}) {
        const std::array<std::uint8_t, 4> number = bigEndian(side);
        header.insert(header.end(), number.begin(), number.end());
    }
    header.insert(header.end(), kKind.begin(), kKind.end());
    putChunk(out, "IHDR", header);
}

} // namespace

Result<void> writePng(std::ostream& out, std::uint32_t width, std::uint32_t height, Bytes rgba,
                      const WriteProgress& progress) {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(checkPicture(width, height, rgba));
        Deflated deflated(out);
        if (!deflated.made()) {
            return Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
        }
        putHeader(out, width, height);
        const std::size_t bytes = kChannels * width;
        Filters filters(bytes);
        for (std::uint32_t y = 0; y < height; ++y) {
            deflated.add(
                filters.best(rgba.subspan(y * bytes, bytes), y == 0 ? Bytes() : rgba.subspan((y - 1) * bytes, bytes)));
            if (progress && !progress(y + 1, height)) {
                return Error{ErrorCode::Cancelled, 0, "writing the picture was cancelled"};
            }
        }
        deflated.end();
        putChunk(out, "IEND", {});
        return {};
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
