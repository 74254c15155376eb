// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_codecs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

/// JPEG-LS (ITU-T T.87) of one component, lossless and near-lossless; the names are those of the standard. CharLS 2.4,
/// which Debian has, never comes back from some damaged data.
namespace voxtact::io {

namespace {

constexpr unsigned kMarker = 0xFF;
constexpr unsigned kFrame = 0xF7;
constexpr unsigned kParameters = 0xF8;
constexpr unsigned kScan = 0xDA;
constexpr unsigned kInterval = 0xDD;

/// Lengths of runs per bit, as powers of two (J).
constexpr std::array<unsigned, 32> kRunBits{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,  2,  3,  3,  3,  3,
                                            4, 4, 5, 5, 6, 6, 7, 7, 8, 9, 10, 11, 12, 13, 14, 15};

Error damaged(const char* what) {
    return Error{ErrorCode::Format, 0, std::string("its JPEG-LS data is damaged or cut off (") + what + ")"};
}

/// Bits up to the next marker; a byte behind 0xFF has seven.
class BitReader {
  public:
    explicit BitReader(std::string_view bytes) : bytes_(bytes) {}

    unsigned take(unsigned count) {
        while (count_ < count) {
            next();
        }
        count_ -= count;
        return static_cast<unsigned>(held_ >> count_) & ((1U << count) - 1);
    }
    /// Returns true if more bits were read than exist.
    [[nodiscard]] bool isExhausted() const { return made_ > count_; }

  private:
    void next() {
        const unsigned value = at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_]) : kMarker;
        if (at_ == bytes_.size() || (behindMarker_ && value > 0x7F)) {
            held_ <<= 8U;
            count_ += 8;
            made_ += 8;
            return;
        }
        const unsigned bits = behindMarker_ ? 7 : 8;
        held_ = held_ << bits | value;
        count_ += bits;
        behindMarker_ = value == kMarker;
        ++at_;
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    std::uint64_t held_ = 0;
    unsigned count_ = 0;
    std::uint64_t made_ = 0;
    bool behindMarker_ = false;
};

struct Parameters {
    int maxval = 0;
    int near = 0;
    int t1 = 0;
    int t2 = 0;
    int t3 = 0;
    int reset = 64;
};

/// C.2.4.1.1: default parameters.
void fillIn(Parameters& p, unsigned precision) {
    p.maxval = p.maxval == 0 ? (1 << precision) - 1 : p.maxval;
    p.reset = p.reset == 0 ? 64 : p.reset;
    const auto clamp = [&p](int value, int least) { return value > p.maxval || value < least ? least : value; };
    const bool large = p.maxval >= 128;
    const int factor = large ? (std::min(p.maxval, 4095) + 128) / 256 : 256 / (p.maxval + 1);
    const auto basic = [&](int value, int shift, int least) {
        return large ? factor * (value - shift) + shift + (2 * shift - 1) * p.near
                     : std::max(least, value / factor + (2 * shift - 1) * p.near);
    };
    p.t1 = p.t1 == 0 ? clamp(basic(3, 2, 2), p.near + 1) : p.t1;
    p.t2 = p.t2 == 0 ? clamp(basic(7, 3, 3), p.t1) : p.t2;
    p.t3 = p.t3 == 0 ? clamp(basic(21, 4, 4), p.t2) : p.t3;
}

/// One scan.
class Scan {
  public:
    Scan(std::string_view bytes, const Parameters& p, const DicomImage& image, std::span<std::uint32_t> cells)
        : bits_(bytes), p_(p), image_(image), cells_(cells), step_(2 * p.near + 1),
          range_((p.maxval + 2 * p.near) / step_ + 1) {
        quantizedBits_ = static_cast<unsigned>(std::bit_width(static_cast<unsigned>(range_) - 1));
        const auto bits = std::max(2U, static_cast<unsigned>(std::bit_width(static_cast<unsigned>(p.maxval))));
        limit_ = 2 * (bits + std::max(8U, bits));
        contexts_.fill({std::max<std::int64_t>(2, (range_ + 32) / 64), 0, 0, 1, 0});
    }

    bool decode() {
        const std::size_t columns = image_.columns;
        // One before the line, one behind it.
        std::vector<int> above(columns + 2);
        std::vector<int> line(columns + 2);
        for (std::size_t y = 0; y < image_.rows; ++y) {
            above[columns + 1] = above[columns];
            line[0] = above[1];
            if (!decodeLine(above, line) || bits_.isExhausted()) {
                return false;
            }
            std::copy(line.begin() + 1, line.end() - 1, cells_.begin() + static_cast<std::ptrdiff_t>(y * columns));
            std::swap(above, line);
        }
        return true;
    }

  private:
    struct Context {
        std::int64_t a = 0;
        std::int64_t b = 0;
        int c = 0;
        int n = 1;
        int nn = 0; ///< run interruptions: how many were negative
    };

