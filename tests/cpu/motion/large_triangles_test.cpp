// SPDX-License-Identifier: MIT
// Poses that may be off, of meshes whose triangles are as long as they are: near the object's origin little of them
// moves, however far their far ends go.
#include "cpu/scenes/ball_and_box.h"
#include "cpu/scenes/engine_fixture.h"
#include "host/motion/divided_mesh.h"
#include "support/host_meters.h"
#include "voxtact/samples.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

namespace voxtact::test {
namespace {

using glm::dvec3;

/// Turned about the object's origin, and moved.
Mat4 offBy(std::mt19937_64& random, const Mat4& pose, const PoseTolerance& tolerance) {
    const auto direction = [&] {
        const dvec3 any(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        return any / std::max(glm::length(any), 1e-9);
    };
    const double angle = tolerance.angle * std::numbers::pi / 180 * (1 - 1e-9);
    const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(angle, direction()));
    const dvec3 move = direction() * (tolerance.distance * (1 - 1e-9));
    Mat4 off = pose;
    for (std::size_t column = 0; column < 3; ++column) {
        const dvec3 axis = turn * dvec3(pose[4 * column], pose[4 * column + 1], pose[4 * column + 2]);
        for (std::size_t row = 0; row < 3; ++row) {
            off[4 * column + row] = axis[static_cast<glm::length_t>(row)];
        }
    }
    for (std::size_t row = 0; row < 3; ++row) {
        off[12 + row] += move[static_cast<glm::length_t>(row)];
    }
    return off;
}

/// Of a box of 12 triangles: where it is said that nothing is reached no such pose touches, and hardly anything is left
/// open.
TEST(LargeTriangles, AreAsFarOffAsTheirPlaces) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    constexpr double kHalf = 5;
    constexpr double kLength = 300;
    constexpr int kPoses = 100;
    constexpr int kTries = 40;
    const cpu::Mesh mesh = take(cpu::Mesh::create(makeBoxTool(kHalf, kLength).view()));
    const cpu::Volume volume = take(cpu::Volume::create(makeBall().view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({kBallPoints, {0, 255}, 256}));
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
    const std::vector<Mat4> poses = posesOfBoxTool(random, kHalf, kLength, 60, kPoses);
    const cpu::BatchItem item{&mesh, &volume, &function, poses};
    for (const PoseTolerance& tolerance : {PoseTolerance{1, 2}, PoseTolerance{0, 5}, PoseTolerance{5, 30}}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(tolerance.angle) + " degrees");
        const std::vector<PairAnswer> found = take(checker.around({{&item, 1}, {}, kBallThreshold}, tolerance)).pairs;
        int hits = 0;
        int possible = 0;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            hits += found[i].hit ? 1 : 0;
            possible += found[i].possible && !found[i].hit ? 1 : 0;
            if (found[i].hit || found[i].possible) {
                continue;
            }
            std::vector<Mat4> off;
            for (int k = 0; k < kTries; ++k) {
                off.push_back(offBy(random, poses[i], tolerance));
            }
            const cpu::BatchItem tried{&mesh, &volume, &function, off};
            for (const PairAnswer& touch : take(detector.detect({{&tried, 1}, {}, kBallThreshold})).pairs) {
                EXPECT_FALSE(touch.hit) << "pose " << i;
            }
        }
        std::cout << "  " << tolerance.distance << " mm, " << tolerance.angle << " degrees: " << hits << " yes, "
                  << possible << " possible of " << kPoses << '\n';
        EXPECT_GT(hits, 0);
        EXPECT_LE(possible, kPoses / 10);
    }
}

/// It reaches a ball where it has to be turned by less than it may be.
TEST(LargeTriangles, OneIsTurnedUpToABall) {
    const cpu::Volume volume = take(cpu::Volume::create(makeBall().view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({kBallPoints, {0, 255}, 256}));
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    for (const TurnedTriangle& tool : TurnedTriangle::all()) {
        const cpu::Mesh mesh = take(cpu::Mesh::create(tool.mesh.view()));
        for (const double angle : {2.0, 5.0, 30.0, 80.0}) {
            const std::vector<Mat4> poses = tool.poses(angle);
            const cpu::BatchItem item{&mesh, &volume, &function, poses};
            const std::vector<PairAnswer> found =
                take(checker.around({{&item, 1}, {}, kBallThreshold}, {0, angle})).pairs;
            for (std::size_t i = 0; i < poses.size(); ++i) {
                SCOPED_TRACE(std::to_string(angle) + " degrees, pose " + std::to_string(i));
                const bool reached = i < tool.reached();
                EXPECT_TRUE(found[i].hit || found[i].possible || !reached);
                // Turned by much, what gets there is not convex.
                EXPECT_FALSE(angle < 10 && found[i].possible && !found[i].hit);
                EXPECT_TRUE(angle > 50 || found[i].hit == reached);
            }
        }
    }
}

/// The pieces are the surface, and none is large for where it is.
TEST(LargeTriangles, AreDividedByWhereTheyAre) {
    const MeshData tool = makeBoxTool(5, 300);
    const cpu::Mesh mesh = take(cpu::Mesh::create(tool.view()));
    const std::unique_ptr<cpu::MeshImpl> pieces = cpu::dividedMesh(mesh.impl());
    ASSERT_NE(pieces, nullptr);
    EXPECT_GT(pieces->facts.triangles, 500U);
    EXPECT_LT(pieces->facts.triangles, 20'000U);
    EXPECT_EQ(pieces->facts.bounds.lo, mesh.facts().bounds.lo);
    EXPECT_EQ(pieces->facts.bounds.hi, mesh.facts().bounds.hi);
    double area = 0;
    for (const cpu::ClusterPlace& place : pieces->clusters) {
        for (std::uint32_t i = place.firstTriangle; i < place.firstTriangle + place.triangleCount; ++i) {
            if (pieces->numbers[i] == cpu::kNoTriangle) {
                continue;
            }
            const auto vertex = [&](std::uint8_t corner) {
                const std::size_t at = place.firstVertex + corner;
                return dvec3(pieces->x[at], pieces->y[at], pieces->z[at]);
            };
            const dvec3 a = vertex(pieces->corner0[i]);
            const dvec3 b = vertex(pieces->corner1[i]);
            const dvec3 c = vertex(pieces->corner2[i]);
            area += 0.5 * glm::length(glm::cross(b - a, c - a));
            const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
            EXPECT_LE(longest, std::max(glm::length(a) / 16, 302.0 / 64));
        }
    }
    EXPECT_NEAR(area, 4 * 10.0 * 300 + 2 * 10.0 * 10, 0.01);
    // Between neighbouring floats there is none.
    MeshData tiny;
    addTriangle(tiny, {1e-44, 0, 0}, {0, 0, 0}, {0, 0, 0});
    const std::unique_ptr<cpu::MeshImpl> few = cpu::dividedMesh(take(cpu::Mesh::create(tiny.view())).impl());
    ASSERT_NE(few, nullptr);
    EXPECT_LT(few->facts.triangles, 100U);
    const MeshData fine = take(makeBuiltinMesh("scalpel"));
    EXPECT_EQ(cpu::dividedMesh(take(cpu::Mesh::create(fine.view())).impl()), nullptr);
}

} // namespace
} // namespace voxtact::test
