// SPDX-License-Identifier: MIT
// What an OverlapMeter's answers depend on, how they change with their scene, and what it refuses.
#include "core/base/infinity.h"
#include "cpu/overlap/known_scenes.h"
#include "cpu/overlap/overlap_held.h"
#include "cpu/overlap/solids.h"
#include "cpu/scenes/random_labels.h"
#include "cpu/scenes/random_scene.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Noise, in which some of a random solid is opaque.
OracleScene noiseScene(std::mt19937_64& random) {
    OracleScene scene;
    const Grid grid = randomSmallGrid(random);
    scene.volume = makeBytes(grid, [&](auto...) { return uniform(random, 0, 255); });
    scene.mesh = randomSolid(random, 0.5 * linearRadius(grid));
    scene.world_from_object = multiply(translation(middleOf(grid)), randomRotation(random));
    return scene;
}

void expectSame(const Bounds& a, const Bounds& b, double slack) {
    EXPECT_LE(a.lower, b.upper + slack);
    EXPECT_GE(a.upper, b.lower - slack);
}

Mat4 scaling(double by) {
    return {by, 0, 0, 0, 0, by, 0, 0, 0, 0, by, 0, 0, 0, 0, 1};
}

TEST(Overlap, FollowsItsWorld) {
    std::mt19937_64 random(testSeed());
    std::size_t some = 0;
    for (std::size_t round = 0; round < randomCases(400, 60) || (round < 1000 && some < 2); ++round) {
        SCOPED_TRACE(round);
        const OracleScene scene = noiseScene(random);
        const double tolerance = 0.02 * std::pow(linearRadius(scene.volume.grid), 3);
        const PairOverlap as = overlap(scene, tolerance);
        const double slack = 1e-9 * as.solid.upper;
        OracleScene large = scene;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            large.volume.grid.spacing[axis] *= 3;
            large.volume.grid.origin[axis] *= 3;
        }
        large.world_from_object = multiply(scaling(3), scene.world_from_object);
        const PairOverlap scaled = overlap(large, 27 * tolerance);
        expectSame({27 * as.bounds.lower, 27 * as.bounds.upper}, scaled.bounds, 27 * slack);
        expectSame({27 * as.solid.lower, 27 * as.solid.upper}, scaled.solid, 27 * slack);
        OracleScene elsewhere = scene;
        const Mat4 motion = randomMotion(random);
        elsewhere.volume = moved(scene.volume, motion);
        elsewhere.world_from_object = multiply(motion, scene.world_from_object);
        const PairOverlap there = overlap(elsewhere, tolerance);
        expectSame(as.bounds, there.bounds, slack);
        EXPECT_EQ(as.inside, there.inside);
        some += as.bounds.lower > 0 && as.bounds.upper < 0.9 * as.solid.lower ? 1 : 0;
    }
    EXPECT_GE(some, 2U);
}

/// Of two halves of a box, and of two solids apart from each other.
TEST(Overlap, AddsUp) {
    std::mt19937_64 random(testSeed());
    for (std::size_t round = 0; round < randomCases(400, 80); ++round) {
        OracleScene scene = noiseScene(random);
        const double side = 0.5 * linearRadius(scene.volume.grid);
        const double cut = uniform(random, -0.9, 0.9) * side;
        const double gap = round % 2 == 0 ? 0 : uniform(random, 0, 0.5) * side;
        const MeshData left = solidBox({-side, -side, -side}, {cut, side, 0.3 * side});
        const MeshData right = solidBox({cut + gap, -side, -side}, {side + gap, side, 0.3 * side});
        const auto measured = [&](const MeshData& mesh) {
            scene.mesh = mesh;
            return overlap(scene, 0.02 * side * side * side).bounds;
        };
        const Bounds a = measured(left);
        const Bounds b = measured(right);
        const Bounds both = measured(joined(left, right));
        expectSame({a.lower + b.lower, a.upper + b.upper}, both, 1e-9);
        if (gap == 0) {
            expectSame(both, measured(solidBox({-side, -side, -side}, {side, side, 0.3 * side})), 1e-9);
        }
    }
}

void expectSameBits(const PairOverlap& a, const PairOverlap& b) {
    EXPECT_EQ(a.bounds.lower, b.bounds.lower);
    EXPECT_EQ(a.bounds.upper, b.bounds.upper);
    EXPECT_EQ(a.solid.lower, b.solid.lower);
    EXPECT_EQ(a.solid.upper, b.solid.upper);
    EXPECT_EQ(a.inside, b.inside);
    EXPECT_EQ(a.end, b.end);
}

