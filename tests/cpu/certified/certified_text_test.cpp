// SPDX-License-Identifier: MIT
// The functions that host and device share (src/exact/certified*.h), one by one, against what they say of themselves:
// an error that a margin elsewhere hides is an error nevertheless.
#include "core/method/certified_constants.h"
#include "core/transfer/opaque_numbers.h"
#include "cpu/scenes/engine_fixture.h"
#include "exact/certified.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace voxtact::test {
namespace {

using shader::CertifiedBounds;
using shader::CertifiedCell;
using shader::CertifiedPiece;
using shader::VoxelPoint;

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
constexpr float kFloatNan = std::numeric_limits<float>::quiet_NaN();

VoxelPoint drawnPoint(std::mt19937_64& random, double lo, double hi) {
    return {drawn(random, lo, hi), drawn(random, lo, hi), drawn(random, lo, hi)};
}

/// All of it in the domain.
CertifiedCell drawnCell(std::mt19937_64& random, double lo, double hi) {
    CertifiedCell cell{};
    for (float* corner :
         {&cell.x000, &cell.x100, &cell.x010, &cell.x110, &cell.x001, &cell.x101, &cell.x011, &cell.x111}) {
        *corner = drawn(random, lo, hi);
    }
    cell.lo = {0, 0, 0};
    cell.hi = {1, 1, 1};
    cell.safeLo = {-1, -1, -1};
    cell.safeHi = {2, 2, 2};
    return cell;
}

double interpolated(const CertifiedCell& cell, double x, double y, double z) {
    const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    return mix(mix(mix(cell.x000, cell.x100, x), mix(cell.x010, cell.x110, x), y),
               mix(mix(cell.x001, cell.x101, x), mix(cell.x011, cell.x111, x), y), z);
}

/// The range of a cubic's Bernstein coefficients over a triangle, by the polar form of the interpolant.
std::pair<double, double> bernsteinRange(const CertifiedCell& cell, const CertifiedPiece& piece) {
    const std::array points{piece.a, piece.b, piece.c};
    double lo = std::numeric_limits<double>::infinity();
    double hi = -lo;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) {
            for (std::size_t k = j; k < 3; ++k) {
                std::array order{i, j, k};
                std::sort(order.begin(), order.end());
                double sum = 0;
                int count = 0;
                for (const auto& [p, q, r] : {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 0, 2},
                                              std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{2, 1, 0}}) {
                    sum += interpolated(cell, points[order[static_cast<std::size_t>(p)]].x,
                                        points[order[static_cast<std::size_t>(q)]].y,
                                        points[order[static_cast<std::size_t>(r)]].z);
                    ++count;
                }
                lo = std::min(lo, sum / count);
                hi = std::max(hi, sum / count);
            }
        }
    }
    return {lo, hi};
}

TEST(CertifiedText, TheRangeOfAPieceIsThatOfItsBernsteinCoefficients) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 20000 && !HasFailure(); ++round) {
        const CertifiedCell cell = drawnCell(random, -10, 10);
        const CertifiedPiece piece{drawnPoint(random, 0, 1), drawnPoint(random, 0, 1), drawnPoint(random, 0, 1)};
        const shader::CertifiedRange range = certifiedRange(cell, piece);
        const auto [lo, hi] = bernsteinRange(cell, piece);
        EXPECT_NEAR(range.lo, lo, 2e-5);
        EXPECT_NEAR(range.hi, hi, 2e-5);
        EXPECT_NEAR(range.atA, interpolated(cell, piece.a.x, piece.a.y, piece.a.z), 2e-5);
        EXPECT_NEAR(range.atB, interpolated(cell, piece.b.x, piece.b.y, piece.b.z), 2e-5);
        EXPECT_NEAR(range.atC, interpolated(cell, piece.c.x, piece.c.y, piece.c.z), 2e-5);
    }
}

/// Opaque from entry 9.5 to entry 20.5.
class OneBand {
  public:
    [[nodiscard]] shader::OpaqueValues opaque() const {
        return {1, 1, 0, 0.5F, kEnds.data(), {9.5F, 20.5F, 9.5F, 20.5F}};
    }
    static bool isOpaque(double entry) { return entry >= 9.5 && entry <= 20.5; }

  private:
    static constexpr std::array kEnds{9.5F, 20.5F, 9.5F, 20.5F};
};

