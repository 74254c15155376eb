// SPDX-License-Identifier: MIT
// Clearances that are known beforehand, and what a ClearanceMeter refuses.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxtact::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A mesh, a volume and a transfer function of the engine.
struct Held {
    Held(const MeshData& data, const VolumeData& image, std::span<const ControlPoint> points, const ValueRange& domain,
         std::uint32_t entries = 256)
        : mesh(take(cpu::Mesh::create(data.view()))), volume(take(cpu::Volume::create(image.view()))),
          function(take(cpu::TransferFunction::create({points, domain, entries}))) {}

    [[nodiscard]] std::vector<PairClearance> measure(std::span<const Mat4> poses, const cpu::ClearanceDesc& desc = {},
                                                     double threshold = 0.5) const {
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create(desc));
        const cpu::BatchItem item{&mesh, &volume, &function, poses};
        return take(meter.measure({std::span(&item, 1), {}, threshold})).pairs;
    }
    [[nodiscard]] PairClearance measure(const Mat4& pose, const cpu::ClearanceDesc& desc = {},
                                        double threshold = 0.5) const {
        return measure(std::span(&pose, 1), desc, threshold).at(0);
    }

    cpu::Mesh mesh;
    cpu::Volume volume;
    cpu::TransferFunction function;
};

void expectAbout(double wanted, const PairClearance& found, double slack = 1e-5) {
    EXPECT_LE(found.bounds.lo, wanted + slack);
    EXPECT_GE(found.bounds.hi, wanted - slack);
    EXPECT_LE(found.bounds.hi - found.bounds.lo, kDefaultTolerance);
    EXPECT_EQ(found.end, ClearanceEnd::Closed);
}

MeshData oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    MeshData mesh;
    addTriangle(mesh, a, b, c);
    return mesh;
}

/// The tip at the object's origin, the rest behind it along +x.
MeshData needle() {
    return oneTriangle({0, 0, 0}, {5, 0.5, 0}, {5, 0, 0.5});
}

Vec3 unit(const Vec3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}

