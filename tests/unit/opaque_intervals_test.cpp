// SPDX-License-Identifier: MIT
// Where values are opaque, against a judge of exact arithmetic on the control points: sums of doubles without rounding
// (Shewchuk, "Adaptive precision floating-point arithmetic", 1997).
#include "core/transfer/opaque_intervals.h"

#include "core/transfer/opaque_numbers.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace voxtact::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t below(std::mt19937_64& random, std::size_t end) {
    return random() % end;
}

bool chance(std::mt19937_64& random, double probability) {
    return uniform(random, 0, 1) < probability;
}

/// A sum of doubles, exactly: they do not overlap, and the last is the largest.
class Exact {
  public:
    explicit Exact(double value = 0) : parts_{value} {}

    void add(double value) {
        for (double& part : parts_) {
            const double sum = value + part;
            const double back = sum - value;
            part = (value - (sum - back)) + (part - back);
            value = sum;
        }
        parts_.push_back(value);
    }
    [[nodiscard]] Exact minus(const Exact& other) const {
        Exact out = *this;
        for (const double part : other.parts_) {
            out.add(-part);
        }
        return out;
    }
    [[nodiscard]] Exact times(const Exact& other) const {
        Exact out;
        for (const double a : parts_) {
            for (const double b : other.parts_) {
                out.add(a * b);
                out.add(std::fma(a, b, -(a * b)));
            }
        }
        return out;
    }
    [[nodiscard]] bool isNegative() const {
        const auto last = std::find_if(parts_.rbegin(), parts_.rend(), [](double part) { return part != 0; });
        return last != parts_.rend() && *last < 0;
    }

  private:
    std::vector<double> parts_;
};

Exact difference(double a, double b) {
    return Exact(a).minus(Exact(b));
}

/// Whether the opacity of a value reaches the threshold.
bool isOpaque(const std::vector<ControlPoint>& points, double threshold, const Exact& value) {
    const auto before = [&](const ControlPoint& point) { return Exact(point.value).minus(value).isNegative(); };
    const auto behind = [&](const ControlPoint& point) { return value.minus(Exact(point.value)).isNegative(); };
    const bool above = behind(points.front());
    if (above || before(points.back())) {
        return (above ? points.front() : points.back()).opacity >= threshold;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!before(points[i]) && !behind(points[i]) && points[i].opacity >= threshold) {
            return true;
        }
        if (i > 0 && before(points[i - 1]) && behind(points[i])) {
            const ControlPoint& a = points[i - 1];
            const ControlPoint& b = points[i];
            const Exact risen = difference(b.opacity, a.opacity).times(value.minus(Exact(a.value)));
            return !risen.minus(difference(threshold, a.opacity).times(difference(b.value, a.value))).isNegative();
        }
    }
    return false;
}

bool isOpaque(const std::vector<ControlPoint>& points, double threshold, double value) {
    return isOpaque(points, threshold, Exact(value));
}

bool isIn(std::span<const ValueRange> intervals, double value) {
    return std::ranges::any_of(intervals, [&](const ValueRange& one) { return one.lo <= value && value <= one.hi; });
}

/// Numbers of bytes, of words, and floats of all magnitudes.
struct Kind {
    double lo;
    double hi;
    double scale; // of the distances between points
    bool whole;
};
constexpr std::array kKinds{Kind{0, 255, 10, true},          Kind{-32768, 32767, 300, true},
                            Kind{0, 65535, 1000, true},      Kind{-3e38, 3e38, 1e37, false},
                            Kind{-1, 1, 1e-3, false},        Kind{-1e-20, 1e-20, 1e-22, false},
                            Kind{1e6, 1e6 + 10, 0.1, false}, Kind{-1e4, 1e4, 1e-9, false}};

