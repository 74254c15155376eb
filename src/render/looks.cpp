// SPDX-License-Identifier: MIT
#include "voxtact/looks.h"
#include "core/base/refuse.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace voxtact {

namespace {

// Hounsfield units.

/// Skin translucent, bone solid.
constexpr ColourPoint kCtColours[] = {{-300, {0.85, 0.55, 0.42}}, {0, {0.85, 0.50, 0.40}},   {80, {0.75, 0.30, 0.25}},
                                      {180, {0.90, 0.80, 0.62}},  {400, {0.96, 0.92, 0.80}}, {1500, {1, 1, 0.95}}};
constexpr ControlPoint kCtOpacity[] = {{-500, 0}, {-200, 0.012}, {60, 0.02}, {150, 0.03}, {260, 0.6}, {600, 0.95}};

/// Bone alone.
constexpr ColourPoint kCtBoneColours[] = {
    {150, {0.72, 0.45, 0.33}}, {260, {0.88, 0.75, 0.58}}, {500, {0.95, 0.90, 0.78}}, {1500, {1, 1, 0.96}}};
constexpr ControlPoint kCtBoneOpacity[] = {{150, 0}, {220, 0.1}, {320, 0.6}, {700, 0.95}};

/// Skin and deeper tissue, solid: for cuts.
constexpr ColourPoint kCtSoftColours[] = {{-250, {0.84, 0.62, 0.50}}, {-80, {0.88, 0.68, 0.53}},
                                          {10, {0.82, 0.53, 0.43}},   {80, {0.73, 0.35, 0.29}},
                                          {200, {0.88, 0.74, 0.60}},  {500, {0.97, 0.94, 0.86}}};
constexpr ControlPoint kCtSoftOpacity[] = {{-320, 0}, {-220, 0.4}, {0, 0.7}, {100, 0.85}, {400, 0.95}};

/// Contrast medium red, bone behind it.
constexpr ColourPoint kCtVesselColours[] = {{130, {0.60, 0.08, 0.06}},
                                            {200, {0.82, 0.14, 0.10}},
                                            {320, {0.93, 0.32, 0.20}},
                                            {450, {0.93, 0.82, 0.66}},
                                            {900, {0.98, 0.95, 0.88}}};
constexpr ControlPoint kCtVesselOpacity[] = {{130, 0}, {190, 0.25}, {300, 0.6}, {600, 0.8}};

/// The lung's own tissue as a haze, its vessels and airways' walls in it, and bone as a shade.
constexpr ColourPoint kCtLungColours[] = {{-950, {0.35, 0.50, 0.72}}, {-800, {0.55, 0.66, 0.82}},
                                          {-600, {0.86, 0.60, 0.55}}, {-400, {0.90, 0.42, 0.36}},
                                          {200, {0.90, 0.84, 0.74}},  {800, {1, 0.98, 0.92}}};
constexpr ControlPoint kCtLungOpacity[] = {{-950, 0},    {-880, 0.008}, {-720, 0.02}, {-560, 0.12},
                                           {-380, 0.10}, {-250, 0},     {250, 0},     {700, 0.03}};

// Fractions of the values' range.

constexpr ColourPoint kMrColours[] = {
    {0.12, {0.78, 0.52, 0.42}}, {0.30, {0.86, 0.64, 0.52}}, {0.55, {0.93, 0.80, 0.68}}, {1, {1, 0.97, 0.90}}};
constexpr ControlPoint kMrOpacity[] = {{0.12, 0}, {0.22, 0.12}, {0.32, 0.45}, {0.6, 0.7}, {1, 0.8}};

/// All that is not air, solid.
constexpr ColourPoint kMrSkinColours[] = {
    {0.08, {0.76, 0.53, 0.43}}, {0.25, {0.88, 0.68, 0.56}}, {0.6, {0.95, 0.82, 0.72}}, {1, {1, 0.94, 0.88}}};
constexpr ControlPoint kMrSkinOpacity[] = {{0.08, 0}, {0.16, 0.5}, {0.3, 0.9}, {1, 0.95}};

/// Bright tissue of a T1 image: white matter solid, gray matter around it, the rest of the head a haze.
constexpr ColourPoint kMrBrainColours[] = {{0.2, {0.55, 0.42, 0.40}},
                                           {0.38, {0.74, 0.52, 0.50}},
                                           {0.5, {0.86, 0.70, 0.64}},
                                           {0.65, {0.97, 0.92, 0.86}},
                                           {1, {1, 1, 0.98}}};
constexpr ControlPoint kMrBrainOpacity[] = {{0.24, 0}, {0.34, 0.03}, {0.44, 0.18}, {0.58, 0.6}, {1, 0.8}};

constexpr LookPreset kPresets[] = {
    {"mr", false, std::nullopt},
    {"mr-skin", false, std::nullopt},
    {"mr-brain", false, std::nullopt},
    {"ct", true, ValueRange{-160, 240}},
    {"ct-bone", true, ValueRange{-450, 1050}},
    {"ct-soft", true, ValueRange{-160, 240}},
    {"ct-vessels", true, ValueRange{-100, 500}},
    {"ct-lung", true, ValueRange{-1350, 150}},
};

struct Points {
    std::span<const ControlPoint> opacity;
    std::span<const ColourPoint> colours;
};

/// In the order of kPresets.
constexpr Points kPoints[] = {{kMrOpacity, kMrColours},
                              {kMrSkinOpacity, kMrSkinColours},
                              {kMrBrainOpacity, kMrBrainColours},
                              {kCtOpacity, kCtColours},
                              {kCtBoneOpacity, kCtBoneColours},
                              {kCtSoftOpacity, kCtSoftColours},
                              {kCtVesselOpacity, kCtVesselColours},
                              {kCtLungOpacity, kCtLungColours}};
static_assert(std::size(kPoints) == std::size(kPresets));

} // namespace

std::span<const LookPreset> lookPresets() noexcept {
    return kPresets;
}

const LookPreset* findLookPreset(std::string_view name) noexcept {
    const auto* found = std::ranges::find_if(kPresets, [&](const LookPreset& preset) { return name == preset.name; });
    return found != std::end(kPresets) ? found : nullptr;
}

Result<Look> lookNamed(std::string_view name, const ValueRange& values) {
    const LookPreset* preset = findLookPreset(name);
    if (preset == nullptr) {
        std::string names;
        for (const LookPreset& one : kPresets) {
            names += (names.empty() ? "" : ", ") + std::string(one.name);
        }
        return refuse("there is no look named \"" + std::string(name) + "\": take one of " + names);
    }
    const Points& points = kPoints[preset - std::begin(kPresets)];
    Look look{{points.opacity.begin(), points.opacity.end()}, {points.colours.begin(), points.colours.end()}};
    if (preset->hounsfield) {
        return look;
    }
    if (!std::isfinite(values.lo) || !std::isfinite(values.hi) || values.lo > values.hi) {
        return refuse("values: the ends of the range are not finite, or not ascending");
    }
    const auto valueAt = [&](double fraction) { return values.lo + fraction * (values.hi - values.lo); };
    for (ControlPoint& point : look.opacity) {
        point.value = valueAt(point.value);
    }
    for (ColourPoint& point : look.colours) {
        point.value = valueAt(point.value);
    }
    return look;
}

std::vector<ColourPoint> plainColours() {
    return {{0, {0.92, 0.86, 0.80}}};
}

} // namespace voxtact
