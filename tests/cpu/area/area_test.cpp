// SPDX-License-Identifier: MIT
// Contact areas that are known, and what must be true of all others.
#include "cpu/area/area_held.h"

#include "core/base/infinity.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "voxtact/samples.h"

#include <iostream>

namespace voxtact::test {
namespace {

/// Each triangle in four.
MeshData quartered(const MeshData& mesh) {
    MeshData out;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<Vec3, 3> t{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const double* at = &mesh.positions[std::size_t{3} * mesh.indices[i + corner]];
            t[corner] = {at[0], at[1], at[2]};
        }
        const auto half = [](const Vec3& a, const Vec3& b) {
            return Vec3{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
        };
        const Vec3 ab = half(t[0], t[1]);
        const Vec3 bc = half(t[1], t[2]);
        const Vec3 ca = half(t[2], t[0]);
        addTriangle(out, t[0], ab, ca);
        addTriangle(out, ab, t[1], bc);
        addTriangle(out, ca, bc, t[2]);
        addTriangle(out, ab, bc, ca);
    }
    return out;
}

TEST(Area, OfAPlateThroughAHalfSpaceIsWhatIsBeyondThePlane) {
    // Opaque from where 8 x is 100, by a ramp of opacity from 90 to 110.
    const std::vector<ControlPoint> points{{90, 0}, {110, 1}};
    const MeshData plate = makeFlat(2, 22, 3.25, 17.5, 8.75);
    expectArea((22 - 12.5) * 14.25, area({plate, valueRamp(), points, kEntries}, {.tolerance = 1e-6}));
    // Askew in the image: a triangle of which a part with the same shape is beyond the plane.
    const MeshData triangle = oneTriangle({2, 3, 4}, {22, 5, 18}, {2.5, 29, 7});
    const double all = surfaceOf(triangle);
    const double beyond = (22 - 12.5) / (22 - 2) * (22 - 12.5) / (22 - 2.5);
    expectArea(all * beyond, area({triangle, valueRamp(), points, kEntries}, {.tolerance = 1e-6}));
}

TEST(Area, OfASheetIsBetweenItsFaces) {
    const std::vector<ControlPoint> sheet{{80, 0}, {100, 1}, {120, 0}}; // half opaque from 90 to 110
    const MeshData plate = makeFlat(2, 22, 4, 14, 8.75);
    expectArea((110 - 90) / 8.0 * 10, area({plate, valueRamp(), sheet, kEntries}, {.tolerance = 1e-6}));
}

/// More intervals in a cell than are examined together.
TEST(Area, OfAComb) {
    std::vector<ControlPoint> comb;
    double share = 0;
    Grid grid;
    grid.size = {4, 4, 4};
    for (int i = 0; i < 20; ++i) {
        comb.push_back({12.0 * i, 0});
        comb.push_back({12.0 * i + 4, 1}); // half opaque from 2 to 8
        comb.push_back({12.0 * i + 12, 0});
        share += 6;
    }
    const VolumeData steep = makeBytes(grid, [](auto x, auto, auto) { return x >= 2 ? 240 : 0; });
    const MeshData plate = makeFlat(1, 2, 0.5, 2.75, 1.25);
    expectArea(share / 240 * 2.25, area({plate, steep, comb, kEntries}, {.tolerance = 1e-4}), 1e-4);
}

TEST(Area, OfWhatIsOpaqueAllOverIsTheSurfaceInTheVolume) {
    std::mt19937_64 random(testSeed());
    const MeshData body = take(makeEllipsoid(2000));
    for (int i = 0; i < 20; ++i) {
        Grid grid;
        grid.size = {40, 50, 60};
        grid.spacing = {4, 3, 3};
        grid.origin = {-40, -37, -90};
        const VolumeData image = moved(makeBytes(grid, [](auto...) { return 255; }), randomMotion(random));
        const Held held(body, image, byteRamp(), {0, 255});
        const Mat4 pose =
            multiply(translation(transformPoint(worldFromIndex(image.grid), {20, 25, 30})), randomRotation(random));
        expectArea(surfaceOf(body, pose), area(held, {.tolerance = 1e-5}, 0.5, pose), 1e-5);
    }
    // A plate that is half outside.
    const Held out(makeFlat(-10, 10, 5, 15, 8.3), makeBytes(unitGrid(1), [](auto...) { return 255; }), byteRamp(),
                   {0, 255});
    EXPECT_EQ(area(out).bounds.upper, 0);
    Grid grid;
    grid.size = {20, 20, 20};
    const Held half(makeFlat(-10, 10, 5, 15, 8.3), makeBytes(grid, [](auto...) { return 255; }), byteRamp(), {0, 255});
    expectArea(10.5 * 10, area(half, {.tolerance = 1e-6}));
}

TEST(Area, CountsEachOfTwoPlatesOnEachOther) {
    MeshData twice = makeFlat(2, 10, 3, 9, 8.75);
    const std::size_t vertices = twice.positions.size() / 3;
    const MeshData once = twice;
    twice.positions.insert(twice.positions.end(), once.positions.begin(), once.positions.end());
    for (const std::uint32_t index : once.indices) {
        twice.indices.push_back(index + static_cast<std::uint32_t>(vertices));
    }
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData image = makeBytes(grid, [](auto...) { return 255; });
    expectArea(2 * 48.0, area({twice, image, byteRamp(), {0, 255}}, {.tolerance = 1e-6}));
}

TEST(Area, IsTheSameHoweverTheSurfaceIsCutAndWhereverTheWorldIs) {
    std::mt19937_64 random(testSeed());
    std::size_t apart = 0;
    for (int round = 0; round < 20 || (round < 1000 && apart <= 5); ++round) {
        const RandomScene scene = makeRandomScene(random, 2);
        const Mat4 motion = randomMotion(random);
        const double tolerance = 1e-4 * surfaceOf(scene.mesh);
        for (const Mat4& pose : scene.poses) {
            const auto measured = [&](const MeshData& mesh, const VolumeData& volume, const Mat4& at) {
                return area({mesh, volume, scene.points, scene.domain, scene.tableSize}, {.tolerance = tolerance},
                            scene.threshold, at)
                    .bounds;
            };
            const Bounds as = measured(scene.mesh, scene.volume, pose);
            const Bounds cut = measured(quartered(quartered(scene.mesh)), scene.volume, pose);
            const Bounds elsewhere = measured(scene.mesh, moved(scene.volume, motion), multiply(motion, pose));
            // A vertex that is a float is off its place by a ten-millionth of the mesh.
            const double slack = 1e-5 * surfaceOf(scene.mesh);
            for (const Bounds& other : {cut, elsewhere}) {
                EXPECT_LE(as.lower, other.upper + slack);
                EXPECT_GE(as.upper, other.lower - slack);
            }
            apart += as.lower > 0 ? 1 : 0;
        }
    }
    std::cout << apart << " have an area\n";
    EXPECT_GT(apart, 5U);
}

/// Plates in faces of cells, through their middles, and through voxels' centres: nothing is lost between two cells, and
/// nothing counts twice.
TEST(Area, OfPlatesInFacesOfCells) {
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData image = makeBytes(grid, [](auto x, auto y, auto z) { return 100.0 + (x + 2 * y + 3 * z) % 7; });
    for (const double at : {5.0, 5.5, 7.0, 8.0, 15.0, 16.0}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto corner = [&](double u, double v) {
                Vec3 out{};
                out[axis] = at;
                out[(axis + 1) % 3] = u;
                out[(axis + 2) % 3] = v;
                return out;
            };
            const MeshData plate = makeRectangle(corner(3, 4), corner(17, 4), corner(17, 16), corner(3, 16));
            expectArea(14.0 * 12.0, area({plate, image, byteRamp(), {0, 255}}, {.tolerance = 1e-6}, 0.2));
        }
    }
}

/// Rounding decides whether a plate in a face of the image is in it, whatever the values are, and says so at once. A
/// millionth of a millimetre within, it is.
TEST(Area, OfAPlateInAFaceOfTheImageIsLeftOpen) {
    std::mt19937_64 random(testSeed());
    Grid grid;
    grid.size = {20, 20, 20};
    for (const bool flat : {true, false}) {
        const VolumeData image = makeBytes(grid, [&](auto...) { return flat ? 255 : uniform(random, 150, 255); });
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const double at : {-0.5, 19.5}) {
                const auto corner = [&](double u, double v) {
                    Vec3 out{};
                    out[axis] = at;
                    out[(axis + 1) % 3] = u;
                    out[(axis + 2) % 3] = v;
                    return out;
                };
                const Held held(makeRectangle(corner(3, 4), corner(13, 4), corner(13, 14), corner(3, 14)), image,
                                byteRamp(), {0, 255});
                const PairArea found = area(held);
                EXPECT_EQ(found.bounds.lower, 0);
                EXPECT_GE(found.bounds.upper, 100);
                EXPECT_LE(found.bounds.upper, 100.001);
                EXPECT_EQ(found.end, StopReason::Rounding);
                Vec3 inward{};
                inward[axis] = at < 0 ? 1e-6 : -1e-6;
                expectArea(100, area(held, {.tolerance = 1e-6}, 0.5, translation(inward)));
                for (double& along : inward) {
                    along = -along;
                }
                EXPECT_EQ(area(held, {}, 0.5, translation(inward)).bounds.upper, 0);
            }
        }
    }
}

