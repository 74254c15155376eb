// SPDX-License-Identifier: MIT
// What is opaque of a transfer function and of a volume's values, and what its table makes of that.
#include "voxtact/data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace voxtact::test {
namespace {

const std::vector<ControlPoint> kVessels{{150, 0}, {200, 1}, {250, 0}};
constexpr ValueRange kWithImplant{-1000, 32767};

OpacityFacts facts(const std::vector<ControlPoint>& points, const ValueRange& domain, const ValueRange& data,
                   std::uint32_t entries = kDefaultTableSize, double threshold = kDefaultThreshold) {
    const Result<OpacityFacts> found = checkOpacity({points, domain, entries}, data, threshold);
    EXPECT_TRUE(found.ok());
    return found.ok() ? *found : OpacityFacts{};
}

TEST(OpacityFacts, WhatIsSeen) {
    EXPECT_TRUE(facts(kVessels, kWithImplant, kWithImplant).any);
    EXPECT_TRUE(facts(kVessels, {}, {200, 200}).any);
    EXPECT_FALSE(facts(kVessels, {}, {-1000, 154}).any);
    EXPECT_TRUE(facts(kVessels, {}, {-1000, 155}).any) << "to the very value";
    EXPECT_TRUE(facts({{0, 0}, {1, 0}}, {0, 255}, {0, 255}, 2, 0).any) << "at 0 everything is opaque";
    const OpacityFacts found = facts({{0, 0}, {255, 0.05}}, {0, 255}, {0, 255});
    EXPECT_FALSE(found.reaches || found.any);
    EXPECT_TRUE(facts({{0, 0}, {255, 0.05}}, {0, 255}, {0, 255}, 256, 0.04).reaches);
    EXPECT_TRUE(facts({{1099, 0}, {1100, 1}}, {}, {0, 1100}, 256, 1).any);
}

TEST(OpacityFacts, HowFarTheTableMovesAnEnd) {
    EXPECT_EQ(facts(kVessels, kWithImplant, kWithImplant).moved, std::numeric_limits<double>::infinity())
        << "no entry is among the opaque values";
    EXPECT_EQ(facts(kVessels, kWithImplant, {300, 32767}).moved, 0) << "no end is among the data";
    EXPECT_DOUBLE_EQ(facts({{0, 0}, {20, 1}}, {0, 100}, {0, 100}, 4, 1).moved, 17.5) << "to the entry at 37.5";
    EXPECT_LT(facts({{0, 0}, {255, 1}}, {0, 255}, {0, 255}).moved, 1e-3) << "a ramp is a ramp";
    EXPECT_LT(facts(kVessels, {}, kWithImplant).moved, 1) << "the table of what the points span";
    EXPECT_LT(facts(kVessels, kWithImplant, kWithImplant, 4096).moved, 33767.0 / 4096);
}

TEST(OpacityFacts, TheTableIsWhereThePointsAre) {
    const ValueRange domain = tableDomain({kVessels, {}, 101});
    EXPECT_DOUBLE_EQ(domain.lo, 149.5);
    EXPECT_DOUBLE_EQ(domain.hi, 250.5);
    const std::vector<float> table = *sampleTable({kVessels, {}, 101});
    EXPECT_NEAR(table.front(), 0, 1e-6);
    EXPECT_NEAR(table[50], 1, 1e-6);
    EXPECT_NEAR(table.back(), 0, 1e-6);
    const std::vector<ControlPoint> step{{1100, 0}, {1100, 1}};
    EXPECT_LT(tableDomain({step}).lo, 1100);
    EXPECT_EQ(sampleTable({step})->front(), 0);
    EXPECT_EQ(sampleTable({step})->back(), 1);
    EXPECT_TRUE(sampleTable({std::vector<ControlPoint>{{0, 0}, {0, 1}}}).ok());
    EXPECT_EQ(tableDomain({kVessels, {0, 255}, 256}).hi, 255);
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
    EXPECT_FALSE(checkOpacity({kVessels, {5, 5}, 256}, {0, 255}).ok());
    EXPECT_FALSE(checkOpacity({kVessels, {0, 255}, 1}, {0, 255}).ok());
}

} // namespace
} // namespace voxtact::test
