// SPDX-License-Identifier: MIT
// What is within a margin, on the device: bit for bit what the same text says on the host, never against the host's
// own cpu::ClearanceMeter::within(), and where distances are known.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/known_pairs.h"
#include "certified/sides.h"
#include "few_kinds.h"

#include "certified.h"
#include "cpu/scenes/margin_cases.h"
#include "cpu/scenes/margin_text.h"
#include "detect/certified/certified_rounds.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <iostream>
#include <limits>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Scenes are made larger or smaller, so that one set of pipelines has them all.
constexpr double kMargin = 2;

DetectorDesc within(double margin) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .margin = margin};
}

int verdictOf(const PairAnswer& answer) {
    EXPECT_FALSE(answer.hit && answer.possible);
    EXPECT_EQ(answer.count, answer.hit ? 1U : 0U);
    EXPECT_EQ(answer.exactness, Exactness::LowerBound);
    EXPECT_EQ(answer.projection, Projection::Conservative);
    return answer.hit ? CERTIFIED_CERTAIN : answer.possible ? CERTIFIED_UNDECIDED : CERTIFIED_NONE;
}

class MarginTest : public CertifiedTest {
  protected:
    /// One pair.
    PairAnswer ask(BlockingDetector& device, const oracle::OraclePair& pair, bool clusters) const {
        return askPair(device, context(), queue(), pair, clusters).pairs.at(0);
    }
};

TEST_F(MarginTest, IsTheHostsTextBitForBitOnRandomCases) {
    const std::uint64_t seed = testSeed();
    BlockingDetector device = detector(within(kMargin));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    std::map<int, std::size_t> said;
    const auto make = [&](std::uint64_t number) { return makeMarginCase(seed, number, meter); };
    const std::uint64_t cases = forFewKinds(randomCases(300, 28), seed, make, [&](MarginCase& c, auto) {
        scaleTo(c, kMargin);
        const oracle::OraclePair pair = c.scene.pair();
        const HostSide side(pair.volume, pair.transferFunction, pair.mesh);
        const cpu::BatchItem item = side.item({&pair.world_from_object, 1});
        const PairAnswer host = take(meter.within({{&item, 1}, {}, pair.threshold}, kMargin)).pairs.at(0);
        const int text =
            marginVerdict(pair.mesh, side.volume, side.function, pair.world_from_object, pair.threshold, kMargin)
                .verdict;
        const PairAnswer plain = ask(device, pair, false);
        EXPECT_EQ(verdictOf(plain), text);
        expectNoContradiction(plain, host);
        // With clusters, a look at a vertex may prove what the text leaves undecided.
        const PairAnswer clusters = ask(device, pair, true);
        EXPECT_TRUE(verdictOf(clusters) == text || (text == CERTIFIED_UNDECIDED && clusters.hit));
        expectNoContradiction(clusters, host);
        ++said[text];
    });
    std::cout << "  " << cases << " cases: " << said[CERTIFIED_CERTAIN] << " within, " << said[CERTIFIED_NONE]
              << " not, " << said[CERTIFIED_UNDECIDED] << " undecided\n";
    if (cases >= 200) { // of fewer, any verdict may have hardly any
        EXPECT_GT(said[CERTIFIED_CERTAIN], cases / 10);
        EXPECT_GT(said[CERTIFIED_NONE], cases / 10);
    }
}

TEST_F(MarginTest, TellsKnownDistancesApart) {
    std::mt19937_64 random(testSeed());
    BlockingDetector device = detector(within(kMargin));
    const std::vector<ScalarType> types = fewTypes();
    for (int round = 0; round < 24 && !HasFailure(); ++round) {
        KnownPlane known = makeKnownPlane(random, round, types);
        SCOPED_TRACE("round " + std::to_string(round));
        const double relative = known.slack / known.distance;
        const auto at = [&](double distance) {
            scaleTo(known, distance);
            return verdictOf(ask(device, pairOf(known), round % 2 == 0));
        };
        EXPECT_EQ(at(kMargin * (1 + relative)), CERTIFIED_NONE);
        EXPECT_EQ(at(kMargin * (1 - relative)), CERTIFIED_CERTAIN);
        EXPECT_EQ(at(kMargin * 2), CERTIFIED_NONE);
        EXPECT_EQ(at(kMargin / 2), CERTIFIED_CERTAIN);
    }
}

TEST_F(MarginTest, OfASingleVoxel) {
    BlockingDetector device = detector(within(kMargin));
    const OneVoxel one;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            for (const double beyond : {-0.01, 0.01}) {
                const MeshData mesh = one.meshAt(axis, side, kMargin + beyond);
                SCOPED_TRACE("axis " + std::to_string(axis) + ", " + std::to_string(side * beyond));
                EXPECT_EQ(verdictOf(ask(device, pairOf(one, mesh), axis == 1)),
                          beyond > 0 ? CERTIFIED_NONE : CERTIFIED_CERTAIN);
            }
        }
    }
}

std::vector<PairAnswer> hostMargins(const Head& scene, double margin) {
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const cpu::BatchItem at = scene.hostItem();
    return take(meter.within({{&at, 1}, {}, kDefaultThreshold}, margin)).pairs;
}