TEST(Overlap, DoesNotDependOnItsCompany) {
    std::mt19937_64 random(testSeed());
    const OracleScene scene = noiseScene(random);
    const OracleScene other = noiseScene(random);
    const HeldScene held(scene);
    const HeldScene second(other);
    std::vector<Mat4> poses = randomPoses(scene.volume.grid, 6, 1, random);
    const LabelData labels = randomLabels(random, scene.volume.grid);
    const LabelData others = randomLabels(random, other.volume.grid);
    const Overlap question{.tolerance = 0.05, .bandLimits = {100, 200}, .labels = {1, 0}, .maxSteps = 300};
    const auto measured = [&](std::uint32_t threads, const std::vector<cpu::BatchItem>& items) {
        cpu::OverlapMeter meter = take(cpu::OverlapMeter::create({.threads = threads}));
        return take(meter.measure(question, {items, {}, scene.threshold}));
    };
    const cpu::BatchItem one{&held.mesh, &held.volume, &held.function, poses, &labels};
    const cpu::BatchItem two{&second.mesh, &second.volume, &second.function, std::span(&second.pose, 1), &others};
    const OverlapAnswer alone = measured(1, {one});
    ASSERT_EQ(alone.pairs.size(), poses.size());
    for (const std::uint32_t threads : {1U, 2U, 3U}) {
        const OverlapAnswer behind = measured(threads, {two, one});
        ASSERT_EQ(behind.pairs.size(), poses.size() + 1);
        ASSERT_EQ(behind.bands.size(), 3 * behind.pairs.size());
        ASSERT_EQ(behind.labels.size(), 2 * behind.pairs.size());
        for (std::uint32_t i = 0; i < poses.size(); ++i) {
            expectSameBits(alone.pairs[i], behind.pairs[i + 1]);
            EXPECT_EQ(behind.pairs[i + 1].item, 1U);
            EXPECT_EQ(behind.pairs[i + 1].pose, i);
            EXPECT_EQ(behind.pairs[i + 1].pair, i + 1);
            for (std::size_t band = 0; band < 3; ++band) {
                EXPECT_EQ(alone.bands[3 * i + band].bounds.lower, behind.bands[3 * (i + 1) + band].bounds.lower);
                EXPECT_EQ(alone.bands[3 * i + band].bounds.upper, behind.bands[3 * (i + 1) + band].bounds.upper);
            }
            for (std::size_t label = 0; label < 2; ++label) {
                EXPECT_EQ(alone.labels[2 * i + label].bounds.lower, behind.labels[2 * (i + 1) + label].bounds.lower);
                EXPECT_EQ(alone.labels[2 * i + label].bounds.upper, behind.labels[2 * (i + 1) + label].bounds.upper);
            }
        }
    }
}

/// With few steps bounds are wide, but true.
TEST(Overlap, IsTrueWithFewSteps) {
    std::mt19937_64 random(testSeed());
    std::size_t budget = 0;
    for (int round = 0; round < 4; ++round) {
        const OracleScene scene = noiseScene(random);
        const Bounds best = overlap(scene, 0.2).bounds;
        for (const std::uint64_t steps : {1ULL, 10ULL, 200ULL}) {
            const PairOverlap rough = overlaps(scene, {.tolerance = 1e-6, .maxSteps = steps}).pairs.at(0);
            expectSame(rough.bounds, best, 1e-9);
            EXPECT_EQ(rough.end == StopReason::Closed, rough.bounds.upper - rough.bounds.lower <= 1e-6);
            budget += rough.end == StopReason::Budget ? 1 : 0;
        }
    }
    EXPECT_GT(budget, 0U);
}

TEST(Overlap, SeesEdits) {
    const OracleScene scene = opaqueScene(unshared(solidBox({2, 3, 4}, {8, 8, 8})));
    HeldScene held(scene);
    cpu::OverlapMeter meter = take(cpu::OverlapMeter::create({.threads = 1}));
    const auto measured = [&] { return take(meter.measure({.tolerance = 1e-3}, held.batch)).pairs.at(0).bounds; };
    expectVolume(6 * 5 * 4, measured());
    take(held.volume.set(VoxelBox{{0, 0, 0}, {20, 20, 20}}, 0));
    EXPECT_EQ(measured().upper, 0);
    // Half way between a voxel of 0 and one of 255 it is opaque: from y = 4.5 on.
    const std::vector<std::byte> voxels(20 * 15 * 20, std::byte{255});
    take(held.volume.write({{0, 5, 0}, {20, 15, 20}}, voxels));
    expectVolume(6 * 3.5 * 4, measured());
    held.function = take(cpu::TransferFunction::create({opaqueFrom(256), {0, 255}}));
    EXPECT_EQ(measured().upper, 0);
    held.function = take(cpu::TransferFunction::create({opaqueFrom(0), {0, 255}}));
    expectVolume(6 * 5 * 4, measured());
    MeshData bent = unshared(solidBox({2, 3, 4}, {7, 8, 9}));
    take(held.mesh.update(bent.positions));
    expectVolume(5 * 5 * 5, measured());
    // One triangle goes elsewhere, and comes back.
    bent.positions[0] -= 1;
    take(held.mesh.update(bent.positions));
    EXPECT_FALSE(meter.measure({}, held.batch).ok());
    bent.positions[0] += 1;
    take(held.mesh.update(bent.positions));
    expectVolume(5 * 5 * 5, measured());
}

