// SPDX-License-Identifier: MIT
// What the passes of the projection `certified` count of themselves, and the rounds that bound their work by it.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "device/touch/certified_rounds.h"
#include "support/host_meters.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kGroup = 64;

class CountersTest : public CertifiedTest {
  protected:
    static AnyDesc counted(bool stopAtFirst = false) {
        return {.method = CountingMethod::Compute,
                .projection = Projection::Certified,
                .stopAtFirst = stopAtFirst,
                .counters = true};
    }
};

void expectSameCounts(const std::vector<PairAnswer>& a, const std::vector<PairAnswer>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].count, b[i].count) << "pair " << i;
        EXPECT_EQ(a[i].possible, b[i].possible) << "pair " << i;
    }
}

/// A scalpel of small triangles. Not at a seed of each run: how much work poses are is what the tests say, and some are
/// none or more than a room.
struct Scalpel : Head {
    std::uint32_t clusters = (mesh.triangles() + kGroup - 1) / kGroup;

    Scalpel(const Context& context, const QueueAccess& queue, std::size_t count)
        : Head(context, queue, take(makeBuiltinMesh("scalpel:1500")), count, 7, true, 0.7) {}
};

TEST_F(CountersTest, TheyAreTheWorkOfABatch) {
    const Scalpel scene(context(), queue(), 12);
    const Answered with = detect(counted(), scene.batch(), 12, 16384);
    AnyDesc plain = counted();
    plain.counters = false;
    expectSameCounts(with.pairs, detect(plain, scene.batch(), 12, 16384).pairs);
    const CertifiedCounters& c = with.counters;
    std::uint64_t survivors = 0;
    for (const PairAnswer& pair : with.pairs) {
        survivors += pair.count;
    }
    EXPECT_GT(survivors, 0U);
    EXPECT_EQ(c.rounds, 1U); // 12 pairs of so few clusters fit one
    EXPECT_EQ(c.room, 16384U);
    EXPECT_EQ(c.clusters, 12U * scene.clusters);
    EXPECT_LT(c.clustersKept, c.clusters);
    EXPECT_LE(c.runsKept, 4 * c.clustersKept);
    EXPECT_GE(4 * c.runsKept, c.clustersKept);
    EXPECT_LE(c.cellsListed, c.cellsSeen);
    EXPECT_EQ(c.cellsDecided, c.cellsListed); // all had room, and no pair is done before the end of a count
    EXPECT_EQ(c.lanes, (c.cellsDecided + kGroup - 1) / kGroup * kGroup);
    EXPECT_GE(c.cellsDecided + c.cellsCertain, survivors); // each is a cell that a lane decided, or clear
    EXPECT_LT(c.cellsListed, survivors / 2);
    EXPECT_LE(c.cellsListed + c.cellsCertain, c.cellsSeen);
    EXPECT_LT(c.cellsOpen, c.cellsDecided);
    EXPECT_EQ(c.left, 0U);
    EXPECT_EQ(c.bricksLeft + c.cellsLeft, 0U);
    // One round: its peaks are the totals.
    EXPECT_EQ(c.peakClusters, c.clustersKept);
    EXPECT_EQ(c.peakRuns, c.runsKept);
    EXPECT_EQ(c.peakParts, c.largeParts);
    EXPECT_EQ(c.peakCells, c.cellsListed);
    EXPECT_EQ(c.peakOpen, c.cellsOpen);
    EXPECT_EQ(c.peakTests, c.bricksSeen + c.cellsSeen);
}

