// SPDX-License-Identifier: MIT
// What is opaque of a transfer function, of its table, and of a volume's values.
#include "voxtact/data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace voxtact::test {
namespace {

const std::vector<ControlPoint> kVessels{{150, 0}, {200, 1}, {250, 0}};
constexpr ValueRange kScanner{-1024, 3071};
constexpr ValueRange kWithImplant{-1000, 32767};

OpacityFacts facts(const std::vector<ControlPoint>& points, const ValueRange& domain, const ValueRange& data,
                   std::uint32_t entries = kDefaultTableSize, double threshold = kDefaultThreshold) {
    const Result<OpacityFacts> found = checkOpacity({points, domain, entries}, data, threshold);
    EXPECT_TRUE(found.ok());
    return found.ok() ? *found : OpacityFacts{};
}

bool isAll(const OpacityFacts& found) {
    return found.reaches && found.any && found.lost.empty();
}

TEST(OpacityFacts, WhatIsSeen) {
    EXPECT_TRUE(isAll(facts({{0, 0}, {255, 1}}, {0, 255}, {0, 255})));
    EXPECT_TRUE(isAll(facts(kVessels, kScanner, {-1000, 3000})));
    EXPECT_TRUE(isAll(facts(kVessels, kWithImplant, kWithImplant, 4096)));
    // Before the first point, beyond the last one, and a step that is narrower than an entry.
    EXPECT_TRUE(isAll(facts({{0, 1}, {1, 0}}, kScanner, {-1000, 3000})));
    EXPECT_TRUE(isAll(facts({{300, 0}, {301, 1}}, kScanner, {-1000, 400})));
    EXPECT_TRUE(isAll(facts({{300, 0}, {300, 1}}, kScanner, {-1000, 400})));
    // At 0 everything is opaque.
    EXPECT_TRUE(isAll(facts({{0, 0}, {1, 0}}, {0, 255}, {0, 255}, 2, 0)));
}

TEST(OpacityFacts, PointsBelowTheThreshold) {
    const OpacityFacts found = facts({{0, 0}, {255, 0.05}}, {0, 255}, {0, 255});
    EXPECT_FALSE(found.reaches);
    EXPECT_FALSE(found.any);
    EXPECT_TRUE(found.lost.empty());
    EXPECT_TRUE(facts({{0, 0}, {255, 0.05}}, {0, 255}, {0, 255}, 256, 0.04).reaches);
}

TEST(OpacityFacts, BetweenTwoEntries) {
    const OpacityFacts found = facts(kVessels, kWithImplant, kWithImplant);
    EXPECT_TRUE(found.reaches);
    EXPECT_FALSE(found.any);
    EXPECT_DOUBLE_EQ(found.spacing, 33767.0 / 256);
    ASSERT_EQ(found.lost.size(), 1U);
    EXPECT_DOUBLE_EQ(found.lost[0].lo, 155);
    EXPECT_DOUBLE_EQ(found.lost[0].hi, 245);
    // Beside what is opaque and seen; and what no value of the data is, or is beyond the table, is not lost.
    std::vector<ControlPoint> more = kVessels;
    more.insert(more.end(), {{1000, 0}, {2000, 1}});
    EXPECT_TRUE(facts(more, kWithImplant, kWithImplant).any);
    EXPECT_EQ(facts(more, kWithImplant, kWithImplant).lost.size(), 1U);
    EXPECT_TRUE(facts(more, kWithImplant, {300, 32767}).lost.empty());
    EXPECT_TRUE(facts(more, kWithImplant, {-1000, 154}).lost.empty());
    EXPECT_TRUE(facts({{0, 0}, {10, 1}, {20, 0}}, {100, 355}, {0, 355}).lost.empty());
    // No entry is at 10.2, but one at 10.5 is opaque, and what is before that gets a share of it.
    EXPECT_TRUE(isAll(facts({{10.1, 0}, {10.2, 1}, {10.3, 1}, {10.4, 0}, {10.45, 0}, {10.5, 1}, {20, 1}, {21, 0}},
                            {0, 256}, {0, 256})));
}

/// The table says what is seen: every value is asked for, of the table as a sampler has it.
TEST(OpacityFacts, AreThoseOfEveryValue) {
    for (const std::uint32_t entries : {2U, 3U, 17U, 64U}) {
        for (int from = 0; from < 100; from += 3) {
            for (const int width : {1, 2, 7, 40}) {
                const std::vector<ControlPoint> points{
                    {from + 0.0, 0}, {from + 0.25 * width, 1}, {from + 0.75 * width, 1}, {from + 1.0 * width, 0}};
                const TransferFunctionDesc desc{points, {5, 95}, entries};
                const std::vector<float> table = *sampleTable(desc);
                const auto opacityAt = [&](double value) {
                    const double at = std::clamp((value - 5) / 90 * entries - 0.5, 0.0, entries - 1.0);
                    const auto below = std::min(static_cast<std::size_t>(at), std::size_t{entries} - 2);
                    const double weight = at - static_cast<double>(below);
                    return (1 - weight) * double{table[below]} + weight * double{table[below + 1]};
                };
                double most = 0;
                double mostInBand = 0;
                const ValueRange data{10, 80};
                for (double value = data.lo; value <= data.hi; value += 1.0 / 64) {
                    most = std::max(most, opacityAt(value));
                }
                const ValueRange band{from + 0.125 * width, from + 0.875 * width}; // half opaque and more
                for (double value = std::max(5.0, band.lo); value <= std::min(95.0, band.hi); value += 1.0 / 1024) {
                    mostInBand = std::max(mostInBand, opacityAt(value));
                }
                const OpacityFacts found = facts(points, {5, 95}, data, entries, 0.5);
                SCOPED_TRACE(std::to_string(entries) + " entries, " + std::to_string(width) + " from " +
                             std::to_string(from));
                if (std::abs(most - 0.5) > 0.05) { // what lies between two of those values
                    EXPECT_EQ(found.any, most > 0.5);
                }
                if (!found.lost.empty()) {
                    EXPECT_LT(mostInBand, 0.5);
                }
                if (band.lo >= data.lo && band.hi <= data.hi && mostInBand < 0.5) {
                    EXPECT_EQ(found.lost.size(), 1U);
                }
            }
        }
    }
}

TEST(OpacityFacts, OpacitiesAreComparedAsSamplesAre) {
    // In single precision it is the threshold itself.
    EXPECT_TRUE(isAll(facts({{0, 0.099999999}}, {0, 255}, {0, 255})));
    EXPECT_FALSE(facts({{0, 0.09999999}}, {0, 255}, {0, 255}).reaches);
    // The table ends half an entry before the domain: what is opaque at its very end is of no entry's making.
    const OpacityFacts end = facts({{0, 0}, {255, 1}}, {0, 255}, {0, 255}, 256, 1);
    EXPECT_TRUE(end.reaches && !end.any && end.lost.empty());
    // A peak that is just as high.
    EXPECT_EQ(facts({{-327, 0}, {-100, 0.1}, {-22, 0}}, {-1000, 32767}, {-1000, 1000}).lost.size(), 1U);
}

TEST(OpacityFacts, RefusesWhatATableRefuses) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(checkOpacity({kVessels, {0, 255}, 256}, {kNan, 255}).ok());
    EXPECT_FALSE(checkOpacity({kVessels, {0, 255}, 256}, {0, kNan}).ok());
    EXPECT_FALSE(checkOpacity({kVessels, {0, 255}, 256}, {1, 0}).ok());
    for (const double threshold : {-0.1, 1.1, kNan}) {
        EXPECT_FALSE(checkOpacity({kVessels, {0, 255}, 256}, {0, 255}, threshold).ok());
    }
    EXPECT_FALSE(checkOpacity({{}, {0, 255}, 256}, {0, 255}).ok());
    EXPECT_FALSE(checkOpacity({kVessels, {0, 0}, 256}, {0, 255}).ok());
    EXPECT_FALSE(checkOpacity({kVessels, {0, 255}, 1}, {0, 255}).ok());
}

} // namespace
} // namespace voxtact::test
