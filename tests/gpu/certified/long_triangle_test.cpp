// SPDX-License-Identifier: MIT
// Triangles through all of a volume, most of them thin, on the device: the answers are the host's, and few of the
// bricks of a triangle's box are looked at.
#include "certified/counted_fixture.h"
#include "certified/sides.h"
#include "cpu/scenes/ball_and_box.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

namespace voxtact::test {
namespace {

class LongTrianglesTest : public CertifiedTest {
  protected:
    /// Through the middle of a volume of so many voxels along each axis, and 1 mm each; the first is as wide as long.
    static MeshData across(std::mt19937_64& random, double side, int number) {
        MeshData mesh;
        for (int i = 0; i < number; ++i) {
            const double width = i == 0 ? side / 2 : std::pow(10, uniform(random, -3, 0));
            Vec3 from{};
            Vec3 to{};
            Vec3 third{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                from[axis] = uniform(random, -side / 2, side / 2);
                to[axis] = -from[axis] + uniform(random, -5, 5);
                third[axis] = to[axis] + width * uniform(random, -1, 1);
            }
            addTriangle(mesh, from, to, third);
        }
        return mesh;
    }
};

TEST_F(LongTrianglesTest, AreCountedAsOnTheHost) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    constexpr std::uint32_t kSide = 140;
    constexpr int kTriangles = 24;
    Grid grid;
    grid.size = {kSide, kSide, kSide};
    grid.origin = {0.5 - kSide / 2.0, 0.5 - kSide / 2.0, 0.5 - kSide / 2.0};
    const VolumeData volume =
        makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const double middle = kSide / 2.0;
            return std::clamp(350 - 5 * std::hypot(x - middle, y - middle, z - middle), 0.0, 255.0);
        });
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const MeshData mesh = across(random, kSide, kTriangles);
    const std::array poses{identity(), translation({20, -10, 5}), translation({70, 60, -65})};
    DetectorDesc desc{.method = CountingMethod::Compute, .projection = Projection::Conservative, .counters = true};
    for (const bool clusters : {true, false}) {
        const Sides sides(context(), queue(), volume.view(), {points, {0, 255}, kDefaultTableSize}, mesh.view(),
                          clusters);
        cpu::Detector host = take(cpu::Detector::create({.threads = 1, .projection = Projection::Conservative}));
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        const std::vector<PairAnswer> wanted = take(host.detect({{&hostItem, 1}, {}, 0.5})).pairs;
        const BatchItem item = sides.item(poses);
        for (const bool first : {false, true}) {
            desc.stopAtFirst = first;
            for (const std::uint32_t room : {16U, 2048U}) { // what has no room is counted all the same
                SCOPED_TRACE(std::to_string(clusters) + " " + std::to_string(first) + " " + std::to_string(room));
                const Answered found = detect(desc, {{&item, 1}, {}, 0.5}, poses.size(), room);
                for (std::size_t i = 0; i < poses.size(); ++i) {
                    EXPECT_EQ(found.pairs[i].hit, wanted[i].hit);
                    EXPECT_EQ(found.pairs[i].possible && !found.pairs[i].hit, wanted[i].possible && !wanted[i].hit);
                    EXPECT_TRUE(first || found.pairs[i].count == wanted[i].count)
                        << found.pairs[i].count << ", " << wanted[i].count;
                }
                if (room == 2048 && !first) {
                    constexpr std::uint64_t kBricks = 18 * 18 * 18;
                    EXPECT_EQ(found.counters.bricksLeft, 0U);
                    EXPECT_LT(found.counters.bricksSeen, kBricks * kTriangles * poses.size() / 4);
                }
            }
        }
        EXPECT_GT(wanted[0].count, 500U);
    }
}

