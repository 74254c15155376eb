// SPDX-License-Identifier: MIT
#include "samples/value_noise.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace voxtact {

namespace {

std::uint32_t mixBits(std::uint32_t bits) {
    bits ^= bits >> 16;
    bits *= 0x7feb352dU;
    bits ^= bits >> 15;
    bits *= 0x846ca68bU;
    return bits ^ (bits >> 16);
}

double blend(double a, double b, double t) {
    return a + (b - a) * t;
}

} // namespace

double ValueNoise::at(const Vec3& point) const noexcept {
    std::array<std::array<std::uint32_t, 2>, 3> lattice{};
    Vec3 weight{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double whole = std::floor(point[axis]);
        const double t = point[axis] - whole;
        weight[axis] = t * t * t * (t * (t * 6 - 15) + 10);
        const auto low = static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
        lattice[axis] = {low, low + 1};
    }
    std::array<double, 2> planes{};
    for (std::size_t k = 0; k < 2; ++k) {
        const std::uint32_t hashZ = mixBits(lattice[2][k] + seed_);
        std::array<double, 2> lines{};
        for (std::size_t j = 0; j < 2; ++j) {
            const std::uint32_t hashYZ = mixBits(lattice[1][j] + hashZ);
            lines[j] = blend(mixBits(lattice[0][0] + hashYZ), mixBits(lattice[0][1] + hashYZ), weight[0]);
        }
        planes[k] = blend(lines[0], lines[1], weight[1]);
    }
    return blend(planes[0], planes[1], weight[2]) / 4294967296.0;
}

double ValueNoise::octavesAt(const Vec3& point) const noexcept {
    const Vec3 second{2 * point[0] + 0.5, 2 * point[1] + 0.5, 2 * point[2] + 0.5};
    const Vec3 third{2 * second[0] + 0.5, 2 * second[1] + 0.5, 2 * second[2] + 0.5};
    return (4 * at(point) + 2 * at(second) + at(third)) / 7;
}

} // namespace voxtact
