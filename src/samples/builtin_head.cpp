// SPDX-License-Identifier: MIT
#include "samples/builtin_head.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

struct Ellipsoid {
    Vec3 centre;
    Vec3 radii;
};

constexpr Ellipsoid kScalp{{0, 4, 4}, {72, 88, 86}};
constexpr Ellipsoid kNose{{0, -80, -12}, {9, 14, 17}};
constexpr Ellipsoid kEar{{71, 8, -8}, {8, 13, 20}};
constexpr Ellipsoid kSkull{{0, 4, 4}, {66, 82, 80}};
constexpr Ellipsoid kCavity{{0, 4, 4}, {58, 74, 72}};
constexpr Ellipsoid kBrain{{0, 4, 4}, {55, 71, 69}};
constexpr Ellipsoid kVentricle{{11, 8, 10}, {5, 26, 9}};
constexpr Ellipsoid kEye{{27, -64, -8}, {12, 12, 12}};
constexpr Ellipsoid kSinus{{0, -70, -26}, {9, 10, 12}};
constexpr Ellipsoid kPetrousBone{{36, 18, -30}, {10, 8, 13}};

constexpr double kFoldSize = 11;
constexpr double kFoldDepth = 28; // below it, no fold is open or near
constexpr double kOpenness = 0.25;
constexpr double kClosing = 0.035; // per mm
constexpr double kCortex = 3.5;

/// Exact on the surface and first order near it, negative inside.
double signedDistance(const Ellipsoid& shape, const Vec3& p) {
    double scaled = 0;
    double gradient = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double q = (p[axis] - shape.centre[axis]) / shape.radii[axis];
        scaled += q * q;
        gradient += q * q / (shape.radii[axis] * shape.radii[axis]);
    }
    if (gradient == 0) {
        return -std::min({shape.radii[0], shape.radii[1], shape.radii[2]});
    }
    const double length = std::sqrt(scaled);
    return length * (length - 1) / std::sqrt(gradient);
}

} // namespace

double BuiltinHead::mix(double outside, double inside, double distance) const noexcept {
    return outside + (inside - outside) * std::clamp(0.5 - distance / blur_, 0.0, 1.0);
}

double BuiltinHead::brainAt(const Vec3& world, double depth) const noexcept {
    double toFluid = depth;
    if (depth < kFoldDepth) {
        const double noise = folds_.at({world[0] / kFoldSize, world[1] / kFoldSize, world[2] / kFoldSize});
        const double openness = kOpenness - kClosing * depth;
        toFluid = std::min(toFluid, (std::abs(2 * noise - 1) - openness) * (kFoldSize / 2));
    }
    const double fissure = std::max(std::abs(world[0]) - 1.2, 14 - world[2]);
    toFluid = std::min(toFluid, fissure);
    const double cortex = mix(tissues_.grey, tissues_.white, kCortex - toFluid);
    return mix(tissues_.fluid, cortex, -toFluid);
}

double BuiltinHead::at(const Vec3& world) const noexcept {
    const Vec3 mirrored{std::abs(world[0]), world[1], world[2]};
    const double scalp =
        std::min({signedDistance(kScalp, mirrored), signedDistance(kNose, mirrored), signedDistance(kEar, mirrored)});
    if (scalp > blur_) {
        return tissues_.air;
    }
    double value = mix(tissues_.air, tissues_.skin, scalp);
    value = mix(value, tissues_.bone, signedDistance(kSkull, mirrored));
    value = mix(value, tissues_.fluid, signedDistance(kCavity, mirrored));
    const double brain = signedDistance(kBrain, mirrored);
    if (brain < blur_) {
        value = mix(value, brainAt(world, std::max(0.0, -brain)), brain);
    }
    value = mix(value, tissues_.fluid, signedDistance(kVentricle, mirrored));
    value = mix(value, tissues_.fluid, signedDistance(kEye, mirrored));
    value = mix(value, tissues_.air, signedDistance(kSinus, mirrored));
    return mix(value, tissues_.densest, signedDistance(kPetrousBone, mirrored));
}

} // namespace voxtact