/// A shaft of slivers beside a ball, nearer and farther: the host never says the opposite, and little is left open.
TEST_F(LongTrianglesTest, AreWithinAMarginAsOnTheHost) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const VolumeData volume = makeBall();
    MeshData shaft;
    constexpr int kFaces = 20;
    const auto corner = [](int i, double z) {
        const double angle = 2 * std::numbers::pi * i / kFaces;
        return Vec3{std::cos(angle), std::sin(angle), z};
    };
    for (int i = 0; i < kFaces; ++i) {
        addTriangle(shaft, corner(i, -100), corner(i + 1, -100), corner(i + 1, 100));
        addTriangle(shaft, corner(i, -100), corner(i + 1, 100), corner(i, 100));
    }
    std::vector<Mat4> poses;
    for (int i = 0; i < 12; ++i) { // beside the ball, which the axis passes by
        poses.push_back(multiply(randomRotation(random), translation({kBallRadius + 1 + 0.5 * i, 0, 0})));
    }
    const Sides sides(context(), queue(), volume.view(), {kBallPoints, {0, 255}, kDefaultTableSize}, shaft.view(),
                      true);
    const BatchItem item = sides.item(poses);
    const cpu::BatchItem hostItem = sides.hostItem(poses);
    const auto size = static_cast<std::uint32_t>(poses.size());
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const std::vector<PairClearance> measured = take(meter.measure({{&hostItem, 1}, {}, kBallThreshold})).pairs;
    DetectorDesc desc{.method = CountingMethod::Compute,
                      .projection = Projection::Conservative,
                      .stopAtFirst = true,
                      .counters = true};
    for (const double margin : {0.3, 3.0}) {
        desc.margin = margin;
        const Answered found = detect(desc, {{&item, 1}, {}, 0.5}, size, 2048);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            EXPECT_FALSE(found.pairs[i].hit && measured[i].bounds.lo > margin) << margin << ", pose " << i;
            EXPECT_FALSE(!found.pairs[i].hit && !found.pairs[i].possible && measured[i].bounds.hi < margin)
                << margin << ", pose " << i;
        }
        EXPECT_EQ(found.counters.bricksLeft, 0U);
    }
    desc.margin = 0;
    desc.clearance = ClearanceSearch{.tolerance = 0.05};
    const Answered near = detect(desc, {{&item, 1}, {}, 0.5}, size, 2048);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        EXPECT_LE(near.clearances[i].bounds.lo, measured[i].bounds.hi) << "pose " << i;
        EXPECT_GE(near.clearances[i].bounds.hi, measured[i].bounds.lo) << "pose " << i;
    }
}

/// A box of 12 triangles that may be turned: never against the host, and hardly more is left open, nor much work done.
TEST_F(LongTrianglesTest, AreAsFarOffAsOnTheHost) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    constexpr double kHalf = 5;
    constexpr double kLength = 300;
    constexpr int kPoses = 60;
    const VolumeData volume = makeBall();
    const MeshData tool = makeBoxTool(kHalf, kLength);
    const std::vector<Mat4> poses = posesOfBoxTool(random, kHalf, kLength, 60, kPoses);
    const Sides sides(context(), queue(), volume.view(), {kBallPoints, {0, 255}, kDefaultTableSize}, tool.view(), true);
    const BatchItem item = sides.item(poses);
    const cpu::BatchItem hostItem = sides.hostItem(poses);
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    for (const PoseTolerance& tolerance : {PoseTolerance{1, 2}, PoseTolerance{0, 5}, PoseTolerance{5, 30}}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(tolerance.angle) + " degrees");
        const std::vector<PairAnswer> host =
            take(checker.around({{&hostItem, 1}, {}, kBallThreshold}, tolerance)).pairs;
        const Answered device = detect({.method = CountingMethod::Compute,
                                        .projection = Projection::Conservative,
                                        .stopAtFirst = true,
                                        .counters = true,
                                        .poseTolerance = tolerance},
                                       {{&item, 1}, {}, kBallThreshold}, kPoses, 2048);
        int possible = 0;
        int hits = 0;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            SCOPED_TRACE("pose " + std::to_string(i));
            expectNoContradiction(device.pairs[i], host[i]);
            possible += device.pairs[i].possible ? 1 : 0;
            hits += device.pairs[i].hit ? 1 : 0;
        }
        std::cout << "  " << tolerance.distance << " mm, " << tolerance.angle << " degrees: " << hits << " yes, "
                  << possible << " possible of " << kPoses << ", " << device.counters.cellsDecided << " cells decided, "
                  << device.counters.cellsLeft << " left\n";
        EXPECT_GT(hits, 0);
        EXPECT_LE(possible, kPoses / 8);
    }
}

/// One triangle reaches a ball where it has to be turned by less than it may be.
TEST_F(LongTrianglesTest, OneIsTurnedUpToABall) {
    const VolumeData volume = makeBall();
    for (const TurnedTriangle& tool : TurnedTriangle::all()) {
        const Sides sides(context(), queue(), volume.view(), {kBallPoints, {0, 255}, kDefaultTableSize},
                          tool.mesh.view(), true);
        for (const double angle : {2.0, 5.0, 30.0, 80.0}) {
            const std::vector<Mat4> poses = tool.poses(angle);
            const BatchItem item = sides.item(poses);
            const auto count = static_cast<std::uint32_t>(poses.size());
            const std::vector<PairAnswer> found = detect({.method = CountingMethod::Compute,
                                                          .projection = Projection::Conservative,
                                                          .stopAtFirst = true,
                                                          .poseTolerance = PoseTolerance{0, angle}},
                                                         {{&item, 1}, {}, kBallThreshold}, count, 2048)
                                                      .pairs;
            for (std::size_t i = 0; i < poses.size(); ++i) {
                SCOPED_TRACE(std::to_string(angle) + " degrees, pose " + std::to_string(i));
                const bool reached = i < tool.reached();
                EXPECT_TRUE(found[i].hit || found[i].possible || !reached);
                // Turned by much, what gets there is not convex.
                EXPECT_TRUE(angle > 10 || reached || !(found[i].hit || found[i].possible));
            }
        }
    }
}

