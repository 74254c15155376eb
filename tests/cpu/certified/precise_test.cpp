// SPDX-License-Identifier: MIT
// The sums and products of floats that lose nothing (src/exact/certified_precise.h), against wider arithmetic.
#include "exact/certified_precise.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace voxtact::test {
namespace {

using namespace voxtact::shader;

/// A float of either sign whose exponent is below `range` in size.
float randomFloat(std::mt19937_64& random, int range) {
    const float mantissa = std::uniform_real_distribution<float>(1, 2)(random);
    const int exponent = std::uniform_int_distribution<int>(-range, range)(random);
    return std::ldexp(random() % 2 == 0 ? mantissa : -mantissa, exponent);
}

TEST(Precise, ASumAndAProductLoseNothing) {
    std::mt19937_64 random(testSeed());
    for (int i = 0; i < 100000; ++i) {
        const float a = randomFloat(random, 12);
        const float b = randomFloat(random, 12);
        const PreciseTwo sum = preciseSum(a, b);
        // 24 bits and 25 exponents: a double holds it.
        ASSERT_EQ(double{sum.high} + double{sum.low}, double{a} + double{b}) << a << " + " << b;
        ASSERT_EQ(sum.high, a + b);
        const PreciseTwo product = preciseProduct(a, b);
        ASSERT_EQ(double{product.high} + double{product.low}, double{a} * double{b}) << a << " * " << b;
    }
}

#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;

TEST(Precise, WhatThreeFloatsDropIsAddedUp) {
    std::mt19937_64 random(testSeed());
    int dropped = 0;
    for (int i = 0; i < 100000; ++i) {
        // 24 bits, 81 exponents and the carry of 8 terms: a Quad holds the sum.
        PreciseThree sum{};
        Quad exact = 0;
        for (int term = 0; term < 8; ++term) {
            const float value = randomFloat(random, 40);
            sum = preciseAdded(sum, value);
            exact += Quad{value};
        }
        const Quad error = exact - Quad{sum.high} - Quad{sum.middle} - Quad{sum.low};
        const Quad size = error < 0 ? -error : error;
        ASSERT_TRUE(size <= Quad{sum.missing} * Quad{1.0001}) << i << ": " << sum.missing;
        dropped += error != 0 ? 1 : 0;
    }
    EXPECT_GT(dropped, 100) << "nothing was tested";
}
#endif

PreciseVertex vertexAt(float x, int on, int beyond) {
    PreciseVertex vertex{};
    vertex.point.x.high = x;
    vertex.on = on;
    vertex.beyond = beyond;
    return vertex;
}

TEST(Precise, ATriangleThatMeetsAFaceInACornerIsThatCorner) {
    constexpr int kFace = 3;
    constexpr int kBit = 1 << kFace;
    PreciseVertex a = vertexAt(1, 0, kBit);
    PreciseVertex b = vertexAt(2, kBit, 0);
    PreciseVertex c = vertexAt(3, 0, kBit);
    preciseFold(kFace, a, b, c);
    EXPECT_EQ(a.point.x.high, 2);
    EXPECT_EQ(b.point.x.high, 2);
    EXPECT_EQ(c.point.x.high, 2);
    // One that has a part inside, or meets the face nowhere, stays as it is.
    for (const int onB : {0, kBit}) {
        a = vertexAt(1, 0, onB == 0 ? kBit : 0);
        b = vertexAt(2, onB, onB == 0 ? kBit : 0);
        c = vertexAt(3, 0, kBit);
        preciseFold(kFace, a, b, c);
        EXPECT_EQ(a.point.x.high, 1);
        EXPECT_EQ(b.point.x.high, 2);
        EXPECT_EQ(c.point.x.high, 3);
    }
}

TEST(Precise, WhatTheNumbersOfThePairAreOffByIsKnown) {
    CertifiedPair pair{};
    CertifiedItem item{};
    item.sizeX = item.sizeY = item.sizeZ = 10;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        pair.place[axis][axis] = 1;
        item.scale[axis] = 1;
        pair.error[axis] = 1;
    }
    const VoxelPoint at = voxelPoint(0.005F, 3, 4);
    const PreciseVertex exact = preciseVertex(pair, item, at);
    EXPECT_EQ(exact.error, 0);
    EXPECT_EQ(exact.inside, 63) << "of all six faces";
    EXPECT_EQ(exact.point.y.high, 2.5F) << "the first voxel's centre is half a voxel from the face";
    pair.reference[3] = 1e-3F;
    const PreciseVertex off = preciseVertex(pair, item, at);
    EXPECT_GE(off.error, 7e-3F) << "a thousandth of 0.005 + 3 + 4";
    EXPECT_EQ(off.inside, 62) << "0.005 from the near face of x";
}

TEST(Precise, WithinTheDomainIsWithinByTwiceTheError) {
    constexpr float kError = 1.0F / 1024;
    PreciseTriangle triangle{};
    triangle.b.x.high = 1;
    triangle.c.y.high = 1;
    triangle.error = kError;
    triangle.delta = 4 * kError;
    CertifiedCell cell{};
    cell.hi = voxelPoint(CERTIFIED_DOMAIN_END, 1, 1);
    VoxelPoint polygon[CERTIFIED_MAX_CORNERS]{};
    const auto farthest = [&](bool within) {
        const int count = preciseClip(triangle, cell, voxelPoint(0, 0, 0), within, polygon);
        EXPECT_GE(count, 3);
        float most = 0;
        for (int i = 0; i < count; ++i) {
            most = std::max(most, polygon[i].x);
        }
        return most;
    };
    EXPECT_EQ(farthest(false), CERTIFIED_DOMAIN_END);
    EXPECT_NEAR(farthest(true), CERTIFIED_DOMAIN_END - 2 * kError, 1e-6);
}

} // namespace
} // namespace voxtact::test
