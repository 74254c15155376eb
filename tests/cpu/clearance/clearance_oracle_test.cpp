// SPDX-License-Identifier: MIT
// Clearances of random scenes against the oracle, which knows nothing of clusters, bricks and directions.
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/clearance_cases.h"
#include "cpu/scenes/held_scene.h"
#include "cpu/scenes/random_labels.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/clearance_oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

using oracle::OracleClearance;

/// Of coordinates, mm: what the oracle rounds.
double largestCoordinate(const OracleScene& scene) {
    double largest = 0;
    for (std::size_t i = 0; i < scene.mesh.positions.size(); i += 3) {
        const double* at = &scene.mesh.positions[i];
        const Vec3 world = transformPoint(scene.world_from_object, {at[0], at[1], at[2]});
        largest = std::max({largest, std::abs(world[0]), std::abs(world[1]), std::abs(world[2])});
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        largest += std::abs(scene.volume.grid.origin[axis]) + std::abs(scene.world_from_object[12 + axis]) +
                   scene.volume.grid.spacing[axis] * scene.volume.grid.size[axis];
    }
    return largest;
}

double distanceOf(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

struct Tally {
    std::map<std::string, std::size_t> ends;
    std::size_t touching = 0;
    std::size_t apart = 0;
    std::size_t infinite = 0;

    void print() const {
        std::cout << touching << " touch, " << apart << " are apart, " << infinite << " have nothing opaque;";
        for (const auto& [end, count] : ends) {
            std::cout << " " << end << " " << count;
        }
        std::cout << "\n";
    }
};

/// The closest points are what they are said to be.
void checkClosest(const CertifiedCase& c, const PairDistance& says, double slack) {
    if (!says.closest) {
        EXPECT_TRUE(std::isinf(says.bounds.upper));
        return;
    }
    const WitnessPoints& closest = *says.closest;
    EXPECT_LT(closest.triangle, c.scene.mesh.indices.size() / 3);
    // As far apart as `hi` says: so they are no nearer than `lo`.
    EXPECT_NEAR(distanceOf(closest.mesh, closest.volume), says.bounds.upper, slack + 1e-11 * says.bounds.upper);
}

void checkCase(const CertifiedCase& c, cpu::ClearanceMeter& meter, cpu::Detector& detector, double resolution,
               Tally& tally) {
    const HeldScene held(c.scene);
    const PairDistance says = take(meter.measure(held.batch)).pairs.at(0);
    const PairAnswer touch = take(detector.detect(held.batch)).pairs.at(0);
    const OracleClearance truth = take(oracle::clearanceOracle(c.scene.pair(), resolution));
    const double slack = 1e-12 * largestCoordinate(c.scene);
    const auto [lo, hi] = says.bounds;
    EXPECT_LE(lo, hi);
    EXPECT_LE(lo, truth.hi + slack) << "not so far: " << lo << " to " << hi << ", truth " << truth.lo << " to "
                                    << truth.hi;
    EXPECT_GE(hi, truth.lo - slack) << "not so near: " << lo << " to " << hi << ", truth " << truth.lo << " to "
                                    << truth.hi;
    EXPECT_EQ(touch.hit, hi == 0);
    EXPECT_TRUE(!touch.possible || lo == 0);
    EXPECT_TRUE(says.end != StopReason::Closed || hi - lo <= kDefaultTolerance || std::isinf(lo));
    checkClosest(c, says, slack);
    ++tally.ends[toString(says.end)];
    ++(touch.hit ? tally.touching : (std::isinf(lo) ? tally.infinite : tally.apart));
}

TEST(ClearanceOracle, TheTruthIsBetweenTheBounds) {
    const std::uint64_t seed = testSeed();
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
    Tally tally;
    const std::size_t cases = randomCases(100000, 400);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const CertifiedCase c = makeClearanceCase(seed, number);
        checkCase(c, meter, detector, number % 8 == 0 ? 1.0 / 512 : 1.0 / 32, tally);
        ASSERT_FALSE(HasFailure());
    }
    tally.print();
    EXPECT_GT(tally.apart, cases / 4);
    EXPECT_GT(tally.touching, cases / 20);
    EXPECT_GT(tally.ends["closed"], cases * 4 / 5);
}

