// SPDX-License-Identifier: MIT
// What a ClearanceMeter keeps from call to call, measures to labels and refuses.
#include "cpu/clearance/held.h"
#include "cpu/scenes/oracle_scenes.h"
#include "cpu/scenes/random_scene.h"

#include "support/host_meters.h"
#include "support/special.h"
#include "voxtact/samples.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace voxtact::test {
namespace {

bool same(const PairDistance& a, const PairDistance& b) {
    return a.bounds.lower == b.bounds.lower && a.bounds.upper == b.bounds.upper && a.end == b.end &&
           a.closest.has_value() == b.closest.has_value() &&
           (!a.closest || (a.closest->mesh == b.closest->mesh && a.closest->volume == b.closest->volume &&
                           a.closest->triangle == b.closest->triangle));
}

/// Neither threads nor what else is in the batch changes an answer.
TEST(Clearance, DoesNotDependOnItsCompany) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const RandomScene scene = makeRandomScene(random, 40);
    const Held held(scene.mesh, scene.volume, scene.points, scene.domain, scene.tableSize);
    const std::vector<PairDistance> alone = held.measure(scene.poses, {.threads = 1}, scene.threshold);
    const std::vector<PairDistance> together = held.measure(scene.poses, {.threads = 3}, scene.threshold);
    ASSERT_EQ(alone.size(), scene.poses.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(alone[i].pose, i);
        EXPECT_TRUE(same(alone[i], together[i])) << i;
        EXPECT_TRUE(same(alone[i], held.measure(scene.poses[i], {.threads = 1}, scene.threshold))) << i;
    }
}

/// Vectors of any length give the numbers that those of two give, to the last bit.
TEST(Clearance, IsTheSameByEveryInstructionSet) {
    std::mt19937_64 random(testSeed());
    std::size_t apart = 0;
    for (int round = 0; round < 30; ++round) {
        RandomScene scene = makeRandomScene(random, 6);
        if (round % 3 == 0) {
            scene.mesh = take(makeEllipsoid(3000));
        }
        for (Mat4& pose : scene.poses) {
            pose =
                multiply(translation({uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -9, 9)}), pose);
        }
        const Held held(scene.mesh, scene.volume, scene.points, scene.domain, scene.tableSize);
        const auto measured = [&] { return held.measure(scene.poses, {.threads = 1}, scene.threshold); };
        const std::vector<PairDistance> best = measured();
        for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
            hwy::SetSupportedTargetsForTest(rest & -rest);
            const std::vector<PairDistance> found = measured();
            for (std::size_t i = 0; i < best.size(); ++i) {
                EXPECT_TRUE(same(best[i], found[i]))
                    << hwy::TargetName(rest & -rest) << ", round " << round << ", pose " << i << ": "
                    << found[i].bounds.lower - best[i].bounds.lower << ", "
                    << found[i].bounds.upper - best[i].bounds.upper;
            }
            hwy::SetSupportedTargetsForTest(0);
        }
        apart += static_cast<std::size_t>(std::ranges::count_if(
            best, [](const PairDistance& pair) { return pair.bounds.lower > 0 && pair.bounds.upper < kInfinity; }));
    }
    std::cout << apart << " are apart\n";
    EXPECT_GT(apart, 10U);
}

/// A meter keeps memory from pair to pair: a mesh of another size may come to be where one was.
TEST(Clearance, TakesMeshesOfAllSizesOneAfterTheOther) {
    const VolumeData image = makeBytes(unitGrid(8), [](auto...) { return 255; });
    Held held(needle(), image, byteRamp(), {0, 255});
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const Mat4 pose = identity();
    for (const std::uint32_t triangles : {1U, 300U, 5U, 2000U, 64U, 70U, 1U}) {
        MeshData mesh;
        for (std::uint32_t i = 0; i < triangles; ++i) {
            const double x = 3.0 + i;
            addTriangle(mesh, {x, 0.5, 0.5}, {x, 0.6, 0.5}, {x, 0.5, 0.6});
        }
        held.mesh = take(cpu::Mesh::create(mesh.view()));
        const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
        const PairDistance found = take(meter.measure({std::span(&item, 1), {}, 0.5})).pairs.at(0);
        expectAbout(2, found);
        EXPECT_EQ(found.closest->triangle, 0U);
    }
}

