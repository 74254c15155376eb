// SPDX-License-Identifier: MIT
// Motions whose touch is known beforehand, poses that may be off, and what a MotionChecker refuses.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "cpu/scenes/random_scene.h"
#include "support/floor.h"
#include "support/host_meters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxtact::test {
namespace {

/// A mesh, a volume and a transfer function of the engine.
struct Held {
    Held(const MeshData& data, const VolumeData& image, std::span<const ControlPoint> points = byteRamp(),
         const ValueRange& domain = {0, 255}, std::uint32_t entries = 256)
        : mesh(take(cpu::Mesh::create(data.view()))), volume(take(cpu::Volume::create(image.view()))),
          function(take(cpu::TransferFunction::create({points, domain, entries}))) {}

    [[nodiscard]] std::vector<SegmentMotion> check(const std::vector<Mat4>& poses,
                                                   const cpu::MotionDesc& desc = {}) const {
        cpu::MotionChecker checker = take(cpu::MotionChecker::create(desc));
        const cpu::BatchItem item{&mesh, &volume, &function, poses};
        return take(checker.check({std::span(&item, 1), {}, 0.5})).segments;
    }
    [[nodiscard]] PairAnswer around(const Mat4& pose, const PoseTolerance& tolerance) const {
        cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
        const cpu::BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
        return take(checker.around({std::span(&item, 1), {}, 0.5}, tolerance)).pairs.at(0);
    }

    cpu::Mesh mesh;
    cpu::Volume volume;
    cpu::TransferFunction function;
};

MeshData oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    MeshData mesh;
    addTriangle(mesh, a, b, c);
    return mesh;
}

/// From corner to corner.
MeshData makeBox(const Vec3& lo, const Vec3& hi) {
    MeshData cube = makeCube(0, 1);
    for (std::size_t i = 0; i < cube.positions.size(); ++i) {
        const std::size_t axis = i % 3;
        cube.positions[i] =
            static_cast<float>(lo[axis] + static_cast<double>(cube.positions[i]) * (hi[axis] - lo[axis]));
    }
    return cube;
}

/// Of a straight way down: the first touch is known, and what is said is within the resolution of it.
void expectTouchAt(double wanted, const SegmentMotion& found, double slack) {
    ASSERT_TRUE(found.touch) << toString(found.end) << ", free until " << found.freeUntil;
    EXPECT_LE(found.freeUntil, wanted + 1e-9);
    EXPECT_GE(found.touch->at, wanted - 1e-9);
    EXPECT_LE(found.touch->at - found.freeUntil, slack);
    EXPECT_EQ(found.end, MotionEnd::Decided);
    EXPECT_FALSE(found.possible);
}