/// Scenes whose opaque part is thinner than what rounding tells apart: the points were nearer to each other than the
/// bounds said.
TEST(ClearanceOracle, PointsOfAThinPartAreAsFarApartAsTheBoundsSay) {
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    for (const auto& [seed, number] : {std::pair{1034, 63}, {2109, 9}}) {
        const CertifiedCase c = makeClearanceCase(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(number));
        const HeldScene held(c.scene);
        const PairDistance says = take(meter.measure(held.batch)).pairs.at(0);
        ASSERT_TRUE(says.closest);
        EXPECT_GT(says.bounds.lower, 1);
        checkClosest(c, says, 1e-12 * largestCoordinate(c.scene));
    }
}

TEST(ClearanceOracle, TheTruthOfLabelsIsBetweenTheirBounds) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const std::vector<std::int32_t> asked{2, 0, 3, 1, 77};
    std::size_t apart = 0;
    std::size_t infinite = 0;
    std::size_t closed = 0;
    const std::size_t cases = randomCases(20000, 200);
    for (std::uint64_t number = 0; number < cases; ++number) {
        const CertifiedCase c = makeClearanceCase(seed, number);
        const LabelData labels = randomLabels(random, c.scene.volume.grid);
        HeldScene held(c.scene);
        held.item.labels = &labels;
        const std::vector<LabelDistance> says = take(meter.measureLabels(held.batch, asked)).labels;
        const Bounds whole = take(meter.measure(held.batch)).pairs.at(0).bounds;
        const double slack = 1e-12 * largestCoordinate(c.scene);
        ASSERT_EQ(says.size(), asked.size());
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < asked.size(); ++i) {
            SCOPED_TRACE("case " + std::to_string(number) + ", label " + std::to_string(asked[i]));
            const auto [lo, hi] = says[i].bounds;
            const OracleClearance truth = take(
                oracle::labelClearanceOracle(c.scene.pair(), labels, asked[i], number % 8 == 0 ? 1.0 / 256 : 1.0 / 32));
            EXPECT_EQ(says[i].label, asked[i]);
            EXPECT_LE(lo, truth.hi + slack) << lo << " to " << hi << ", truth " << truth.lo << " to " << truth.hi;
            EXPECT_GE(hi, truth.lo - slack) << lo << " to " << hi << ", truth " << truth.lo << " to " << truth.hi;
            EXPECT_GE(hi, whole.lower);
            least = std::min(least, lo);
            ++(std::isinf(lo) ? infinite : apart);
            closed += says[i].end == StopReason::Closed ? 1 : 0;
        }
        // Everything has one of the labels.
        EXPECT_LE(least, whole.upper);
        ASSERT_FALSE(HasFailure());
    }
    std::cout << apart << " are apart, " << infinite << " have nothing, " << closed << " closed\n";
    EXPECT_GT(apart, cases);
    EXPECT_GT(infinite, cases);
    EXPECT_GT(closed, cases * 9 / 2);
}

