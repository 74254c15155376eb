// SPDX-License-Identifier: MIT
// What the device does with a margin, done on the host: against the oracle of clearances, against
// cpu::ClearanceMeter::within(), and where the distance is known.
#include "cpu/scenes/margin_cases.h"
#include "cpu/scenes/margin_text.h"

#include "certified_margin_look.h"
#include "core/method/certified_constants.h"
#include "core/transfer/table_extremes.h"
#include "cpu/scene/scene_impl.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "oracle/clearance_oracle.h"
#include "support/contact_scenes.h"
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

/// A brick that proves something opaque near a vertex: the host finds it, too.
TEST(MarginText, ABrickProvesOnlyWhatIsThere) {
    std::mt19937_64 random(testSeed());
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    Grid grid = obliqueGrid(random, true);
    grid.size = {15, 15, 15}; // 2x2x2 bricks
    const std::vector<ControlPoint> points{{100, 0}, {101, 1}, {102, 0}};
    std::size_t proven = 0;
    for (int round = 0; round < 400; ++round) {
        const std::size_t brick = random() % 8;
        // Noise at either side of the peak, on one side of it, or in it; or a single voxel, in the brick.
        const double least = uniform(random, 60, 101);
        const double range = uniform(random, 0, 60);
        const bool single = round % 2 == 0;
        std::array<std::size_t, 3> voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxel[axis] = random() % 7 + 8 * (brick >> axis & 1U);
        }
        const VolumeData image = makeVolume<std::uint16_t>(grid, ScalarType::UInt16, [&](auto x, auto y, auto z) {
            return single ? (std::array<std::size_t, 3>{x, y, z} == voxel ? 140.0 : 60.0)
                          : std::floor(least + uniform(random, 0, range));
        });
        const cpu::Volume volume = take(cpu::Volume::create(image.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create({points, {0, 256}, 256}));
        const double margin = uniform(random, 8, 25);
        const cpu::VolumeImpl& at = volume.impl();
        const TableExtremes extremes(function.impl().table);
        const shader::CertifiedItem item = withMargin(
            certifiedItem(at.grid, 1, at.storedIntercept, {0, 256}, 256, 0.45, kDefaultResolution), at.grid, margin);
        const shader::OpacityTable table{item.tableSize, item.tableLevels, item.threshold, extremes.values().data()};
        const shader::VoxelPoint vertex{static_cast<float>(uniform(random, -8, 14)),
                                        static_cast<float>(uniform(random, -4, 10)),
                                        static_cast<float>(uniform(random, -4, 10))};
        const auto middle = [&](std::size_t axis) { return (brick >> axis & 1U) != 0U ? 11.0F : 3.0F; };
        if (!shader::marginBrickProves(table, item, shader::marginOf(item), vertex, 1e-4F,
                                       {middle(0), middle(1), middle(2)}, at.bricks.lo[brick], at.bricks.hi[brick])) {
            continue;
        }
        ++proven;
        const Vec3 world = transformPoint(worldFromIndex(grid), {vertex.x, vertex.y, vertex.z});
        MeshData data;
        addTriangle(data, world, world, world);
        const cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
        const Mat4 pose = identity();
        const cpu::BatchItem asked{&mesh, &volume, &function, {&pose, 1}};
        EXPECT_TRUE(take(meter.within({{&asked, 1}, {}, 0.45}, margin)).pairs.at(0).hit) << "round " << round;
    }
    EXPECT_GT(proven, 10U);
    EXPECT_LT(proven, 300U);
}

} // namespace
} // namespace voxtact::test