/// Ramps, spikes that are no wider than rounding, plateaus, steps, and points of one value.
std::vector<ControlPoint> drawnPoints(std::mt19937_64& random, const Kind& kind, double threshold) {
    std::vector<ControlPoint> points;
    double value = uniform(random, kind.lo, kind.hi);
    const std::size_t count = 1 + below(random, chance(random, 0.1) ? 60 : 6);
    for (std::size_t i = 0; i < count; ++i) {
        value = chance(random, 0.5) ? std::round(value) : value;
        if (i > 0 && !(value >= points.back().value)) {
            value = points.back().value;
        }
        const double opacity = chance(random, 0.2)   ? 0
                               : chance(random, 0.2) ? 1
                               : chance(random, 0.3) ? threshold
                               : chance(random, 0.2) ? std::nextafter(threshold, chance(random, 0.5) ? 0.0 : 1.0)
                                                     : uniform(random, 0, 1);
        points.push_back({value, opacity});
        switch (below(random, 4)) {
        case 0:
            break; // a step
        case 1:
            value = std::nextafter(value, kInfinity);
            break;
        default:
            value += kind.scale * uniform(random, 0, 1);
        }
    }
    return points;
}

/// Values near to where something happens.
std::vector<double> asked(std::mt19937_64& random, const Kind& kind, const std::vector<ControlPoint>& points,
                          const OpaqueIntervals& intervals) {
    std::vector<double> values{uniform(random, kind.lo, kind.hi), kind.lo, kind.hi};
    for (const ControlPoint& point : points) {
        values.push_back(point.value);
    }
    for (const std::span<const ValueRange> some : {intervals.outer(), intervals.inner()}) {
        for (const ValueRange& one : some) {
            values.insert(values.end(), {one.lo, one.hi, 0.5 * one.lo + 0.5 * one.hi});
        }
    }
    for (std::size_t i = 0, count = values.size(); i < count; ++i) {
        values.push_back(std::nextafter(values[i], kInfinity));
        values.push_back(std::nextafter(values[i], -kInfinity));
    }
    // Products with denormals are not exact.
    constexpr double kLeast = 1e-250;
    std::erase_if(values,
                  [](double value) { return !std::isfinite(value) || (value != 0 && std::abs(value) < kLeast); });
    return values;
}

TEST(OpaqueIntervals, AreThoseOfExactArithmetic) {
    std::mt19937_64 random(testSeed());
    std::array<std::size_t, 2> answers{};
    for (std::size_t round = 0; round < 4000 && !HasFailure(); ++round) {
        const Kind& kind = kKinds[below(random, kKinds.size())];
        const double threshold = chance(random, 0.05) ? static_cast<double>(below(random, 2)) : uniform(random, 0, 1);
        const std::vector<ControlPoint> points = drawnPoints(random, kind, threshold);
        const OpaqueIntervals intervals(points, threshold);
        for (const double value : asked(random, kind, points, intervals)) {
            const bool opaque = isOpaque(points, threshold, value);
            EXPECT_TRUE(opaque || !isIn(intervals.inner(), value)) << "round " << round << ", at " << value;
            EXPECT_TRUE(!opaque || isIn(intervals.outer(), value)) << "round " << round << ", at " << value;
            EXPECT_EQ(intervals.mayMeet(value, value), isIn(intervals.outer(), value));
            EXPECT_EQ(intervals.contain(value, value), isIn(intervals.inner(), value));
            ++answers[opaque ? 1 : 0];
        }
        for (const ControlPoint& point : points) {
            EXPECT_TRUE(point.opacity < threshold || isIn(intervals.inner(), point.value)) << "round " << round;
        }
    }
    EXPECT_GT(answers[0], 10000U);
    EXPECT_GT(answers[1], 10000U);
}