double dotOf(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 crossOf(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Turns +x to a direction, then moves the origin to a place.
Mat4 poseAlong(const Vec3& direction, const Vec3& place) {
    const Vec3 x = unit(direction);
    const Vec3 y = unit(crossOf(x, std::abs(x[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 z = crossOf(x, y);
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
            gradient[axis] = dotOf(
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
        const PairClearance found = held.measure(poseAlong(scene.outward, scene.at(distance)));
        SCOPED_TRACE(std::to_string(i) + ": " + std::to_string(distance));
        expectAbout(distance, found, 1e-3);
        ASSERT_TRUE(found.closest);
        // A point of the plane that is farther by the tolerance is that much off the perpendicular.
        EXPECT_GT(dotOf(found.closest->perTranslation, scene.outward), distance / (distance + 0.011));
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
        const std::optional<ClosestPoints> closest = held.measure(pose, fine).closest;
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
            const double before = held.measure(pose, fine).bounds.hi;
            const double moved = held.measure(multiply(translation(offset), pose), fine).bounds.hi;
            EXPECT_NEAR((moved - before) / step, closest->perTranslation[axis], 0.02);
            const double after = held.measure(turned, fine).bounds.hi;
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
    EXPECT_EQ(at(20.5).bounds.hi, 0);
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
        const PairClearance found = held.measure(translation(place));
        SCOPED_TRACE(i);
        if (squared > 0) {
            expectAbout(std::sqrt(squared), found);
            EXPECT_NEAR(found.bounds.hi, std::sqrt(squared), 1e-9);
        } else {
            EXPECT_EQ(found.bounds.hi, 0);
        }
    }
}

TEST(Clearance, OfNothingIsInfinite) {
    const VolumeData volume = makeBytes(unitGrid(8), [](auto x, auto, auto) { return x == 3 ? 40 : 10; });
    const Held held(needle(), volume, byteRamp(), {0, 255});
    const PairClearance found = held.measure(identity());
    EXPECT_EQ(found.bounds.lo, kInfinity);
    EXPECT_EQ(found.bounds.hi, kInfinity);
    EXPECT_EQ(found.end, ClearanceEnd::Closed);
    EXPECT_FALSE(found.closest);
}

TEST(Clearance, OfATouchIsZeroAndItsPointsAreOne) {
    const VolumeData volume = makeBytes(unitGrid(8), [](auto x, auto, auto) { return x > 3 ? 255 : 0; });
    const Held held(makeFlat(-1, 2, -1, 2, 0.5), volume, byteRamp(), {0, 255});
    const PairClearance found = held.measure(identity());
    EXPECT_EQ(found.bounds.lo, 0);
    EXPECT_EQ(found.bounds.hi, 0);
    ASSERT_TRUE(found.closest);
    EXPECT_EQ(found.closest->mesh, found.closest->volume);
    EXPECT_GE(found.closest->mesh[0], 3.5 / 8);
    EXPECT_NEAR(found.closest->mesh[2], 0.5, 1e-6);
    EXPECT_EQ(found.closest->perTranslation, (Vec3{}));
}

/// A vertex alone proves it, which is looked at before any triangle is.
TEST(Clearance, OfATouchByAVertexHasThatVertex) {
    const VolumeData volume = makeBytes(unitGrid(8), [](auto x, auto, auto) { return x > 3 ? 255 : 0; });
    const Held held(makeFlat(0.7, 0.9, 0.6, 0.8, 0.5), volume, byteRamp(), {0, 255});
    const PairClearance found = held.measure(identity());
    EXPECT_EQ(found.bounds.hi, 0);
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
    EXPECT_EQ(at(5.99).bounds.lo, 5.99);
    EXPECT_EQ(at(5.99).bounds.hi, kInfinity);
    EXPECT_EQ(at(5.99).end, ClearanceEnd::Beyond);
    EXPECT_EQ(at(1).bounds.lo, 1);
    EXPECT_EQ(held.measure(translation({4, 4, 4}), {.maximum = 1}).bounds.hi, 0);
}

/// With few steps the bounds are wide, and still bounds.
TEST(Clearance, ABudgetLeavesBounds) {
    std::mt19937_64 random(testSeed());
    const HalfSpace scene(random, randomGrid(random, 30));
    const Held held(makeCube(-3, 3), scene.volume, scene.points, scene.domain, 1024);
    const Mat4 pose = poseAlong(scene.outward, scene.at(12));
    const double whole = held.measure(pose).bounds.hi;
    std::size_t cut = 0;
    for (std::uint64_t steps = 1; steps < 1000; steps *= 2) {
        const PairClearance found = held.measure(pose, {.mostSteps = steps});
        EXPECT_LE(found.bounds.lo, whole);
        EXPECT_GE(found.bounds.hi, whole - kDefaultTolerance);
        EXPECT_EQ(found.end,
                  found.bounds.hi - found.bounds.lo <= kDefaultTolerance ? ClearanceEnd::Closed : ClearanceEnd::Budget);
        cut += found.end == ClearanceEnd::Budget ? 1 : 0;
    }
    EXPECT_GT(cut, 1U);
}

bool same(const PairClearance& a, const PairClearance& b) {
    return a.bounds.lo == b.bounds.lo && a.bounds.hi == b.bounds.hi && a.end == b.end &&
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
    const std::vector<PairClearance> alone = held.measure(scene.poses, {.threads = 1}, scene.threshold);
    const std::vector<PairClearance> together = held.measure(scene.poses, {.threads = 3}, scene.threshold);
    ASSERT_EQ(alone.size(), scene.poses.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(alone[i].pose, i);
        EXPECT_TRUE(same(alone[i], together[i])) << i;
        EXPECT_TRUE(same(alone[i], held.measure(scene.poses[i], {.threads = 1}, scene.threshold))) << i;
    }
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
        const PairClearance found = take(meter.measure({std::span(&item, 1), {}, 0.5})).pairs.at(0);
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
    const double before = held.measure(pose).bounds.hi;
    EXPECT_NEAR(before, 27.5, 0.1);
    ASSERT_TRUE(held.volume.set(VoxelBox{{15, 10, 10}, {1, 1, 1}}, 200).ok());
    EXPECT_NEAR(held.measure(pose).bounds.hi, 14.5, 0.1);
    held.function = take(cpu::TransferFunction::create({low, {0, 255}}));
    EXPECT_NEAR(held.measure(pose).bounds.hi, 10.5, 1e-6);
}

/// Of label 1 in front of a needle that points along -x from x = 30.
double clearanceToOne(cpu::ClearanceMeter& meter, const Held& held, const LabelData& labels) {
    const Mat4 pose = translation({30, 10, 10});
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1), &labels};
    const std::vector<std::int32_t> one{1};
    return take(meter.measureLabels({std::span(&item, 1), {}, 0.5}, one)).labels.at(0).bounds.hi;
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
    const LabelClearance says = take(all.measureLabels({std::span(&item, 1), {}, 0.5}, one)).labels.at(0);
    EXPECT_LE(says.bounds.lo, 7 + 1e-9);
    EXPECT_GE(says.bounds.hi, 7 - 1e-9);
    EXPECT_EQ(says.end, ClearanceEnd::Closed);
}

TEST(Clearance, RefusesWhatItCannotUse) {
    const auto refused = [](const cpu::ClearanceDesc& desc) {
        const Result<cpu::ClearanceMeter> meter = cpu::ClearanceMeter::create(desc);
        return meter.ok() ? std::string() : meter.error().text;
    };
    EXPECT_EQ(refused({.tolerance = 0}), "the tolerance 0 mm is not a number from 1e-06 mm on");
    EXPECT_NE(refused({.tolerance = std::nan("")}), "");
    EXPECT_NE(refused({.tolerance = kInfinity}), "");
    EXPECT_EQ(refused({.maximum = 0}), "the maximum clearance 0 mm is not above 0");
    EXPECT_NE(refused({.maximum = std::nan("")}), "");
    EXPECT_NE(refused({.resolution = 2}), "");
    EXPECT_EQ(refused({.mostSteps = 0}), "mostSteps is 0, a clearance takes at least one step");
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
    EXPECT_EQ(refusedLabels(&coarse, one),
              "batch item 0: the label map is not on the grid of the volume; resample it to that");
    EXPECT_NE(refusedLabels(&labels, std::vector<std::int32_t>(5000, 1)), "");
    EXPECT_EQ(refusedLabels(&labels, one), "");
    EXPECT_EQ(refusedLabels(&labels, {}), "");
    item.volume = nullptr;
    EXPECT_FALSE(meter.measure({std::span(&item, 1), {}, 0.5}).ok());
    EXPECT_TRUE(take(meter.measure({})).pairs.empty());
}

} // namespace
} // namespace voxtact::test