/// Slivers down to what rounding leaves of a width, which has no direction then.
TEST_F(LongTrianglesTest, SliversAreTurnedAsOnTheHost) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData volume = makeBall();
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    const std::array tolerances{PoseTolerance{0.5, 3}, PoseTolerance{0, 8}, PoseTolerance{2, 20}};
    int hits = 0;
    for (std::size_t number = 0; number < 36; ++number) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", sliver " + std::to_string(number));
        const double length = uniform(random, 60, 400);
        const double width = std::pow(10, uniform(random, -6, number % 4 == 0 ? 0.5 : -2));
        const Mat4 place = multiply(randomRotation(random), translation({uniform(random, -60, 60), 0, 0}));
        std::array<Vec3, 3> corners{Vec3{0, 0, 0}, Vec3{length, width * uniform(random, -1, 1), 0},
                                    Vec3{length * std::array{0.0, 0.5, 1.0}[number % 3], width, 0}};
        std::ranges::rotate(corners, corners.begin() + static_cast<std::ptrdiff_t>(random() % 3));
        MeshData sliver;
        addTriangle(sliver, transformPoint(place, corners[0]), transformPoint(place, corners[1]),
                    transformPoint(place, corners[2]));
        std::vector<Mat4> poses;
        for (int i = 0; i < 40; ++i) {
            const Vec3 on = transformPoint(place, {uniform(random, 0, length), 0, 0});
            const Mat4 turn = randomRotation(random);
            const Mat4 way = randomRotation(random);
            const Vec3 to = transformPoint(way, {kBallRadius + uniform(random, 0, 30), 0, 0});
            const Vec3 from = transformPoint(turn, on);
            poses.push_back(multiply(translation({to[0] - from[0], to[1] - from[1], to[2] - from[2]}), turn));
        }
        const Sides sides(context(), queue(), volume.view(), {kBallPoints, {0, 255}, kDefaultTableSize}, sliver.view(),
                          true);
        const PoseTolerance& tolerance = tolerances[number % tolerances.size()];
        const BatchItem item = sides.item(poses);
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        const std::vector<PairAnswer> host =
            take(checker.around({{&hostItem, 1}, {}, kBallThreshold}, tolerance)).pairs;
        const std::vector<PairAnswer> device = detect({.method = CountingMethod::Compute,
                                                       .projection = Projection::Conservative,
                                                       .stopAtFirst = true,
                                                       .poseTolerance = tolerance},
                                                      {{&item, 1}, {}, kBallThreshold}, 40, 2048)
                                                   .pairs;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            SCOPED_TRACE("pose " + std::to_string(i));
            expectNoContradiction(device[i], host[i]);
            hits += host[i].hit ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 100);
}

/// A shaft of many triangles far from a ball: there are more bricks that may be near than touch, and the search ends
/// all the same.
TEST_F(LongTrianglesTest, FarAwayTheClearanceOfAFineShaftIsFound) {
    constexpr int kFaces = 64;
    constexpr int kRings = 100;
    constexpr double kLength = 250;
    MeshData shaft;
    const auto corner = [](int i, int ring) {
        const double angle = 2 * std::numbers::pi * i / kFaces;
        return Vec3{std::cos(angle), std::sin(angle), kLength * ring / kRings};
    };
    for (int ring = 0; ring < kRings; ++ring) {
        for (int i = 0; i < kFaces; ++i) {
            addTriangle(shaft, corner(i, ring), corner(i + 1, ring), corner(i + 1, ring + 1));
            addTriangle(shaft, corner(i, ring), corner(i + 1, ring + 1), corner(i, ring + 1));
        }
    }
    const VolumeData volume = take(makeBuiltinVolume("head:120"));
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const std::array<Mat4, 1> poses{Mat4{-0.826859621, 0.211349227, -0.521185831, 0, -0.385042567, -0.888198603,
                                         0.250689975, 0, -0.409933395, 0.407964148, 0.815794009, 0, 118.2078, -92.4435,
                                         60.6299, 1}};
    const Sides sides(context(), queue(), volume.view(), {points, {0, 255}, kDefaultTableSize}, shaft.view(), true);
    const BatchItem item = sides.item(poses);
    const cpu::BatchItem hostItem = sides.hostItem(poses);
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    const ClearanceBounds wanted = take(meter.measure({{&hostItem, 1}, {}, 0.1})).pairs[0].bounds;
    const Answered found = detect({.method = CountingMethod::Compute,
                                   .projection = Projection::Conservative,
                                   .stopAtFirst = true,
                                   .counters = true,
                                   .clearance = ClearanceSearch{}},
                                  {{&item, 1}, {}, 0.1}, 1, 2048);
    EXPECT_GT(wanted.lo, 40);
    EXPECT_EQ(found.clearances[0].end, ClearanceEnd::Closed);
    EXPECT_LE(found.clearances[0].bounds.lo, wanted.hi);
    EXPECT_GE(found.clearances[0].bounds.hi, wanted.lo);
}

} // namespace
} // namespace voxtact::test
