// SPDX-License-Identifier: MIT
#include "view/model/answers/live_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::view {

const PairClearance* LiveClearance::of(std::size_t mesh) const noexcept {
    const auto at = std::ranges::find_if(meshes, [mesh](const MeshClearance& one) { return one.mesh == mesh; });
    return at == meshes.end() ? nullptr : &at->pair;
}

std::string clearanceText(const PairClearance& clearance) {
    const auto& [lo, hi] = clearance.bounds;
    if (std::isinf(lo)) {
        return "nothing is opaque";
    }
    if (hi == 0) {
        return "touches";
    }
    char text[64];
    if (std::isinf(hi)) {
        std::snprintf(text, sizeof text, "at least %.4g mm away", lo);
    } else {
        std::snprintf(text, sizeof text, "%.2f to %.2f mm away", lo, hi);
    }
    return text;
}

std::optional<std::array<Vec3, 2>> closestSegment(const PairClearance& clearance) noexcept {
    if (!clearance.closest || clearance.bounds.hi == 0) {
        return std::nullopt;
    }
    return std::array{clearance.closest->mesh, clearance.closest->volume};
}

double distanceOfPlane(const std::array<Vec3, 2>& segment, std::size_t axis, double at) noexcept {
    const auto [lo, hi] = std::minmax(segment[0][axis], segment[1][axis]);
    return std::max({lo - at, at - hi, 0.0});
}

} // namespace voxtact::view
