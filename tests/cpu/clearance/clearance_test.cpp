// SPDX-License-Identifier: MIT
// Clearances that are known beforehand.
#include "core/geometry/vec3.h"
#include "cpu/clearance/held.h"
#include "cpu/scenes/oracle_scenes.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "support/special.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxtact::test {
namespace {

/// Turns +x to a direction, then moves the origin to a place.
Mat4 poseAlong(const Vec3& direction, const Vec3& place) {
    const Vec3 x = unit(direction);
    const Vec3 y = unit(cross(x, std::abs(x[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 z = cross(x, y);
    return {x[0], x[1], x[2], 0, y[0], y[1], y[2], 0, z[0], z[1], z[2], 0, place[0], place[1], place[2], 1};
}

/// Anisotropic, turned, and with axes that are not at right angles.
Grid randomGrid(std::mt19937_64& random, std::uint32_t side) {
    Grid grid;
    grid.size = {side, side + 3, side - 2};
    const Mat4 turn = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] = uniform(random, 0.5, 3);
        grid.origin[axis] = uniform(random, -100, 100);
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = turn[4 * axis + row];
        }
    }
    for (std::size_t row = 0; row < 3; ++row) {
        grid.direction[3 + row] += 0.3 * grid.direction[row];
    }
    return grid;
}

/// A volume that is a linear function of the place, and the plane where it is 0, through the volume's middle.
struct HalfSpace {
    HalfSpace(std::mt19937_64& random, const Grid& grid)
        : middle(transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5})) {
        const Vec3 slope = unit({uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)});
        volume = makeVolume<float>(grid, ScalarType::Float32, [&](auto x, auto y, auto z) {
            return slope[0] * (x - 0.5 * (grid.size[0] - 1)) + slope[1] * (y - 0.5 * (grid.size[1] - 1)) +
                   slope[2] * (z - 0.5 * (grid.size[2] - 1));
        });
        const Mat4 index_from_world = take(inverse(worldFromIndex(grid)));
        Vec3 gradient{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            gradient[axis] = dot(
                slope, {index_from_world[4 * axis], index_from_world[4 * axis + 1], index_from_world[4 * axis + 2]});
        }
        const Vec3 inward = unit(gradient);
        outward = {-inward[0], -inward[1], -inward[2]};
    }
    [[nodiscard]] Vec3 at(double distance) const {
        return {middle[0] + distance * outward[0], middle[1] + distance * outward[1],
                middle[2] + distance * outward[2]};
    }

    VolumeData volume;
    Vec3 middle;
    Vec3 outward{}; ///< to where nothing is opaque
    std::vector<ControlPoint> points{{-1, 0}, {1, 1}};
    ValueRange domain{-40, 40};
};

TEST(Clearance, OfTiltedHalfSpacesInGridsOfAllKinds) {
    std::mt19937_64 random(testSeed());
    for (int i = 0; i < 60; ++i) {
        const HalfSpace scene(random, randomGrid(random, 20));
        // So many entries that the ramp has some.
        const Held held(needle(), scene.volume, scene.points, scene.domain, 1024);
        const double distance = std::pow(10, uniform(random, -2, 1));
        const PairDistance found = held.measure(poseAlong(scene.outward, scene.at(distance)));
        SCOPED_TRACE(std::to_string(i) + ": " + std::to_string(distance));
        expectAbout(distance, found, 1e-3);
        ASSERT_TRUE(found.closest);
        // A point of the plane that is farther by the tolerance is that much off the perpendicular.
        EXPECT_GT(dot(found.closest->perTranslation, scene.outward), distance / (distance + 0.011));
        ASSERT_FALSE(HasFailure());
    }
}

/// By differences, about the axes of the world through the object's origin.
TEST(Clearance, TheGradientIsHowItChanges) {
    std::mt19937_64 random(testSeed());
    const cpu::ClearanceDesc fine{.tolerance = 1e-6};
    for (int i = 0; i < 20; ++i) {
        const HalfSpace scene(random, randomGrid(random, 20));
        // The tip is off the origin, so that turning moves it.
        const Held held(oneTriangle({2, 1, -1}, {7, 1.5, 0}, {7, 0, 1.5}), scene.volume, scene.points, scene.domain,
                        1024);
        Mat4 pose = poseAlong(scene.outward, scene.at(1.5));
        const std::optional<WitnessPoints> closest = held.measure(pose, fine).closest;
        ASSERT_TRUE(closest);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double step = 1e-2;
            Vec3 offset{};
            offset[axis] = step;
            Mat4 turn = identity();
            const std::size_t next = (axis + 1) % 3;
            const std::size_t last = (axis + 2) % 3;
            turn[4 * next + next] = turn[4 * last + last] = std::cos(step);
            turn[4 * next + last] = std::sin(step);
            turn[4 * last + next] = -std::sin(step);
            const Vec3 origin{pose[12], pose[13], pose[14]};
            const Mat4 turned = multiply(
                translation(origin), multiply(turn, multiply(translation({-origin[0], -origin[1], -origin[2]}), pose)));
            const double before = held.measure(pose, fine).bounds.upper;
            const double moved = held.measure(multiply(translation(offset), pose), fine).bounds.upper;
            EXPECT_NEAR((moved - before) / step, closest->perTranslation[axis], 0.02);
            const double after = held.measure(turned, fine).bounds.upper;
            EXPECT_NEAR((after - before) / step, closest->perRotation[axis], 0.15);
        }
        ASSERT_FALSE(HasFailure());
    }
}