/// Of its cells some are opaque in part.
TEST(Area, OfAPlateInAFaceOfTheImageThatIsPartlyOpaqueIsLeftOpen) {
    // Opaque from x = 12.5 on, in the middle of a cell.
    const std::vector<ControlPoint> points{{90, 0}, {110, 1}};
    for (const double z : {-0.5, 31.5}) {
        const PairArea found = area({makeFlat(2, 22, 3, 13, z), valueRamp(), points, kEntries}, {.tolerance = 1e-3});
        EXPECT_EQ(found.bounds.lower, 0);
        EXPECT_NEAR(found.bounds.upper, 9.5 * 10, 1e-3);
        EXPECT_EQ(found.end, StopReason::Rounding);
    }
}

/// Plates some steps of a float within a face of the image, or beyond it, wherever the world is.
TEST(Area, OfPlatesHardlyWithinTheImage) {
    std::mt19937_64 random(testSeed());
    cpu::AreaMeter meter = take(cpu::AreaMeter::create({.threads = 1, .tolerance = 0.01, .maxSteps = 200}));
    const cpu::TransferFunction ramp = take(cpu::TransferFunction::create({byteRamp(), {0, 255}}));
    std::size_t open = 0;
    for (int round = 0; round < 4000; ++round) {
        const std::size_t axis = random() % 3;
        Grid grid;
        for (std::size_t i = 0; i < 3; ++i) {
            grid.size[i] = 2 + static_cast<std::uint32_t>(random() % 9);
            grid.spacing[i] = uniform(random, 0.1, 1.5);
        }
        const double far = std::ldexp(1, static_cast<int>(random() % 36));
        grid.origin[axis] = far;
        const bool upper = random() % 2 == 0;
        const long double face = (upper ? static_cast<long double>(grid.size[axis]) - 0.5L : -0.5L) *
                                 static_cast<long double>(grid.spacing[axis]);
        auto at = static_cast<float>(face);
        for (std::uint64_t step = random() % 4; step > 0; --step) {
            at = std::nextafter(at, random() % 2 == 0 ? 1e9F : -1e9F);
        }
        const bool inside = upper ? static_cast<long double>(at) <= face : static_cast<long double>(at) >= face;
        const auto side = [&](std::size_t of) { return static_cast<double>(static_cast<float>(grid.spacing[of] / 2)); };
        const auto corner = [&](double u, double v) {
            Vec3 out{};
            out[axis] = static_cast<double>(at);
            out[(axis + 1) % 3] = u * side((axis + 1) % 3);
            out[(axis + 2) % 3] = v * side((axis + 2) % 3);
            return out;
        };
        const cpu::Mesh mesh =
            take(cpu::Mesh::create(makeRectangle(corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)).view()));
        const cpu::Volume volume = take(cpu::Volume::create(makeBytes(grid, [](auto...) { return 255; }).view()));
        Vec3 offset{};
        offset[axis] = far;
        const Mat4 pose = translation(offset);
        const cpu::BatchItem item{&mesh, &volume, &ramp, std::span(&pose, 1)};
        const Bounds found = take(meter.measure({std::span(&item, 1), {}, 0.5})).pairs.at(0).bounds;
        const double all = side((axis + 1) % 3) * side((axis + 2) % 3);
        const double truth = inside ? all : 0;
        EXPECT_LE(found.lower, truth * (1 + 1e-15)) << round;
        EXPECT_GE(found.upper, truth * (1 - 1e-15)) << round;
        open += found.upper - found.lower > 0.5 * all ? 1 : 0;
    }
    std::cout << open << " were left open\n";
    EXPECT_GT(open, 0U);
    EXPECT_LT(open, 3000U);
}

