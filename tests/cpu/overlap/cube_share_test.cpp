// SPDX-License-Identifier: MIT
#include "host/overlap/cube_share.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using cpu::LinearSign;
using cpu::Trilinear;
using glm::dvec3;

/// Mostly of one slope, bent by up to as much.
Trilinear randomTerms(std::mt19937_64& random) {
    Trilinear terms{};
    const double bent = std::exp2(uniform(random, -6, 0));
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const bool isLinear = i == 1 || i == 2 || i == 4;
        terms[i] = uniform(random, -1, 1) * (isLinear || i == 0 ? 1 : bent);
    }
    return terms;
}

TEST(OverlapCubeShare, TheLinearSignIsRight) {
    std::mt19937_64 random(testSeed());
    std::size_t told = 0;
    std::size_t all = 0;
    for (std::size_t round = 0; round < randomCases(1000000, 50); ++round) {
        const Trilinear terms = randomTerms(random);
        const double from = uniform(random, -1, 1);
        const LinearSign linear = cpu::linearSign(terms, from);
        for (int i = 0; i < 32; ++i, ++all) {
            dvec3 at{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
            for (int axis = 0; axis < 3; ++axis) {
                at[axis] = uniform(random, 0, 1) < 0.3 ? std::copysign(1.0, at[axis]) : at[axis];
            }
            const double value = cpu::valueAt(terms, at) - from;
            const double says = linear.middle + linear.slope.x * at.x + linear.slope.y * at.y + linear.slope.z * at.z;
            if (std::abs(says) > linear.off + 1e-14) {
                ++told;
                ASSERT_EQ(says > 0, value > 0) << "round " << round << ": " << says << ", " << value;
            }
        }
    }
    std::cout << told << " of " << all << " told\n";
    EXPECT_GT(told, all / 2);
}

/// Off by the square of how bent it is: a surface that is halved is four times as near to a plane.
TEST(OverlapCubeShare, TheLinearSignIsOffByTheSquare) {
    const auto off = [](double bent) {
        return cpu::linearSign({0, 1, 0.25, bent, 0.125, bent, bent * bent, bent * bent * bent}, 0).off;
    };
    EXPECT_LT(off(0x1p-4), 0x1p-4);
    const auto flat = [](double bent) { return cpu::linearSign({0, 1, 0, bent, 0, bent, 0, 0}, 0).off; };
    EXPECT_EQ(flat(0x1p-4), 0x1p-6);
    EXPECT_EQ(flat(0x1p-5), 0x1p-8);
}

} // namespace
} // namespace voxtact::test