TEST(Overlap, OfWhatIsTooFarAwayToTellIsUnknown) {
    const PairOverlap found = overlap(opaqueScene(solidBox({-1e17, -1e17, -1e17}, {1e17, 1e17, 1e17})));
    EXPECT_LE(found.bounds.lower, 8000);
    EXPECT_GE(found.bounds.upper, 8000);
    const PairOverlap away = overlap(opaqueScene(solidBox({1e6, 1e6, 1e6}, {2e6, 2e6, 2e6})));
    EXPECT_EQ(away.bounds.upper, 0);
    EXPECT_EQ(away.inside, Containment::None);
    EXPECT_NEAR(away.solid.lower, 1e18, 1e6);
}

TEST(Overlap, RefusesWhatItCannotUse) {
    const double kNan = std::numeric_limits<double>::quiet_NaN();
    HeldScene held(opaqueScene(solidBox({2, 3, 4}, {8, 8, 8})));
    cpu::OverlapMeter meter = take(cpu::OverlapMeter::create({.threads = 1}));
    const auto refused = [&](const Overlap& question) {
        const Result<OverlapAnswer> answer = meter.measure(question, held.batch);
        return answer.ok() ? Error{} : answer.error();
    };
    for (const double tolerance : {0.0, 1e-10, -1.0, kNan, kInfinity}) {
        EXPECT_THAT(refused({.tolerance = tolerance}).text, HasSubstr("tolerance")) << tolerance;
        EXPECT_EQ(refused({.tolerance = tolerance}).code, ErrorCode::InvalidArgument) << tolerance;
    }
    for (const std::vector<double>& limits :
         {std::vector<double>{2, 1}, {1, 1}, {kNan}, {1, kNan}, {1, kInfinity}, std::vector<double>{-kInfinity}}) {
        EXPECT_THAT(refused({.bandLimits = limits}).text, HasSubstr("band")) << limits.front();
    }
    std::vector<double> many(kMaxBandLimits);
    for (std::size_t i = 0; i < many.size(); ++i) {
        many[i] = static_cast<double>(i);
    }
    EXPECT_EQ(take(meter.measure({.bandLimits = many}, held.batch)).bands.size(), kMaxBandLimits + 1);
    many.push_back(1000);
    EXPECT_THAT(refused({.bandLimits = many}).text, HasSubstr("65"));
    EXPECT_FALSE(refused({.maxSteps = 0}).text.empty());
    EXPECT_THAT(refused({.labels = {1}}).text, HasSubstr("batch item 0"));
    Grid grid = opaqueScene({}).volume.grid;
    const LabelData fitting = take(makeLabels(makeBytes(grid, [](auto...) { return 1; }).view()));
    held.item.labels = &fitting;
    const OverlapAnswer labelled = take(meter.measure({.tolerance = 1e-3, .labels = {1, 0}}, held.batch));
    expectVolume(120, labelled.labels.at(0).bounds);
    EXPECT_EQ(labelled.labels.at(1).bounds.upper, 0);
    EXPECT_EQ(refused({.labels = std::vector<std::int32_t>(kMaxMeasuredLabels + 1, 1)}).code, ErrorCode::LimitExceeded);
    grid.size[1] = 19;
    const LabelData other = take(makeLabels(makeBytes(grid, [](auto...) { return 1; }).view()));
    held.item.labels = &other;
    EXPECT_EQ(refused({.labels = {1}}).code, ErrorCode::Unsupported);
    EXPECT_EQ(cpu::OverlapMeter::create({.threads = 5000}).ok(), false);
    const std::atomic<bool> cancel = true;
    held.batch.cancel = &cancel;
    EXPECT_EQ(refused({}).code, ErrorCode::Cancelled);
    held.batch.cancel = nullptr;
    held.batch.threshold = 1.5;
    EXPECT_FALSE(meter.measure({}, held.batch).ok());
    held.batch.threshold = 0.5;
    held.item.mesh = nullptr;
    EXPECT_FALSE(meter.measure({}, held.batch).ok());
}

TEST(Overlap, NamesItsAnswers) {
    EXPECT_STREQ(toString(StopReason::Closed), "closed");
    EXPECT_STREQ(toString(StopReason::Rounding), "rounding");
    EXPECT_STREQ(toString(StopReason::Budget), "budget");
    EXPECT_STREQ(toString(Containment::None), "none");
    EXPECT_STREQ(toString(Containment::Some), "some");
    EXPECT_STREQ(toString(Containment::All), "all");
    EXPECT_STREQ(toString(Containment::Undecided), "undecided");
}

} // namespace
} // namespace voxtact::test