/// The entries of the voxels of an image, which are what certified answers compare.
TEST(OpaqueIntervals, EntriesOfVoxelsAreOpaqueWhereVoxelsAre) {
    std::mt19937_64 random(testSeed());
    std::size_t unsure = 0;
    std::size_t all = 0;
    for (std::size_t round = 0; round < 4000 && !HasFailure(); ++round) {
        const Kind& kind = kKinds[below(random, kKinds.size())];
        const double threshold = uniform(random, 0, 1);
        const std::vector<ControlPoint> points = drawnPoints(random, kind, threshold);
        StoredScale stored;
        if (kind.whole) {
            stored = {chance(random, 0.5) ? 1.0 : chance(random, 0.5) ? -1.0 : 0.25, kind.lo};
        }
        const OpaqueNumbers numbers = opaqueNumbers(points, threshold, stored, kind.whole);
        const shader::OpaqueValues opaque = numbers.values();
        const OpaqueIntervals intervals(points, threshold, stored);
        for (const double value : asked(random, kind, points, OpaqueIntervals(points, threshold))) {
            const double wanted = (value - stored.intercept) / stored.slope;
            const auto voxel = static_cast<float>(kind.whole ? std::round(wanted) : wanted);
            if (!std::isfinite(voxel) || (kind.whole && std::abs(voxel) > 65535)) {
                continue;
            }
            Exact real(static_cast<double>(voxel) * stored.slope);
            real.add(stored.intercept);
            const bool isIt = isOpaque(points, threshold, real);
            const float entry = (voxel - numbers.reference) * numbers.scale;
            const bool certain = shader::certainlyAllOpaque(opaque, entry, entry);
            const bool may = shader::mayBeOpaque(opaque, entry, entry);
            EXPECT_TRUE(may || !isIt) << "round " << round << ", voxel " << voxel;
            // Devices take voxels next to nothing for nothing: see CERTIFIED_LEAST_ENTRY.
            EXPECT_TRUE(!certain || isIt || (numbers.reference == 0 && std::abs(entry) < 1e-30F))
                << "round " << round << ", voxel " << voxel;
            EXPECT_EQ(shader::certainlySomeOpaque(opaque, entry, entry), certain);
            if (certain) {
                EXPECT_EQ(shader::opaqueFrom(opaque, entry), entry);
                EXPECT_GE(shader::opacityOfOpaque(opaque, entry), static_cast<float>(threshold));
            }
            unsure += may != certain ? 1 : 0;
            ++all;
        }
        // What is certain of a range is so of its parts; the bounds say nothing else.
        shader::OpaqueValues slow = opaque;
        slow.bounds = {};
        slow.outer = opaque.outer;
        for (int i = 0; i < 20; ++i) {
            const auto draw = [&] {
                const auto place = static_cast<float>(uniform(random, kind.lo, kind.hi));
                return chance(random, 0.7) && !numbers.numbers.empty()
                           ? numbers.numbers[below(random, numbers.numbers.size())]
                           : (place - numbers.reference) * numbers.scale;
            };
            const float one = draw();
            const float other = draw();
            const float lo = std::min(one, other);
            const float hi = std::max(one, other);
            const bool may = shader::mayBeOpaque(opaque, lo, hi);
            const bool some = shader::certainlySomeOpaque(opaque, lo, hi);
            const bool whole = shader::certainlyAllOpaque(opaque, lo, hi);
            EXPECT_TRUE(!whole || some);
            EXPECT_TRUE(!some || may);
            const auto isMet = [&](int first, int count) {
                const float* const ends = opaque.numbers + 2 * first;
                bool met = false;
                for (int j = 0; j < count; ++j) {
                    met = met || (ends[2 * j] <= hi && ends[2 * j + 1] >= lo);
                }
                return met;
            };
            EXPECT_EQ(may, isMet(0, opaque.outer)) << lo << " to " << hi << ", round " << round;
            EXPECT_EQ(some, isMet(opaque.outer, opaque.inner)) << lo << " to " << hi << ", round " << round;
        }
    }
    EXPECT_LT(unsure, all / 5) << "next to the ends";
}

