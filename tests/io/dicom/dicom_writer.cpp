// SPDX-License-Identifier: MIT
#include "dicom_writer.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <zlib.h>

namespace voxtact::test {

namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFF;

template <class Number> void put(std::string& to, Number number, bool big) {
    std::string raw;
    append(raw, number);
    to += big ? std::string(raw.rbegin(), raw.rend()) : raw;
}

void putTag(std::string& to, std::uint32_t tag, bool big) {
    put(to, static_cast<std::uint16_t>(tag >> 16U), big);
    put(to, static_cast<std::uint16_t>(tag), big);
}

void putHeader(std::string& to, std::uint32_t tag, const std::string& type, std::uint32_t length, bool typed,
               bool big) {
    putTag(to, tag, big);
    if (!typed) {
        put(to, length, big);
        return;
    }
    to += type;
    if (type == "OB" || type == "OW" || type == "SQ" || type == "UN") {
        put(to, std::uint16_t{0}, big);
        put(to, length, big);
    } else {
        put(to, static_cast<std::uint16_t>(length), big);
    }
}

std::string rawDeflated(const std::string& content) {
    z_stream stream{};
    deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string in = content;
    std::string out(deflateBound(&stream, in.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

std::string padded(const std::string& text, char with) {
    return text.size() % 2 == 0 ? text : text + with;
}

} // namespace

DicomSet& DicomSet::text(std::uint32_t tag, const char* type, const std::string& value) {
    elements_[tag] = {type, padded(value, std::string(type) == "UI" ? '\0' : ' '), {}, {}, {}};
    return *this;
}

DicomSet& DicomSet::number(std::uint32_t tag, std::uint16_t value) {
    elements_[tag] = {"US", {}, {value}, {}, {}};
    return *this;
}

DicomSet& DicomSet::sequence(std::uint32_t tag, std::vector<DicomSet> items) {
    elements_[tag] = {"SQ", {}, {}, std::move(items), {}};
    return *this;
}

DicomSet& DicomSet::words(std::uint32_t tag, std::vector<std::uint16_t> values) {
    elements_[tag] = {"OW", {}, std::move(values), {}, {}};
    return *this;
}

DicomSet& DicomSet::bytes(std::uint32_t tag, const std::string& values) {
    elements_[tag] = {"OB", padded(values, '\0'), {}, {}, {}};
    return *this;
}

DicomSet& DicomSet::pieces(std::uint32_t tag, std::vector<std::string> values) {
    elements_[tag] = {"OB", {}, {}, {}, std::move(values)};
    return *this;
}

DicomSet& DicomSet::remove(std::uint32_t tag) {
    elements_.erase(tag);
    return *this;
}

std::string DicomSet::body(bool typed, bool big, bool bigPixels) const {
    std::string out;
    for (const auto& [tag, element] : elements_) {
        if (!element.pieces.empty()) {
            putHeader(out, tag, "OB", kUndefined, typed, big);
            putHeader(out, 0xFFFEE000, "", 0, false, big);
            for (const std::string& piece : element.pieces) {
                const std::string even = padded(piece, '\0');
                putHeader(out, 0xFFFEE000, "", static_cast<std::uint32_t>(even.size()), false, big);
                out += even;
            }
            putHeader(out, 0xFFFEE0DD, "", 0, false, big);
            continue;
        }
        std::string value = element.bytes;
        for (const std::uint16_t word : element.words) {
            put(value, word, element.type == "OW" ? bigPixels : big);
        }
        // Every second sequence with lengths, every other with delimiters.
        const bool open = element.type == "SQ" && tag % 2 == 0;
        for (const DicomSet& item : element.items) {
            const std::string inner = item.body(typed, big, bigPixels);
            putHeader(value, 0xFFFEE000, "", open ? kUndefined : static_cast<std::uint32_t>(inner.size()), false, big);
            value += inner;
            if (open) {
                putHeader(value, 0xFFFEE00D, "", 0, false, big);
            }
        }
        putHeader(out, tag, element.type, open ? kUndefined : static_cast<std::uint32_t>(value.size()), typed, big);
        out += value;
        if (open) {
            putHeader(out, 0xFFFEE0DD, "", 0, false, big);
        }
    }
    return out;
}

std::string DicomSet::file(const std::string& syntax) const {
    DicomSet meta;
    meta.text(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.2").text(0x00020010, "UI", syntax);
    const std::string elements = meta.body();
    std::string out(128, '\0');
    out += "DICM";
    putHeader(out, 0x00020000, "UL", 4, true, false);
    put(out, static_cast<std::uint32_t>(elements.size()), false);
    const bool big = syntax == kBigEndian;
    const bool typed = syntax != kImplicit && syntax != kGeBigPixels;
    const std::string content = body(typed, big, big || syntax == kGeBigPixels);
    return out + elements + (syntax == kDeflated ? rawDeflated(content) : content);
}

std::vector<std::uint16_t> ctWords(int index) {
    std::vector<std::uint16_t> words;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            words.push_back(static_cast<std::uint16_t>(ctValue(index, row, column)));
        }
    }
    return words;
}

DicomSet ctSlice(int index) {
    DicomSet set;
    set.text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL")
        .text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2")
        .text(0x00080018, "UI", "1.2.3.4." + std::to_string(index + 1))
        .text(0x00080060, "CS", "CT")
        .text(0x0008103E, "LO", "Thorax")
        .text(0x0020000E, "UI", "1.2.3.4")
        .text(0x00200013, "IS", std::to_string(index + 1))
        .text(0x00200032, "DS", "-10\\20\\" + std::to_string(5 + kGap * index))
        .text(0x00200037, "DS", "1\\0\\0\\0\\1\\0")
        .text(0x00200052, "UI", "1.2.3.5")
        .number(0x00280002, 1)
        .text(0x00280004, "CS", "MONOCHROME2")
        .number(0x00280010, kRows)
        .number(0x00280011, kColumns)
        .text(0x00280030, "DS", "0.8\\0.5")
        .number(0x00280100, 16)
        .number(0x00280101, 16)
        .number(0x00280102, 15)
        .number(0x00280103, 1)
        .text(0x00281052, "DS", "0")
        .text(0x00281053, "DS", "1")
        .words(0x7FE00010, ctWords(index));
    return set;
}

void writeCt(const TemporaryFolder& folder, int slices, const std::string& syntax) {
    for (int i = 0; i < slices; ++i) {
        folder.write("s" + std::to_string(i) + ".dcm", ctSlice(i).file(syntax));
    }
}

std::string rleFrame(std::span<const std::uint16_t> cells, bool literal) {
    std::array<std::string, 2> segments;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto byte = [&](std::size_t cell) { return static_cast<char>(cells[cell] >> (i == 0 ? 8U : 0U)); };
        std::size_t length = 0;
        for (std::size_t cell = 0; cell < cells.size(); cell += length) {
            length = 1;
            while (length < 128 && cell + length < cells.size() && (literal || byte(cell + length) == byte(cell))) {
                ++length;
            }
            segments[i] += static_cast<char>(literal || length == 1 ? length - 1 : 257 - length);
            for (std::size_t j = 0; j < (literal ? length : 1); ++j) {
                segments[i] += byte(cell + j);
            }
        }
        segments[i] = padded(segments[i], '\x80');
    }
    std::string out;
    append(out, std::uint32_t{2});
    append(out, std::uint32_t{64});
    append(out, static_cast<std::uint32_t>(64 + segments[0].size()));
    out.resize(64);
    return out + segments[0] + segments[1];
}

namespace {

/// 255 codes of nine bits: symbol s has the code s.
class JpegWriter {
  public:
    void marker(unsigned code, const std::string& content) {
        out_ += {static_cast<char>(0xFF), static_cast<char>(code)};
        big(static_cast<unsigned>(content.size()) + 2);
        out_ += content;
    }
    void alone(unsigned code) { out_ += {static_cast<char>(0xFF), static_cast<char>(code)}; }
    void frame(unsigned code, unsigned bits, std::size_t rows, unsigned columns) {
        std::string content(1, static_cast<char>(bits));
        content += {static_cast<char>(rows >> 8U), static_cast<char>(rows), static_cast<char>(columns >> 8U),
                    static_cast<char>(columns)};
        marker(code, content + std::string("\1\1\x11\0", 4));
    }
    void tables(bool both) {
        for (const char kind : {'\0', '\x10'}) {
            std::string content(1, kind);
            for (int length = 1; length <= 16; ++length) {
                content += length == 9 ? static_cast<char>(255) : '\0';
            }
            for (int symbol = 0; symbol < 255; ++symbol) {
                content += static_cast<char>(symbol);
            }
            if (both || kind == '\0') {
                marker(0xC4, content);
            }
        }
    }
    void interval(unsigned count) { marker(0xDD, {static_cast<char>(count >> 8U), static_cast<char>(count)}); }
    void bits(unsigned value, unsigned count) {
        for (unsigned i = count; i-- > 0;) {
            held_ = held_ << 1U | ((value >> i) & 1U);
            if (++count_ == 8) {
                out_ += static_cast<char>(held_);
                if ((held_ & 0xFFU) == 0xFF) {
                    out_ += '\0';
                }
                held_ = 0;
                count_ = 0;
            }
        }
    }
    void flush() {
        while (count_ != 0) {
            bits(1, 1);
        }
    }
    static unsigned category(int value) {
        unsigned result = 0;
        for (int rest = std::abs(value); rest != 0; rest >>= 1) {
            ++result;
        }
        return result;
    }
    void difference(int value, unsigned run) {
        const unsigned size = category(value);
        bits(run << 4U | size, 9);
        if (size < 16) {
            bits(static_cast<unsigned>(value > 0 ? value : value + (1 << size) - 1), size);
        }
    }
    [[nodiscard]] std::string done() {
        flush();
        alone(0xD9);
        return out_;
    }

