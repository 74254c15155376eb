// SPDX-License-Identifier: MIT
#include "render/render_impl.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

/// An opacity of 1 would have an infinite extinction.
constexpr double kMostOpacity = 0.999;
/// Steps of the midpoint rule between two entries.
constexpr int kParts = 16;

using Sample = std::array<double, 4>; ///< extinction times colour, extinction; 1/mm

Sample sampleAt(const std::array<std::vector<float>, 4>& channels, double opacityUnit, std::size_t entry,
                double weight) {
    const auto at = [&](std::size_t channel) {
        const double below = channels[channel][entry];
        return weight == 0 ? below : below + (channels[channel][entry + 1] - below) * weight;
    };
    const double extinction = -std::log1p(-std::min(at(3), kMostOpacity)) / opacityUnit;
    return {extinction * at(0), extinction * at(1), extinction * at(2), extinction};
}

} // namespace

std::vector<float> extinctionIntegrals(const std::array<std::vector<float>, 4>& channels, double opacityUnit) {
    const std::size_t entries = channels[3].size();
    std::vector<float> out;
    out.reserve(8 * entries);
    const auto append = [&out](const Sample& sample) {
        for (const double value : sample) {
            out.push_back(static_cast<float>(value));
        }
    };
    Sample sum{};
    append(sum);
    for (std::size_t entry = 0; entry + 1 < entries; ++entry) {
        for (int part = 0; part < kParts; ++part) {
            const Sample sample = sampleAt(channels, opacityUnit, entry, (part + 0.5) / kParts);
            for (std::size_t i = 0; i < sum.size(); ++i) {
                sum[i] += sample[i] / kParts;
            }
        }
        append(sum);
    }
    for (std::size_t entry = 0; entry < entries; ++entry) {
        append(sampleAt(channels, opacityUnit, entry, 0));
    }
    return out;
}

} // namespace voxtact
