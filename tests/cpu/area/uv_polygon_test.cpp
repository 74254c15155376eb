// SPDX-License-Identifier: MIT
// Parts of triangles: cut and measured.
#include "core/base/infinity.h"
#include "host/area/uv_polygon.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace voxtact::test {
namespace {

using cpu::areaBetween;
using cpu::Heights;
using cpu::split;
using cpu::Uv;
using cpu::UvPolygon;

constexpr double kSlack = 1e-12;

/// Above the line a u + b v = c.
Heights heightsOf(const UvPolygon& polygon, double a, double b, double c) {
    Heights heights{};
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        heights[i] = a * polygon.corners[i].u + b * polygon.corners[i].v - c;
    }
    return heights;
}

TEST(UvPolygon, OfAllOfATriangleIsHalfItsParallelogram) {
    EXPECT_EQ(UvPolygon::whole().area(), 0.5);
    EXPECT_FALSE(UvPolygon::whole().empty());
    EXPECT_TRUE(UvPolygon().empty());
    EXPECT_EQ(UvPolygon().area(), 0);
}

TEST(UvPolygon, IsCutIntoWhatItConsistsOf) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 2000; ++round) {
        UvPolygon polygon = UvPolygon::whole();
        for (int cut = 0; cut < 8 && !polygon.empty(); ++cut) {
            // Lines also go through corners and along edges.
            const bool through = random() % 3 == 0;
            const Uv corner = polygon.corners[random() % polygon.count];
            const Uv next = polygon.corners[random() % polygon.count];
            double a = uniform(random, -1, 1);
            double b = uniform(random, -1, 1);
            if (random() % 4 == 0) {
                a = next.v - corner.v;
                b = corner.u - next.u;
            }
            const double c = through ? a * corner.u + b * corner.v : a * uniform(random, 0, 0.5) + b * 0.3;
            const Heights heights = heightsOf(polygon, a, b, c);
            UvPolygon below;
            UvPolygon above;
            ASSERT_TRUE(split(polygon, heights, kSlack, below, above));
            EXPECT_NEAR(below.area() + above.area(), polygon.area(), 1e-15);
            for (std::uint32_t i = 0; i < below.count; ++i) {
                EXPECT_LE(heightsOf(below, a, b, c)[i], 2 * kSlack);
            }
            for (std::uint32_t i = 0; i < above.count; ++i) {
                EXPECT_GE(heightsOf(above, a, b, c)[i], -2 * kSlack);
            }
            EXPECT_NEAR(areaBetween(polygon, heights, 0, kInfinity), above.area(), 1e-11);
            EXPECT_NEAR(areaBetween(polygon, heights, -kInfinity, 0), below.area(), 1e-11);
            polygon = random() % 2 == 0 || below.empty() ? above : below;
        }
    }
}

/// All of a polygon that lies along the line is on one side of it.
TEST(UvPolygon, IsNotInBothPartsWhereItIsOnTheLine) {
    const UvPolygon polygon = UvPolygon::whole();
    UvPolygon below;
    UvPolygon above;
    for (const Heights& heights : {Heights{0, 0, 0}, Heights{1e-13, -1e-13, 0}, Heights{-1e-13, 1e-13, -1e-13}}) {
        ASSERT_TRUE(split(polygon, heights, kSlack, below, above));
        EXPECT_EQ(below.area() + above.area(), 0.5);
        EXPECT_TRUE(below.empty() || above.empty());
    }
    ASSERT_TRUE(split(polygon, {0, 0, -1}, kSlack, below, above));
    EXPECT_EQ(below.area(), 0.5);
    EXPECT_TRUE(above.empty());
    ASSERT_TRUE(split(polygon, {0, 0, 1}, kSlack, below, above));
    EXPECT_EQ(above.area(), 0.5);
    EXPECT_TRUE(below.empty());
}

TEST(UvPolygon, HasAnAreaBetweenHeights) {
    const UvPolygon polygon = UvPolygon::whole();
    const Heights heights = heightsOf(polygon, 1, 0, 0); // u
    EXPECT_NEAR(areaBetween(polygon, heights, 0.25, 0.5), 0.5 * (0.75 * 0.75 - 0.5 * 0.5), 1e-15);
    EXPECT_EQ(areaBetween(polygon, heights, 0.5, 0.25), 0);
    EXPECT_EQ(areaBetween(polygon, heights, -kInfinity, kInfinity), 0.5);
    EXPECT_EQ(areaBetween(polygon, heights, 2, kInfinity), 0);
}

/// There is no room for more corners than kMost: said, not written behind the end.
TEST(UvPolygon, SaysWhereThereIsNoRoom) {
    UvPolygon round;
    round.count = UvPolygon::kMost;
    for (std::uint32_t i = 0; i < round.count; ++i) {
        const double angle = 6.283185307179586 * i / round.count;
        round.corners[i] = {0.3 + 0.2 * std::cos(angle), 0.3 + 0.2 * std::sin(angle)};
    }
    // A corner alone on one side: the other part has one more than there were.
    Heights heights;
    heights.fill(1);
    heights[3] = -1;
    UvPolygon below;
    UvPolygon above;
    EXPECT_FALSE(split(round, heights, kSlack, below, above));
}

} // namespace
} // namespace voxtact::test