/// A triangle far from its object's origin, turned: its own area is known less well, and what that adds is in the
/// bounds, without any slack.
TEST(Area, OfSmallTrianglesFarFromTheirOrigin) {
    std::mt19937_64 random(testSeed());
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData image = makeBytes(grid, [](auto...) { return 255; });
    for (int round = 0; round < 300; ++round) {
        constexpr double kFar = 65536;
        std::array<Vec3, 3> corners{};
        for (Vec3& at : corners) {
            for (double& along : at) {
                along = kFar + static_cast<double>(random() % 32) / 128; // as floats have it
            }
        }
        Mat4 pose = randomRotation(random);
        const Vec3 there = transformPoint(pose, {kFar, kFar, kFar});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose[12 + axis] = 10 - there[axis];
        }
        std::array<std::array<long double, 3>, 2> sides{};
        for (std::size_t side = 0; side < 2; ++side) {
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    sides[side][row] += static_cast<long double>(pose[4 * column + row]) *
                                        (corners[side + 1][column] - corners[0][column]);
                }
            }
        }
        const auto& [a, b] = sides;
        const long double truth =
            std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]) / 2;
        if (truth == 0) {
            continue;
        }
        const Held held(oneTriangle(corners[0], corners[1], corners[2]), image, byteRamp(), {0, 255});
        const Bounds found = area(held, {.threads = 1}, 0.5, pose).bounds;
        EXPECT_LE(static_cast<long double>(found.lower), truth * (1 + 1e-17L));
        EXPECT_GE(static_cast<long double>(found.upper), truth * (1 - 1e-17L));
        EXPECT_LE(found.upper - found.lower, 1e-6);
    }
}

