// SPDX-License-Identifier: MIT
// Motions of random scenes against the oracle, which samples.
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/motion_oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using oracle::OracleMotion;

/// A scene that the engine has, and where its mesh goes.
struct Moving {
    Moving(std::uint64_t seed, std::uint64_t number) : random(seed ^ (number * 0x9e3779b97f4a7c15ULL)) {
        scene = makeCertifiedCase(seed, number).scene;
        mesh = std::make_unique<cpu::Mesh>(take(cpu::Mesh::create(scene.mesh.view())));
        volume = std::make_unique<cpu::Volume>(take(cpu::Volume::create(scene.volume.view())));
        function = std::make_unique<cpu::TransferFunction>(
            take(cpu::TransferFunction::create({scene.points, scene.domain, scene.tableSize})));
        const Box& box = mesh->facts().bounds;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            centre[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
        }
        poses = {off(), off()};
        scene.world_from_object = poses[0];
        interpolation = chance(random, 0.5) ? Interpolation::Screw : Interpolation::Slerp;
    }

    /// The scene's own pose, and the mesh from there a little away and turned about its middle.
    Mat4 off() {
        const Mat4 direction = randomRotation(random);
        const double by = chance(random, 0.2) ? 0 : std::pow(10, uniform(random, -1.5, 1));
        const Mat4 spin = randomRotation(random);
        Mat4 turn = identity();
        if (chance(random, 0.7)) {
            const double angle = uniform(random, 0, 1.3);
            turn[5] = turn[10] = std::cos(angle);
            turn[6] = std::sin(angle);
            turn[9] = -std::sin(angle);
            turn = multiply(spin, multiply(turn, take(inverse(spin))));
        }
        const Vec3 at = transformPoint(scene.world_from_object, centre);
        const Vec3 to{at[0] + by * direction[0], at[1] + by * direction[1], at[2] + by * direction[2]};
        return multiply(translation(to),
                        multiply(turn, multiply(translation({-at[0], -at[1], -at[2]}), scene.world_from_object)));
    }

    [[nodiscard]] SegmentMotion check(cpu::MotionChecker& checker) const {
        const cpu::BatchItem item{mesh.get(), volume.get(), function.get(), poses};
        return take(checker.check({std::span(&item, 1), {}, scene.threshold})).segments.at(0);
    }
    [[nodiscard]] PairAnswer touch(cpu::Detector& detector, const Mat4& pose) const {
        const cpu::BatchItem item{mesh.get(), volume.get(), function.get(), std::span(&pose, 1)};
        return take(detector.detect({std::span(&item, 1), {}, scene.threshold})).pairs.at(0);
    }

    std::mt19937_64 random;
    OracleScene scene;
    std::unique_ptr<cpu::Mesh> mesh;
    std::unique_ptr<cpu::Volume> volume;
    std::unique_ptr<cpu::TransferFunction> function;
    Vec3 centre{};
    std::vector<Mat4> poses;
    Interpolation interpolation{};
};

double largestDifference(const Mat4& a, const Mat4& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, std::abs(a[i] - b[i]));
    }
    return most;
}

/// Two checkers, and what certifies a touch.
struct Engines {
    cpu::MotionChecker screw = take(cpu::MotionChecker::create({.threads = 1}));
    cpu::MotionChecker slerp = take(cpu::MotionChecker::create({.threads = 1, .interpolation = Interpolation::Slerp}));
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
};

struct Tally {
    std::size_t touching = 0;
    std::size_t free = 0;
    std::size_t possible = 0;
    std::size_t late = 0; ///< touches of the oracle's that the engine has earlier
};

