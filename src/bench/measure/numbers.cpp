// SPDX-License-Identifier: MIT
#include "bench/measure/numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::lab {

namespace {

double quantile(const std::vector<double>& sorted, double part) {
    const double at = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(at));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (sorted[above] - sorted[below]) * (at - std::floor(at));
}

} // namespace

Spread spreadOf(std::vector<double> samples) {
    std::sort(samples.begin(), samples.end());
    return {.median = quantile(samples, 0.5),
            .min = samples.front(),
            .max = samples.back(),
            .p10 = quantile(samples, 0.1),
            .p90 = quantile(samples, 0.9)};
}

double quantileOf(std::vector<double> samples, double part) {
    std::sort(samples.begin(), samples.end());
    return quantile(samples, part);
}

double medianOf(const std::vector<double>& samples) {
    return spreadOf(samples).median;
}

std::optional<MedianInterval> medianInterval(std::vector<double> samples, double confidence) {
    std::sort(samples.begin(), samples.end());
    const auto count = static_cast<double>(samples.size());
    std::optional<MedianInterval> interval;
    // Each sample is below the median with probability 1/2. `beyond`: that at most `rank` of them are. Logarithms,
    // because the first of these probabilities is too small for a double where there are a thousand samples.
    double logarithm = -count * std::log(2.0);
    double beyond = std::exp(logarithm);
    for (std::size_t rank = 0; 2 * rank + 1 < samples.size() && 1 - 2 * beyond >= confidence; ++rank) {
        interval = {samples[rank], samples[samples.size() - 1 - rank], 1 - 2 * beyond};
        const auto at = static_cast<double>(rank);
        logarithm += std::log((count - at) / (at + 1));
        beyond += std::exp(logarithm);
    }
    return interval;
}

std::optional<double> percentOf(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? std::nullopt
                      : std::optional(rounded(100.0 * static_cast<double>(part) / static_cast<double>(whole)));
}

double rounded(double value) {
    if (value == 0 || !std::isfinite(value)) {
        return 0;
    }
    const double parts = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
    return std::round(value * parts) / parts;
}

std::string shortNumber(double value) {
    if (std::abs(value) < 1e-9 || !std::isfinite(value)) {
        return "0";
    }
    // Digits after the point that make three in all.
    const int digits = std::max(0, 2 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
    char text[64];
    static_cast<void>(std::snprintf(text, sizeof text, "%.*f", digits, value));
    return text;
}

std::string grouped(std::uint64_t value) {
    std::string text = std::to_string(value);
    for (std::size_t at = text.size(); at > 3; at -= 3) {
        text.insert(at - 3, ",");
    }
    return text;
}

std::string sizeText(const std::array<std::uint32_t, 3>& voxels) {
    return concat(voxels[0], "x", voxels[1], "x", voxels[2]);
}

std::string joined(const std::vector<std::string>& texts, const char* between) {
    std::string all;
    for (const std::string& text : texts) {
        all += (&text == texts.data() ? "" : between) + text;
    }
    return all;
}

std::string listed(const std::vector<std::string>& names) {
    if (names.size() < 2) {
        return joined(names, "");
    }
    return joined({names.begin(), names.end() - 1}, ", ") + " and " + names.back();
}

} // namespace voxtact::lab
