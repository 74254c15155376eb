// SPDX-License-Identifier: MIT
// The text of src/exact/exact.h itself: what neither counts nor the oracle tell apart.
#include "cpu/scenes/random_scene.h"
#include "exact/exact.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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
    const int count = shader::exactClip(3, corners, 1.5F, 1.5F);
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

/// Whichever end of an edge is far away, inside or outside of the plane, the place where it is cut is that of the
/// other.
TEST(ExactText, ACutIsAsExactAsTheNearerCorner) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 2000; ++round) {
        ExactCorner inside = drawnCorner(random);
        ExactCorner outside = drawnCorner(random);
        ExactCorner& far = round % 2 == 0 ? inside : outside;
        const auto scale = static_cast<float>(std::pow(10, uniform(random, 0, 20)));
        for (float* of : {&far.x, &far.y, &far.tx, &far.ty, &far.tz}) {
            *of *= scale;
        }
        const float in = drawn(random, 0.1, 1) * (round % 2 == 0 ? scale : 1);
        const float out = -drawn(random, 0.1, 1) * (round % 2 == 0 ? 1 : scale);
        const ExactCorner cut = shader::exactCut(inside, outside, in, out);
        const double span = static_cast<double>(in) - out;
        const auto expectNear = [&](float found, double a, double b) {
            const double ofInside = -out / span * a;
            const double ofOutside = in / span * b;
            // A hundred roundings of what each of both contributes.
            const double error = 100 * (std::abs(ofInside) + std::abs(ofOutside)) * 0x1p-24;
            EXPECT_NEAR(found, ofInside + ofOutside, error) << "round " << round;
        };
        expectNear(cut.x, inside.x, outside.x);
        expectNear(cut.y, inside.y, outside.y);
        expectNear(cut.tx, inside.tx, outside.tx);
        expectNear(cut.ty, inside.ty, outside.ty);
        expectNear(cut.tz, inside.tz, outside.tz);
    }
}

/// A corner with a w of 1 is no sign that the others have one, whichever it is.
TEST(ExactText, ATriangleIsSeenInPerspectiveWhereOneOfItsCornersIs) {
    constexpr int kPixels = 64;
    std::mt19937_64 random(testSeed());
    int covered = 0;
    for (int round = 0; round < 2000 && !HasFailure(); ++round) {
        std::array<ExactCorner, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i) {
            ExactCorner& corner = corners[i];
            corner = drawnCorner(random);
            corner.w = i == static_cast<std::size_t>(round % 3) ? static_cast<float>(uniform(random, 2, 4)) : 1;
            corner.x = 0.3F * corner.x * corner.w;
            corner.y = 0.3F * corner.y * corner.w;
        }
        shader::ExactTriangle triangle{};
        if (!shader::exactSetUp(corners[0], corners[1], corners[2], kPixels, kPixels, triangle)) {
            continue;
        }
        const auto x = static_cast<int>(below(random, kPixels));
        const auto y = static_cast<int>(below(random, kPixels));
        float tx = 0;
        float ty = 0;
        float tz = 0;
        if (!shader::exactFragment(triangle, x, y, tx, ty, tz)) {
            continue;
        }
        // The weights a of the corners with sum a_i (x_i - X w_i, y_i - Y w_i) = 0, at (X, Y) on the screen.
        const double atX = (x + 0.5) / kPixels * 2 - 1;
        const double atY = (y + 0.5) / kPixels * 2 - 1;
        std::array<std::array<double, 2>, 3> off{};
        for (std::size_t i = 0; i < 3; ++i) {
            off[i] = {corners[i].x - atX * corners[i].w, corners[i].y - atY * corners[i].w};
        }
        const auto area = [&](std::size_t i, std::size_t j) { return off[i][0] * off[j][1] - off[i][1] * off[j][0]; };
        const std::array weights{area(1, 2), area(2, 0), area(0, 1)};
        const double sum = weights[0] + weights[1] + weights[2];
        const double expected =
            (weights[0] * corners[0].tx + weights[1] * corners[1].tx + weights[2] * corners[2].tx) / sum;
        // Corners are put on 1/256 of a pixel.
        const double tolerance = 2e-3 / std::abs(sum) + 1e-4;
        if (tolerance < 0.01) {
            EXPECT_NEAR(tx, expected, tolerance) << "round " << round;
            ++covered;
        }
    }
    EXPECT_GT(covered, 50);
}

} // namespace
} // namespace voxtact::test
