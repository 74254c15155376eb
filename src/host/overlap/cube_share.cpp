// SPDX-License-Identifier: MIT
#include "host/overlap/cube_share.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// Maximum relative change of the slope along an axis for a quotient by that slope.
constexpr double kMaxChange = 0.5;

/// The part of a unit cube where a * x + b * y + c * z < at, for a <= b <= c, which are 1 together, and at <= 1/2
/// (Scardovelli and Zaleski, "Analytical relations connecting linear interfaces and volume fractions in rectangular
/// grids", 2000).
double lowerShare(double a, double b, double c, double at) noexcept {
    if (at <= 0) {
        return 0;
    }
    if (at < a) {
        return at * at * at / (6 * a * b * c);
    }
    const double first = b > 0 ? a * a / (6 * b * c) : 0;
    if (at < b) {
        return at * (at - a) / (2 * b * c) + first;
    }
    const double both = a + b;
    if (at >= both && both <= c) {
        return (2 * at - both) / (2 * c);
    }
    if (a == 0) { // and at < both
        return (at * at - (at - b) * (at - b)) / (2 * b * c);
    }
    if (at < c) {
        return (at * at * (3 * both - at) + a * a * (a - 3 * at) + b * b * (b - 3 * at)) / (6 * a * b * c);
    }
    return (at * at * (3 - 2 * at) + a * a * (a - 3 * at) + b * b * (b - 3 * at) + c * c * (c - 3 * at)) /
           (6 * a * b * c);
}

} // namespace

double linearShare(const dvec3& slope, double from) noexcept {
    std::array<double, 3> sizes{std::abs(slope.x), std::abs(slope.y), std::abs(slope.z)};
    std::ranges::sort(sizes);
    const double all = sizes[0] + sizes[1] + sizes[2];
    if (!(all > 0)) {
        return from <= 0 ? 1 : 0;
    }
    const double at = std::clamp(0.5 * (from / all + 1), 0.0, 1.0); // from the lower end
    const double below = at <= 0.5 ? lowerShare(sizes[0] / all, sizes[1] / all, sizes[2] / all, at)
                                   : 1 - lowerShare(sizes[0] / all, sizes[1] / all, sizes[2] / all, 1 - at);
    return std::clamp(1 - below, 0.0, 1.0);
}

namespace {

/// A trilinear function as (a0 + a1 y + a2 z + a3 yz) + x (b + e1 y + e2 z + e3 yz), x being one of the axes.
struct AlongAxis {
    AlongAxis(const Trilinear& terms, unsigned axis, double from)
        : y((axis + 1) % 3), z((axis + 2) % 3), a0(terms[0] - from), a1(terms[1U << y]), a2(terms[1U << z]),
          a3(terms[1U << y | 1U << z]), b(terms[1U << axis]), e1(terms[1U << axis | 1U << y]),
          e2(terms[1U << axis | 1U << z]), e3(terms[7]) {}

    /// Relative change of the slope.
    [[nodiscard]] double change() const noexcept {
        return b != 0 ? (std::abs(e1) + std::abs(e2) + std::abs(e3)) / std::abs(b) : 1;
    }
    /// Returns true if the function crosses 0 on each line along x: true if it does at the corners.
    [[nodiscard]] bool passes() const noexcept {
        bool passes = true;
        for (const double v : {-1.0, 1.0}) {
            for (const double w : {-1.0, 1.0}) {
                passes =
                    passes && std::abs(a0 + a1 * v + a2 * w + a3 * v * w) <= std::abs(b + e1 * v + e2 * w + e3 * v * w);
            }
        }
        return passes;
    }
    /// The mean over y and z of (a0 + ...) / |b + ...|, by 1 - e + e^2 for 1 / (1 + e): the error is at most change()
    /// cubed, because the quotient is between -1 and 1.
    [[nodiscard]] double mean() const noexcept {
        const double first = ((a1 * e1 + a2 * e2) / 3 + a3 * e3 / 9) / b;
        const double second =
            (a0 * (e1 * e1 + e2 * e2) / 3 + (a0 * e3 * e3 + 2 * (a1 * e2 * e3 + a2 * e1 * e3 + a3 * e1 * e2)) / 9) /
            (b * b);
        return (a0 - first + second) / std::abs(b);
    }

    unsigned y;
    unsigned z;
    double a0;
    double a1;
    double a2;
    double a3;
    double b;
    double e1;
    double e2;
    double e3;
};

} // namespace

std::optional<GraphShare> graphShare(const Trilinear& terms, double from) noexcept {
    std::optional<GraphShare> best;
    double least = kMaxChange;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const AlongAxis along(terms, axis, from);
        const double change = along.change();
        if (change <= least && along.passes()) {
            least = change;
            best.emplace();
            best->share = 0.5 + 0.5 * along.mean();
            best->error = 0.5 * change * change * change + 0x1p-40;
            best->steepness = std::abs(along.b) * (1 - change);
            best->axis = static_cast<int>(std::abs(along.e1) >= std::abs(along.e2) ? along.y : along.z);
        }
    }
    return best;
}

LinearSign linearSign(const Trilinear& terms, double from) noexcept {
    const double all = terms[0] - from;
    const double cubic = std::abs(terms[7]);
    const dvec3 bent{std::abs(terms[3]) + std::abs(terms[5]) + cubic, std::abs(terms[3]) + std::abs(terms[6]) + cubic,
                     std::abs(terms[5]) + std::abs(terms[6]) + cubic};
    LinearSign out{{terms[1], terms[2], terms[4]}, all, 0.5 * (bent.x + bent.y + bent.z - cubic), bent};
    for (unsigned axis = 0; axis < 3; ++axis) {
        const AlongAxis along(terms, axis, from);
        const double change = along.change();
        if (change > kMaxChange) {
            continue;
        }
        // The function is A + x b (1 + e), and 0 at x = -A / (b (1 + e)). At -A (1 - e) / b = x (1 - e^2) it is off by
        // no more than e^2 if x is from -1 to 1, and beyond the cube's end less e^2 if x is beyond.
        const double e1 = along.e1 / along.b;
        const double e2 = along.e2 / along.b;
        const double e3 = along.e3 / along.b;
        const double square = change * change * std::abs(along.b);
        const double yy = along.a1 * e1; // y^2 is between 0 and 1
        const double zz = along.a2 * e2;
        const double yz = std::abs(along.a3 - along.a0 * e3 - along.a1 * e2 - along.a2 * e1);
        const double rest = square + yz + std::abs(along.a1 * e3 + along.a3 * e1) +
                            std::abs(along.a2 * e3 + along.a3 * e2) + std::abs(along.a3 * e3);
        const double off = rest + 0.5 * (std::abs(yy) + std::abs(zz));
        if (off < out.off) {
            out.middle = along.a0 - 0.5 * (yy + zz);
            out.off = off;
            const auto set = [&](unsigned at, double slope, double gone) {
                out.slope[static_cast<int>(at)] = slope;
                out.bent[static_cast<int>(at)] = gone;
            };
            set(axis, along.b, 0);
            set(along.y, along.a1 - along.a0 * e1, std::abs(yy) + rest);
            set(along.z, along.a2 - along.a0 * e2, std::abs(zz) + rest);
        }
    }
    return out;
}

} // namespace voxtact::cpu
