// SPDX-License-Identifier: MIT
#include "viewer/model/shown/chart_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::view {

ValueRange zoomed(const ValueRange& shown, const ValueRange& whole, double factor, double about) noexcept {
    constexpr double kLeast = 1e-5;
    const double all = whole.hi - whole.lo;
    const double before = shown.hi - shown.lo;
    const double width = std::clamp(before * factor, all * kLeast, all);
    const double share = std::clamp((about - shown.lo) / before, 0.0, 1.0);
    // Exactly the whole where it is that wide.
    const double lo = std::clamp(about - share * width, whole.lo, std::max(whole.hi - width, whole.lo));
    return width >= all ? whole : ValueRange{lo, std::min(lo + width, whole.hi)};
}

ValueRange panned(const ValueRange& shown, const ValueRange& whole, double by) noexcept {
    const double within = std::clamp(by, whole.lo - shown.lo, std::max(whole.hi - shown.hi, whole.lo - shown.lo));
    return {shown.lo + within, shown.hi + within};
}

std::vector<double> axisTicks(const ValueRange& shown, std::size_t most) {
    const double width = shown.hi - shown.lo;
    const double least = width / static_cast<double>(std::max<std::size_t>(most, 1));
    const double power = std::pow(10, std::floor(std::log10(least)));
    constexpr std::array<double, 4> kTimes{1, 2, 5, 10};
    for (const double times : kTimes) {
        const double step = times * power;
        const double first = std::ceil(shown.lo / step);
        const double last = std::floor(shown.hi / step);
        if (last - first + 1 > static_cast<double>(most)) {
            continue;
        }
        std::vector<double> out;
        for (double number = first; number <= last; ++number) {
            out.push_back(number * step);
        }
        return out;
    }
    return {};
}

} // namespace voxtact::view
