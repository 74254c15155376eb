// SPDX-License-Identifier: MIT
// The certified oracle against dense samples of random cases, and its witnesses against another evaluation.
#include "cpu/judges/certified_judge.h"

#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

using oracle::Certainty;
using oracle::CertifiedOracle;
using oracle::JudgedTriangle;

/// Texture space; far more than the places computed here are off.
constexpr double kNear = 1e-7;

using Triangle = std::array<Vec3, 3>;

/// In texture space.
Triangle triangleOf(const CertifiedCase& c, std::size_t number) {
    const Mat4 texture_from_object = multiply(take(textureFromWorld(c.scene.volume.grid)), c.scene.world_from_object);
    Triangle out;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const double* at = &c.scene.mesh.positions[std::size_t{3} * c.scene.mesh.indices[3 * number + corner]];
        out[corner] = transformPoint(texture_from_object, {at[0], at[1], at[2]});
    }
    return out;
}

Vec3 pointOf(const Triangle& triangle, double a, double b) {
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[axis] = triangle[0][axis] + a * (triangle[1][axis] - triangle[0][axis]) +
                    b * (triangle[2][axis] - triangle[0][axis]);
    }
    return out;
}

/// Barycentric weights of the second and the third corner.
using Weights = std::array<double, 2>;

Vec3 pointOf(const Triangle& triangle, const Weights& weights) {
    return pointOf(triangle, weights[0], weights[1]);
}

/// Of a random point; where the triangle is large, of one in the domain if there is.
Weights sampleWeights(std::mt19937_64& random, const Triangle& triangle) {
    Weights out{};
    for (int i = 0; i < 8; ++i) {
        out = {uniform(random, 0, 1), uniform(random, 0, 1)};
        if (out[0] + out[1] > 1) {
            out = {1 - out[0], 1 - out[1]};
        }
        const Vec3 point = pointOf(triangle, out);
        if (std::max({std::abs(point[0] - 0.5), std::abs(point[1] - 0.5), std::abs(point[2] - 0.5)}) < 0.5) {
            break;
        }
    }
    return out;
}

/// Near others, and of a point of the triangle.
Weights stepFrom(std::mt19937_64& random, const Weights& weights, double size) {
    Weights out{};
    for (std::size_t i = 0; i < 2; ++i) {
        out[i] = std::clamp(weights[i] + uniform(random, -size, size), 0.0, 1.0);
    }
    const double sum = out[0] + out[1];
    return sum > 1 ? Weights{out[0] / sum, out[1] / sum} : out;
}

/// Opaque, and so are its neighbours in all directions.
bool opaqueAround(const CertifiedCase& c, const Vec3& texture) {
    bool out = opacityOf(c, texture) >= c.scene.threshold;
    for (std::size_t axis = 0; axis < 3 && out; ++axis) {
        for (const double step : {-kNear, kNear}) {
            Vec3 beside = texture;
            beside[axis] += step;
            out = out && opacityOf(c, beside) >= c.scene.threshold;
        }
    }
    return out;
}

/// Whether a point is in the plane and between the edges of a triangle; true for triangles too narrow to tell.
bool onTriangle(const Triangle& triangle, const Vec3& point) {
    double uu = 0;
    double uv = 0;
    double vv = 0;
    double up = 0;
    double vp = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double u = triangle[1][axis] - triangle[0][axis];
        const double v = triangle[2][axis] - triangle[0][axis];
        const double p = point[axis] - triangle[0][axis];
        uu += u * u;
        uv += u * v;
        vv += v * v;
        up += u * p;
        vp += v * p;
    }
    const double determinant = uu * vv - uv * uv;
    if (determinant <= 1e-6 * uu * vv) {
        return true;
    }
    const double a = (up * vv - vp * uv) / determinant;
    const double b = (vp * uu - up * uv) / determinant;
    const Vec3 back = pointOf(triangle, a, b);
    const double off = std::hypot(back[0] - point[0], back[1] - point[1], back[2] - point[2]);
    return off <= kNear && a >= -1e-6 && b >= -1e-6 && a + b <= 1 + 1e-6;
}

struct Tally {
    std::map<Certainty, std::size_t> triangles;
    std::map<Certainty, std::size_t> pairs;
    std::size_t opaqueSamples = 0;
    std::size_t crossings = 0;

    void print() const {
        for (const auto& [name, counts] : {std::pair{"pairs", &pairs}, std::pair{"triangles", &triangles}}) {
            std::cout << name;
            for (const auto& [certainty, count] : *counts) {
                std::cout << "  " << toString(certainty) << " " << count;
            }
            std::cout << "\n";
        }
        std::cout << opaqueSamples << " triangles with an opaque sample, " << crossings << " witnesses of a crossing\n";
    }
};

/// The most opaque point that samples find: anywhere, then nearer and nearer to the best.
Vec3 mostOpaque(const CertifiedCase& c, const Triangle& triangle, std::mt19937_64& random) {
    constexpr int kAnywhere = 60;
    constexpr int kNearer = 140;
    Weights best{1.0 / 3, 1.0 / 3};
    double most = -2;
    for (int i = 0; i < kAnywhere + kNearer; ++i) {
        const double size = std::pow(0.9, i - kAnywhere);
        const Weights weights = i < kAnywhere ? sampleWeights(random, triangle) : stepFrom(random, best, size);
        const double opacity = opacityOf(c, pointOf(triangle, weights));
        if (opacity >= most) {
            most = opacity;
            best = weights;
        }
    }
    return pointOf(triangle, best);
}

