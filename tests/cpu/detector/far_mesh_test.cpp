// SPDX-License-Identifier: MIT
// Meshes far from their own origin, and poses that bring them back: map and stage coordinates. The answers are those of
// the same mesh at its origin.
#include "cpu/clearance/held.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "voxtact/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

/// Opaque from x = 9.1 on, with a threshold of 0.1.
VolumeData halfImage() {
    Grid grid;
    grid.size = {20, 20, 20};
    return makeVolume<std::int16_t>(grid, ScalarType::Int16, [](auto x, auto...) { return x >= 10 ? 100.0 : 0.0; });
}
constexpr std::array kRamp{ControlPoint{0, 0}, ControlPoint{100, 1}};
constexpr double kAt = 0.1;

/// In map coordinates: at x = 8.9 after the pose.
MeshData mapTriangle() {
    MeshData mesh;
    mesh.positions = {500008.9, 4649781.2, 1005.2, 500008.9, 4649784.2, 1005.2, 500008.9, 4649781.2, 1008.2};
    mesh.indices = {0, 1, 2};
    return mesh;
}
const Mat4 kMapPose = translation({-500000, -4649776, -1000});

MeshData movedBy(MeshData mesh, const Vec3& by) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] += by[i % 3];
    }
    return mesh;
}

TEST(FarMesh, HasTheDistanceOfItsOwnCoordinates) {
    const Held held(mapTriangle(), halfImage(), kRamp, {0, 100});
    const PairDistance found = held.measure(kMapPose, {}, kAt);
    EXPECT_LE(found.bounds.lower, 0.2);
    EXPECT_GE(found.bounds.upper, 0.2);
    EXPECT_LE(found.bounds.upper - found.bounds.lower, kDefaultTolerance);
    EXPECT_NEAR(found.closest->mesh[0], 8.9, 1e-3);
    // A micrometre before it touches, and one behind.
    for (const double beyond : {-1e-3, 1e-3}) {
        const Mat4 pose = multiply(translation({0.2 + beyond, 0, 0}), kMapPose);
        const PairDistance at = held.measure(pose, {}, kAt);
        EXPECT_EQ(at.bounds.upper == 0, beyond > 0);
        EXPECT_LE(at.bounds.lower, std::max(-beyond, 0.0)); // 0 within the tolerance
        EXPECT_GE(at.bounds.upper, std::max(-beyond, 0.0));
    }
}

TEST(FarMesh, AGradientTurnsAboutTheObjectsOrigin) {
    const MeshData near = oneTriangle({0, -1, -1}, {0, 2, -1}, {0, -1, 2});
    constexpr double kFar = 5e6;
    const VolumeData image = halfImage();
    const Held here(near, image, kRamp, {0, 100});
    const Held there(movedBy(near, {0, kFar, 0}), image, kRamp, {0, 100});
    const Mat4 pose = translation({8, 10, 10});
    const WitnessPoints one = here.measure(pose, {}, kAt).closest.value();
    const WitnessPoints other = there.measure(multiply(pose, translation({0, -kFar, 0})), {}, kAt).closest.value();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(other.perTranslation[axis], one.perTranslation[axis], 1e-9);
    }
    EXPECT_NEAR(one.perTranslation[0], -1, 1e-9);
    // What is so far from its axis goes as far for each radian.
    EXPECT_NEAR(other.perRotation[2] - one.perRotation[2], kFar, 1e-3);
}