TEST(CertifiedText, APointProvesATouchWhereAllThatItMayBeIsOpaque) {
    std::mt19937_64 random(testSeed());
    const OneBand band;
    std::array<std::size_t, 2> answers{};
    for (int round = 0; round < 20000 && !HasFailure(); ++round) {
        CertifiedCell cell = drawnCell(random, 0, 31);
        cell.margin = drawn(random, 0, 3);
        const float entry = drawn(random, 0, 31);
        const bool proves = certifiedPointProves(band.opaque(), cell, {0.5F, 0.5F, 0.5F}, entry);
        const bool all = OneBand::isOpaque(entry - cell.margin) && OneBand::isOpaque(entry + cell.margin);
        EXPECT_TRUE(all || !proves) << entry << " within " << cell.margin;
        const bool amply =
            OneBand::isOpaque(entry - cell.margin - 1e-3) && OneBand::isOpaque(entry + cell.margin + 1e-3);
        EXPECT_TRUE(proves || !amply) << entry << " within " << cell.margin;
        ++answers[proves ? 1 : 0];
        cell.safeHi.y = 0.4F; // the point may be beyond the domain
        EXPECT_FALSE(certifiedPointProves(band.opaque(), cell, {0.5F, 0.5F, 0.5F}, entry));
    }
    EXPECT_GT(answers[0], 1000U);
    EXPECT_GT(answers[1], 1000U);
}

TEST(CertifiedText, TwoPointsProveATouchWhereSomethingOpaqueIsBetweenThemForCertain) {
    constexpr double kRounding = 1e-5; // the shader adds in single precision
    std::mt19937_64 random(testSeed());
    const OneBand band;
    std::array<std::size_t, 2> answers{};
    for (int round = 0; round < 20000 && !HasFailure(); ++round) {
        CertifiedCell cell = drawnCell(random, 0, 31);
        cell.margin = drawn(random, 0, 2);
        shader::CertifiedSamples samples{};
        const float a = drawn(random, 0, 31);
        const float b = drawn(random, 0, 31);
        certifiedSample(cell, {0, 0, 0}, a, samples);
        certifiedSample(cell, {1, 1, 1}, b, samples);
        certifiedSample(cell, {0.5F, 2.5F, 0.5F}, 1000, samples); // not certainly in the domain
        certifiedSample(cell, {-1.5F, 0.5F, 0.5F}, -1000, samples);
        EXPECT_EQ(samples.lo, std::min(a, b));
        EXPECT_EQ(samples.hi, std::max(a, b));
        const bool proves = certifiedCrossingProves(band.opaque(), samples, cell.margin);
        const double lo = static_cast<double>(samples.lo) + cell.margin;
        const double hi = static_cast<double>(samples.hi) - cell.margin;
        EXPECT_TRUE((lo < hi + kRounding && lo <= 20.5 && hi >= 9.5) || !proves) << samples.lo << ", " << samples.hi;
        EXPECT_TRUE(proves || !(lo + 1e-2 < hi && lo < 20.49 && hi > 9.51)) << samples.lo << ", " << samples.hi;
        ++answers[proves ? 1 : 0];
    }
    EXPECT_GT(answers[0], 1000U);
    EXPECT_GT(answers[1], 1000U);
    EXPECT_FALSE(certifiedCrossingProves(band.opaque(), shader::CertifiedSamples{false, 0, 31, {}, {}}, 0));
}

TEST(CertifiedText, ACellWithACornerThatIsNoNumberIsNotAllOpaque) {
    std::mt19937_64 random(testSeed());
    const OneBand band;
    CertifiedCell cell = drawnCell(random, 12, 18);
    cell.least = 12;
    cell.greatest = 18;
    EXPECT_TRUE(certifiedCellAllOpaque(band.opaque(), cell));
    for (float* corner :
         {&cell.x000, &cell.x100, &cell.x010, &cell.x110, &cell.x001, &cell.x101, &cell.x011, &cell.x111}) {
        const float before = *corner;
        *corner = kFloatNan;
        EXPECT_FALSE(certifiedCellAllOpaque(band.opaque(), cell));
        *corner = before;
    }
    cell.margin = 4;
    EXPECT_FALSE(certifiedCellAllOpaque(band.opaque(), cell)) << "it reaches 8 and 22";
}

TEST(CertifiedText, APartOfACellIsAsWideAsItsTriangleMayBeDisplaced) {
    float lo = 0;
    float hi = 0;
    shader::certifiedPart(0.5F, 0.25F, 0.75F, 0.125F, 0, 1, lo, hi);
    EXPECT_EQ(lo, 0.125F);
    EXPECT_EQ(hi, 0.875F);
    shader::certifiedPart(-3, 0.25F, 0.95F, 0.125F, 0, 1, lo, hi);
    EXPECT_EQ(lo, 0);
    EXPECT_EQ(hi, 1);
}

struct Placed {
    shader::CertifiedPair pair;
    shader::CertifiedItem item{};
    Grid grid;
    Mat4 voxel_from_object{};
};

Placed drawnPlace(std::mt19937_64& random) {
    Placed out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.grid.size[axis] = static_cast<std::uint32_t>(8 + random() % 60);
        out.grid.spacing[axis] = uniform(random, 0.3, 2);
    }
    const Mat4 pose =
        multiply(translation({uniform(random, -20, 60), uniform(random, -20, 60), uniform(random, -20, 60)}),
                 randomRotation(random));
    out.pair = certifiedPair(pairGrid(out.grid, take(textureFromWorld(out.grid))), pose);
    out.item.sizeX = static_cast<int>(out.grid.size[0]);
    out.item.sizeY = static_cast<int>(out.grid.size[1]);
    out.item.sizeZ = static_cast<int>(out.grid.size[2]);
    return out;
}