template <class Scalar> void expectPlane(ScalarType type, double offset) {
    Grid grid;
    grid.size = {20, 9, 9};
    grid.spacing = {0.5, 2, 1};
    const VolumeData volume = makeVolume<Scalar>(grid, type, [&](auto x, auto, auto) { return offset + 10.0 * x; });
    // Opaque from x = 10 on, which is at 5 mm.
    const std::vector<ControlPoint> points{{offset + 90, 0}, {offset + 110, 1}};
    const Held held(needle(), volume, points, {offset, offset + 200}, 2000);
    for (const double distance : {0.02, 0.7, 3.0, 40.0}) {
        SCOPED_TRACE(std::string(toString(type)) + " " + std::to_string(distance));
        expectAbout(distance, held.measure(poseAlong({-1, 0, 0}, {5 - distance, 8, 4})), 1e-3);
    }
}

TEST(Clearance, OfEveryScalarType) {
    expectPlane<std::uint8_t>(ScalarType::UInt8, 0);
    expectPlane<std::int16_t>(ScalarType::Int16, -1000);
    expectPlane<std::uint16_t>(ScalarType::UInt16, 60000);
    expectPlane<float>(ScalarType::Float32, -3.5);
}

/// The product of 1 - |x| along the axes is one half at half a voxel on each of them.
TEST(Clearance, OfOneVoxelAndOfASheetOfThem) {
    Grid grid;
    grid.size = {9, 9, 9};
    grid.spacing = {1, 2, 4};
    for (const bool sheet : {false, true}) {
        const VolumeData volume =
            makeBytes(grid, [&](auto x, auto y, auto z) { return x == 4 && (sheet || (y == 4 && z == 4)) ? 255 : 0; });
        const Held held(needle(), volume, byteRamp(), {0, 255});
        expectAbout(3, held.measure(poseAlong({-1, 0, 0}, {4 - 0.5 - 3, 8, 16})), 0.003);
        expectAbout(30, held.measure(poseAlong({1, 0, 0}, {4 + 0.5 + 30, 8, 16})), 0.003);
        if (!sheet) {
            expectAbout(2, held.measure(poseAlong({0, 0, 1}, {4, 8, 16 + 2 + 2})), 0.01);
        }
    }
}

/// A plate in front of a sheet, parallel to it: the same distance everywhere.
TEST(Clearance, OfAPlateInFrontOfASheet) {
    Grid grid;
    grid.size = {33, 33, 33};
    const VolumeData volume = makeBytes(grid, [](auto, auto, auto z) { return z == 16 ? 255 : 0; });
    const Held held(makeFlat(-40, 40, -40, 40, 0), volume, byteRamp(), {0, 255});
    for (const double distance : {0.01, 0.3, 2.0, 25.0}) {
        expectAbout(distance, held.measure(translation({16, 16, 16.5 + distance})), 0.002);
    }
}

TEST(Clearance, OfNarrowPeaksAndBetweenTwo) {
    Grid grid;
    grid.size = {101, 5, 5};
    const VolumeData volume = makeVolume<float>(grid, ScalarType::Float32, [](auto x, auto, auto) { return x; });
    // Opaque where the value, and so x, is near 20 and 60, by so little that no voxel is.
    const std::vector<ControlPoint> points{{20.4, 0}, {20.5, 1}, {20.6, 0}, {60.4, 0}, {60.5, 1}, {60.6, 0}};
    const Held held(oneTriangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), volume, points, {0, 100}, 10000);
    const auto at = [&](double x) { return held.measure(translation({x, 2, 2})); };
    expectAbout(20.45 - 12, at(12), 0.02);
    expectAbout(30 - 20.55, at(30), 0.02);
    expectAbout(60.45 - 58, at(58), 0.02);
    expectAbout(72 - 60.55, at(72), 0.02);
    EXPECT_EQ(at(20.5).bounds.upper, 0);
}