    bool decodeLine(const std::vector<int>& above, std::vector<int>& line) {
        for (std::size_t x = 1; x <= image_.columns;) {
            const int a = line[x - 1];
            const int b = above[x];
            const int c = above[x - 1];
            const int d = above[x + 1];
            if (std::abs(d - b) <= p_.near && std::abs(b - c) <= p_.near && std::abs(c - a) <= p_.near) {
                if (!run(above, line, x)) {
                    return false;
                }
                continue;
            }
            if (!regular(a, b, c, d, line[x])) {
                return false;
            }
            ++x;
        }
        return true;
    }

    [[nodiscard]] int quantized(int d) const {
        const int size = std::abs(d);
        const int level = size <= p_.near ? 0 : size < p_.t1 ? 1 : size < p_.t2 ? 2 : size < p_.t3 ? 3 : 4;
        return d < 0 ? -level : level;
    }

    /// A.5.1: Golomb's k.
    static unsigned golomb(std::int64_t a, int n) {
        unsigned k = 0;
        while (k < 31 && std::int64_t{n} << k < a) {
            ++k;
        }
        return k;
    }

    /// A.5.3: -1 for codes that no encoder writes.
    int mapped(unsigned k, unsigned limit) {
        unsigned high = 0;
        while (high < limit && bits_.take(1) == 0) {
            ++high;
        }
        if (high >= limit || k > 24) {
            return -1;
        }
        const std::int64_t value = high < limit - quantizedBits_ - 1 ? (std::int64_t{high} << k) + bits_.take(k)
                                                                     : std::int64_t{bits_.take(quantizedBits_)} + 1;
        return value > 2 * std::int64_t{range_} + 2 ? -1 : static_cast<int>(value);
    }

    /// A.8: brought back into the range, and to the steps of the near-lossless mode.
    [[nodiscard]] int reconstructed(int predicted, int error) const {
        int value = predicted + error * step_;
        if (value < -p_.near) {
            value += range_ * step_;
        } else if (value > p_.maxval + p_.near) {
            value -= range_ * step_;
        }
        return std::clamp(value, 0, p_.maxval);
    }

    bool regular(int a, int b, int c, int d, int& sample) {
        int q = 81 * quantized(d - b) + 9 * quantized(b - c) + quantized(c - a);
        const int sign = q < 0 ? -1 : 1;
        q = std::abs(q);
        Context& context = contexts_[static_cast<std::size_t>(q)];
        int predicted = a + b - c;
        if (c >= std::max(a, b)) {
            predicted = std::min(a, b);
        } else if (c <= std::min(a, b)) {
            predicted = std::max(a, b);
        }
        predicted = std::clamp(predicted + sign * context.c, 0, p_.maxval);
        const unsigned k = golomb(context.a, context.n);
        const int m = mapped(k, limit_);
        if (m < 0) {
            return false;
        }
        int error = m % 2 == 0 ? m / 2 : -(m + 1) / 2;
        if (p_.near == 0 && k == 0 && 2 * context.b <= -context.n) {
            error = m % 2 == 0 ? -m / 2 - 1 : (m - 1) / 2;
        }
        update(context, error);
        sample = reconstructed(predicted, sign * error);
        return true;
    }

    void update(Context& context, int error) const {
        context.b += std::int64_t{error} * step_;
        context.a += std::abs(error);
        if (context.n == p_.reset) {
            context.a >>= 1U;
            context.b = context.b >= 0 ? context.b / 2 : -((1 - context.b) / 2);
            context.n /= 2;
        }
        ++context.n;
        if (context.b <= -context.n) {
            context.b = std::max<std::int64_t>(context.b + context.n, 1 - context.n);
            context.c = std::max(context.c - 1, -128);
        } else if (context.b > 0) {
            context.b = std::min<std::int64_t>(context.b - context.n, 0);
            context.c = std::min(context.c + 1, 127);
        }
    }

