// SPDX-License-Identifier: MIT
// The text of shaders/exact.h itself: what neither counts nor the oracle tell apart.
#include "exact.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <vector>

namespace voxtact::test {
namespace {

using shader::ExactCorner;
using Bits = std::array<std::uint32_t, 7>;

Bits bitsOf(const ExactCorner& corner) {
    return std::bit_cast<Bits>(std::array{corner.x, corner.y, corner.z, corner.w, corner.tx, corner.ty, corner.tz});
}

ExactCorner drawnCorner(std::mt19937_64& random) {
    const auto draw = [&](double lo, double hi) { return static_cast<float>(uniform(random, lo, hi)); };
    ExactCorner corner;
    corner.x = draw(-3, 3);
    corner.y = draw(-3, 3);
    corner.z = draw(-1, 2);
    corner.w = draw(0.5, 1.5);
    corner.tx = draw(0, 1);
    corner.ty = draw(0, 1);
    corner.tz = draw(0, 1);
    return corner;
}

/// Sorted: where a polygon begins, and which way it goes round, are of no matter.
std::vector<Bits> clipped(std::array<ExactCorner, 3> triangle) {
    ExactCorner corners[EXACT_MAX_CORNERS]{};
    std::copy(triangle.begin(), triangle.end(), corners);
    const int count = shader::exactClip(corners, 3, 1.5F, 1.5F);
    std::vector<Bits> out;
    std::transform(corners, corners + count, std::back_inserter(out), bitsOf);
    std::sort(out.begin(), out.end());
    return out;
}

/// So triangles that share an edge, which go along it in opposite directions, leave no gap where it is cut.
TEST(ExactText, ATriangleTurnedRoundIsCutAtTheSameBits) {
    std::mt19937_64 random(testSeed());
    int cut = 0;
    for (int round = 0; round < 20000 && !HasFailure(); ++round) {
        // Two cuts by two planes may meet in another order: one plane at a time.
        const std::array triangle{drawnCorner(random), drawnCorner(random), drawnCorner(random)};
        int planes = 0;
        for (int plane = 0; plane < 6; ++plane) {
            const auto inside = std::count_if(triangle.begin(), triangle.end(), [&](const ExactCorner& corner) {
                return shader::exactPlane(corner, plane, 1.5F, 1.5F) >= 0;
            });
            planes += inside < 3 ? 1 : 0;
        }
        if (planes != 1) {
            continue;
        }
        const std::vector<Bits> polygon = clipped(triangle);
        EXPECT_EQ(clipped({triangle[2], triangle[1], triangle[0]}), polygon);
        EXPECT_EQ(clipped({triangle[1], triangle[2], triangle[0]}), polygon);
        cut += polygon.empty() ? 0 : 1;
    }
    EXPECT_GT(cut, 100);
}

} // namespace
} // namespace voxtact::test