/// More rounds than there are headers, and queues that hold a few triangles' cells.
TEST_F(CountersTest, TotalsDoNotDependOnTheRounds) {
    const Scalpel scene(context(), queue(), 12);
    const CertifiedCounters one = detect(counted(), scene.batch(), 12, 16384).counters;
    const Answered many = detect(counted(), scene.batch(), 12, 16);
    const CertifiedCounters& c = many.counters;
    EXPECT_EQ(c.rounds, 12 * ((scene.clusters + 3) / 4)); // a count has rounds of a quarter of the room
    EXPECT_GT(c.rounds, 64U);
    EXPECT_EQ(c.clusters, one.clusters);
    EXPECT_EQ(c.clustersKept, one.clustersKept);
    EXPECT_EQ(c.runsKept, one.runsKept);
    EXPECT_EQ(c.cellsSeen, one.cellsSeen);
    EXPECT_EQ(c.cellsListed, one.cellsListed);
    EXPECT_EQ(c.cellsCertain, one.cellsCertain);
    EXPECT_LE(c.peakClusters, 4U);
    EXPECT_GE(c.peakClusters * std::uint64_t{c.rounds}, c.clustersKept);
    EXPECT_LE(c.cellsDecided, c.cellsListed);
    // What had no room was examined again.
    EXPECT_EQ(c.left > 0, c.cellsLeft > 0);
    EXPECT_EQ(c.peakCells > 16U * 32U || c.peakParts > 4U, c.left > 0);
}

/// Small triangles and large ones, in cells that are opaque all over: a decision is only made of these where outputs
/// want a witness, and the count is the same.
TEST_F(CountersTest, WhatIsClearCountsWithoutADecision) {
    const Scalpel scene(context(), queue(), 6);
    const Mesh large = upload(makeFlat(-60, 60, -60, 60, 0.5));
    const std::array items{scene.item, BatchItem{&large, &scene.volume, &scene.function, scene.poses}};
    AnyDesc desc = counted();
    BlockingDetector clear = detector(desc);
    desc.outputs.triangles = true;
    BlockingDetector decided = detector(desc);
    for (const BatchItem& item : items) {
        const Batch batch{{&item, 1}, {}, kDefaultThreshold};
        const BatchAnswer found = take(clear.detect(batch));
        const BatchAnswer wanted = take(decided.detect(batch));
        expectSameCounts(found.pairs, wanted.pairs);
        EXPECT_EQ(wanted.counters->cellsCertain, 0U);
        EXPECT_GT(found.counters->cellsCertain, wanted.counters->cellsListed / 4);
        EXPECT_LE(found.counters->cellsListed + found.counters->cellsCertain, wanted.counters->cellsListed);
    }
}

TEST_F(CountersTest, OfABlockingDetectorAndOfNothing) {
    const Scalpel scene(context(), queue(), 3);
    BlockingDetector blocking = detector(counted());
    const BatchAnswer answer = take(blocking.detect(scene.batch()));
    ASSERT_TRUE(answer.counters);
    EXPECT_EQ(answer.counters->clusters, 3U * scene.clusters);
    const CertifiedCounters twice = together(*answer.counters, *answer.counters);
    EXPECT_EQ(twice.clusters, 6U * scene.clusters);
    EXPECT_EQ(twice.rounds, 2 * answer.counters->rounds);
    EXPECT_EQ(twice.peakCells, answer.counters->peakCells);
    const BatchAnswer nothing = take(blocking.detect({}));
    ASSERT_TRUE(nothing.counters);
    EXPECT_EQ(nothing.counters->rounds, 0U);
    BlockingDetector plain = detector({.method = CountingMethod::Compute, .projection = Projection::Certified});
    EXPECT_FALSE(take(plain.detect(scene.batch())).counters);
}

TEST_F(CountersTest, WhatHasNoneRefusesThem) {
    const Scalpel scene(context(), queue(), 1);
    AnyDesc desc = counted();
    desc.counters = false;
    const Detector detector = take(Detector::create(context(), desc));
    Results results = take(Results::create(detector, {}));
    const VkCommandBuffer commands = raw().begin();
    take(detector.cmdDetect(commands, scene.batch(), results));
    take(results.cmdReadBack(commands));
    raw().submitAndWait(commands);
    const Result<CertifiedCounters> none = results.counters();
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().code, ErrorCode::NotReady);
    EXPECT_THAT(none.error().text, HasSubstr("without CertifiedDesc::counters"));
}

// No watchdog