    /// A.7: samples alike, and the one that ends them, if the line does not.
    bool run(const std::vector<int>& above, std::vector<int>& line, std::size_t& x) {
        const int value = line[x - 1];
        const std::size_t end = std::size_t{image_.columns} + 1;
        while (x < end && bits_.take(1) == 1) {
            const std::size_t length = std::size_t{1} << kRunBits[runIndex_];
            const std::size_t part = std::min(length, end - x);
            std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(x), part, value);
            x += part;
            runIndex_ += part == length && runIndex_ < 31 ? 1 : 0;
            if (bits_.isExhausted()) {
                return false;
            }
        }
        if (x == end) {
            return true;
        }
        const std::size_t rest = bits_.take(kRunBits[runIndex_]);
        if (rest >= end - x) {
            return false;
        }
        std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(x), rest, value);
        x += rest;
        if (!interruption(value, above[x], line[x])) {
            return false;
        }
        ++x;
        runIndex_ -= runIndex_ > 0 ? 1 : 0;
        return true;
    }

    bool interruption(int a, int b, int& sample) {
        const bool alike = std::abs(a - b) <= p_.near;
        Context& context = contexts_[alike ? 366 : 365];
        const unsigned k = golomb(context.a + (alike ? context.n / 2 : 0), context.n);
        const int m = mapped(k, limit_ - kRunBits[runIndex_] - 1);
        if (m < 0) {
            return false;
        }
        const int doubled = m + (alike ? 1 : 0);
        const bool odd = doubled % 2 == 1;
        const int size = (doubled + (odd ? 1 : 0)) / 2;
        const bool mostlyNegative = k != 0 || 2 * context.nn >= context.n;
        const int error = mostlyNegative == odd ? -size : size;
        context.nn += error < 0 ? 1 : 0;
        context.a += (m + 1 - (alike ? 1 : 0)) / 2;
        if (context.n == p_.reset) {
            context.a >>= 1U;
            context.n /= 2;
            context.nn /= 2;
        }
        ++context.n;
        const int sign = !alike && a > b ? -1 : 1;
        sample = reconstructed(alike ? a : b, sign * error);
        return true;
    }

    BitReader bits_;
    const Parameters& p_;
    const DicomImage& image_;
    std::span<std::uint32_t> cells_;
    int step_;
    int range_;
    unsigned quantizedBits_ = 0;
    unsigned limit_ = 0;
    unsigned runIndex_ = 0;
    std::array<Context, 367> contexts_;
};

class Decoder {
  public:
    Decoder(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells)
        : bytes_(bytes), image_(image), cells_(cells) {}

    Result<void> decode() {
        constexpr unsigned kStart = 0xFFD8;
        if (bytes_.size() < 4 || word(0) != kStart) {
            return damaged("it does not begin like one");
        }
        for (std::size_t at = 2;;) {
            if (at + 4 > bytes_.size() || byte(at) != kMarker) {
                return damaged("no marker where one should be");
            }
            const unsigned marker = byte(at + 1);
            const std::size_t end = at + 2 + word(at + 2);
            if (word(at + 2) < 2 || end > bytes_.size()) {
                return damaged("a segment longer than the data");
            }
            if (marker == kScan) {
                return scan(at + 4, end);
            }
            if (const char* wrong = segment(marker, at + 4, end); wrong != nullptr) {
                return damaged(wrong);
            }
            at = end;
        }
    }

  private:
    [[nodiscard]] unsigned byte(std::size_t at) const { return static_cast<unsigned char>(bytes_[at]); }
    [[nodiscard]] unsigned word(std::size_t at) const { return byte(at) << 8U | byte(at + 1); }

    /// Returns the error, or null.
    const char* segment(unsigned marker, std::size_t at, std::size_t end) {
        constexpr unsigned kFirstApplication = 0xE0;
        constexpr unsigned kComment = 0xFE;
        if (marker == kFrame) {
            return frame(at, end);
        }
        if (marker == kParameters) {
            if (end - at != 11 || byte(at) != 1) {
                return "tables of values are not supported";
            }
            const auto number = [&](std::size_t i) { return static_cast<int>(word(at + 1 + 2 * i)); };
            p_ = {number(0), 0, number(1), number(2), number(3), number(4)};
            return nullptr;
        }
        if (marker == kInterval) {
            return "restart intervals are not supported";
        }
        const bool known = (marker >= kFirstApplication && marker < kFirstApplication + 16) || marker == kComment;
        return known ? nullptr : "an unexpected marker";
    }

    const char* frame(std::size_t at, std::size_t end) {
        if (end - at != 9 || precision_ != 0 || word(at + 1) != image_.rows || word(at + 3) != image_.columns ||
            byte(at + 5) != 1) {
            return "another size than the file says";
        }
        precision_ = byte(at);
        if (precision_ < 2 || precision_ > 16 || precision_ > image_.bitsAllocated ||
            (image_.isSigned && precision_ < image_.bitsStored)) {
            return "a precision that does not fit";
        }
        return nullptr;
    }

    Result<void> scan(std::size_t at, std::size_t end) {
        if (precision_ == 0 || end - at != 6 || byte(at) != 1 || byte(at + 2) != 0 || byte(at + 4) != 0 ||
            byte(at + 5) != 0) {
            return damaged("a scan's parameters");
        }
        p_.near = static_cast<int>(byte(at + 3));
        fillIn(p_, precision_);
        if (p_.maxval >= 1 << precision_ || p_.near > p_.maxval / 2 || p_.t1 <= p_.near || p_.t2 < p_.t1 ||
            p_.t3 < p_.t2 || p_.t3 > p_.maxval || p_.reset < 3) {
            return damaged("its parameters");
        }
        return Scan(bytes_.substr(end), p_, image_, cells_).decode() ? Result<void>() : damaged("its pixels");
    }

    std::string_view bytes_;
    const DicomImage& image_;
    std::span<std::uint32_t> cells_;
    unsigned precision_ = 0;
    Parameters p_;
};

} // namespace

Result<void> decodeJpegLs(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells) {
    return Decoder(bytes, image, cells).decode();
}

} // namespace voxtact::io
