// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_codecs.h"

#include "core/base/try.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

/// JPEG (ITU-T T.81) of one component with Huffman codes: baseline and extended sequential at 8 and 12 bits, and
/// lossless. Image libraries read at most 8 bits, or end the program on damaged data.
namespace voxtact::io {

namespace {

constexpr unsigned kMarker = 0xFF;
constexpr unsigned kFirstRestart = 0xD0;

/// Positions of the coefficients of a block, in the order of the stream.
constexpr std::array<std::uint8_t, 64> kZigzag{0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,
                                               12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6,  7,  14, 21, 28,
                                               35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,
                                               58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

Error damaged(const char* what) {
    return Error{ErrorCode::Format, 0, std::string("its JPEG data is damaged or cut off (") + what + ")"};
}

struct HuffmanTable {
    bool isThere = false;
    std::array<std::uint32_t, 17> end{};   ///< of the codes of each length, left-aligned in 16 bits; exclusive
    std::array<std::uint32_t, 17> first{}; ///< the first code of each length
    std::array<std::uint32_t, 17> at{};    ///< its value's index
    std::array<std::uint8_t, 256> values{};
};

/// Bits of entropy-coded data, up to the next marker.
class BitReader {
  public:
    explicit BitReader(std::string_view bytes) : bytes_(bytes) {}

    /// The next 16, filled up with zeros behind the end.
    std::uint32_t peek16() {
        while (count_ < 16) {
            held_ = held_ << 8U | next();
            count_ += 8;
        }
        return static_cast<std::uint32_t>(held_ >> (count_ - 16)) & 0xFFFFU;
    }
    void drop(unsigned count) { count_ -= count; }
    std::uint32_t take(unsigned count) {
        const std::uint32_t bits = count == 0 ? 0 : peek16() >> (16 - count);
        drop(count);
        return bits;
    }
    /// Returns true if more bits were read than exist.
    [[nodiscard]] bool isExhausted() const { return made_ * 8 > count_; }

    /// Goes behind the marker that ends this part.
    bool restart(unsigned number) {
        held_ = 0;
        count_ = 0;
        made_ = 0;
        while (at_ + 1 < bytes_.size() && byte(at_) == kMarker && byte(at_ + 1) == kMarker) {
            ++at_;
        }
        if (at_ + 1 >= bytes_.size() || byte(at_) != kMarker || byte(at_ + 1) != kFirstRestart + number) {
            return false;
        }
        at_ += 2;
        return true;
    }

  private:
    [[nodiscard]] unsigned byte(std::size_t at) const { return static_cast<unsigned char>(bytes_[at]); }
    unsigned next() {
        if (at_ < bytes_.size()) {
            const unsigned value = byte(at_);
            if (value != kMarker) {
                ++at_;
                return value;
            }
            if (at_ + 1 < bytes_.size() && byte(at_ + 1) == 0) {
                at_ += 2;
                return value;
            }
        }
        ++made_;
        return 0;
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    std::uint64_t held_ = 0;
    unsigned count_ = 0;
    std::uint64_t made_ = 0;
};

/// -1 for a code that is none.
int symbol(BitReader& bits, const HuffmanTable& table) {
    const std::uint32_t code = bits.peek16();
    for (unsigned length = 1; length <= 16; ++length) {
        if (code < table.end[length]) {
            bits.drop(length);
            return table.values[table.at[length] + ((code >> (16 - length)) - table.first[length])];
        }
    }
    return -1;
}

/// A difference of the category: the upper half is positive.
int difference(BitReader& bits, unsigned category) {
    if (category == 0) {
        return 0;
    }
    if (category == 16) {
        return 32768;
    }
    const int value = static_cast<int>(bits.take(category));
    return value < 1 << (category - 1) ? value - (1 << category) + 1 : value;
}

using Waves = std::array<std::array<double, 8>, 8>;

/// waves[u][x] = C(u)/2 cos((2x + 1) u pi / 16)
Waves makeWaves() {
    Waves waves{};
    for (std::size_t u = 0; u < 8; ++u) {
        for (std::size_t x = 0; x < 8; ++x) {
            waves[u][x] = (u == 0 ? std::numbers::sqrt2 / 2 : 1.0) / 2 *
                          std::cos(static_cast<double>((2 * x + 1) * u) * std::numbers::pi / 16);
        }
    }
    return waves;
}

class Decoder {
  public:
    Decoder(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells)
        : bytes_(bytes), image_(image), cells_(cells) {}

    Result<void> decode();

  private:
    [[nodiscard]] unsigned byte(std::size_t at) const { return static_cast<unsigned char>(bytes_[at]); }
    [[nodiscard]] unsigned word(std::size_t at) const { return byte(at) << 8U | byte(at + 1); }

    Result<void> segment(unsigned marker, std::size_t at, std::size_t end);
    Result<void> frame(unsigned marker, std::size_t at, std::size_t end);
    Result<void> quantization(std::size_t at, std::size_t end);
    Result<void> huffman(std::size_t at, std::size_t end);
    Result<void> scan(std::size_t at, std::size_t end);
    Result<void> lossless(BitReader bits, const HuffmanTable& table, unsigned predictor, unsigned shift);
    Result<void> sequential(BitReader bits, const HuffmanTable& constant, const HuffmanTable& rest);
    bool block(BitReader& bits, const HuffmanTable& constant, const HuffmanTable& rest, int& last,
               std::array<double, 64>& block);
    void put(std::array<double, 64>& block, std::uint32_t left, std::uint32_t top);

    std::string_view bytes_;
    const DicomImage& image_;
    std::span<std::uint32_t> cells_;
    unsigned process_ = 0; ///< marker of the frame
    unsigned precision_ = 0;
    unsigned quantizationTable_ = 0;
    unsigned component_ = 0;
    std::uint32_t interval_ = 0;
    std::array<std::array<double, 64>, 4> quantization_{};
    std::array<bool, 4> hasQuantization_{};
    std::array<HuffmanTable, 4> constants_{};
    std::array<HuffmanTable, 4> others_{};
};

constexpr unsigned kBaseline = 0xC0;
constexpr unsigned kExtended = 0xC1;
constexpr unsigned kLossless = 0xC3;
constexpr unsigned kHuffmanTables = 0xC4;
constexpr unsigned kStart = 0xD8;
constexpr unsigned kScan = 0xDA;
constexpr unsigned kQuantization = 0xDB;
constexpr unsigned kInterval = 0xDD;

Result<void> Decoder::decode() {
    if (bytes_.size() < 4 || word(0) != (kMarker << 8U | kStart)) {
        return damaged("it does not begin like one");
    }
    std::size_t at = 2;
    for (;;) {
        if (at + 4 > bytes_.size() || byte(at) != kMarker) {
            return damaged("no marker where one should be");
        }
        const unsigned marker = byte(at + 1);
        if (marker == kMarker) {
            ++at;
            continue;
        }
        const std::size_t end = at + 2 + word(at + 2);
        if (word(at + 2) < 2 || end > bytes_.size()) {
            return damaged("a segment longer than the data");
        }
        if (marker == kScan) {
            return scan(at + 4, end);
        }
        VOXTACT_TRY(segment(marker, at + 4, end));
        at = end;
    }
}

Result<void> Decoder::segment(unsigned marker, std::size_t at, std::size_t end) {
    constexpr unsigned kFirstApplication = 0xE0;
    constexpr unsigned kComment = 0xFE;
    switch (marker) {
    case kBaseline:
    case kExtended:
    case kLossless:
        return frame(marker, at, end);
    case kHuffmanTables:
        return huffman(at, end);
    case kQuantization:
        return quantization(at, end);
    case kInterval:
        if (end - at != 2) {
            return damaged("a restart interval of a wrong length");
        }
        interval_ = word(at);
        return {};
    default:
        break;
    }
    if ((marker >= kFirstApplication && marker < kFirstApplication + 16) || marker == kComment) {
        return {};
    }
    if (marker > kLossless && marker < kFirstRestart) {
        return Error{ErrorCode::Format, 0,
                     "its JPEG data is progressive, hierarchical or arithmetically coded, which "
                     "DICOM does not use; convert the series"};
    }
    return damaged("an unexpected marker");
}

Result<void> Decoder::frame(unsigned marker, std::size_t at, std::size_t end) {
    if (end - at != 9 || process_ != 0) {
        return damaged("more than one frame or component");
    }
    process_ = marker;
    precision_ = byte(at);
    if (word(at + 1) != image_.rows || word(at + 3) != image_.columns || byte(at + 5) != 1) {
        return damaged("another size than the file says");
    }
    component_ = byte(at + 6);
    quantizationTable_ = byte(at + 8);
    const bool isRight = marker == kLossless   ? precision_ >= 2 && precision_ <= 16
                         : marker == kBaseline ? precision_ == 8
                                               : precision_ == 8 || precision_ == 12;
    if (!isRight || precision_ > image_.bitsAllocated || quantizationTable_ > 3) {
        return damaged("a precision that does not fit");
    }
    if (image_.isSigned && precision_ < image_.bitsStored) {
        return damaged("fewer bits than the file says, of signed values");
    }
    return {};
}

Result<void> Decoder::quantization(std::size_t at, std::size_t end) {
    while (at < end) {
        const unsigned wide = byte(at) >> 4U;
        const unsigned table = byte(at) & 15U;
        const std::size_t bytes = wide == 0 ? 64 : 128;
        if (wide > 1 || table > 3 || end - at - 1 < bytes) {
            return damaged("a quantization table");
        }
        for (std::size_t i = 0; i < 64; ++i) {
            quantization_[table][i] = wide == 0 ? byte(at + 1 + i) : word(at + 1 + 2 * i);
        }
        hasQuantization_[table] = true;
        at += 1 + bytes;
    }
    return {};
}

Result<void> Decoder::huffman(std::size_t at, std::size_t end) {
    while (at < end) {
        const unsigned kind = byte(at) >> 4U;
        const unsigned number = byte(at) & 15U;
        if (kind > 1 || number > 3 || end - at < 17) {
            return damaged("a Huffman table");
        }
        HuffmanTable& table = kind == 0 ? constants_[number] : others_[number];
        table = {};
        table.isThere = true;
        std::uint32_t code = 0;
        std::uint32_t index = 0;
        for (unsigned length = 1; length <= 16; ++length) {
            const std::uint32_t codes = byte(at + length);
            table.first[length] = code;
            table.at[length] = index;
            code += codes;
            index += codes;
            if (code > 1U << length || index > 256) {
                return damaged("a Huffman table");
            }
            table.end[length] = code << (16 - length);
            code <<= 1U;
        }
        if (end - at - 17 < index) {
            return damaged("a Huffman table");
        }
        for (std::uint32_t i = 0; i < index; ++i) {
            table.values[i] = static_cast<std::uint8_t>(byte(at + 17 + i));
        }
        at += 17 + index;
    }
    return {};
}

Result<void> Decoder::scan(std::size_t at, std::size_t end) {
    if (process_ == 0 || end - at != 6 || byte(at) != 1 || byte(at + 1) != component_) {
        return damaged("a scan without its frame");
    }
    const unsigned constant = byte(at + 2) >> 4U;
    const unsigned rest = byte(at + 2) & 15U;
    const unsigned first = byte(at + 3);
    const unsigned last = byte(at + 4);
    const unsigned shift = byte(at + 5) & 15U;
    if (constant > 3 || rest > 3 || !constants_[constant].isThere || byte(at + 5) > 15) {
        return damaged("a scan without its tables");
    }
    const BitReader bits(bytes_.substr(end));
    if (process_ == kLossless) {
        if (first < 1 || first > 7 || last != 0 || shift >= precision_ ||
            (interval_ != 0 && interval_ % image_.columns != 0)) {
            return damaged("a lossless scan's parameters");
        }
        return lossless(bits, constants_[constant], first, shift);
    }
    // First and last coefficient are meaningless here, and some writers set other numbers.
    if (shift != 0 || !others_[rest].isThere || !hasQuantization_[quantizationTable_]) {
        return damaged("a scan's parameters");
    }
    return sequential(bits, constants_[constant], others_[rest]);
}

Result<void> Decoder::lossless(BitReader bits, const HuffmanTable& table, unsigned predictor, unsigned shift) {
    const std::uint32_t columns = image_.columns;
    const std::uint32_t rowsBetween = interval_ == 0 ? image_.rows : interval_ / columns;
    std::vector<int> above(columns);
    std::vector<int> row(columns);
    for (std::uint32_t y = 0; y < image_.rows; ++y) {
        const bool begins = y % rowsBetween == 0;
        if (begins && y > 0 && (bits.isExhausted() || !bits.restart((y / rowsBetween - 1) % 8))) {
            return damaged("a restart is missing");
        }
        for (std::uint32_t x = 0; x < columns; ++x) {
            const int category = symbol(bits, table);
            if (category < 0 || category > 16) {
                return damaged("a code that is none");
            }
            const int change = difference(bits, static_cast<unsigned>(category));
            const int a = x == 0 ? 0 : row[x - 1];
            const int b = above[x];
            const int c = x == 0 ? 0 : above[x - 1];
            int guess = 0;
            if (begins) {
                guess = x == 0 ? 1 << (precision_ - shift - 1) : a;
            } else if (x == 0) {
                guess = b;
            } else {
                const std::array<int, 8> guesses{
                    0, a, b, c, a + b - c, a + ((b - c) >> 1), b + ((a - c) >> 1), (a + b) >> 1};
                guess = guesses[predictor];
            }
            row[x] = (guess + change) & 0xFFFF;
            cells_[std::size_t{y} * columns + x] = static_cast<std::uint32_t>(row[x]) << shift & 0xFFFFU;
        }
        if (bits.isExhausted()) {
            return damaged("it ends before the image does");
        }
        std::swap(above, row);
    }
    return {};
}

bool Decoder::block(BitReader& bits, const HuffmanTable& constant, const HuffmanTable& rest, int& last,
                    std::array<double, 64>& block) {
    const std::array<double, 64>& steps = quantization_[quantizationTable_];
    block.fill(0);
    const int category = symbol(bits, constant);
    if (category < 0 || category > 15) {
        return false;
    }
    // Damaged data may add up to anything; a true constant has 16 bits.
    last = std::clamp(last + difference(bits, static_cast<unsigned>(category)), -65536, 65536);
    block[0] = last * steps[0];
    for (unsigned k = 1; k < 64; ++k) {
        const int code = symbol(bits, rest);
        if (code < 0) {
            return false;
        }
        const unsigned run = static_cast<unsigned>(code) >> 4U;
        const unsigned size = static_cast<unsigned>(code) & 15U;
        if (size == 0) {
            if (run != 15) {
                break;
            }
            k += 15;
            continue;
        }
        k += run;
        if (k > 63) {
            return false;
        }
        block[kZigzag[k]] = difference(bits, size) * steps[k];
    }
    return true;
}

void Decoder::put(std::array<double, 64>& block, std::uint32_t left, std::uint32_t top) {
    static const Waves waves = makeWaves();
    std::array<double, 64> rows{};
    for (std::size_t v = 0; v < 8; ++v) {
        for (std::size_t x = 0; x < 8; ++x) {
            for (std::size_t u = 0; u < 8; ++u) {
                rows[8 * v + x] += waves[u][x] * block[8 * v + u];
            }
        }
    }
    const double middle = 1U << (precision_ - 1);
    const double most = 2 * middle - 1;
    for (std::size_t y = 0; y < 8 && top + y < image_.rows; ++y) {
        for (std::size_t x = 0; x < 8 && left + x < image_.columns; ++x) {
            double value = middle;
            for (std::size_t v = 0; v < 8; ++v) {
                value += waves[v][y] * rows[8 * v + x];
            }
            cells_[(top + y) * image_.columns + left + x] =
                static_cast<std::uint32_t>(std::clamp(std::round(value), 0.0, most));
        }
    }
}

Result<void> Decoder::sequential(BitReader bits, const HuffmanTable& constant, const HuffmanTable& rest) {
    const std::uint32_t across = (image_.columns + 7) / 8;
    const std::uint32_t down = (image_.rows + 7) / 8;
    std::array<double, 64> values{};
    int last = 0;
    for (std::uint32_t i = 0; i < across * down; ++i) {
        if (interval_ != 0 && i != 0 && i % interval_ == 0) {
            if (bits.isExhausted() || !bits.restart((i / interval_ - 1) % 8)) {
                return damaged("a restart is missing");
            }
            last = 0;
        }
        if (!block(bits, constant, rest, last, values)) {
            return damaged("a code that is none");
        }
        if (bits.isExhausted()) {
            return damaged("it ends before the image does");
        }
        put(values, i % across * 8, i / across * 8);
    }
    return {};
}

} // namespace

Result<void> decodeJpeg(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells) {
    return Decoder(bytes, image, cells).decode();
}

} // namespace voxtact::io
