// SPDX-License-Identifier: MIT
#include "viewer/model/answers/live_measures.h"

#include "core/base/infinity.h"
#include "core/base/outward.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::view {

namespace {

/// Hundredths of a millimetre; for short distances two significant digits.
int decimalsOf(double mm) {
    constexpr int kLeast = 2;
    constexpr int kMost = 6; // a nanometre
    return mm > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(mm))), kLeast, kMost) : kLeast;
}

std::string written(double mm, int decimals) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, mm);
    return text;
}

} // namespace

const MeshMeasures* LiveMeasures::of(std::size_t mesh) const noexcept {
    const auto at = std::ranges::find_if(meshes, [mesh](const MeshMeasures& one) { return one.mesh == mesh; });
    return at == meshes.end() ? nullptr : &*at;
}

bool LiveMeasures::hasAreas() const noexcept {
    return std::ranges::all_of(meshes, [](const MeshMeasures& one) { return one.area.has_value(); });
}

std::string lowerText(double mm) {
    const int decimals = decimalsOf(mm);
    return written(lowerRounded(mm, std::pow(10, decimals)), decimals);
}

std::string upperText(double mm) {
    const int decimals = decimalsOf(mm);
    return written(upperRounded(mm, std::pow(10, decimals)), decimals);
}

std::string measuresText(const MeshMeasures& measured) {
    const auto& [lo, hi] = measured.pair.bounds;
    if (std::isinf(lo)) {
        return "nothing is opaque";
    }
    if (hi == 0) {
        const Bounds area = measured.area ? measured.area->bounds : Bounds();
        const bool isKnown = area.upper > 0 && area.upper < kInfinity;
        return (isKnown ? lowerText(area.lower) + " to " + upperText(area.upper) + " mm\u00b2 touch" : "touches");
    }
    return (std::isinf(hi) ? "at least " + lowerText(lo) : lowerText(lo) + " to " + upperText(hi)) + " mm away";
}

std::string overlapText(const MeshMeasures& measured) {
    if (!measured.overlap) {
        return {};
    }
    const auto& [lower, upper] = measured.overlap->bounds;
    if (upper == 0) {
        return "nothing opaque inside";
    }
    const double share = std::floor(100 * lower / measured.overlap->solid.upper);
    return lowerText(lower) + " to " + upperText(upper) + " mm\u00b3 inside, at least " + written(share, 0) + " %";
}

std::optional<std::array<Vec3, 2>> closestSegment(const PairDistance& pair) noexcept {
    if (!pair.closest || pair.bounds.upper == 0) {
        return std::nullopt;
    }
    return std::array{pair.closest->mesh, pair.closest->volume};
}

double distanceOfPlane(const std::array<Vec3, 2>& segment, std::size_t axis, double at) noexcept {
    const auto [lo, hi] = std::minmax(segment[0][axis], segment[1][axis]);
    return std::max({lo - at, at - hi, 0.0});
}

} // namespace voxtact::view