/// Every cell of a chessboard may be opaque. A mesh in planes between its voxels is not, nor is it far from it: there
/// the value is halfway between the two, and the peak beside that. So nothing ends early.
struct Adversary {
    static constexpr std::uint32_t kSide = 64;
    VolumeData board = makeBytes(unitGrid(kSide), [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (x + y + z) % 2 == 0 ? 0.0 : 255.0;
    });
    std::array<ControlPoint, 3> points{ControlPoint{126.9, 0}, ControlPoint{127, 1}, ControlPoint{127.1, 0}};
    TransferFunctionDesc table{points, {0, 255}, 4096};
    double threshold = 0.6; // below what the entries of the table near the peak have

    /// Sixty small triangles, and four that go through the whole volume: a cluster.
    static MeshData mesh(std::mt19937_64& random) {
        MeshData out;
        for (std::uint32_t triangle = 0; triangle < 64; ++triangle) {
            const bool large = triangle % 16 == 5;
            const double x = static_cast<double>(8 + random() % 48) / kSide; // between two voxels
            const double y = large ? 0.5 : uniform(random, 0.1, 0.9);
            const double z = large ? 0.5 : uniform(random, 0.1, 0.9);
            const double side = large ? 1.8 : 0.01;
            for (const auto& [toY, toZ] : {std::pair(-0.5, -0.4), std::pair(0.5, -0.5), std::pair(0.05, 0.5)}) {
                for (const double coordinate : {x, y + side * toY, z + side * toZ}) {
                    out.positions.push_back(static_cast<float>(coordinate));
                }
            }
            out.indices.insert(out.indices.end(), {3 * triangle, 3 * triangle + 1, 3 * triangle + 2});
        }
        return out;
    }
};

TEST_F(CountersTest, NoDispatchDoesMoreThanItsBound) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const Adversary scene;
    const MeshData data = Adversary::mesh(random);
    const Volume volume = take(Volume::upload(context(), queue(), scene.board.view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), scene.table));
    const cpu::Volume hostVolume = take(cpu::Volume::create(scene.board.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(scene.table));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
    constexpr std::uint32_t kRoom = 16;
    std::vector<Mat4> poses;
    for (std::uint32_t i = 0; i < kRoom; ++i) {
        poses.push_back(translation({0, uniform(random, -0.02, 0.02), uniform(random, -0.02, 0.02)}));
    }
    const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
    const BatchAnswer onHost =
        take(take(cpu::Detector::create({.stopAtFirst = true, .projection = Projection::Certified}))
                 .detect({{&hostItem, 1}, {}, scene.threshold}));
    // Beside the large ones, a cluster has 64 triangles of 27 cells.
    constexpr std::uint64_t kMostLooks = kRoom * (65536U + 1728U);
    for (const bool clusters : {true, false}) {
        SCOPED_TRACE((clusters ? "clusters, seed " : "no clusters, seed ") + std::to_string(seed));
        const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = clusters}));
        const BatchItem item{&mesh, &volume, &function, poses};
        const Answered found = detect(counted(true), {{&item, 1}, {}, scene.threshold}, kRoom, kRoom);
        expectSameCounts(found.pairs, onHost.pairs);
        EXPECT_TRUE(std::ranges::none_of(found.pairs, &PairAnswer::hit));
        const CertifiedCounters& c = found.counters;
        EXPECT_EQ(c.clusters, kRoom);
        EXPECT_EQ(c.rounds, kRoom); // of all pairs in one, the large triangles might have more than the bound
        EXPECT_LE(c.peakClusters, kRoom);
        EXPECT_LE(c.peakRuns, 4 * kRoom);
        EXPECT_LE(c.peakTests, kMostLooks);
        EXPECT_LE(c.peakTestsLeft, kMostLooks);
        EXPECT_GT(c.bricksSeen + c.cellsSeen, 0U);
    }
}