void checkCase(const Moving& c, Engines& engines, Tally& tally) {
    const bool slerp = c.interpolation == Interpolation::Slerp;
    const SegmentMotion says = c.check(slerp ? engines.slerp : engines.screw);
    const OracleMotion truth =
        take(oracle::motionOracle(c.scene.pair(), c.poses[1], c.interpolation, c.centre, 4, 1.0 / 32));
    const double hit = says.touch ? says.touch->at : 2;
    EXPECT_LE(says.freeUntil, 1);
    EXPECT_LE(says.freeUntil, hit);
    EXPECT_EQ(says.possible, !says.touch && says.freeUntil < 1);
    if (truth.touches) {
        EXPECT_LT(says.freeUntil, *truth.touches + (*truth.touches == 0 ? 1e-300 : 0))
            << "a pose that touches is called free";
        EXPECT_TRUE(says.touch || says.possible);
        tally.late += hit < *truth.touches ? 1 : 0;
    }
    EXPECT_GE(hit, truth.freeUntil) << "a pose that does not touch is said to touch";
    // What is a good deal free is known to be.
    EXPECT_TRUE(truth.clearance < 0.05 || says.freeUntil == 1) << truth.clearance << " mm away, and possible";
    if (says.touch) {
        const Mat4 pose = take(poseBetween(c.poses[0], c.poses[1], hit, c.interpolation, c.centre));
        EXPECT_EQ(pose, says.touch->world_from_object);
        EXPECT_TRUE(c.touch(engines.detector, pose).hit);
    }
    ++(says.touch ? tally.touching : says.possible ? tally.possible : tally.free);
}

TEST(MotionOracle, NoSampleContradictsAMotion) {
    const std::uint64_t seed = testSeed();
    Engines engines;
    Tally tally;
    const std::size_t cases = randomCases(20000, 100);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        checkCase(Moving(seed, number), engines, tally);
        ASSERT_FALSE(HasFailure());
    }
    std::cout << tally.touching << " touch, " << tally.late << " earlier than a sample, " << tally.free << " are free, "
              << tally.possible << " possible\n";
    EXPECT_GT(tally.touching, cases / 5);
    EXPECT_GT(tally.free, cases / 10);
    EXPECT_LT(tally.possible, cases / 4);
}

/// The engine's poses are those of another road.
TEST(MotionOracle, PosesAreThoseOfSquareRoots) {
    const std::uint64_t seed = testSeed();
    for (std::uint64_t number = 0; number < 100; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const Moving c(seed, number);
        double size = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            size += std::abs(c.poses[0][12 + i]) + std::abs(c.poses[1][12 + i]) + std::abs(c.centre[i]);
        }
        for (const Interpolation interpolation : {Interpolation::Screw, Interpolation::Slerp}) {
            const std::vector<Mat4> poses =
                take(oracle::oraclePoses(c.poses[0], c.poses[1], interpolation, c.centre, 3));
            for (std::size_t i = 0; i < poses.size(); ++i) {
                const Mat4 pose =
                    take(poseBetween(c.poses[0], c.poses[1], static_cast<double>(i) / 8, interpolation, c.centre));
                EXPECT_LT(largestDifference(pose, poses[i]), 1e-9 * size) << toString(interpolation) << " " << i;
            }
        }
        ASSERT_FALSE(HasFailure());
    }
}

/// A path with one more pose of it says the same: no touch is lost at a joint, and none is found that was not there.
TEST(MotionOracle, APathInPiecesSaysTheSame) {
    const std::uint64_t seed = testSeed();
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    std::size_t touching = 0;
    const std::size_t cases = randomCases(20000, 100);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        Moving c(seed, number);
        const SegmentMotion whole = c.check(checker);
        const double cut = uniform(c.random, 0.05, 0.95);
        c.poses.insert(c.poses.begin() + 1, take(poseBetween(c.poses[0], c.poses[1], cut)));
        const cpu::BatchItem item{c.mesh.get(), c.volume.get(), c.function.get(), c.poses};
        const std::vector<SegmentMotion> parts =
            take(checker.check({std::span(&item, 1), {}, c.scene.threshold})).segments;
        ASSERT_EQ(parts.size(), 2U);
        // Both are bounds of the same first touch.
        double freeUntil = cut * parts[0].freeUntil;
        double hit = parts[0].touch ? cut * parts[0].touch->at : 2;
        if (parts[0].freeUntil == 1) {
            freeUntil = cut + (1 - cut) * parts[1].freeUntil;
            hit = parts[1].touch ? cut + (1 - cut) * parts[1].touch->at : 2;
        }
        EXPECT_LE(whole.freeUntil, hit + 1e-9);
        EXPECT_LE(freeUntil, (whole.touch ? whole.touch->at : 2) + 1e-9);
        touching += whole.touch ? 1 : 0;
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(touching, cases / 5);
}

} // namespace
} // namespace voxtact::test