TEST(Clearance, SeesEditsAndNewTransferFunctions) {
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData image = makeBytes(grid, [](auto x, auto, auto) { return x == 2 ? 200 : 100; });
    const std::vector<ControlPoint> high{{150, 0}, {150, 1}};
    const std::vector<ControlPoint> low{{50, 0}, {50, 1}};
    Held held(needle(), image, high, {0, 255});
    const Mat4 pose = translation({30, 10, 10});
    const double before = held.measure(pose).bounds.upper;
    EXPECT_NEAR(before, 27.5, 0.1);
    ASSERT_TRUE(held.volume.set(VoxelBox{{15, 10, 10}, {1, 1, 1}}, 200).ok());
    EXPECT_NEAR(held.measure(pose).bounds.upper, 14.5, 0.1);
    held.function = take(cpu::TransferFunction::create({low, {0, 255}}));
    EXPECT_NEAR(held.measure(pose).bounds.upper, 10.5, 1e-6);
}

/// Of label 1 in front of a needle that points along -x from x = 30.
double clearanceToOne(cpu::ClearanceMeter& meter, const Held& held, const LabelData& labels) {
    const Mat4 pose = translation({30, 10, 10});
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1), &labels};
    const std::vector<std::int32_t> one{1};
    return take(meter.measureLabels({std::span(&item, 1), {}, 0.5}, one)).labels.at(0).bounds.upper;
}

/// A map is the caller's: what a meter keeps of one must not outlive what it held.
TEST(Clearance, SeesLabelMapsThatAreEditedInPlace) {
    Grid grid;
    grid.size = {20, 20, 20};
    const Held held(needle(), makeBytes(grid, [](auto...) { return 255; }), byteRamp(), {0, 255});
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    LabelData labels = take(makeLabels(makeBytes(grid, [](auto x, auto, auto) { return x == 2 ? 1 : 0; }).view()));
    EXPECT_NEAR(clearanceToOne(meter, held, labels), 27.5, 1e-4);
    // The brick of this voxel had no label 1 before.
    labels.indices[(10 * 20 + 10) * 20 + 17] = 1;
    EXPECT_NEAR(clearanceToOne(meter, held, labels), 12.5, 1e-4);
    // The other way round: the numbers of the labels change, and no voxel does.
    labels.values = {-1, 0};
    EXPECT_EQ(clearanceToOne(meter, held, labels), kInfinity);
    labels = take(makeLabels(makeBytes(grid, [](auto x, auto, auto) { return x == 9 ? 1 : 0; }).view()));
    EXPECT_NEAR(clearanceToOne(meter, held, labels), 20.5, 1e-4);
}

/// A label's own faces are exact, be what is in it opaque or not: a needle that points along -x from x = 30, and one
/// beside a corner of a box of a skewed grid.
TEST(Clearance, MeasuresToLabelsAtAnyOpacity) {
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData empty = makeBytes(grid, [](auto x, auto, auto) { return x == 15 ? 255 : 0; });
    const LabelData labels = take(makeLabels(makeBytes(grid, [](auto x, auto, auto) { return x < 4 ? 1 : 2; }).view()));
    const Held held(needle(), empty, byteRamp(), {0, 255});
    cpu::ClearanceMeter all = take(cpu::ClearanceMeter::create({.threads = 1, .labelsAtAnyOpacity = true}));
    EXPECT_NEAR(clearanceToOne(all, held, labels), 30 - 3.5, 1e-4);
    cpu::ClearanceMeter opaque = take(cpu::ClearanceMeter::create({.threads = 1}));
    EXPECT_EQ(clearanceToOne(opaque, held, labels), kInfinity);
    // Nothing at all is opaque.
    const Held none(needle(), makeBytes(grid, [](auto...) { return 0; }), byteRamp(), {0, 255});
    EXPECT_NEAR(clearanceToOne(all, none, labels), 30 - 3.5, 1e-4);

    Grid skewed;
    skewed.size = {12, 10, 8};
    skewed.spacing = {0.7, 1.3, 2.5};
    const double c = std::cos(0.4);
    const double s = std::sin(0.4);
    skewed.direction = {c, s, 0, -s, c, 0, 0, 0, 1};
    skewed.origin = {-4, 7, 100};
    const LabelData box = take(
        makeLabels(makeBytes(skewed, [](auto x, auto y, auto z) { return x < 5 && y < 4 && z < 3 ? 1 : 0; }).view()));
    // The corner of the voxels 4, 3, 2 that is farthest from the origin, and 3, 2 and 6 mm beyond it.
    const Vec3 corner = transformPoint(worldFromIndex(skewed), {4.5, 3.5, 2.5});
    const Vec3 tip{corner[0] + c * 3 - s * 2, corner[1] + s * 3 + c * 2, corner[2] + 6};
    const MeshData point{{0, 0, 0, 0, 0, 1, 0, 0, 0.5}, {0, 1, 2}, "", {}};
    const Held apart(point, makeBytes(skewed, [](auto...) { return 0; }), byteRamp(), {0, 255});
    const Mat4 pose = translation(tip);
    const cpu::BatchItem item{&apart.mesh, &apart.volume, &apart.function, std::span(&pose, 1), &box};
    const std::vector<std::int32_t> one{1};
    const LabelDistance says = take(all.measureLabels({std::span(&item, 1), {}, 0.5}, one)).labels.at(0);
    EXPECT_LE(says.bounds.lower, 7 + 1e-9);
    EXPECT_GE(says.bounds.upper, 7 - 1e-9);
    EXPECT_EQ(says.end, StopReason::Closed);
}