TEST(Area, OfWhatIsTouchedAtAPointIsNothing) {
    const Held held(makeFlat(2, 12.4, 3, 9, 8.75), valueRamp(), std::vector<ControlPoint>{{90, 0}, {110, 1}}, kEntries);
    EXPECT_EQ(area(held).bounds.upper, 0);
    EXPECT_EQ(area(held).end, StopReason::Closed);
}

TEST(Area, IsTrueWithFewSteps) {
    std::mt19937_64 random(testSeed());
    std::size_t budget = 0;
    for (int round = 0; round < 40 || (round < 1000 && budget <= 10); ++round) {
        const RandomScene scene = makeRandomScene(random, 3);
        const Held held(scene.mesh, scene.volume, scene.points, scene.domain, scene.tableSize);
        const double fine = 1e-5 * surfaceOf(scene.mesh) + 1e-9;
        const auto measured = [&](std::uint64_t steps) {
            return areas(held, scene.poses, {.threads = 1, .tolerance = fine, .maxSteps = steps}, scene.threshold);
        };
        const std::vector<PairArea> best = measured(1U << 14U);
        for (const std::uint64_t steps : {1ULL, 3ULL, 100ULL}) {
            const std::vector<PairArea> rough = measured(steps);
            for (std::size_t i = 0; i < best.size(); ++i) {
                EXPECT_LE(rough[i].bounds.lower, best[i].bounds.upper);
                EXPECT_GE(rough[i].bounds.upper, best[i].bounds.lower);
                EXPECT_GE(rough[i].bounds.upper - rough[i].bounds.lower,
                          0.99 * (best[i].bounds.upper - best[i].bounds.lower) - fine);
                EXPECT_EQ(rough[i].end == StopReason::Closed, rough[i].bounds.upper - rough[i].bounds.lower <= fine);
                budget += rough[i].end == StopReason::Budget ? 1 : 0;
            }
        }
    }
    std::cout << budget << " took too many steps\n";
    EXPECT_GT(budget, 10U);
}

