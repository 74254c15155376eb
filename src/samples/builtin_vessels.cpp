// SPDX-License-Identifier: MIT
#include "samples/builtin_vessels.h"
#include "core/geometry/vec3.h"

#include "samples/value_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace voxtact {

namespace {

constexpr Vec3 kRoot{0, 0, -100};
constexpr Vec3 kUp{0, 0, 1};
constexpr double kTrunkLength = 46;
constexpr double kTrunkRadius = 15;
constexpr std::uint32_t kVessels = 255; ///< eight generations; those of number n are 2n and 2n+1
/// Relative to the parent vessel. The radius follows Murray's law: the cubes of two branches add up to that of the
/// trunk.
constexpr double kShorter = 0.84;
constexpr double kThinner = 0.7937;
/// Relative to the angle of the parent vessel.
constexpr double kCosine = 0.8;
constexpr double kSine = 0.6;

/// A unit vector at right angles to `direction`, by the number of a vessel. Square roots only: sine and cosine differ
/// from library to library.
Vec3 sideways(const Vec3& direction, std::uint32_t number, const ValueNoise& random) {
    Vec3 any{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        any[axis] = 2 * random.at({static_cast<double>(number), static_cast<double>(axis), 0}) - 1;
    }
    return unit(step(any, direction, -dot(any, direction)));
}

struct Span {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// The voxels of an axis whose centres are within [lo, hi].
Span voxelsWithin(const Grid& grid, std::size_t axis, double lo, double hi) {
    const double last = grid.size[axis];
    const double begin = std::ceil((lo - grid.origin[axis]) / grid.spacing[axis]);
    const double end = std::floor((hi - grid.origin[axis]) / grid.spacing[axis]) + 1;
    return {static_cast<std::uint32_t>(std::clamp(begin, 0.0, last)),
            static_cast<std::uint32_t>(std::clamp(end, 0.0, last))};
}

/// 0 from twice the radius on.
double valueAt(const Vessel& vessel, const Vec3& world) {
    const Vec3 axis = step(vessel.to, vessel.from, -1);
    const double t = std::clamp(dot(step(world, vessel.from, -1), axis) / dot(axis, axis), 0.0, 1.0);
    const Vec3 away = step(world, step(vessel.from, axis, t), -1);
    const double radius = vessel.fromRadius + (vessel.toRadius - vessel.fromRadius) * t;
    return 255 * std::max(0.0, 1 - dot(away, away) / (4 * radius * radius));
}

void drawVessel(const Vessel& vessel, VolumeData& volume) {
    const Grid& grid = volume.grid;
    const double reach = 2 * std::max(vessel.fromRadius, vessel.toRadius);
    std::array<Span, 3> box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [lo, hi] = std::minmax(vessel.from[axis], vessel.to[axis]);
        box[axis] = voxelsWithin(grid, axis, lo - reach, hi + reach);
    }
    for (std::size_t z = box[2].begin; z < box[2].end; ++z) {
        for (std::size_t y = box[1].begin; y < box[1].end; ++y) {
            std::byte* const row = volume.voxels.data() + (z * grid.size[1] + y) * grid.size[0];
            for (std::size_t x = box[0].begin; x < box[0].end; ++x) {
                const Vec3 world{grid.origin[0] + static_cast<double>(x) * grid.spacing[0],
                                 grid.origin[1] + static_cast<double>(y) * grid.spacing[1],
                                 grid.origin[2] + static_cast<double>(z) * grid.spacing[2]};
                row[x] = std::max(row[x], static_cast<std::byte>(std::floor(valueAt(vessel, world) + 0.5)));
            }
        }
    }
}

} // namespace

std::vector<Vessel> vesselTree() {
    const ValueNoise random(0x7eeeU);
    std::vector<Vessel> vessels{{kRoot, step(kRoot, kUp, kTrunkLength), kTrunkRadius, kTrunkRadius * kThinner}};
    std::vector<double> lengths{kTrunkLength};
    for (std::uint32_t number = 2; number <= kVessels; ++number) {
        const Vessel& before = vessels[number / 2 - 1];
        const Vec3 direction = unit(step(before.to, before.from, -1));
        // Two branches part in opposite directions.
        const Vec3 side = sideways(direction, number / 2, random);
        const Vec3 turned = step({direction[0] * kCosine, direction[1] * kCosine, direction[2] * kCosine}, side,
                                 number % 2 == 0 ? kSine : -kSine);
        const double length = lengths[number / 2 - 1] * kShorter;
        lengths.push_back(length);
        vessels.push_back({before.to, step(before.to, turned, length), before.toRadius, before.toRadius * kThinner});
    }
    return vessels;
}

void drawVessels(const std::vector<Vessel>& vessels, VolumeData& volume) {
    for (const Vessel& vessel : vessels) {
        drawVessel(vessel, volume);
    }
}

} // namespace voxtact