/// A label that is asked for twice is answered twice.
TEST(Clearance, MeasuresToALabelAsOftenAsItIsAskedFor) {
    Grid grid;
    grid.size = {20, 20, 20};
    const Held held(needle(), makeBytes(grid, [](auto...) { return 255; }), byteRamp(), {0, 255});
    const LabelData labels = take(makeLabels(makeBytes(grid, [](auto x, auto, auto) { return x < 4 ? 1 : 2; }).view()));
    const Mat4 pose = translation({30, 10, 10});
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1), &labels};
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const std::vector<std::int32_t> wanted{1, 2, 1, 3, 1, 3, 2};
    const std::vector<LabelDistance> found = take(meter.measureLabels({std::span(&item, 1), {}, 0.5}, wanted)).labels;
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_EQ(found[i].label, wanted[i]);
        const double truth = wanted[i] == 1 ? 30 - 3.5 : wanted[i] == 2 ? 30 - 19.5 : kInfinity;
        EXPECT_TRUE(found[i].bounds.upper == truth || std::abs(found[i].bounds.upper - truth) < 1e-4)
            << i << ": " << found[i].bounds.upper;
    }
}

TEST(Clearance, RefusesWhatItCannotUse) {
    const auto refused = [](const cpu::ClearanceDesc& desc) {
        const Result<cpu::ClearanceMeter> meter = cpu::ClearanceMeter::create(desc);
        return meter.ok() ? std::string() : meter.error().text;
    };
    EXPECT_EQ(refused({.tolerance = 0}), "the tolerance 0 mm is not a number from 1e-06 mm on");
    EXPECT_NE(refused({.tolerance = std::nan("")}), "");
    EXPECT_NE(refused({.tolerance = kInfinity}), "");
    EXPECT_EQ(refused({.maximum = 0}), "the max 0 mm is not a number above 0 mm");
    EXPECT_NE(refused({.maximum = std::nan("")}), "");
    EXPECT_NE(refused({.resolution = 2}), "");
    EXPECT_EQ(refused({.maxSteps = 0}), "at most 0 steps are allowed, a search takes at least one step");
    EXPECT_EQ(refused({.threads = 2}), "");

    const VolumeData volume = makeBytes(unitGrid(8), [](auto...) { return 255; });
    const Held held(needle(), volume, byteRamp(), {0, 255});
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const Mat4 pose = identity();
    cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
    for (const double margin : {-1.0, std::nan(""), kInfinity}) {
        EXPECT_FALSE(meter.within({std::span(&item, 1), {}, 0.5}, margin).ok());
    }
    EXPECT_FALSE(meter.measure({std::span(&item, 1), {}, 1.5}).ok());
    const std::vector<std::int32_t> one{1};
    const auto refusedLabels = [&](const LabelData* labels, std::span<const std::int32_t> asked) {
        item.labels = labels;
        const auto answer = meter.measureLabels({std::span(&item, 1), {}, 0.5}, asked);
        return answer.ok() ? std::string() : answer.error().text;
    };
    const LabelData labels = take(makeLabels(makeBytes(unitGrid(8), [](auto...) { return 1; }).view()));
    const LabelData coarse = take(makeLabels(makeBytes(unitGrid(4), [](auto...) { return 1; }).view()));
    EXPECT_EQ(refusedLabels(nullptr, one), "batch item 0: labels is null, and clearances to labels are asked for");
    EXPECT_EQ(
        refusedLabels(&coarse, one),
        "batch item 0: the label map is not on the grid of the volume: its spacing is 0.25, 0.25, 0.25 mm, that of the "
        "volume 0.125, 0.125, 0.125 mm; resample it to that");
    EXPECT_NE(refusedLabels(&labels, std::vector<std::int32_t>(5000, 1)), "");
    LabelData beyond = labels;
    beyond.indices[5] = 60000;
    EXPECT_EQ(refusedLabels(&beyond, one), "the label map's voxel 5 has the index 60000, there are " +
                                               std::to_string(beyond.values.size()) + " values");
    EXPECT_EQ(refusedLabels(&labels, one), "");
    EXPECT_EQ(refusedLabels(&labels, {}), "");
    item.volume = nullptr;
    EXPECT_FALSE(meter.measure({std::span(&item, 1), {}, 0.5}).ok());
    EXPECT_TRUE(take(meter.measure({})).pairs.empty());
}

} // namespace
} // namespace voxtact::test
