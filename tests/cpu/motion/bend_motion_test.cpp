// SPDX-License-Identifier: MIT
// Motions of meshes that bend on the way, against samples of the way and against ways that are known.
#include "cpu/scenes/bent_meshes.h"
#include "cpu/scenes/needle_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr Interpolation kWays[] = {Interpolation::Screw, Interpolation::Slerp};

/// A mesh that goes from pose to pose and from shape to shape in a random volume.
struct BendingWay {
    explicit BendingWay(std::mt19937_64& random)
        : scene(makeRandomScene(random, 2)), volume(take(cpu::Volume::create(scene.volume.view()))),
          function(take(cpu::TransferFunction::create(scene.transferFunction()))),
          mesh(take(cpu::Mesh::create(scene.mesh.view()))) {
        // Rigid ways: the second pose is the first one, moved.
        const double size = bendSize(scene.volume.grid);
        scene.poses = randomPoses(scene.volume.grid, 2, 1.5, random);
        if (chance(random, 0.3)) {
            scene.poses[1] = scene.poses[0]; // it bends alone
        } else if (chance(random, 0.5)) {
            const double by = 0.1 * size;
            scene.poses[1] =
                multiply(translation({uniform(random, -by, by), uniform(random, -by, by), uniform(random, -by, by)}),
                         scene.poses[0]);
        }
        for (std::vector<double>& shape : shapes) {
            shape = bent(random, scene.mesh, 0.5 * size);
        }
        views = {shapes[0], shapes[1]};
        const Box& box = mesh.facts().bounds;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            centre[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
        }
    }

    [[nodiscard]] cpu::BatchItem item() const { return {&mesh, &volume, &function, scene.poses}; }
    [[nodiscard]] SegmentMotion check(cpu::MotionChecker& checker) const {
        const cpu::BatchItem one = item();
        const ShapesOfPoses of = views;
        return take(checker.checkBending({{&one, 1}, {}, scene.threshold}, {&of, 1})).segments.at(0);
    }
    /// The mesh at a parameter, newly made.
    [[nodiscard]] cpu::Mesh meshAt(double parameter) const {
        return take(cpu::Mesh::create({take(shapeBetween(shapes[0], shapes[1], parameter)), scene.mesh.indices}));
    }
    [[nodiscard]] Mat4 poseAt(double parameter, Interpolation interpolation) const {
        return take(poseBetween(scene.poses[0], scene.poses[1], parameter, interpolation, centre));
    }

    RandomScene scene;
    cpu::Volume volume;
    cpu::TransferFunction function;
    cpu::Mesh mesh;
    std::array<std::vector<double>, 2> shapes;
    std::array<std::span<const double>, 2> views;
    Vec3 centre{};
};