/// Everything is opaque, out to the outermost voxels' faces.
TEST(Clearance, OfTheVolumesBox) {
    std::mt19937_64 random(testSeed());
    Grid grid;
    grid.size = {4, 1, 9};
    grid.spacing = {1, 5, 0.5};
    const VolumeData volume = makeBytes(grid, [](auto...) { return 255; });
    const Held held(oneTriangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}), volume, byteRamp(), {0, 255});
    for (int i = 0; i < 200; ++i) {
        Vec3 place{};
        double squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lo = -0.5 * grid.spacing[axis];
            const double hi = (grid.size[axis] - 0.5) * grid.spacing[axis];
            place[axis] = uniform(random, -12, 12);
            const double off = std::max({lo - place[axis], place[axis] - hi, 0.0});
            squared += off * off;
        }
        const PairDistance found = held.measure(translation(place));
        SCOPED_TRACE(i);
        if (squared > 0) {
            expectAbout(std::sqrt(squared), found);
            EXPECT_NEAR(found.bounds.upper, std::sqrt(squared), 1e-9);
        } else {
            EXPECT_EQ(found.bounds.upper, 0);
        }
    }
}

TEST(Clearance, OfNothingIsInfinite) {
    const VolumeData volume = makeBytes(unitGrid(8), [](auto x, auto, auto) { return x == 3 ? 40 : 10; });
    const Held held(needle(), volume, byteRamp(), {0, 255});
    const PairDistance found = held.measure(identity());
    EXPECT_EQ(found.bounds.lower, kInfinity);
    EXPECT_EQ(found.bounds.upper, kInfinity);
    EXPECT_EQ(found.end, StopReason::Closed);
    EXPECT_FALSE(found.closest);
}

TEST(Clearance, OfATouchIsZeroAndItsPointsAreOne) {
    const VolumeData volume = makeBytes(unitGrid(8), [](auto x, auto, auto) { return x > 3 ? 255 : 0; });
    const Held held(makeFlat(-1, 2, -1, 2, 0.5), volume, byteRamp(), {0, 255});
    const PairDistance found = held.measure(identity());
    EXPECT_EQ(found.bounds.lower, 0);
    EXPECT_EQ(found.bounds.upper, 0);
    ASSERT_TRUE(found.closest);
    EXPECT_EQ(found.closest->mesh, found.closest->volume);
    EXPECT_GE(found.closest->mesh[0], 3.5 / 8);
    EXPECT_NEAR(found.closest->mesh[2], 0.5, 1e-6);
    EXPECT_EQ(found.closest->perTranslation, (Vec3{}));
}

/// A vertex alone proves it, which is examined before any triangle is.
TEST(Clearance, OfATouchByAVertexHasThatVertex) {
    const VolumeData volume = makeBytes(unitGrid(8), [](auto x, auto, auto) { return x > 3 ? 255 : 0; });
    const Held held(makeFlat(0.7, 0.9, 0.6, 0.8, 0.5), volume, byteRamp(), {0, 255});
    const PairDistance found = held.measure(identity());
    EXPECT_EQ(found.bounds.upper, 0);
    ASSERT_TRUE(found.closest);
    EXPECT_EQ(found.closest->mesh, found.closest->volume);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(found.closest->mesh[axis], (Vec3{0.7, 0.6, 0.5})[axis] - 1e-6);
        EXPECT_LE(found.closest->mesh[axis], (Vec3{0.9, 0.8, 0.5})[axis] + 1e-6);
    }
}

TEST(Clearance, BeyondTheMaximumIsNotMeasured) {
    Grid grid;
    grid.size = {8, 8, 8};
    const VolumeData volume = makeBytes(grid, [](auto...) { return 255; });
    const Held held(needle(), volume, byteRamp(), {0, 255});
    const auto at = [&](double maximum) { return held.measure(translation({7.5 + 6, 4, 4}), {.maximum = maximum}); };
    expectAbout(6, at(7));
    expectAbout(6, at(6.001));
    EXPECT_EQ(at(5.99).bounds.lower, 5.99);
    EXPECT_EQ(at(5.99).bounds.upper, kInfinity);
    EXPECT_EQ(at(5.99).end, StopReason::Beyond);
    EXPECT_EQ(at(1).bounds.lower, 1);
    EXPECT_EQ(held.measure(translation({4, 4, 4}), {.maximum = 1}).bounds.upper, 0);
}

/// With few steps the bounds are wide, and still bounds.
TEST(Clearance, ABudgetLeavesBounds) {
    std::mt19937_64 random(testSeed());
    const HalfSpace scene(random, randomGrid(random, 30));
    const Held held(makeCube(-3, 3), scene.volume, scene.points, scene.domain, 1024);
    const Mat4 pose = poseAlong(scene.outward, scene.at(12));
    const double whole = held.measure(pose).bounds.upper;
    std::size_t cut = 0;
    for (std::uint64_t steps = 1; steps < 1000; steps *= 2) {
        const PairDistance found = held.measure(pose, {.maxSteps = steps});
        EXPECT_LE(found.bounds.lower, whole);
        EXPECT_GE(found.bounds.upper, whole - kDefaultTolerance);
        EXPECT_EQ(found.end, found.bounds.upper - found.bounds.lower <= kDefaultTolerance ? StopReason::Closed
                                                                                          : StopReason::Budget);
        cut += found.end == StopReason::Budget ? 1 : 0;
    }
    EXPECT_GT(cut, 1U);
}

} // namespace
} // namespace voxtact::test