TEST(Motion, FindsWhereATipReachesAFloor) {
    const Held held(oneTriangle({0, 0, 0}, {0.3, 0, 5}, {0, 0.3, 5}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    for (const double height : {0.02, 0.5, 3.0, 9.0, 200.0}) {
        for (const double down : {height + 0.5, 2 * height + 1}) {
            SCOPED_TRACE(std::to_string(height) + " " + std::to_string(down));
            const std::vector<SegmentMotion> found =
                held.check({translation({1, 2, height}), translation({1, 2, height - down})});
            ASSERT_EQ(found.size(), 1U);
            expectTouchAt(height / down, found[0], kDefaultMotionResolution / down + 1e-9);
            EXPECT_NEAR(found[0].touch->position[2], 0, 0.02);
            EXPECT_EQ(found[0].touch->triangle, 0U);
        }
        const std::vector<SegmentMotion> before =
            held.check({translation({1, 2, height}), translation({1, 2, 0.01 * height})});
        EXPECT_EQ(before[0].freeUntil, 1);
        EXPECT_FALSE(before[0].touch || before[0].possible);
    }
}

/// One plate of 0.1 mm, one layer of voxels of 0.05 mm, 400 mm in one segment: nothing that samples sees it.
TEST(Motion, FindsAThinPlateThatCrossesASheet) {
    Grid grid;
    grid.size = {33, 33, 65};
    grid.spacing = {1, 1, 0.05};
    const VolumeData volume = makeBytes(grid, [](auto, auto, auto z) { return z == 32 ? 255 : 0; });
    const Held held(makeBox({-5, -5, 0}, {5, 5, 0.1}), volume);
    const double top = 0.05 * 32.5;
    for (const Vec3& from : {Vec3{16, 16, 200}, Vec3{10, 20, 123.4}}) {
        const std::vector<SegmentMotion> found = held.check({translation(from), translation({16, 16, -200})});
        expectTouchAt((from[2] - top) / (from[2] + 200), found[0], 1e-4);
    }
    // Past it, 0.1 mm beside the last voxel's face.
    const std::vector<SegmentMotion> beside = held.check({translation({37.6, 16, 200}), translation({37.6, 16, -200})});
    EXPECT_EQ(beside[0].freeUntil, 1);
}

/// A rod from the origin along x, turned about y: its far end comes down on a circle.
TEST(Motion, FindsWhereATurningRodReachesAFloor) {
    const Held held(oneTriangle({0, 0, 0}, {15, 0, 0}, {15, 0.1, 0}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    for (const double height : {0.1, 2.0, 9.0}) {
        const Mat4 up = translation({0, 0, height});
        const double angle = 1.2;
        // Turning +z to +x about y: the rod's end goes down.
        const std::vector<SegmentMotion> found = held.check({up, multiply(up, turned(1, angle))});
        const double wanted = std::asin(height / 15) / angle;
        expectTouchAt(wanted, found[0], 1e-3);
        EXPECT_NEAR(std::hypot(found[0].touch->position[0], found[0].touch->position[2] - height), 15, 0.05);
    }
}

/// Some voxels where the rod's end is at last. Seen from the middle of the way, the end is not on the tangent but 3 mm
/// beside it.
TEST(Motion, FindsWhatIsWhereATurnEnds) {
    const double angle = 1.2;
    Grid grid;
    grid.size = {41, 5, 41};
    grid.spacing = {0.5, 0.5, 0.5};
    grid.origin = {0, -1, -20};
    const std::array<double, 2> end{15 * std::cos(angle), -15 * std::sin(angle)};
    const VolumeData volume = makeBytes(grid, [&](auto x, auto y, auto z) {
        return y >= 1 && y <= 3 && std::abs(0.5 * x - end[0]) <= 0.6 && std::abs(0.5 * z - 20 - end[1]) <= 0.6 ? 255
                                                                                                               : 0;
    });
    const Held held(oneTriangle({14.9, 0, 0}, {15, 0, 0}, {15, 0.01, 0}), volume);
    for (const Interpolation interpolation : {Interpolation::Screw, Interpolation::Slerp}) {
        const SegmentMotion found = held.check({identity(), turned(1, angle)}, {.interpolation = interpolation})[0];
        ASSERT_TRUE(found.touch);
        EXPECT_GT(found.freeUntil, 0.9);
        EXPECT_LT(found.touch->at, 1);
    }
}

/// With slerp the middle of the mesh goes straight down while it turns: the lower end is the first.
TEST(Motion, TurnsAboutTheMiddleWithSlerp) {
    const Held held(oneTriangle({10, 0, 0}, {20, 0, 0}, {20, 0.1, 0}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    const Mat4 from = translation({-15, 0, 4});
    // Turned by half a right angle about the middle, which comes down by 2 mm.
    const Mat4 to =
        multiply(translation({0, 0, 2}), multiply(turned(1, std::numbers::pi / 4), translation({-15, 0, 0})));
    const double fine = 0.001;
    const std::vector<SegmentMotion> found =
        held.check({from, to}, {.interpolation = Interpolation::Slerp, .resolution = fine});
    double wanted = 0;
    for (double step = 0.5; step > 1e-12; step /= 2) {
        const double t = wanted + step;
        wanted = 4 - 2 * t - 5 * std::sin(t * std::numbers::pi / 4) > 0 ? t : wanted;
    }
    expectTouchAt(wanted, found[0], 3e-4);
    // The screw from one to the other goes along an arc, and is there at another time.
    const std::vector<SegmentMotion> screw = held.check({from, to}, {.resolution = fine});
    ASSERT_TRUE(screw[0].touch);
    EXPECT_GT(std::abs(screw[0].touch->at - wanted), 1e-3);
}

/// Along a floor, at a small distance all the way: few steps, since only what goes towards it counts.
TEST(Motion, SlidesAlongAFloor) {
    const Held held(makeBox({-1, -1, 0}, {1, 1, 1}), floorImage(), kFloorPoints, kFloorDomain, kFloorEntries);
    const auto slide = [&](double height, std::uint64_t maxSteps) {
        return held.check({translation({-5, 0, height}), translation({5, 1, height})}, {.maxSteps = maxSteps})[0];
    };
    // Steps are of cells; halves as long as the distance would take ten times as many.
    for (const double height : {5.0, 0.5, 0.05}) {
        EXPECT_EQ(slide(height, 2000).freeUntil, 1) << height;
    }
    const SegmentMotion grazes = slide(0, 1U << 20U);
    EXPECT_TRUE(grazes.possible || grazes.touch);
    EXPECT_EQ(grazes.freeUntil, 0);
    const SegmentMotion within = slide(-0.001, 1U << 20U);
    ASSERT_TRUE(within.touch);
    EXPECT_EQ(within.touch->at, 0);
    const SegmentMotion few = held.check({translation({0, 0, 9}), translation({0, 0, -2})}, {.maxSteps = 3})[0];
    EXPECT_EQ(few.end, MotionEnd::Budget);
    EXPECT_LT(few.freeUntil, 9.0 / 11);
}

/// Somewhere it is a hair's breadth from touching, and later it touches.
TEST(Motion, AGrazeIsNotWhereItEnds) {
    const Held held(oneTriangle({0, 0, 0}, {0.3, 0, 5}, {0, 0.3, 5}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    // A turn about a point 10 mm above comes down to the floor, just so, and up again; then it is moved below.
    const Mat4 pivot = translation({0, 0, 10});
    const Mat4 arm = translation({0, 0, -10});
    const auto at = [&](double angle) { return multiply(pivot, multiply(turned(1, angle), arm)); };
    const std::vector<SegmentMotion> found = held.check({at(-0.5), at(0.6)});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_LE(found[0].freeUntil, 0.5 / 1.1);
    EXPECT_GT(found[0].freeUntil, 0.4);
    EXPECT_TRUE(found[0].possible || found[0].touch);
}

TEST(Motion, IsThatOfEachPairOfConsecutivePoses) {
    const Held held(oneTriangle({0, 0, 0}, {0.3, 0, 5}, {0, 0.3, 5}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    const std::vector<Mat4> path{translation({0, 0, 5}), translation({9, 0, 5}), translation({9, 0, -1}),
                                 translation({9, 0, 3})};
    const std::vector<SegmentMotion> alone = held.check(path, {.threads = 1});
    ASSERT_EQ(alone.size(), 3U);
    EXPECT_EQ(alone[0].freeUntil, 1);
    expectTouchAt(5.0 / 6, alone[1], 0.01);
    ASSERT_TRUE(alone[2].touch);
    EXPECT_EQ(alone[2].touch->at, 0);
    EXPECT_EQ(alone[2].freeUntil, 0);
    const std::vector<SegmentMotion> together = held.check(path, {.threads = 3});
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(alone[i].segment, i);
        EXPECT_EQ(alone[i].pose, i);
        EXPECT_EQ(alone[i].freeUntil, together[i].freeUntil);
        EXPECT_EQ(alone[i].touch.has_value(), together[i].touch.has_value());
    }
    EXPECT_TRUE(held.check({path[0]}).empty());
    EXPECT_TRUE(held.check({}).empty());
    // Nothing moves.
    EXPECT_EQ(held.check({path[0], path[0]})[0].freeUntil, 1);
    EXPECT_EQ(held.check({path[2], path[2]})[0].touch->at, 0);
}

TEST(Motion, GoesFromTheFirstPoseToTheSecond) {
    std::mt19937_64 random(testSeed());
    for (int i = 0; i < 50; ++i) {
        const Mat4 from = randomMotion(random);
        const Mat4 to = randomMotion(random);
        const Vec3 centre{uniform(random, -5, 5), uniform(random, -5, 5), uniform(random, -5, 5)};
        for (const Interpolation interpolation : {Interpolation::Screw, Interpolation::Slerp}) {
            EXPECT_EQ(take(poseBetween(from, to, 0, interpolation, centre)), from);
            EXPECT_EQ(take(poseBetween(from, to, 1, interpolation, centre)), to);
            const Mat4 nearly = take(poseBetween(from, to, 1 - 1e-12, interpolation, centre));
            for (std::size_t k = 0; k < 16; ++k) {
                EXPECT_NEAR(nearly[k], to[k], 1e-8);
            }
            // The centre goes straight with slerp.
            if (interpolation == Interpolation::Slerp) {
                const Vec3 a = transformPoint(from, centre);
                const Vec3 b = transformPoint(to, centre);
                const Vec3 third = transformPoint(take(poseBetween(from, to, 0.25, interpolation, centre)), centre);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    EXPECT_NEAR(third[axis], 0.75 * a[axis] + 0.25 * b[axis], 1e-9);
                }
            }
        }
    }
    // Rounded as a file has it: no rigid motion to the last digit, and still there at the end.
    Mat4 rounded = turned(2, 0.7);
    for (double& element : rounded) {
        element = std::round(element * 1e4) / 1e4;
    }
    EXPECT_EQ(take(poseBetween(identity(), rounded, 1)), rounded);
}

/// Which way round is written down (voxtact/motion.h): counter-clockwise about the direction of the axis whose
/// coordinate of the largest magnitude is positive.
TEST(Motion, HalfATurnGoesTheWayThatIsSaid) {
    const double half = std::sqrt(0.5);
    const std::pair<Vec3, Vec3> axes[] = {{{0, 0, 1}, {0, 0, 1}},           {{0, 0, -1}, {0, 0, 1}},
                                          {{0, -1, 0}, {0, 1, 0}},          {{-1, 0, 0}, {1, 0, 0}},
                                          {{-0.6, 0, 0.8}, {-0.6, 0, 0.8}}, {{0.6, 0, -0.8}, {-0.6, 0, 0.8}},
                                          {{-0.8, 0, 0.6}, {0.8, 0, -0.6}}, {{-half, half, 0}, {half, -half, 0}}};
    for (const auto& [given, taken] : axes) {
        // 2 a aT - 1 turns by 180 degrees about a; it is symmetric, and so says nothing of the way.
        Mat4 to = identity();
        for (std::size_t column = 0; column < 3; ++column) {
            for (std::size_t row = 0; row < 3; ++row) {
                to[4 * column + row] = 2 * given[column] * given[row] - (column == row ? 1 : 0);
            }
        }
        for (const Interpolation interpolation : {Interpolation::Screw, Interpolation::Slerp}) {
            const Mat4 quarter = take(poseBetween(identity(), to, 0.5, interpolation));
            // Of a quarter of a turn about a, the part that is not symmetric is cross(a, .).
            EXPECT_NEAR((quarter[6] - quarter[9]) / 2, taken[0], 1e-12);
            EXPECT_NEAR((quarter[8] - quarter[2]) / 2, taken[1], 1e-12);
            EXPECT_NEAR((quarter[1] - quarter[4]) / 2, taken[2], 1e-12);
        }
    }
}

/// How far a floor is below a tip, by how much the pose may be off.
TEST(PoseTolerance, OfATipAboveAFloor) {
    const Held held(oneTriangle({0, 0, 0}, {0.3, 0, 5}, {0, 0.3, 5}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    for (const double height : {0.1, 2.0, 8.0}) {
        SCOPED_TRACE(height);
        const Mat4 pose = translation({1, 2, height});
        EXPECT_FALSE(held.around(pose, {0, 0}).hit);
        const PairAnswer safe = held.around(pose, {height - 0.001, 0});
        EXPECT_FALSE(safe.hit || safe.possible);
        const PairAnswer off = held.around(pose, {height + 0.001, 0});
        EXPECT_TRUE(off.hit);
        EXPECT_EQ(off.count, 1U);
        // The tip is the object's origin, turning does not bring it nearer, nor the rest of the mesh, unless by much.
        const PairAnswer spun = held.around(pose, {height - 0.001, 20});
        EXPECT_FALSE(spun.hit || spun.possible);
        EXPECT_TRUE(held.around(pose, {height - 0.001, 180}).hit);
    }
    EXPECT_TRUE(held.around(translation({0, 0, -0.5}), {0, 0}).hit);
}

/// A rod parallel to the floor: its far end comes down by the sine of the angle.
TEST(PoseTolerance, OfARodAboveAFloor) {
    const Held held(oneTriangle({0, 0, 0}, {15, 0, 0}, {15, 0.01, 0}), floorImage(), kFloorPoints, kFloorDomain,
                    kFloorEntries);
    for (const double degrees : {0.5, 2.0, 10.0, 25.0}) {
        for (const double distance : {0.0, 1.0}) {
            SCOPED_TRACE(std::to_string(degrees) + " " + std::to_string(distance));
            const double far = distance + std::hypot(15, 0.01) * std::sin(degrees * std::numbers::pi / 180);
            const PairAnswer safe = held.around(translation({0, 0, far + 0.002}), {distance, degrees});
            EXPECT_FALSE(safe.hit || safe.possible);
            EXPECT_TRUE(held.around(translation({0, 0, far - 0.02}), {distance, degrees}).hit);
        }
    }
}

/// What is called safe is: of poses drawn at random that are off by as much, none touches.
TEST(PoseTolerance, NoPoseThatIsOffTouches) {
    std::mt19937_64 random(testSeed());
    std::size_t safe = 0;
    std::size_t hits = 0;
    std::size_t possible = 0;
    const std::size_t cases = randomCases(4000, 200);
    // Few cases may all be alike: on until both kinds were among them.
    for (std::size_t number = 0; number < cases || ((hits == 0 || safe == 0) && number < 20 * cases); ++number) {
        SCOPED_TRACE(number);
        const RandomScene scene = makeRandomScene(random, 1);
        const cpu::Mesh mesh = take(cpu::Mesh::create(scene.mesh.view()));
        const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(scene.transferFunction()));
        const PoseTolerance tolerance{std::pow(10, uniform(random, -1, 1)), uniform(random, 0, 20)};
        std::vector<Mat4> poses = scene.poses;
        const cpu::BatchItem one{&mesh, &volume, &function, poses};
        cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
        const PairAnswer says = take(checker.around({std::span(&one, 1), {}, scene.threshold}, tolerance)).pairs.at(0);
        ++(says.hit ? hits : says.possible ? possible : safe);
        if (says.hit || says.possible) {
            continue;
        }
        const Vec3 origin{poses[0][12], poses[0][13], poses[0][14]};
        for (int i = 0; i < 100; ++i) {
            const Mat4 spin = randomRotation(random);
            const Mat4 turn =
                multiply(spin, multiply(turned(0, uniform(random, 0, tolerance.angle) * std::numbers::pi / 180),
                                        take(inverse(spin))));
            const Mat4 way = randomRotation(random);
            const double by = tolerance.distance * std::cbrt(uniform(random, 0, 1));
            const Vec3 to{origin[0] + by * way[0], origin[1] + by * way[1], origin[2] + by * way[2]};
            poses.push_back(
                multiply(translation(to),
                         multiply(turn, multiply(translation({-origin[0], -origin[1], -origin[2]}), scene.poses[0]))));
        }
        cpu::Detector detector =
            take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
        const cpu::BatchItem all{&mesh, &volume, &function, poses};
        bool some = false;
        for (const PairAnswer& pair : take(detector.detect({std::span(&all, 1), {}, scene.threshold})).pairs) {
            some = some || pair.hit;
        }
        EXPECT_FALSE(some) << tolerance.distance << " mm, " << tolerance.angle << " degrees";
        ASSERT_FALSE(HasFailure());
    }
    std::cout << hits << " touch, " << safe << " are safe, " << possible << " possible\n";
    EXPECT_GT(hits, 0U);
    EXPECT_GT(safe, 0U);
}

TEST(Motion, RefusesWhatItCannotUse) {
    const auto refused = [](const cpu::MotionDesc& desc) {
        const Result<cpu::MotionChecker> checker = cpu::MotionChecker::create(desc);
        return checker.ok() ? std::string() : checker.error().text;
    };
    EXPECT_EQ(refused({.resolution = 0}), "the resolution 0 mm is not a number from 1e-06 mm on");
    EXPECT_NE(refused({.resolution = std::nan("")}), "");
    EXPECT_NE(refused({.touchResolution = 2}), "");
    EXPECT_EQ(refused({.maxSteps = 0}), "at most 0 steps are allowed, a search takes at least one step");
    EXPECT_NE(refused({.interpolation = static_cast<Interpolation>(7)}), "");
    EXPECT_EQ(refused({.threads = 2}), "");

    const Held held(makeCube(-1, 1), floorImage());
    cpu::HostEngine engine = take(cpu::HostEngine::create(1));
    const Touch both{.margin = 1, .uncertainty = PoseTolerance{1, 0}};
    const Mat4 unmoved = identity();
    const cpu::BatchItem one{&held.mesh, &held.volume, &held.function, {&unmoved, 1}};
    EXPECT_NE(engine.ask(both, {.items = {&one, 1}}).error().text.find("leave out one of the two"), std::string::npos);
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    const auto text = [&](const std::vector<Mat4>& poses) {
        const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, poses};
        const Result<MotionAnswer> answer = checker.check({std::span(&item, 1), {}, 0.5});
        return answer.ok() ? std::string() : answer.error().text;
    };
    Mat4 large = identity();
    large[0] = large[5] = large[10] = 1.01;
    Mat4 mirror = identity();
    mirror[0] = -1;
    Mat4 flat = identity();
    flat[10] = 0;
    EXPECT_EQ(text({identity(), large}),
              "batch item 0, poses 0 and 1: the motion from one to the other is not rigid (scale, shear or a mirror "
              "image); give poses of one scale");
    EXPECT_EQ(text({identity(), identity(), mirror}).substr(0, 32), "batch item 0, poses 1 and 2: the");
    EXPECT_NE(text({flat, flat}), "");
    // Scale and mirror image are fine where they do not change.
    EXPECT_EQ(text({large, multiply(turned(0, 1), large)}), "");
    EXPECT_EQ(text({mirror, multiply(turned(0, 1), mirror)}), "");
    for (const double parameter : {-0.1, 1.1, std::nan("")}) {
        EXPECT_FALSE(poseBetween(identity(), identity(), parameter).ok());
    }
    const Mat4 pose = identity();
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
    for (const PoseTolerance& tolerance : {PoseTolerance{-1, 0}, PoseTolerance{0, -1}, PoseTolerance{0, 181},
                                           PoseTolerance{std::nan(""), 0}, PoseTolerance{0, std::nan("")}}) {
        EXPECT_FALSE(checker.around({std::span(&item, 1), {}, 0.5}, tolerance).ok());
    }
}

} // namespace
} // namespace voxtact::test