/// Of triangles in a cell or two of noise, before anything is divided: where the interpolant bends most.
TEST(Area, HoldsBeforeAPartIsDivided) {
    std::mt19937_64 random(testSeed());
    Grid grid;
    grid.size = {8, 8, 8};
    const VolumeData image = makeBytes(grid, [&](auto...) { return uniform(random, 0, 255); });
    cpu::AreaMeter coarse = take(cpu::AreaMeter::create({.threads = 1, .tolerance = 1e9}));
    cpu::AreaMeter fine = take(cpu::AreaMeter::create({.threads = 1, .tolerance = 1e-6}));
    Held held(oneTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), image, byteRamp(), {0, 255});
    const Mat4 pose = identity();
    std::size_t apart = 0;
    for (int round = 0; round < 5000; ++round) {
        const Vec3 middle{uniform(random, 1, 6), uniform(random, 1, 6), uniform(random, 1, 6)};
        std::array<Vec3, 3> corners{};
        for (Vec3& corner : corners) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                corner[axis] = middle[axis] + uniform(random, -0.5, 0.5);
            }
        }
        held.mesh = take(cpu::Mesh::create(oneTriangle(corners[0], corners[1], corners[2]).view()));
        const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
        const cpu::Batch batch{std::span(&item, 1), {}, 0.5};
        const Bounds first = take(coarse.measure(batch)).pairs.at(0).bounds;
        const Bounds last = take(fine.measure(batch)).pairs.at(0).bounds;
        EXPECT_LE(first.lower, last.upper) << round;
        EXPECT_GE(first.upper, last.lower) << round;
        apart += first.upper - first.lower > 1e-3 ? 1 : 0;
    }
    std::cout << apart << " were not known at once\n";
    EXPECT_GT(apart, 1000U);
}

/// Voxels of -10^30 for *no data* cost nothing but next to themselves.
TEST(Area, IsNotSpoiltByAnOutlier) {
    Grid grid;
    grid.size = {24, 24, 24};
    const VolumeData image = makeVolume<float>(grid, ScalarType::Float32, [](auto x, auto y, auto z) {
        return x == 20 && y == 20 && z == 20 ? -1e30 : 10.0 * x;
    });
    const Held held(makeFlat(2, 16, 3, 9, 8.75), image, std::vector<ControlPoint>{{90, 0}, {110, 1}}, {0, 255});
    expectArea(6 * 6.0, area(held, {.tolerance = 1e-6}));
    const PairArea near =
        area({makeFlat(2, 22, 3, 22, 19.75), image, std::vector<ControlPoint>{{90, 0}, {110, 1}}, {0, 255}});
    // Of the four cells around the outlier that the plate goes through nothing is sure.
    EXPECT_LE(near.bounds.lower, 12 * 19.0);
    EXPECT_GE(near.bounds.lower, 12 * 19.0 - 16.001);
    EXPECT_LE(near.bounds.upper, 12 * 19.0 + 1e-6);
}

TEST(Area, OfWhatIsTooFarAwayToTellIsUnknown) {
    const Held held(makeFlat(-1e16, 1e16, -1e16, 1e16, 8), valueRamp(), byteRamp(), {0, 255});
    const PairArea found = area(held);
    EXPECT_EQ(found.bounds.lower, 0);
    EXPECT_EQ(found.bounds.upper, kInfinity);
    EXPECT_EQ(found.end, StopReason::Rounding);
}

} // namespace
} // namespace voxtact::test