/// All of a label is what is opaque of it where everything is.
TEST(ClearanceOracle, TheTruthOfWholeLabelsIsBetweenTheirBounds) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1, .labelsAtAnyOpacity = true}));
    const std::vector<std::int32_t> asked{2, 0, 77};
    std::size_t closed = 0;
    const std::size_t cases = randomCases(20000, 150);
    for (std::uint64_t number = 0; number < cases; ++number) {
        CertifiedCase c = makeClearanceCase(seed, number);
        const LabelData labels = randomLabels(random, c.scene.volume.grid);
        HeldScene held(c.scene);
        held.item.labels = &labels;
        const std::vector<LabelDistance> says = take(meter.measureLabels(held.batch, asked)).labels;
        for (ControlPoint& point : c.scene.points) {
            point.opacity = 1;
        }
        const double slack = 1e-12 * largestCoordinate(c.scene);
        ASSERT_EQ(says.size(), asked.size());
        for (std::size_t i = 0; i < asked.size(); ++i) {
            SCOPED_TRACE("case " + std::to_string(number) + ", label " + std::to_string(asked[i]));
            const auto [lo, hi] = says[i].bounds;
            const OracleClearance truth = take(
                oracle::labelClearanceOracle(c.scene.pair(), labels, asked[i], number % 8 == 0 ? 1.0 / 256 : 1.0 / 32));
            EXPECT_LE(lo, truth.hi + slack) << lo << " to " << hi << ", truth " << truth.lo << " to " << truth.hi;
            EXPECT_GE(hi, truth.lo - slack) << lo << " to " << hi << ", truth " << truth.lo << " to " << truth.hi;
            closed += says[i].end == StopReason::Closed ? 1 : 0;
        }
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(closed, cases * 3 * 9 / 10);
}

/// A margin is what the bounds say, and where these leave it open, it is itself.
TEST(ClearanceOracle, AMarginIsWhatTheClearanceSays) {
    const std::uint64_t seed = testSeed();
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1, .tolerance = 1e-4}));
    std::size_t yes = 0;
    std::size_t no = 0;
    const std::size_t cases = randomCases(50000, 100);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const CertifiedCase c = makeClearanceCase(seed, number);
        const HeldScene held(c.scene);
        const PairDistance says = take(meter.measure(held.batch)).pairs.at(0);
        const auto [lo, hi] = says.bounds;
        for (const double margin : {lo / 2, lo * 0.999, hi * 1.001, 2 * hi, 0.5}) {
            if (!(margin > 0) || std::isinf(margin)) {
                continue;
            }
            const PairAnswer answer = take(meter.within(held.batch, margin)).pairs.at(0);
            if (margin < lo) {
                EXPECT_FALSE(answer.hit || answer.possible) << margin << " is below " << lo;
                ++no;
            } else if (margin >= hi && says.end == StopReason::Closed) {
                EXPECT_TRUE(answer.hit) << margin << " is not below " << hi << ", " << lo;
                ++yes;
            } else if (answer.hit) {
                EXPECT_LE(lo, margin);
            }
            EXPECT_EQ(answer.count, answer.hit ? 1U : 0U);
        }
        ASSERT_FALSE(HasFailure());
    }
    std::cout << yes << " within, " << no << " not\n";
    EXPECT_GT(yes, cases);
    EXPECT_GT(no, cases / 2);
}

/// A mesh that is moved by some way is nearer or farther by no more than that.
TEST(ClearanceOracle, AMoveChangesItByNoMoreThanItsLength) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    std::size_t changed = 0;
    const std::size_t cases = randomCases(50000, 100);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        CertifiedCase c = makeClearanceCase(seed, number);
        const Bounds before = take(meter.measure(HeldScene(c.scene).batch)).pairs.at(0).bounds;
        const double by = std::pow(10, uniform(random, -2, 1));
        const Mat4 turn = randomRotation(random);
        c.scene.world_from_object =
            multiply(translation({by * turn[0], by * turn[1], by * turn[2]}), c.scene.world_from_object);
        const Bounds after = take(meter.measure(HeldScene(c.scene).batch)).pairs.at(0).bounds;
        const double slack = 1e-12 * largestCoordinate(c.scene);
        EXPECT_LE(after.lower, before.upper + by + slack);
        EXPECT_GE(after.upper, before.lower - by - slack);
        changed += before.lower > 0 && std::abs(after.lower - before.lower) > 0.1 * by ? 1 : 0;
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(changed, cases / 8);
}

} // namespace
} // namespace voxtact::test