  private:
    void big(unsigned value) { out_ += {static_cast<char>(value >> 8U), static_cast<char>(value)}; }

    std::string out_ = "\xFF\xD8";
    unsigned held_ = 0;
    unsigned count_ = 0;
};

/// T.81, table H.1.
int predicted(std::span<const std::uint16_t> cells, std::size_t at, unsigned columns, unsigned predictor) {
    const int a = cells[at - 1];
    const int b = cells[at - columns];
    const int c = cells[at - columns - 1];
    switch (predictor) {
    case 1:
        return a;
    case 2:
        return b;
    case 3:
        return c;
    case 4:
        return a + b - c;
    case 5:
        return a + ((b - c) >> 1);
    case 6:
        return b + ((a - c) >> 1);
    default:
        return (a + b) >> 1;
    }
}

} // namespace

std::string jpegLosslessFrame(std::span<const std::uint16_t> cells, unsigned columns, unsigned bits, unsigned predictor,
                              unsigned restartRows) {
    JpegWriter jpeg;
    jpeg.frame(0xC3, bits, cells.size() / columns, columns);
    jpeg.tables(false);
    if (restartRows != 0) {
        jpeg.interval(restartRows * columns);
    }
    jpeg.marker(0xDA, std::string("\1\1\0", 3) + static_cast<char>(predictor) + std::string(2, '\0'));
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t row = i / columns;
        const bool begins = restartRows == 0 ? row == 0 : row % restartRows == 0;
        if (begins && row != 0 && i % columns == 0) {
            jpeg.flush();
            jpeg.alone(0xD0 + static_cast<unsigned>(row / restartRows - 1) % 8);
        }
        int guess = 0;
        if (begins) {
            guess = i % columns == 0 ? 1 << (bits - 1) : cells[i - 1];
        } else {
            guess = i % columns == 0 ? cells[i - columns] : predicted(cells, i, columns, predictor);
        }
        // Differences are modulo 2^16.
        int change = (cells[i] - guess) & 0xFFFF;
        change = change > 32768 ? change - 65536 : change;
        jpeg.difference(change, 0);
    }
    return jpeg.done();
}

