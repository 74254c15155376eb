// SPDX-License-Identifier: MIT
// What the certified oracle is made of: bounds of values and of opacities, cuts.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/certified_sample.h"

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

using oracle::certified::Cell;
using oracle::certified::Corners;
using oracle::certified::Field;
using oracle::certified::Opacity;
using oracle::certified::Polygon;

using CornerWeights = std::array<double, 3>;

CornerWeights randomWeights(std::mt19937_64& random) {
    CornerWeights out{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
    const double sum = out[0] + out[1] + out[2];
    for (double& weight : out) {
        weight /= sum;
    }
    return out;
}

Vec3 weighted(const Corners& triangle, const CornerWeights& weights) {
    Vec3 out{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out[axis] += weights[corner] * triangle[corner][axis];
        }
    }
    return out;
}

Corners randomCorners(std::mt19937_64& random, const Cell& cell) {
    Corners out{};
    for (Vec3& corner : out) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner[axis] = static_cast<double>(cell[axis]) + uniform(random, 0, 1);
        }
    }
    return out;
}

Field fieldOf(const VolumeData& volume) {
    return {volume.view(), take(checkVolume(volume.view()))};
}

TEST(CertifiedParts, ValuesOverATriangleHoldAllThatAreInIt) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 300; ++round) {
        const VolumeData volume =
            makeBytes(unitGrid(3, 4, 2), [&](auto...) { return static_cast<double>(random() % 256); });
        const Field field = fieldOf(volume);
        Cell cell{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cell[axis] = static_cast<std::int64_t>(below(random, volume.grid.size[axis] + 1)) - 1;
        }
        const Corners corners = randomCorners(random, cell);
        const ValueRange range = field.over(field.voxelsOf(cell), cell, corners, 0);
        for (int i = 0; i < 100; ++i) {
            const ValueRange value = field.at(weighted(corners, randomWeights(random)), 0);
            ASSERT_GE(value.hi, range.lo);
            ASSERT_LE(value.lo, range.hi);
        }
    }
}

TEST(CertifiedParts, ValuesOverATriangleAreTightWhereNothingBends) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 300; ++round) {
        const double steps[] = {uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -50, 50)};
        const VolumeData volume = makeVolume<float>(unitGrid(2), ScalarType::Float32, [&](auto x, auto y, auto z) {
            return x * steps[0] + y * steps[1] + z * steps[2];
        });
        const Field field = fieldOf(volume);
        const Corners corners = randomCorners(random, {0, 0, 0});
        double lo = 1e9;
        double hi = -1e9;
        for (const Vec3& corner : corners) {
            lo = std::min(lo, field.at(corner, 0).hi);
            hi = std::max(hi, field.at(corner, 0).lo);
        }
        const ValueRange range = field.over(field.voxelsOf({0, 0, 0}), {0, 0, 0}, corners, 0);
        EXPECT_NEAR(range.lo, lo, 1e-4); // the voxels are floats, and do not add up beyond that
        EXPECT_NEAR(range.hi, hi, 1e-4);
    }
}

TEST(CertifiedParts, AValueHoldsThoseNearby) {
    std::mt19937_64 random(testSeed());
    const VolumeData volume = makeBytes(unitGrid(5), [&](auto...) { return static_cast<double>(random() % 256); });
    const Field field = fieldOf(volume);
    for (int round = 0; round < 10000; ++round) {
        const double error = std::pow(10, uniform(random, -9, -2));
        Vec3 place{};
        Vec3 beside{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            place[axis] = uniform(random, -0.5, 4.5);
            beside[axis] = place[axis] + (chance(random, 0.5) ? error : -error);
        }
        const ValueRange value = field.at(place, error);
        const ValueRange other = field.at(beside, 0);
        ASSERT_GE(other.hi, value.lo);
        ASSERT_LE(other.lo, value.hi);
    }
}

constexpr std::array<ControlPoint, 6> kPeakAndPlateau{{{0, 0}, {1, 1}, {2, 0}, {3, 0.75}, {4, 0.75}, {5, 0}}};

TEST(CertifiedParts, OpacitiesOverRangesOfValues) {
    const Opacity opacity(kPeakAndPlateau, 0.5);
    const auto expect = [&](double lo, double hi, bool may, bool all) {
        EXPECT_EQ(opacity.mayBeOpaque({lo, hi}), may) << lo << " to " << hi;
        EXPECT_EQ(opacity.allOpaque({lo, hi}), all) << lo << " to " << hi;
    };
    expect(0, 0.499, false, false);
    expect(0, 0.501, true, false);
    expect(0.501, 1.499, true, true);
    expect(0.1, 1.9, true, false);
    expect(0.9, 3.1, true, false); // with a gap between opaque ends
    expect(1.501, 2.499, false, false);
    expect(2.9, 4.1, true, true);
    expect(3, 4, true, true);
    expect(-100, 0, false, false);
    expect(5, 100, false, false);
    expect(-100, 100, true, false);
}

TEST(CertifiedParts, OpaqueValuesBetweenTwo) {
    const Opacity opacity(kPeakAndPlateau, 0.5);
    EXPECT_NEAR(opacity.opaqueBetween(0.1, 1.9).value(), 1, 1e-12);
    EXPECT_NEAR(opacity.opaqueBetween(0.1, 0.6).value(), 0.6, 1e-12);
    EXPECT_NEAR(opacity.opaqueBetween(1.4, 2.1).value(), 1.4, 1e-12);
    EXPECT_FALSE(opacity.opaqueBetween(0, 0.499).has_value());
    EXPECT_FALSE(opacity.opaqueBetween(1.501, 2.499).has_value());
    EXPECT_EQ(opacity.opaqueBetween(1, 1), 1);
    EXPECT_FALSE(opacity.opaqueBetween(4.9, 100).has_value());
}

TEST(CertifiedParts, SlabsOfATriangleAddUpToIt) {
    std::mt19937_64 random(testSeed());
    const auto area = [](const Polygon& polygon) {
        double out = 0;
        for (std::size_t i = 0; i + 2 < polygon.size(); ++i) {
            double u[3];
            double v[3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                u[axis] = polygon[i + 1][axis] - polygon[0][axis];
                v[axis] = polygon[i + 2][axis] - polygon[0][axis];
            }
            out += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
        }
        return out;
    };
    for (int round = 0; round < 300; ++round) {
        const Corners corners = randomCorners(random, {0, 0, 0});
        const Polygon whole(corners.begin(), corners.end());
        double sum = 0;
        for (int x = 0; x < 4; ++x) {
            const Polygon part = oracle::certified::slab(whole, 0, x / 4.0, (x + 1) / 4.0);
            for (int y = 0; y < 3; ++y) {
                sum += area(oracle::certified::slab(part, 1, y / 3.0, (y + 1) / 3.0));
            }
        }
        EXPECT_NEAR(sum, area(whole), 1e-12);
        const auto halves = oracle::certified::halves(corners);
        for (const Corners& half : halves) {
            EXPECT_NEAR(area({half.begin(), half.end()}), area(whole) / 2, 1e-12);
            EXPECT_LE(oracle::certified::longestEdge(half), oracle::certified::longestEdge(corners));
        }
    }
}

} // namespace
} // namespace voxtact::test