void expectSame(const std::vector<PairAnswer>& a, const std::vector<PairAnswer>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(verdictOf(a[i]), verdictOf(b[i])) << "pair " << i;
    }
}

TEST_F(MarginTest, NothingDependsOnTheRooms) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint32_t kPoses = 10;
    std::size_t left = 0;
    for (const bool clusters : {true, false}) {
        const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:1500")), kPoses, seed, clusters);
        for (const double margin : {1.0, 9.0}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", margin " + std::to_string(margin));
            DetectorDesc desc = within(margin);
            desc.counters = true;
            const Answered one = detect(desc, scene.batch(), kPoses, 16384);
            const Answered many = detect(desc, scene.batch(), kPoses, 16);
            expectSame(one.pairs, many.pairs);
            const std::vector<PairAnswer> host = hostMargins(scene, margin);
            for (std::size_t i = 0; i < kPoses; ++i) {
                expectNoContradiction(one.pairs[i], host[i]);
                EXPECT_FALSE(one.pairs[i].possible) << "pair " << i;
            }
            EXPECT_EQ(one.counters.left, 0U);
            EXPECT_EQ(one.counters.cellsOpen, 0U);
            EXPECT_LE(many.counters.mostLooks, 16U * 65536U + 4U * 64U * 32U);
            left += many.counters.left;
        }
    }
    EXPECT_GT(left, 0U);
}

/// Triangles that are near more bricks than a lane looks at.
TEST_F(MarginTest, OfTrianglesThroughAllOfIt) {
    const std::uint64_t seed = testSeed();
    MeshData flat = makeFlat(-90, 90, -90, 90, 0);
    constexpr std::uint32_t kPoses = 12;
    const Head scene(context(), queue(), flat, kPoses, seed);
    DetectorDesc desc = within(11);
    desc.counters = true;
    const Answered found = detect(desc, scene.batch(), kPoses, 16384);
    expectSame(found.pairs, detect(desc, scene.batch(), kPoses, 16).pairs);
    const std::vector<PairAnswer> host = hostMargins(scene, 11);
    for (std::size_t i = 0; i < kPoses; ++i) {
        expectNoContradiction(found.pairs[i], host[i]);
    }
    EXPECT_LE(static_cast<double>(found.counters.bricksSeen + found.counters.cellsSeen),
              kPoses * meshLooks(scene.item, 11).of(0, 1));
}

/// What certainly touches is within every margin, what is within one is within a larger one; and a margin of 0 is the
/// touch.
TEST_F(MarginTest, GrowsWithTheMargin) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint32_t kPoses = 24;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed);
    DetectorDesc touch = within(0);
    std::vector<PairAnswer> before = detect(touch, scene.batch(), kPoses, 2048).pairs;
    std::size_t hits = 0;
    for (const double margin : {0.02, 3.0, 20.0}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", margin " + std::to_string(margin));
        const std::vector<PairAnswer> now = detect(within(margin), scene.batch(), kPoses, 2048).pairs;
        const std::vector<PairAnswer> host = hostMargins(scene, margin);
        for (std::size_t i = 0; i < kPoses; ++i) {
            EXPECT_FALSE(before[i].hit && !now[i].hit) << "pair " << i;
            expectNoContradiction(now[i], host[i]);
            hits += now[i].hit ? 1U : 0U;
        }
        before = now;
    }
    EXPECT_GT(hits, kPoses / 4);
    EXPECT_LT(hits, 3 * kPoses);
}

/// Poses on the device make the same pairs.
TEST_F(MarginTest, OfPosesOnTheDevice) {
    constexpr std::uint32_t kPoses = 10;
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    const PosesOnDevice poses(raw(), context(), scene.poses);
    DetectorDesc desc = within(kMargin);
    const std::vector<PairAnswer> wanted = detect(desc, scene.batch(), kPoses, 2048).pairs;
    desc.devicePoses = true;
    scene.item.world_from_object = {};
    scene.item.poses = &poses.buffer();
    expectSame(detect(desc, scene.batch(), kPoses, 2048).pairs, wanted);
}

TEST_F(MarginTest, RefusesWhatHasNoAnswer) {
    const auto refusal = [&](const DetectorDesc& desc) {
        const Result<Detector> made = Detector::create(context(), desc);
        EXPECT_FALSE(made.ok());
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        return made.ok() ? std::string() : made.error().text;
    };
    for (const double margin :
         {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1000001.0}) {
        EXPECT_THAT(refusal(within(margin)), HasSubstr("mm is not a number from 0 to 1000000"));
    }
    DetectorDesc counts = within(1);
    counts.stopAtFirst = false;
    EXPECT_THAT(refusal(counts), HasSubstr("it needs a detector that stops at the first survivor"));
    DetectorDesc outputs = within(1);
    outputs.outputs.triangles = true;
    EXPECT_THAT(refusal(outputs), HasSubstr("by yes or no, without outputs"));
    EXPECT_THAT(refusal({.method = CountingMethod::Compute, .margin = 1}),
                HasSubstr("a margin is for the projection conservative, not for view"));
    EXPECT_THAT(refusal({.margin = 1}), HasSubstr("a margin is for the projection conservative"));
    EXPECT_TRUE(Detector::create(context(), within(1000000)).ok());
}

} // namespace
} // namespace voxtact::test
