// SPDX-License-Identifier: MIT
#include "app/render/colours.h"

namespace voxtact::app {

namespace {

constexpr ColourPoint kCtColours[] = {{-300, {0.85, 0.55, 0.42}}, {0, {0.85, 0.50, 0.40}},   {80, {0.75, 0.30, 0.25}},
                                      {180, {0.90, 0.80, 0.62}},  {400, {0.96, 0.92, 0.80}}, {1500, {1, 1, 0.95}}};
constexpr ControlPoint kCtOpacity[] = {{-500, 0}, {-200, 0.012}, {60, 0.02}, {150, 0.03}, {260, 0.6}, {600, 0.95}};

/// Values here are fractions.
constexpr ColourPoint kMrColours[] = {
    {0.12, {0.78, 0.52, 0.42}}, {0.30, {0.86, 0.64, 0.52}}, {0.55, {0.93, 0.80, 0.68}}, {1, {1, 0.97, 0.90}}};
constexpr ControlPoint kMrOpacity[] = {{0.12, 0}, {0.22, 0.12}, {0.32, 0.45}, {0.6, 0.7}, {1, 0.8}};

} // namespace

Look lookNamed(const std::string& preset, const ValueRange& values) {
    if (preset == "ct") {
        return {{std::begin(kCtOpacity), std::end(kCtOpacity)}, {std::begin(kCtColours), std::end(kCtColours)}};
    }
    Look look;
    const auto valueAt = [&](double fraction) { return values.lo + fraction * (values.hi - values.lo); };
    for (const ControlPoint& point : kMrOpacity) {
        look.opacity.push_back({valueAt(point.value), point.opacity});
    }
    for (const ColourPoint& point : kMrColours) {
        look.colours.push_back({valueAt(point.value), point.colour});
    }
    return look;
}

std::vector<ColourPoint> plainColours() {
    return {{0, {0.92, 0.86, 0.80}}};
}

} // namespace voxtact::app