TEST(OpaqueIntervals, CornersStepsAndPlateausAreExact) {
    const auto outer = [](const std::vector<ControlPoint>& points, double threshold) {
        const OpaqueIntervals found(points, threshold);
        EXPECT_EQ(found.outer().size(), found.inner().size());
        std::string text;
        for (std::size_t i = 0; i < found.outer().size() && i < found.inner().size(); ++i) {
            EXPECT_EQ(found.outer()[i].lo, found.inner()[i].lo);
            EXPECT_EQ(found.outer()[i].hi, found.inner()[i].hi);
            text += (i > 0 ? " " : "") +
                    std::to_string(static_cast<int>(std::clamp(found.outer()[i].lo, -9999.0, 9999.0))) + ":" +
                    std::to_string(static_cast<int>(std::clamp(found.outer()[i].hi, -9999.0, 9999.0)));
        }
        return text;
    };
    EXPECT_EQ(outer({{1099, 0}, {1100, 1}}, 1), "1100:9999");
    EXPECT_EQ(outer({{100, 0}, {100, 1}}, 0.5), "100:9999") << "a step up";
    EXPECT_EQ(outer({{100, 1}, {100, 0}}, 0.5), "-9999:100") << "a step down: its value is opaque, too";
    EXPECT_EQ(outer({{100, 0}, {100, 1}, {100, 0}}, 0.5), "100:100") << "a single value";
    EXPECT_EQ(outer({{100, 1}, {100, 0}, {100, 1}}, 0.5), "-9999:9999") << "a hole that holds no value";
    EXPECT_EQ(outer({{0, 0}, {10, 0.5}, {20, 0.5}, {30, 0}}, 0.5), "10:20") << "a plateau at the threshold";
    EXPECT_EQ(outer({{0, 0}, {10, 0.5}, {20, 0}}, 0.5), "10:10") << "a peak at the threshold";
    EXPECT_EQ(outer({{0, 0}, {200, 1}, {400, 0}}, 0.5), "100:300") << "crossings that are doubles";
    EXPECT_EQ(outer({{0, 0}, {10, 0.4}}, 0.5), "");
    EXPECT_EQ(outer({{0, 0}, {10, 0}}, 0), "-9999:9999");
    EXPECT_EQ(outer({{5, 1}}, 0.5), "-9999:9999");
}

TEST(OpaqueIntervals, ProductsThatUnderflowProveNothing) {
    const OpaqueIntervals found(std::array{ControlPoint{0, 0}, ControlPoint{1e-200, 1}}, 1e-200);
    EXPECT_FALSE(found.contain(0, 0)) << "opacity 0 at 0";
    EXPECT_TRUE(found.contain(1e-200, 1e-200));
}

TEST(OpaqueIntervals, TheOpacityAtAStepIsItsGreatest) {
    const std::array points{ControlPoint{0, 1}, ControlPoint{10, 1}, ControlPoint{10, 0}, ControlPoint{20, 0}};
    const OpaqueNumbers numbers = opaqueNumbers(points, 0.1, {}, false);
    const float entry = numbers.scale * (10 - numbers.reference);
    EXPECT_EQ(shader::opacityOfOpaque(numbers.values(), entry), 1);
}

TEST(OpaqueIntervals, WhatIsNotANumberMayBeAnythingAndIsNeverCertain) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const std::vector<ControlPoint>& points :
         {std::vector<ControlPoint>{{0, 0}, {1, 1}}, {{0, 0}, {1, 1}, {2, 0}, {3, 1}}}) {
        const OpaqueNumbers numbers = opaqueNumbers(points, 0.5, {}, false);
        for (const auto& [lo, hi] : {std::pair{kNan, 2.0F}, {0.0F, kNan}, {kNan, kNan}}) {
            EXPECT_TRUE(shader::mayBeOpaque(numbers.values(), lo, hi));
            EXPECT_FALSE(shader::certainlyAllOpaque(numbers.values(), lo, hi));
            EXPECT_FALSE(shader::certainlySomeOpaque(numbers.values(), lo, hi));
        }
    }
    const OpaqueNumbers nothing = opaqueNumbers(std::vector<ControlPoint>{{0, 0}}, 0.5, {}, false);
    EXPECT_FALSE(shader::mayBeOpaque(nothing.values(), kNan, kNan));
    EXPECT_FALSE(shader::mayBeOpaque(nothing.values(), -1e30F, 1e30F));
}

} // namespace
} // namespace voxtact::test
