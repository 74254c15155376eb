// SPDX-License-Identifier: MIT
// What the device does with a margin, done on the host: against the oracle of clearances, against
// cpu::ClearanceMeter::within(), and where the distance is known.
#include "cpu/scenes/margin_cases.h"
#include "cpu/scenes/margin_text.h"

#include "certified.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "oracle/clearance_oracle.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <iostream>

namespace voxtact::test {
namespace {

struct Said {
    std::size_t none = 0;
    std::size_t certain = 0;
    std::size_t undecided = 0;
    std::size_t meterUndecided = 0;

    void add(int verdict, const PairAnswer& meter) {
        ++(verdict == CERTIFIED_NONE ? none : verdict == CERTIFIED_CERTAIN ? certain : undecided);
        meterUndecided += meter.possible ? 1U : 0U;
    }
};

/// Neither says yes where the other says no.
void expectNoContradiction(int verdict, const PairAnswer& meter) {
    EXPECT_FALSE(verdict == CERTIFIED_CERTAIN && !meter.hit && !meter.possible);
    EXPECT_FALSE(verdict == CERTIFIED_NONE && meter.hit);
}

TEST(MarginText, IsNeverWrongOnRandomScenes) {
    const std::uint64_t seed = testSeed();
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    Said said;
    const std::size_t cases = randomCases(20000, 40);
    for (std::uint64_t number = 0; number < cases && !testing::Test::HasFailure(); ++number) {
        const MarginCase c = makeMarginCase(seed, number, meter);
        SCOPED_TRACE("case " + std::to_string(number) + ", margin " + std::to_string(c.margin));
        const oracle::OraclePair pair = c.scene.pair();
        const cpu::Volume volume = take(cpu::Volume::create(pair.volume));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(pair.transferFunction));
        const cpu::Mesh mesh = take(cpu::Mesh::create(pair.mesh));
        const cpu::BatchItem item{&mesh, &volume, &function, {&c.scene.world_from_object, 1}};
        const PairAnswer within = take(meter.within({{&item, 1}, {}, c.scene.threshold}, c.margin)).pairs.at(0);
        const int verdict =
            marginVerdict(pair.mesh, volume, function, c.scene.world_from_object, c.scene.threshold, c.margin).verdict;
        expectNoContradiction(verdict, within);
        if (number % 4 == 0) {
            const oracle::OracleClearance truth = take(oracle::clearanceOracle(pair, 1.0 / 64));
            EXPECT_FALSE(verdict == CERTIFIED_CERTAIN && truth.lo > c.margin * (1 + 1e-9)) << truth.lo;
            EXPECT_FALSE(verdict == CERTIFIED_NONE && truth.hi < c.margin * (1 - 1e-9)) << truth.hi;
        }
        said.add(verdict, within);
    }
    std::cout << "  " << cases << " cases: " << said.certain << " within, " << said.none << " not, " << said.undecided
              << " undecided; the host leaves " << said.meterUndecided << " undecided\n";
    EXPECT_GT(said.certain, cases / 8);
    EXPECT_GT(said.none, cases / 8);
    EXPECT_LT(said.undecided, cases / 4);
}

/// What the passes skip, and what they say at a first look, is what a decision of all cells says.
TEST(MarginText, WhatIsSkippedIsNothing) {
    const std::uint64_t seed = testSeed();
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const std::size_t cases = randomCases(2000, 40);
    for (std::uint64_t number = 0; number < cases && !testing::Test::HasFailure(); ++number) {
        const MarginCase c = makeMarginCase(seed, number, meter);
        SCOPED_TRACE("case " + std::to_string(number) + ", margin " + std::to_string(c.margin));
        const oracle::OraclePair pair = c.scene.pair();
        const cpu::Volume volume = take(cpu::Volume::create(pair.volume));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(pair.transferFunction));
        const auto verdict = [&](bool whole) {
            return marginVerdict(pair.mesh, volume, function, c.scene.world_from_object, c.scene.threshold, c.margin,
                                 whole)
                .verdict;
        };
        const int quick = verdict(false);
        const int slow = verdict(true);
        EXPECT_TRUE(quick == slow || slow == CERTIFIED_UNDECIDED) << quick << " " << slow;
    }
}

/// A half-space that is opaque beyond a plane at a known place, in grids of all kinds: the distance of a needle's tip
/// from it is known, and what is a ten-thousandth of a voxel from the margin is told apart.
TEST(MarginText, TellsKnownDistancesApart) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 60 && !HasFailure(); ++round) {
        const KnownPlane known = makeKnownPlane(random, round);
        SCOPED_TRACE("round " + std::to_string(round) + ", distance " + std::to_string(known.distance));
        const cpu::Volume volume = take(cpu::Volume::create(known.volume.view()));
        const cpu::TransferFunction function =
            take(cpu::TransferFunction::create({known.points, known.domain, kDefaultTableSize}));
        const auto verdict = [&](double margin) {
            return marginVerdict(known.mesh.view(), volume, function, identity(), known.threshold, margin).verdict;
        };
        EXPECT_EQ(verdict(known.distance + known.slack), CERTIFIED_CERTAIN);
        EXPECT_EQ(verdict(known.distance - known.slack), CERTIFIED_NONE);
        EXPECT_EQ(verdict(known.distance * 2), CERTIFIED_CERTAIN);
        EXPECT_EQ(verdict(known.distance / 2), CERTIFIED_NONE);
    }
}

} // namespace
} // namespace voxtact::test