std::string jpegFrame(std::span<const std::uint16_t> cells, unsigned columns, unsigned bits, unsigned restartBlocks) {
    constexpr std::array<int, 64> kZigzag{0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,
                                          12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6,  7,  14, 21, 28,
                                          35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,
                                          58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};
    const auto rows = static_cast<unsigned>(cells.size() / columns);
    JpegWriter jpeg;
    jpeg.marker(0xDB, std::string(1, '\0') + std::string(64, '\1'));
    jpeg.frame(bits == 8 ? 0xC0 : 0xC1, bits, rows, columns);
    jpeg.tables(true);
    if (restartBlocks != 0) {
        jpeg.interval(restartBlocks);
    }
    jpeg.marker(0xDA, std::string("\1\1\0\0\x3F\0", 6));
    const unsigned across = (columns + 7) / 8;
    int last = 0;
    for (unsigned block = 0; block < across * ((rows + 7) / 8); ++block) {
        if (restartBlocks != 0 && block != 0 && block % restartBlocks == 0) {
            jpeg.flush();
            jpeg.alone(0xD0 + (block / restartBlocks - 1) % 8);
            last = 0;
        }
        std::array<int, 64> waves{};
        for (unsigned v = 0; v < 8; ++v) {
            for (unsigned u = 0; u < 8; ++u) {
                double sum = 0;
                for (unsigned y = 0; y < 8; ++y) {
                    for (unsigned x = 0; x < 8; ++x) {
                        const unsigned column = std::min(block % across * 8 + x, columns - 1);
                        const unsigned row = std::min(block / across * 8 + y, rows - 1);
                        sum += (cells[row * columns + column] - (1 << (bits - 1))) *
                               std::cos((2 * x + 1) * u * std::numbers::pi / 16) *
                               std::cos((2 * y + 1) * v * std::numbers::pi / 16);
                    }
                }
                const double scale = (u == 0 ? std::sqrt(0.5) : 1) * (v == 0 ? std::sqrt(0.5) : 1) / 4;
                waves[8 * v + u] = static_cast<int>(std::lround(scale * sum));
            }
        }
        jpeg.difference(waves[0] - last, 0);
        last = waves[0];
        unsigned run = 0;
        for (std::size_t k = 1; k < 64; ++k) {
            const int value = waves[static_cast<std::size_t>(kZigzag[k])];
            if (value == 0) {
                ++run;
                continue;
            }
            for (; run > 15; run -= 16) {
                jpeg.bits(0xF0, 9);
            }
            jpeg.difference(value, run);
            run = 0;
        }
        if (run != 0) {
            jpeg.bits(0, 9);
        }
    }
    return jpeg.done();
}

} // namespace voxtact::test
