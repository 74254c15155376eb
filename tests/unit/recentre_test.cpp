// SPDX-License-Identifier: MIT
#include "core/geometry/recentre.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

/// The largest distance between the vertices and what stands for them, in extended precision.
double farthestOff(std::span<const double> positions, const Recentred& found) {
    long double most = 0;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        long double squares = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const long double off = static_cast<long double>(found.positions[i + axis]) +
                                    static_cast<long double>(found.origin.offset[axis]) -
                                    static_cast<long double>(positions[i + axis]);
            squares += off * off;
        }
        most = std::max(most, std::sqrt(squares));
    }
    return static_cast<double>(most);
}

TEST(Recentre, FloatsStayWhereTheyAre) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 200; ++i) {
        const double far = std::pow(10, uniform(random, -3, 8));
        std::vector<double> positions;
        for (int k = 0; k < 30; ++k) {
            positions.push_back(static_cast<float>(far + uniform(random, -1, 1)));
        }
        const Recentred found = recentred(positions);
        EXPECT_EQ(found.origin.offset, Vec3{});
        EXPECT_EQ(found.origin.rounding, 0);
        EXPECT_EQ(found.positions, floatsOf(positions));
    }
}

TEST(Recentre, DoublesNearTheOriginToo) {
    const std::vector<double> positions{0.1, 0, 0, 10, 0.3, 0, 10, 10, 0.7};
    const Recentred found = recentred(positions);
    EXPECT_EQ(found.origin.offset, Vec3{});
    EXPECT_EQ(found.positions, floatsOf(positions));
    EXPECT_GT(found.origin.rounding, 0);
    EXPECT_LT(found.origin.rounding, 1e-6);
}

TEST(Recentre, RoundsNoMoreThanItSaysAndNoMoreThanItsSizeMakesIt) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 500; ++i) {
        const double size = std::pow(10, uniform(random, -3, 4));
        std::vector<double> positions;
        Vec3 centre{};
        for (double& coordinate : centre) {
            coordinate = uniform(random, -1, 1) * std::pow(10, uniform(random, 0, 9));
        }
        for (int k = 0; k < 10; ++k) {
            for (const double coordinate : centre) {
                positions.push_back(coordinate + uniform(random, -size, size));
            }
        }
        const Recentred found = recentred(positions);
        const double off = farthestOff(positions, found);
        EXPECT_LE(off, found.origin.rounding);
        EXPECT_GE(off, 0.9 * found.origin.rounding);
        // Coordinates of three sizes and less, each half a unit of its last place off. The offset has 20 bits.
        const double far = std::max({std::abs(centre[0]), std::abs(centre[1]), std::abs(centre[2])});
        EXPECT_LE(found.origin.rounding, 4 * std::max(size, far * 0x1p-19) * 0x1p-23);
    }
}

TEST(Recentre, APointAndExtremesHaveAnOffset) {
    const std::vector<double> point{4500000.2, -3.3, 7.1, 4500000.2, -3.3, 7.1, 4500000.2, -3.3, 7.1};
    EXPECT_LT(recentred(point).origin.rounding, 1e-6);
    const std::vector<double> largest{3e38, 3e38, 3e38, 3e38, 2.9999999e38, 3e38, 2.9999999e38, 3e38, 3e38};
    for (const float coordinate : recentred(largest).positions) {
        EXPECT_TRUE(std::isfinite(coordinate));
    }
    const std::vector<double> tiny{1e-310, 0, 0, 0, 1e-310, 0, 0, 0, 1e-310};
    EXPECT_GT(recentred(tiny).origin.rounding, 0);
}

TEST(Recentre, AMeshTellsItsRoundingAndItsOwnBounds) {
    const std::vector<double> positions{4500000.2, 0, 0, 4500001.2, 0, 0, 4500000.2, 1, 0};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    const MeshFacts facts = checkMesh({positions, indices}).value();
    EXPECT_EQ(facts.bounds.lo[0], 4500000.2);
    EXPECT_EQ(facts.bounds.hi[0], 4500001.2);
    EXPECT_EQ(facts.degenerate, 0U);
    EXPECT_LT(facts.rounding, 1e-7);
    const std::vector<double> beyond{1e39, 0, 0, 1, 0, 0, 0, 1, 0};
    EXPECT_NE(checkMesh({beyond, indices}).error().text.find("beyond the range of floats"), std::string::npos);
}

} // namespace
} // namespace voxtact::test