/// Certified answers of meshes that are translated, and of poses that translate them back.
TEST(FarMesh, AnswersAreThoseOfTheMeshAtItsOrigin) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    int touched = 0;
    for (int scene = 0; scene < 60; ++scene) {
        const RandomScene of = makeRandomScene(random, 4);
        Vec3 by{};
        for (double& coordinate : by) {
            // A whole number of a few bits that all coordinates can take: nothing is rounded on the way.
            coordinate = std::ldexp(std::round(uniform(random, -1000, 1000)), static_cast<int>(below(random, 14)));
        }
        const MeshData moved = movedBy(of.mesh, by);
        std::vector<Mat4> poses;
        for (const Mat4& pose : of.poses) {
            poses.push_back(multiply(pose, translation({-by[0], -by[1], -by[2]})));
        }
        const cpu::Volume volume = take(cpu::Volume::create(of.volume.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(of.transferFunction()));
        const cpu::Mesh here = take(cpu::Mesh::create(of.mesh.view()));
        const cpu::Mesh there = take(cpu::Mesh::create(moved.view()));
        cpu::Detector detector = take(cpu::Detector::create({.threads = 1, .projection = Projection::Certified}));
        const std::array items{cpu::BatchItem{&here, &volume, &function, of.poses},
                               cpu::BatchItem{&there, &volume, &function, poses}};
        const std::vector<PairAnswer> pairs = take(detector.detect({items, {}, of.threshold})).pairs;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const PairAnswer& one = pairs[i];
            const PairAnswer& other = pairs[poses.size() + i];
            EXPECT_FALSE(one.hit && !other.hit && !other.possible) << scene << ", pose " << i;
            EXPECT_FALSE(other.hit && !one.hit && !one.possible) << scene << ", pose " << i;
            touched += one.hit && other.hit ? 1 : 0;
        }
    }
    EXPECT_GT(touched, 10);
}

TEST(FarMesh, BendsWithTheOffsetOfItsShape) {
    const VolumeData image = halfImage();
    Held held(mapTriangle(), image, kRamp, {0, 100});
    MeshData bent = mapTriangle();
    for (const double x : {8.9, 9.05, 9.15}) {
        bent.positions[0] = 500000 + x;
        ASSERT_TRUE(held.mesh.update(bent.positions).ok());
        EXPECT_EQ(held.mesh.facts().bounds.hi[0], std::max(500008.9, 500000 + x));
        const PairDistance found = held.measure(kMapPose, {}, kAt);
        const double right = std::max(0.0, 9.1 - x);
        EXPECT_LE(found.bounds.lower, right + 1e-9);
        EXPECT_GE(found.bounds.upper, right - 1e-9);
        EXPECT_LE(found.bounds.upper - found.bounds.lower, kDefaultTolerance);
    }
    // On its way from one shape to the other: it touches from x = 9.1 on, 0.2 of 0.25.
    const std::vector<double> from = mapTriangle().positions;
    bent.positions[0] = 500009.15;
    const std::array<std::span<const double>, 2> shapes{from, bent.positions};
    const ShapesOfPoses ofItem(shapes);
    const std::array poses{kMapPose, kMapPose};
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, poses};
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    const MotionAnswer answer = take(checker.checkBending({std::span(&item, 1), {}, kAt}, std::span(&ofItem, 1)));
    EXPECT_LE(answer.segments.at(0).freeUntil, 0.8 + 1e-6);
    ASSERT_TRUE(answer.segments.at(0).touch);
    EXPECT_GE(answer.segments.at(0).touch->at, 0.8 - 1e-6);
    EXPECT_NEAR(answer.segments.at(0).touch->at, 0.8, 0.05);
}

TEST(FarMesh, WhatRoundingLeavesOpenIsNotDecided) {
    // The plane is where what is opaque begins, but for less than what is rounded.
    const double rounding = checkMesh(mapTriangle().view()).value().rounding;
    ASSERT_GT(rounding, 0);
    const Held held(mapTriangle(), halfImage(), kRamp, {0, 100});
    cpu::Detector detector = take(cpu::Detector::create({.threads = 1, .projection = Projection::Certified}));
    const auto ask = [&](double beyond) {
        const Mat4 pose = multiply(translation({0.2 + beyond, 0, 0}), kMapPose);
        const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
        return take(detector.detect({std::span(&item, 1), {}, kAt})).pairs.at(0);
    };
    EXPECT_TRUE(ask(1e-4).hit);
    EXPECT_FALSE(ask(-1e-4).hit || ask(-1e-4).possible);
}

} // namespace
} // namespace voxtact::test