/// What the host expects of large triangles in any direction is no less than what is examined.
TEST_F(CountersTest, LooksAreWithinWhatTheHostExpects) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData noise =
        makeBytes(unitGrid(48, 40, 56), [&](auto...) { return static_cast<double>(random() % 256); });
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const Volume volume = take(Volume::upload(context(), queue(), noise.view(), {.bricks = true}));
    const TransferFunction function = upload(points, {0, 255});
    const Detector counting = take(Detector::create(context(), counted()));
    double fullest = 0;
    for (int turn = 0; turn < 8; ++turn) {
        MeshData data;
        for (std::uint32_t triangle = 0; triangle < 5; ++triangle) {
            const double side = std::exp2(uniform(random, -4, 0.5));
            for (int corner = 0; corner < 3; ++corner) {
                for (int axis = 0; axis < 3; ++axis) {
                    data.positions.push_back(static_cast<float>(0.5 + side * uniform(random, -0.7, 0.7)));
                }
                data.indices.push_back(3 * triangle + static_cast<std::uint32_t>(corner));
            }
        }
        const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = turn % 2 == 0}));
        const double stretch = uniform(random, 0.7, 1.4);
        const Mat4 pose = multiply(translation({uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2), 0}),
                                   Mat4{stretch, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 / stretch, 0, 0, 0, 0, 1});
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        Results results = take(Results::create(counting, {.clustersAtOnce = 16384}));
        const VkCommandBuffer commands = raw().begin();
        take(counting.cmdDetect(commands, {{&item, 1}, {}, 0.9}, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        const CertifiedCounters c = take(results.counters());
        const double expected = meshLooks(item).of(0, 1) + 5 * 27;
        EXPECT_LE(static_cast<double>(c.bricksSeen + c.cellsSeen), expected) << "turn " << turn << ", seed " << seed;
        fullest = std::max(fullest, static_cast<double>(c.bricksSeen + c.cellsSeen) / expected);
    }
    std::cout << "at most " << fullest << " of it\n";
    EXPECT_GT(fullest, 0.01);
}

TEST(RoundsTest, EachClusterOfEachPairIsInOneOfThem) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    for (int turn = 0; turn < 300; ++turn) {
        MeshLooks mesh;
        mesh.clusters = 1 + static_cast<std::uint32_t>(random() % 40);
        mesh.pairs = static_cast<std::uint32_t>(random() % 30);
        std::vector<double> before(1);
        for (std::uint32_t cluster = 0; cluster < mesh.clusters; ++cluster) {
            before.push_back(before.back() + (random() % 8 == 0 ? uniform(random, 0, 200) : uniform(random, 0, 1)));
        }
        mesh.before = turn % 5 == 0 ? std::span<const double>() : before;
        mesh.scale = turn % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : uniform(random, 0.1, 3);
        mesh.most = uniform(random, 1, 1000);
        const RoundLimits limits{1 + static_cast<std::uint32_t>(random() % 64),
                                 1 + static_cast<std::uint32_t>(random() % 9), uniform(random, 1, 500)};
        std::vector<int> seen(std::size_t{mesh.pairs} * mesh.clusters);
        const RoundCut cut{mesh, limits};
        const std::uint32_t atOnce = cut.pairsAtOnce();
        std::uint64_t rounds = 0;
        eachRound(cut, [&](const Round& round) {
            ++rounds;
            const std::uint32_t clusters = round.endCluster - round.firstCluster;
            EXPECT_EQ(round.firstPair % atOnce, 0U) << seed;
            EXPECT_EQ(round.pairs, std::min(atOnce, mesh.pairs - round.firstPair)) << seed;
            EXPECT_GE(round.pairs * clusters, 1U);
            EXPECT_LE(round.pairs, limits.pairs);
            if (round.pairs * clusters > 1) {
                EXPECT_LE(round.pairs * clusters, limits.clusters) << seed;
                EXPECT_LE(round.pairs * mesh.of(round.firstCluster, round.endCluster), limits.looks) << seed;
            }
            for (std::uint32_t pair = round.firstPair; pair < round.firstPair + round.pairs; ++pair) {
                for (std::uint32_t cluster = round.firstCluster; cluster < round.endCluster; ++cluster) {
                    ++seen.at(std::size_t{pair} * mesh.clusters + cluster);
                }
            }
        });
        EXPECT_EQ(roundsOf(cut, UINT64_MAX), rounds) << "turn " << turn << " of " << seed;
        EXPECT_EQ(roundsOf(cut, 3), std::min<std::uint64_t>(rounds, 3)) << "turn " << turn << " of " << seed;
        EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }))
            << "turn " << turn << " of " << seed;
    }
}

} // namespace
} // namespace voxtact::test