TEST(BendingMotion, NoSampleOfTheWayContradictsIt) {
    constexpr int kSamples = 32;
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1, .tolerance = 0.01}));
    std::size_t free = 0;
    std::size_t touching = 0;
    std::size_t possible = 0;
    std::size_t onTheWay = 0;
    const std::size_t rounds = randomCases(3000, 40);
    // On until there were some of each: how many there are in so many rounds is chance.
    const auto enough = [&] { return free > 1 && onTheWay > 0; };
    for (std::size_t round = 0; round < rounds || (round < 20 * rounds && !enough()); ++round) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", round " << round);
        const BendingWay way(random);
        const Interpolation interpolation = kWays[round % 2];
        cpu::MotionChecker checker =
            take(cpu::MotionChecker::create({.threads = 1, .interpolation = interpolation, .maxSteps = 1U << 13U}));
        const auto touchAt = [&](double parameter) {
            const cpu::Mesh mesh = way.meshAt(parameter);
            const Mat4 pose = way.poseAt(parameter, interpolation);
            const cpu::BatchItem item{&mesh, &way.volume, &way.function, {&pose, 1}};
            return take(detector.detect({{&item, 1}, {}, way.scene.threshold})).pairs.at(0).hit;
        };
        if (touchAt(0) && chance(random, 0.9)) {
            continue; // most ways are to begin outside
        }
        const SegmentMotion says = way.check(checker);
        EXPECT_EQ(says.possible, !says.touch && says.freeUntil < 1);
        for (int i = 0; i <= kSamples && says.freeUntil > 0; ++i) {
            const double parameter = i == kSamples ? says.freeUntil : uniform(random, 0, says.freeUntil);
            ASSERT_FALSE(touchAt(parameter)) << "free until " << says.freeUntil << ", touches at " << parameter;
        }
        if (says.touch) {
            EXPECT_LE(says.freeUntil, says.touch->at);
            EXPECT_EQ(says.touch->world_from_object, way.poseAt(says.touch->at, interpolation));
            EXPECT_TRUE(touchAt(says.touch->at));
            EXPECT_LT(says.touch->triangle, way.mesh.facts().triangles);
            onTheWay += says.touch->at > 0 ? 1U : 0U;
        } else if (says.end == MotionEnd::Grazes) {
            // Then it is near at the place where no more is known.
            const cpu::Mesh mesh = way.meshAt(says.freeUntil);
            const Mat4 pose = way.poseAt(says.freeUntil, interpolation);
            const cpu::BatchItem item{&mesh, &way.volume, &way.function, {&pose, 1}};
            const DistanceAnswer near =
                take(meter.measure({.items = {&item, 1}, .view = {}, .threshold = way.scene.threshold}));
            EXPECT_LT(near.pairs.at(0).bounds.lower, 0.1 + 1e-6 * bendSize(way.scene.volume.grid));
        }
        ++(says.touch ? touching : says.possible ? possible : free);
    }
    std::cout << "  " << free << " free, " << touching << " touch, " << onTheWay << " of them on the way, " << possible
              << " possible\n";
    EXPECT_TRUE(enough());
}

TEST(BendingMotion, WhatDoesNotBendIsAsCheckSays) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 2, .maxSteps = 1U << 13U}));
    std::size_t touching = 0;
    for (std::size_t round = 0; round < randomCases(300, 10); ++round) {
        BendingWay way(random);
        way.views = {way.scene.mesh.positions, way.scene.mesh.positions};
        const cpu::BatchItem item = way.item();
        const SegmentMotion rigid = take(checker.check({{&item, 1}, {}, way.scene.threshold})).segments.at(0);
        const SegmentMotion same = way.check(checker);
        EXPECT_EQ(same.freeUntil, rigid.freeUntil);
        EXPECT_EQ(same.end, rigid.end);
        ASSERT_EQ(same.touch.has_value(), rigid.touch.has_value());
        if (rigid.touch) {
            EXPECT_EQ(same.touch->at, rigid.touch->at);
            ++touching;
        }
    }
    EXPECT_GT(touching, 3U);
}

class BendingNeedle : public NeedleFixture {
  protected:
    [[nodiscard]] SegmentMotion go(std::span<const double> from, std::span<const double> to, const Vec3& by = {}) {
        const std::array poses{pose_, multiply(translation(by), pose_)};
        const cpu::BatchItem item{&mesh_, &volume_, &function_, poses};
        const std::array shapes{from, to};
        const ShapesOfPoses of = shapes;
        return take(checker_.checkBending({{&item, 1}, {}, 0.5}, {&of, 1})).segments.at(0);
    }

    cpu::MotionChecker checker_ = take(cpu::MotionChecker::create({.threads = 1}));
};

TEST_F(BendingNeedle, TouchesWhenItsTipGetsThere) {
    // The needle's point is at x = 3, and half of the way to the opaque part in voxels of 1 mm.
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create());
    const std::vector<double> straight = deflected(0);
    const std::vector<double> bentBy = deflected(10);
    const SegmentMotion says = go(straight, bentBy);
    ASSERT_TRUE(says.touch.has_value());
    EXPECT_EQ(says.end, MotionEnd::Decided);
    EXPECT_GT(says.freeUntil, 0.3);
    EXPECT_LE(10 * (says.touch->at - says.freeUntil), kDefaultMotionResolution * 1.01);
    // What is measured there: within the resolution of a touch.
    const std::vector<double> shape = take(shapeBetween(straight, bentBy, says.freeUntil));
    const cpu::Mesh there = take(cpu::Mesh::create({shape, data_.indices}));
    const cpu::BatchItem item{&there, &volume_, &function_, {&pose_, 1}};
    const Bounds bounds = take(meter.measure({.items = {&item, 1}, .view = {}, .threshold = 0.5})).pairs[0].bounds;
    EXPECT_LE(bounds.lower, 2 * kDefaultMotionResolution);
    EXPECT_EQ(says.touch->world_from_object, pose_);
    // Not so far, and the other way round: free.
    EXPECT_EQ(go(straight, deflected(2)).freeUntil, 1);
    EXPECT_EQ(go(straight, deflected(-10)).freeUntil, 1);
    // Out of the opaque part it is not free at all.
    EXPECT_EQ(go(bentBy, straight).touch.value().at, 0);
}