void checkTriangle(const CertifiedCase& c, std::size_t number, const JudgedTriangle& found, std::mt19937_64& random,
                   Tally& tally) {
    const Triangle triangle = triangleOf(c, number);
    ++tally.triangles[found.certainty];
    const Vec3 point = mostOpaque(c, triangle, random);
    const bool opaque = opaqueAround(c, point);
    tally.opaqueSamples += opaque ? 1U : 0U;
    EXPECT_FALSE(opaque && found.certainty == Certainty::None)
        << "triangle " << number << " at " << point[0] << ", " << point[1] << ", " << point[2];
    if (found.certainty == Certainty::Certain) {
        tally.crossings += found.crossing ? 1U : 0U;
        const double slack = found.crossing ? 1e-8 : 1e-11;
        EXPECT_GE(opacityOf(c, found.witness), c.scene.threshold - slack) << "triangle " << number;
        EXPECT_TRUE(onTriangle(triangle, found.witness)) << "triangle " << number;
    }
}

TEST(CertifiedOracleRandom, NoSampleContradicts) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    Tally tally;
    std::chrono::duration<double> spent{};
    constexpr std::uint64_t kCases = 4000;
    for (std::uint64_t number = 0; number < kCases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const CertifiedCase c = makeCertifiedCase(seed, number);
        const auto start = std::chrono::steady_clock::now();
        const CertifiedOracle oracle = take(oracle::certifiedOracle(c.scene.pair()));
        spent += std::chrono::steady_clock::now() - start;
        ++tally.pairs[oracle.certainty];
        for (std::size_t triangle = 0; triangle < oracle.triangles.size(); ++triangle) {
            checkTriangle(c, triangle, oracle.triangles[triangle], random, tally);
        }
        ASSERT_FALSE(HasFailure());
    }
    tally.print();
    std::cout << kCases / spent.count() << " pairs per second\n";
    EXPECT_GT(tally.pairs[Certainty::Certain], kCases / 5);
    EXPECT_GT(tally.pairs[Certainty::None], kCases / 5);
    EXPECT_LT(tally.pairs[Certainty::Undecided], kCases / 20);
    EXPECT_GT(tally.crossings, kCases / 400);
}

/// The cell of a point, unless it is within `margin` voxels of another; nothing outside the domain.
std::optional<std::array<std::int64_t, 3>> cellOf(const Grid& grid, const Vec3& texture, double margin) {
    std::array<std::int64_t, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place = texture[axis] * grid.size[axis] - 0.5;
        out[axis] = static_cast<std::int64_t>(std::floor(place));
        if (std::abs(place - std::round(place)) < margin || texture[axis] < 0 || texture[axis] > 1) {
            return {};
        }
    }
    return out;
}

TEST(CertifiedOracleRandom, NoSampleContradictsTheCells) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t certain = 0;
    std::size_t undecided = 0;
    std::size_t sampled = 0;
    for (std::uint64_t number = 0; number < 500; ++number) {
        const CertifiedCase c = makeCertifiedCase(seed, number);
        const CertifiedOracle oracle = take(oracle::certifiedOracle(c.scene.pair()));
        for (std::uint32_t triangle = 0; triangle < oracle.triangles.size(); ++triangle) {
            SCOPED_TRACE("case " + std::to_string(number) + ", triangle " + std::to_string(triangle));
            std::map<std::array<std::int64_t, 3>, Certainty> cells;
            std::size_t certainHere = 0;
            for (const oracle::JudgedCell& cell : take(oracle::certifiedCells(c.scene.pair(), triangle))) {
                cells[cell.cell] = cell.certainty;
                certainHere += cell.certainty == Certainty::Certain ? 1U : 0U;
            }
            certain += certainHere;
            undecided += cells.size() - certainHere;
            const Certainty whole = oracle.triangles[triangle].certainty;
            EXPECT_FALSE(whole == Certainty::None && certainHere > 0);
            EXPECT_FALSE(whole == Certainty::Certain && cells.empty());
            const Triangle corners = triangleOf(c, triangle);
            for (int i = 0; i < 300; ++i) {
                const Vec3 point = pointOf(corners, sampleWeights(random, corners));
                const auto cell = cellOf(c.scene.volume.grid, point, 1e-6);
                if (cell && opaqueAround(c, point)) {
                    ++sampled;
                    EXPECT_TRUE(cells.contains(*cell)) << (*cell)[0] << ", " << (*cell)[1] << ", " << (*cell)[2];
                }
            }
        }
        ASSERT_FALSE(HasFailure());
    }
    std::cout << certain << " certain cells, " << undecided << " undecided, " << sampled << " opaque samples\n";
    EXPECT_GT(certain, undecided);
}

TEST(CertifiedOracleRandom, ACoarserOneIsAtMostUndecided) {
    const std::uint64_t seed = testSeed();
    std::size_t fewer = 0;
    for (std::uint64_t number = 0; number < 2000; ++number) {
        const CertifiedCase c = makeCertifiedCase(seed, number);
        const CertifiedOracle fine = take(oracle::certifiedOracle(c.scene.pair()));
        const CertifiedOracle coarse = take(oracle::certifiedOracle(c.scene.pair(), 2));
        for (std::size_t i = 0; i < fine.triangles.size(); ++i) {
            const Certainty rough = coarse.triangles[i].certainty;
            fewer += rough != fine.triangles[i].certainty ? 1U : 0U;
            EXPECT_TRUE(rough == Certainty::Undecided || rough == fine.triangles[i].certainty) << "case " << number;
        }
    }
    EXPECT_GT(fewer, 0U);
}

} // namespace
} // namespace voxtact::test
