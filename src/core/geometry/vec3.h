// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cmath>

/// Vectors where glm's are not at hand. The sums go in one order, from the first axis to the last.
namespace voxtact {

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// a + times * b.
[[nodiscard]] inline Vec3 step(const Vec3& a, const Vec3& b, double times) {
    return {a[0] + b[0] * times, a[1] + b[1] * times, a[2] + b[2] * times};
}

[[nodiscard]] inline double length(const Vec3& a) {
    return std::sqrt(dot(a, a));
}

/// Returns a unit vector; NaN if `a` is zero.
[[nodiscard]] inline Vec3 unit(const Vec3& a) {
    const double size = length(a);
    return {a[0] / size, a[1] / size, a[2] / size};
}

} // namespace voxtact