bool holds(int outerFirst, int outerLast, int first, int last) {
    return last < first || (outerFirst <= first && outerLast >= last);
}

TEST(CertifiedText, TheBoundsOfABoxHoldThoseOfItsTriangles) {
    std::mt19937_64 random(testSeed());
    std::size_t some = 0;
    for (int round = 0; round < 20000 && !HasFailure(); ++round) {
        const Placed placed = drawnPlace(random);
        const VoxelPoint from = drawnPoint(random, -30, 30);
        const float side = drawn(random, 0, 20);
        std::array<shader::CertifiedVertex, 3> vertices{};
        shader::CertifiedBox box{kFloatInfinity,  kFloatInfinity,  kFloatInfinity,
                                 -kFloatInfinity, -kFloatInfinity, -kFloatInfinity};
        for (shader::CertifiedVertex& vertex : vertices) {
            const VoxelPoint at = drawnPoint(random, 0, side);
            const VoxelPoint object{from.x + at.x, from.y + at.y, from.z + at.z};
            vertex = certifiedVertex(placed.pair, object.x, object.y, object.z);
            box = {std::min(box.loX, object.x), std::min(box.loY, object.y), std::min(box.loZ, object.z),
                   std::max(box.hiX, object.x), std::max(box.hiY, object.y), std::max(box.hiZ, object.z)};
        }
        const CertifiedBounds triangle = certifiedBounds(placed.item, vertices[0], vertices[1], vertices[2]);
        const CertifiedBounds outer = certifiedBoxBounds(placed.item, placed.pair, box);
        EXPECT_GE(outer.delta, triangle.delta);
        for (const shader::CertifiedVertex& vertex : vertices) {
            EXPECT_GT(triangle.delta, vertex.error);
        }
        const bool empty =
            triangle.lastX < triangle.firstX || triangle.lastY < triangle.firstY || triangle.lastZ < triangle.firstZ;
        EXPECT_TRUE(empty || (holds(outer.firstX, outer.lastX, triangle.firstX, triangle.lastX) &&
                              holds(outer.firstY, outer.lastY, triangle.firstY, triangle.lastY) &&
                              holds(outer.firstZ, outer.lastZ, triangle.firstZ, triangle.lastZ)))
            << "round " << round;
        some += empty ? 0U : 1U;
    }
    EXPECT_GT(some, 800U);
}

/// Far from the reference rounding is what matters: the box's error is that of its farthest point.
TEST(CertifiedText, TheErrorOfABoxIsThatOfItsFarthestVertex) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 2000 && !HasFailure(); ++round) {
        const Placed placed = drawnPlace(random);
        const float far = static_cast<float>(std::pow(10.0, uniform(random, 3, 7)));
        const VoxelPoint at = drawnPoint(random, -far, far);
        const shader::CertifiedVertex vertex = certifiedVertex(placed.pair, at.x, at.y, at.z);
        const shader::CertifiedBox box{std::min(0.0F, at.x), std::min(0.0F, at.y), std::min(0.0F, at.z),
                                       std::max(0.0F, at.x), std::max(0.0F, at.y), std::max(0.0F, at.z)};
        EXPECT_GE(certifiedBoxBounds(placed.item, placed.pair, box).delta, vertex.error);
    }
}

TEST(CertifiedText, ATriangleMayBeDisplacedAsFarAsItsWorstVertex) {
    std::mt19937_64 random(testSeed());
    const Placed placed = drawnPlace(random);
    for (std::size_t which = 0; which < 3; ++which) {
        std::array<shader::CertifiedVertex, 3> vertices{};
        for (shader::CertifiedVertex& vertex : vertices) {
            vertex = {drawnPoint(random, 0, 1), 1e-6F};
        }
        vertices[which].error = 0.125F;
        EXPECT_GE(certifiedBounds(placed.item, vertices[0], vertices[1], vertices[2]).delta, 0.125F) << which;
    }
}

TEST(CertifiedText, AVertexThatIsNowhereMakesATriangleThatMayBeAnywhere) {
    std::mt19937_64 random(testSeed());
    const Placed placed = drawnPlace(random);
    for (const float error : {kFloatInfinity, kFloatNan, 2e30F}) {
        for (std::size_t which = 0; which < 3; ++which) {
            std::array<shader::CertifiedVertex, 3> vertices{};
            for (shader::CertifiedVertex& vertex : vertices) {
                vertex = {{-1e6F, -1e6F, -1e6F}, 1e-6F};
            }
            vertices[which].error = error;
            const CertifiedBounds bounds = certifiedBounds(placed.item, vertices[0], vertices[1], vertices[2]);
            EXPECT_EQ(bounds.delta, kFloatInfinity) << error << ", vertex " << which;
            EXPECT_FALSE(bounds.usable);
            EXPECT_EQ(bounds.firstX, -1);
            EXPECT_EQ(bounds.lastX, placed.item.sizeX - 1);
        }
    }
}

} // namespace
} // namespace voxtact::test