/// While it goes away as fast as it bends towards the opaque part, it never gets nearer.
TEST_F(BendingNeedle, BendsAndMovesAtTheSameTime) {
    const std::vector<double> straight = deflected(0);
    EXPECT_TRUE(go(straight, deflected(8)).touch.has_value());
    EXPECT_EQ(go(straight, deflected(8), {-8, 0, 0}).freeUntil, 1);
    const SegmentMotion faster = go(straight, deflected(8), {8, 0, 0});
    const SegmentMotion alone = go(straight, deflected(8));
    EXPECT_LT(faster.freeUntil, 0.6 * alone.freeUntil);
}

/// Both ends are clear of a sheet one voxel thin, which the tip goes through on its way.
TEST_F(BendingNeedle, ASheetIsNeverSteppedOver) {
    const VolumeData sheet = makeBytes(grid(), [](auto x, auto...) { return x == 8 ? 255.0 : 0.0; });
    const cpu::Volume volume = take(cpu::Volume::create(sheet.view()));
    Mat4 flat = pose_;
    flat[12] = -200; // bent by 208 mm its tip is at 8, by 400 far behind
    const std::array poses{flat, flat};
    const cpu::BatchItem item{&mesh_, &volume, &function_, poses};
    const std::vector<double> from = deflected(0);
    const std::vector<double> to = deflected(400);
    const std::array<std::span<const double>, 2> shapes{from, to};
    const ShapesOfPoses of = shapes;
    const SegmentMotion says = take(checker_.checkBending({{&item, 1}, {}, 0.5}, {&of, 1})).segments.at(0);
    ASSERT_TRUE(says.touch.has_value());
    EXPECT_NEAR(says.touch->at, 0.52, 0.03);
}

TEST_F(BendingNeedle, WhatIsRefused) {
    const auto text = [](const auto& result) { return result.ok() ? "" : result.error().text; };
    const std::array poses{pose_, pose_};
    const cpu::BatchItem item{&mesh_, &volume_, &function_, poses};
    const cpu::Batch batch{{&item, 1}, {}, 0.5};
    const std::vector<double> good = deflected(1);
    std::vector<double> bad = good;
    bad[4] = std::numeric_limits<float>::infinity();
    const std::array<std::span<const double>, 3> shapes{good, bad, std::span(good).first(3)};
    const auto check = [&](std::span<const std::span<const double>> of) {
        return text(checker_.checkBending(batch, {&of, 1}));
    };
    const std::array<ShapesOfPoses, 2> tooMany{shapes, shapes};
    EXPECT_THAT(text(checker_.checkBending(batch, tooMany)), HasSubstr("shapes for 2 items, the batch has 1"));
    EXPECT_THAT(check(shapes), HasSubstr("batch item 0: there are 3 shapes for 2 poses"));
    EXPECT_THAT(check(std::span(shapes).first(2)), HasSubstr("the shape of pose 1: vertex 1 of the mesh has"));
    const std::array<std::span<const double>, 2> small{shapes[2], shapes[0]};
    EXPECT_THAT(check(small), HasSubstr("the shape of pose 0: 3 coordinates, the mesh has"));
    EXPECT_THAT(text(shapeBetween(good, shapes[2], 0.5)), HasSubstr("coordinates"));
    EXPECT_THAT(text(shapeBetween(good, good, 1.5)), HasSubstr("the parameter 1.5 is outside"));
    EXPECT_EQ(take(shapeBetween(good, deflected(2), 0)), good);
    EXPECT_EQ(take(shapeBetween(deflected(2), good, 1)), good);
}

} // namespace
} // namespace voxtact::test
