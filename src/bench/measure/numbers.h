// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Statistics of samples, and formats of numbers.
namespace voxtact::lab {

/// Repeated measurements of one thing.
struct Spread {
    double median = 0;
    double min = 0;
    double max = 0;
    double p10 = 0;
    double p90 = 0;
};

/// Linear between the two nearest ranks. `samples` must not be empty.
[[nodiscard]] Spread spreadOf(std::vector<double> samples);
[[nodiscard]] double medianOf(const std::vector<double>& samples);
/// Returns the quantile `part`, 0..1, of the samples; linear, too.
[[nodiscard]] double quantileOf(std::vector<double> samples, double part);

/// A confidence interval of the median, for any distribution of the samples.
struct MedianInterval {
    double low = 0;
    double high = 0;
    double confidence = 0; ///< reached, 0..1: at least the requested one
};

/// From the smallest interval between two samples of mirrored ranks whose confidence, by the sign test, is
/// `confidence`. Nothing where there are too few samples: six for 0.95.
[[nodiscard]] std::optional<MedianInterval> medianInterval(std::vector<double> samples, double confidence);

/// Formats a time that may be unknown.
inline void keep(const std::optional<double>& time, std::vector<double>& samples) {
    if (time) {
        samples.push_back(*time);
    }
}

/// Returns the percentage of a whole, rounded(); empty if the whole is 0.
[[nodiscard]] std::optional<double> percentOf(std::uint64_t part, std::uint64_t whole);

/// Said where it makes agreement a small thing.
inline constexpr const char* kNothingTouches = "no pose touches: agreement means little";

/// Six significant digits: more would be noise. 0 if not finite.
[[nodiscard]] double rounded(double value);
/// Three significant digits, without an exponent.
[[nodiscard]] std::string shortNumber(double value);
/// 12,345
[[nodiscard]] std::string grouped(std::uint64_t value);
/// "181x217x181"
[[nodiscard]] std::string sizeText(const std::array<std::uint32_t, 3>& voxels);
/// One text of several pieces: texts, and whole numbers.
template <class... Pieces> [[nodiscard]] std::string concat(const Pieces&... pieces) {
    std::string all;
    const auto add = [&all](const auto& piece) {
        if constexpr (std::integral<std::remove_cvref_t<decltype(piece)>>) {
            all += std::to_string(piece);
        } else {
            all += piece;
        }
    };
    (add(pieces), ...);
    return all;
}
/// "1 thread", "2 threads"
[[nodiscard]] inline std::string counted(std::uint64_t count, const char* unit) {
    return concat(count, " ", unit, count == 1 ? "" : "s");
}
/// With something between each two.
[[nodiscard]] std::string joined(const std::vector<std::string>& texts, const char* between);
/// "a, b and c"
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

} // namespace voxtact::lab
