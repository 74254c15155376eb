// SPDX-License-Identifier: MIT
#include "viewer/model/shown/pace.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

constexpr double kLeastCost = 1e-7;
constexpr double kMostCost = 1;
constexpr double kLeastScale = 1.0 / 12;

/// Upwards at once, so that one slow frame is not followed by another; downwards by halves.
void learn(double& cost, double pixels, double milliseconds) {
    if (!(pixels >= 1) || !(milliseconds >= 0)) {
        return;
    }
    const double measured = std::clamp(milliseconds / pixels, kLeastCost, kMostCost);
    cost = measured > cost ? measured : (cost + measured) / 2;
}

} // namespace

void Pace::tookCoarse(double pixels, double milliseconds) {
    learn(coarseCost_, pixels, milliseconds);
}

void Pace::tookFine(double pixels, double milliseconds) {
    learn(fineCost_, pixels, milliseconds);
}

Extent Pace::coarse(const Extent& full) const {
    const double pixels = static_cast<double>(full.width) * full.height;
    double scale = std::clamp(std::sqrt(budget_ / coarseCost_ / pixels), kLeastScale, 1.0);
    // In steps: a picture whose size changes with each frame flickers.
    constexpr double kSteps = 12;
    scale = std::floor(scale * kSteps + 1e-9) / kSteps;
    const auto side = [scale](std::uint32_t length) {
        return std::max<std::uint32_t>(static_cast<std::uint32_t>(std::lround(scale * length)), 1);
    };
    return {side(full.width), side(full.height)};
}

std::uint32_t Pace::rows(const Extent& full) const {
    const double rows = budget_ / fineCost_ / full.width;
    return static_cast<std::uint32_t>(std::clamp(rows, 1.0, static_cast<double>(full.height)));
}

SampledPart sampledPart(const Extent& picture, const Extent& texture) {
    const auto width = static_cast<float>(texture.width);
    const auto height = static_cast<float>(texture.height);
    const auto right = static_cast<float>(picture.width);
    const auto bottom = static_cast<float>(picture.height);
    constexpr float kHalf = 0.5F; // from the middle of a texel to its edge
    return {{right / width, bottom / height}, {(right - kHalf) / width, (bottom - kHalf) / height}};
}

} // namespace voxtact::view
