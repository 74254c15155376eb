// SPDX-License-Identifier: MIT
// Plans against boxes, whose distance from a line is known.
#include "cpu/scenes/box_scene.h"
#include "host/plan/direction_grid.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <numbers>
#include <set>

namespace voxtact::test {
namespace {

using glm::dvec3;

TEST(DirectionGrid, CoversTheSphereOnce) {
    for (const std::uint32_t wanted : {1U, 12U, 13U, 500U}) {
        const cpu::DirectionGrid grid(wanted);
        ASSERT_GE(grid.count(), std::max(wanted, 12U));
        const std::uint32_t n = grid.side();
        std::set<std::uint32_t> met;
        double angle = 0; // of all triangles, as seen from the middle
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
        for (std::uint32_t rhombus = 0; rhombus < cpu::DirectionGrid::kRhombi; ++rhombus) {
            for (std::uint32_t i = 0; i < n; ++i) {
                for (std::uint32_t j = 0; j < n; ++j) {
                    for (const auto& triangle : grid.triangles(rhombus, i, j)) {
                        const dvec3 a = grid.direction(triangle[0]);
                        const dvec3 b = grid.direction(triangle[1]);
                        const dvec3 c = grid.direction(triangle[2]);
                        // Van Oosterom and Strackee, 1983.
                        angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                                1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
                        for (std::size_t k = 0; k < 3; ++k) {
                            met.insert(triangle[k]);
                            ++edges[{triangle[k], triangle[(k + 1) % 3]}];
                        }
                    }
                }
            }
        }
        EXPECT_EQ(met.size(), grid.count());
        EXPECT_EQ(*met.rbegin(), grid.count() - 1);
        EXPECT_NEAR(angle, 4 * std::numbers::pi, 1e-9);
        for (const auto& [edge, times] : edges) {
            EXPECT_EQ(times, 1);
            EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
        }
    }
}

TEST(DirectionGrid, ConesHoldTheirPatches) {
    std::mt19937_64 random(testSeed());
    const cpu::DirectionGrid grid(1000);
    const std::uint32_t n = grid.side();
    for (int number = 0; number < 2000; ++number) {
        cpu::DirectionPatch patch;
        patch.rhombus = static_cast<std::uint32_t>(random() % 10);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            patch.lo[axis] = static_cast<std::uint32_t>(random() % n);
            patch.hi[axis] = patch.lo[axis] + 1 + static_cast<std::uint32_t>(random() % (n - patch.lo[axis]));
        }
        const cpu::DirectionCone cone = grid.cone(patch);
        const auto isIn = [&](const dvec3& direction) {
            return std::acos(std::min(glm::dot(direction, cone.axis), 1.0)) <= cone.angle + 1e-7;
        };
        const auto i = patch.lo[0] + static_cast<std::uint32_t>(random() % patch.cells(0));
        const auto j = patch.lo[1] + static_cast<std::uint32_t>(random() % patch.cells(1));
        const auto triangle = grid.triangles(patch.rhombus, i, j)[random() % 2];
        dvec3 sum(0);
        for (const std::uint32_t corner : triangle) {
            sum += uniform(random, 0, 1) * grid.direction(corner);
        }
        EXPECT_TRUE(isIn(glm::normalize(sum)));
        // The farthest are on the edges: at the corners, or where the ridge meets them.
        for (std::uint32_t at = patch.lo[0]; at <= patch.hi[0]; ++at) {
            EXPECT_TRUE(isIn(grid.direction(grid.number(patch.rhombus, at, patch.lo[1]))));
            EXPECT_TRUE(isIn(grid.direction(grid.number(patch.rhombus, at, patch.hi[1]))));
        }
        for (std::uint32_t at = patch.lo[1]; at <= patch.hi[1]; ++at) {
            EXPECT_TRUE(isIn(grid.direction(grid.number(patch.rhombus, patch.lo[0], at))));
            EXPECT_TRUE(isIn(grid.direction(grid.number(patch.rhombus, patch.hi[0], at))));
        }
    }
}

TEST(Plan, SaysHowNearEachPathComes) {
    std::mt19937_64 random(testSeed());
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1, .tolerance = 0.01}));
    std::array<std::size_t, 3> verdicts{};
    for (std::size_t scenes = 0; scenes < randomCases(400, 50); ++scenes) {
        BoxScene scene(random, 12);
        scene.task.margin = scenes % 3 == 0 ? 0 : uniform(random, 0, 3);
        const PlanAnswer answer = take(planner.plan(scene.task));
        ASSERT_EQ(answer.paths.size(), 162U);
        for (const PlannedPath& path : answer.paths) {
            const double truth = scene.clearance(toGlm(path.position));
            const auto [lo, hi] = path.clearance;
            EXPECT_LE(lo, truth + 1e-6);
            EXPECT_GE(hi, truth - 1e-6);
            EXPECT_EQ(path.end, truth >= kDefaultPlanMaximum + 0.0101 ? StopReason::Beyond : path.end)
                << truth << " in [" << lo << ", " << hi << "]";
            EXPECT_TRUE(path.end == StopReason::Beyond ? lo == kDefaultPlanMaximum : hi - lo <= 0.0101);
            EXPECT_NEAR(path.length, 30, 1e-9);
            ++verdicts[static_cast<std::size_t>(path.safety)];
            if (std::abs(truth - scene.task.margin) > 1e-5 && truth > 1e-5) {
                EXPECT_EQ(path.safety, truth > scene.task.margin ? Safety::Safe : Safety::Unsafe);
            }
            if (path.nearest && hi > 0) {
                const dvec3 there = toGlm(path.nearest->position);
                const AxisBox& box = scene.boxes.at(static_cast<std::size_t>(path.nearest->label - 1));
                EXPECT_LE(box.distance(there), 1e-6);
                EXPECT_NEAR(glm::distance(there, toGlm(path.nearest->onPath)) - 1, hi, 1e-6);
            }
        }
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(verdicts[0], 200U);
    EXPECT_GT(verdicts[1], 200U);
    EXPECT_LT(verdicts[2], verdicts[0] / 20);
}

/// A triangle is certified for all of its points.
TEST(Plan, CertifiesPatchesForAllTheirPaths) {
    std::mt19937_64 random(testSeed());
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1}));
    double safeArea = 0;
    double cornersArea = 0; // of triangles with three safe corners
    for (std::size_t scenes = 0; scenes < randomCases(200, 100); ++scenes) {
        BoxScene scene(random, 12);
        scene.task.surface.entries = 2562;
        scene.task.margin = uniform(random, 0, 2);
        const PlanAnswer answer = take(planner.plan(scene.task));
        EXPECT_EQ(answer.triangles.size(), 5120U);
        double safe = 0;
        double all = 0;
        for (const EntryTriangle& triangle : answer.triangles) {
            std::array<dvec3, 3> corners{};
            bool safeCorners = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const PlannedPath& path = answer.paths[triangle.paths[i]];
                corners[i] = toGlm(path.position);
                safeCorners = safeCorners && path.safety == Safety::Safe;
            }
            const double area = 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
            all += area;
            cornersArea += safeCorners ? area : 0;
            safe += triangle.safe ? area : 0;
            EXPECT_TRUE(!triangle.safe || safeCorners);
            for (int sample = 0; triangle.safe && sample < 5; ++sample) {
                const double a = uniform(random, 0, 1);
                const double b = uniform(random, 0, 1 - a);
                const dvec3 entry = corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
                EXPECT_GT(scene.clearance(entry), scene.task.margin);
            }
        }
        EXPECT_NEAR(answer.area, all, 1e-6 * all);
        EXPECT_NEAR(answer.area, 4 * std::numbers::pi * 30 * 30, 0.01 * all);
        EXPECT_NEAR(answer.safeArea, safe, 1e-6 * all);
        safeArea += safe;
        ASSERT_FALSE(HasFailure());
    }
    std::cout << "certified: " << safeArea << " of " << cornersArea << " mm2 with safe corners\n";
    EXPECT_GT(safeArea, 0.75 * cornersArea);
    EXPECT_LE(safeArea, cornersArea);
}

/// A triangle's clearance is no more than that of any path from it, and not much less than that of the nearest.
TEST(Plan, MeasuresTrianglesForAllTheirPaths) {
    std::mt19937_64 random(testSeed());
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1, .tolerance = 0.01}));
    double above = 0; // mm, of the nearest sampled path over the bound
    std::size_t measured = 0;
    for (std::size_t scenes = 0; scenes < randomCases(100, 20); ++scenes) {
        BoxScene scene(random, 12);
        scene.task.surface.entries = 642;
        scene.task.margin = uniform(random, 0, 3);
        const PlanAnswer without = take(planner.plan(scene.task));
        scene.task.triangleDistances = true;
        const PlanAnswer answer = take(planner.plan(scene.task));
        for (std::size_t i = 0; i < answer.triangles.size(); ++i) {
            const EntryTriangle& triangle = answer.triangles[i];
            EXPECT_EQ(triangle.safe, without.triangles[i].safe);
            EXPECT_EQ(without.triangles[i].clearance, 0);
            EXPECT_LE(triangle.clearance, kDefaultPlanMaximum);
            EXPECT_TRUE(!triangle.safe || triangle.clearance >= scene.task.margin);
            std::array<dvec3, 3> corners{};
            double nearest = kDefaultPlanMaximum;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = toGlm(answer.paths[triangle.paths[k]].position);
                nearest = std::min(nearest, scene.clearance(corners[k]));
            }
            for (int sample = 0; sample < 5; ++sample) {
                const double a = uniform(random, 0, 1);
                const double b = uniform(random, 0, 1 - a);
                nearest = std::min(nearest, scene.clearance(corners[0] + a * (corners[1] - corners[0]) +
                                                            b * (corners[2] - corners[0])));
            }
            EXPECT_LE(triangle.clearance, nearest + 1e-6);
            if (nearest > 0) {
                above += nearest - triangle.clearance;
                ++measured;
            }
        }
        ASSERT_FALSE(HasFailure());
    }
    ASSERT_GT(measured, 1000U);
    std::cout << "nearest of some paths above the bound: " << above / static_cast<double>(measured)
              << " mm on average\n";
    EXPECT_LT(above / static_cast<double>(measured), 2); // the entries are some 4 mm apart, the far ends 9
}

/// The needle as a mesh, with another tip and axis, moved by the same rule: no farther off than makeNeedle() says.
TEST(Plan, AMeshIsMeasuredOnItsWayIn) {
    std::mt19937_64 random(testSeed());
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1, .tolerance = 0.01}));
    const MeshData round = take(makeNeedle(2, 6)); // all of its way is among the boxes
    constexpr double kInside = 0.01;               // mm, 1 % of its radius
    MeshData turned = round;
    for (std::size_t i = 0; i < round.positions.size(); i += 3) {
        turned.positions[i] = 5 - round.positions[i + 2]; // the shaft along -x from (5, 6, 7)
        turned.positions[i + 1] = 6 + round.positions[i + 1];
        turned.positions[i + 2] = 7 + round.positions[i];
    }
    const cpu::Mesh mesh = take(cpu::Mesh::create(turned.view()));
    for (std::size_t scenes = 0; scenes < randomCases(40, 20); ++scenes) {
        BoxScene scene(random, 10);
        scene.task.surface.entries = 42;
        scene.task.surface.radius = 18;
        scene.task.needle.length = 6;
        scene.task.margin = scenes % 2 == 0 ? 0 : uniform(random, 0, 3);
        const PlanAnswer exact = take(planner.plan(scene.task));
        scene.task.mesh = cpu::PlanMesh{&mesh, {5, 6, 7}, {-3, 0, 0}};
        const PlanAnswer answer = take(planner.plan(scene.task));
        EXPECT_EQ(answer.safeArea, 0);
        ASSERT_EQ(answer.paths.size(), exact.paths.size());
        for (std::size_t i = 0; i < answer.paths.size(); ++i) {
            const PlannedPath& path = answer.paths[i];
            const double truth = scene.clearance(toGlm(path.position));
            EXPECT_GE(path.clearance.upper, truth - 1e-5);
            EXPECT_LE(path.clearance.lower, truth + kInside);
            EXPECT_TRUE(path.end == StopReason::Beyond || path.clearance.upper - path.clearance.lower <= 0.0101)
                << toString(path.end) << ' ' << path.clearance.lower << ' ' << path.clearance.upper << ", truth "
                << truth;
            EXPECT_TRUE(path.safety != Safety::Safe || truth + kInside > scene.task.margin);
            EXPECT_TRUE(path.safety != Safety::Unsafe || truth - 1e-5 < scene.task.margin);
        }
        ASSERT_FALSE(HasFailure());
    }
}

/// What is opaque: half of a volume whose values rise along x. Entries are on the surface of a ball of another one.
TEST(Plan, AvoidsWhatIsOpaqueAndEntersThroughASurface) {
    Grid grid;
    grid.size = {40, 40, 40};
    grid.origin = {-19.5, -19.5, -19.5};
    const VolumeData rising = makeBytes(grid, [](auto x, auto, auto) { return 5.0 * x; });
    const VolumeData ball = makeBytes(grid, [](auto x, auto y, auto z) {
        return std::clamp(100 + 20 * (15 - std::hypot(x - 19.5, y - 19.5, z - 19.5)), 0.0, 255.0);
    });
    const cpu::Volume obstacle = take(cpu::Volume::create(rising.view()));
    const cpu::Volume head = take(cpu::Volume::create(ball.view()));
    // Opaque from 150 on: x from 10.5 on in world coordinates.
    const std::vector<ControlPoint> steps{{0, 0}, {255, 1}};
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({steps, {0, 255}}));
    const cpu::PlanObstacle avoided{&obstacle, &function, 150.0 / 255, nullptr, {}};
    cpu::Plan task;
    task.obstacles = std::span(&avoided, 1);
    task.needle = {2, 20};
    task.surface = {.entries = 642, .volume = &head, .transferFunction = &function, .threshold = 100.0 / 255};
    task.margin = 1;
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1, .tolerance = 0.01}));
    const PlanAnswer answer = take(planner.plan(task));
    ASSERT_EQ(answer.paths.size(), 642U);
    for (const PlannedPath& path : answer.paths) {
        EXPECT_NEAR(path.length, 15, 0.1);
        ASSERT_TRUE(path.angle.has_value());
        EXPECT_LT(*path.angle, 12); // a ball of voxels
        // The far end of the axis is the nearest, if the box's other faces do not matter.
        const dvec3 direction = toGlm(path.position) / path.length;
        const dvec3 end = (path.length + 19) * direction;
        if (std::abs(end.y) < 20 && std::abs(end.z) < 20) {
            const double truth = std::clamp(10.5 - std::max(end.x, direction.x) - 1, 0.0, 1e9);
            EXPECT_LE(path.clearance.lower, truth + 0.2);
            EXPECT_GE(path.clearance.upper, truth - 0.2);
        }
        EXPECT_TRUE(!path.nearest || path.nearest->label == 0);
    }
    // The limits leave some out.
    task.target = {0, 0, 5};
    task.longest = 14;
    const PlanAnswer shorter = take(planner.plan(task));
    EXPECT_GT(shorter.tooLong, 100U);
    EXPECT_EQ(shorter.paths.size() + shorter.tooLong, 642U);
    for (const PlannedPath& path : shorter.paths) {
        EXPECT_LE(path.length, 14);
    }
    task.longest.reset();
    task.steepest = 10;
    const PlanAnswer straighter = take(planner.plan(task));
    EXPECT_GT(straighter.tooOblique, 50U);
    for (const PlannedPath& path : straighter.paths) {
        EXPECT_LE(*path.angle, 10);
    }
}

/// A sheet across a diagonal of the voxels: rays are in it for 0.29 voxels or more.
TEST(Plan, EntersThroughThinSheetsInAllDirections) {
    Grid grid;
    grid.size = {40, 40, 40};
    const VolumeData rising = makeBytes(grid, [](auto x, auto y, auto z) { return x + y + z; });
    const cpu::Volume volume = take(cpu::Volume::create(rising.view()));
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1}));
    const cpu::DirectionGrid directions(642);
    const dvec3 target(10, 10, 10);
    std::size_t looked = 0;
    for (double at = 60; at < 61; at += 0.1) {
        constexpr double kHalf = 0.25; // of the sheet, in values
        const std::vector<ControlPoint> peak{{at - kHalf, 0}, {at - kHalf, 1}, {at + kHalf, 1}, {at + kHalf, 0}};
        const cpu::TransferFunction function = take(cpu::TransferFunction::create({peak, {0, 120}, 65536}));
        const cpu::PlanObstacle avoided{&volume, &function, 0.5, nullptr, {}};
        const PlanAnswer answer = take(planner.plan(
            {.target = {target.x, target.y, target.z},
             .surface = {.entries = 642, .volume = &volume, .transferFunction = &function, .threshold = 0.5},
             .obstacles = std::span(&avoided, 1),
             .needle = {1, 5}}));
        std::map<std::uint32_t, double> lengths;
        for (const PlannedPath& path : answer.paths) {
            lengths[path.entry] = path.length;
        }
        for (std::uint32_t number = 0; number < directions.count(); ++number) {
            const dvec3 direction = directions.direction(number);
            const double rate = direction.x + direction.y + direction.z; // values for each mm
            const double outside = (at + kHalf - 30) / rate;
            const dvec3 there = target + outside * direction;
            const bool isInside =
                glm::all(glm::greaterThan(there, dvec3(0))) && glm::all(glm::lessThan(there, dvec3(39)));
            if (rate > 0 && isInside) {
                ASSERT_EQ(lengths.count(number), 1U) << at << " in direction " << number;
                EXPECT_NEAR(lengths[number], outside, 0.01);
                ++looked;
            }
        }
    }
    EXPECT_GT(looked, 200U);
}

TEST(Plan, DoesNotDependOnThreads) {
    std::mt19937_64 random(testSeed());
    BoxScene scene(random, 12);
    scene.task.surface.entries = 642;
    scene.task.margin = 1;
    scene.task.triangleDistances = true;
    const PlanAnswer one = take(take(cpu::Planner::create({.threads = 1})).plan(scene.task));
    const PlanAnswer three = take(take(cpu::Planner::create({.threads = 3})).plan(scene.task));
    ASSERT_EQ(one.paths.size(), three.paths.size());
    for (std::size_t i = 0; i < one.paths.size(); ++i) {
        EXPECT_EQ(one.paths[i].clearance.lower, three.paths[i].clearance.lower);
        EXPECT_EQ(one.paths[i].clearance.upper, three.paths[i].clearance.upper);
    }
    for (std::size_t i = 0; i < one.triangles.size(); ++i) {
        EXPECT_EQ(one.triangles[i].safe, three.triangles[i].safe);
        EXPECT_EQ(one.triangles[i].clearance, three.triangles[i].clearance);
    }
    EXPECT_EQ(one.safeArea, three.safeArea);
}

TEST(Plan, TellsWhatALineCrosses) {
    Grid grid;
    grid.size = {10, 10, 10};
    const LabelData labels = take(makeLabels(makeBytes(grid, [](auto x, auto y, auto) {
                                                 return x < 3 ? 7 : x < 5 ? 0 : y == 9 ? 2 : 5;
                                             }).view()));
    EXPECT_EQ(*labelsAlong(labels, {-3, 4, 4}, {20, 4, 4}), (std::vector<std::int32_t>{7, 5}));
    EXPECT_EQ(*labelsAlong(labels, {20, 4, 4}, {-3, 4, 4}), (std::vector<std::int32_t>{5, 7}));
    EXPECT_EQ(*labelsAlong(labels, {7, 0, 4}, {7, 9.4, 4}), (std::vector<std::int32_t>{5, 2}));
    EXPECT_TRUE(labelsAlong(labels, {20, 20, 20}, {30, 20, 20})->empty());
    for (double far = 100; far < 1e300; far *= 1e7) {
        EXPECT_EQ(*labelsAlong(labels, {-far, 4, 4}, {far, 4, 4}), (std::vector<std::int32_t>{7, 5})) << far;
        EXPECT_EQ(*labelsAlong(labels, {7, far, 4}, {7, -far, 4}), (std::vector<std::int32_t>{2, 5})) << far;
        EXPECT_TRUE(labelsAlong(labels, {7, far, 20}, {7, -far, 20})->empty()) << far;
        // At an angle, to an end that is inside.
        const Vec3 away{-far, 4 - 0.5 * far, 4};
        EXPECT_EQ(*labelsAlong(labels, {8.9, 9.4, 4}, away), (std::vector<std::int32_t>{2, 5, 7})) << far;
        EXPECT_EQ(*labelsAlong(labels, away, {8.9, 9.4, 4}), (std::vector<std::int32_t>{7, 5, 2})) << far;
    }
    EXPECT_EQ(labelsAlong(labels, {-1.7e308, 4, 4}, {1.7e308, 4, 4}).error().text,
              "an end of the line is too far away");
    EXPECT_EQ(*labelsAlong(labels, {1, 1, 1}, {1, 1, 1}), (std::vector<std::int32_t>{7}));
    EXPECT_EQ(labelsAlong(labels, {0, std::nan(""), 0}, {1, 1, 1}).error().text, "an end of the line is not finite");
    EXPECT_EQ(labelsAlong(labels, {0, 0, 0}, {1, HUGE_VAL, 1}).error().code, ErrorCode::InvalidArgument);
}

TEST(Plan, RefusesWhatItCannotUse) {
    std::mt19937_64 random(testSeed());
    const BoxScene scene(random, 5);
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1}));
    const auto refused = [&](const std::function<void(cpu::Plan&)>& change) {
        cpu::Plan task = scene.task;
        change(task);
        const Result<PlanAnswer> answer = planner.plan(task);
        return answer.ok() ? std::string() : answer.error().text;
    };
    EXPECT_EQ(refused([](auto&) {}), "");
    const auto numbers = [&](const cpu::PlannerDesc& desc) {
        return take(cpu::Planner::create(desc)).plan(scene.task).error().text;
    };
    EXPECT_EQ(numbers({.threads = 1, .tolerance = 0}), "the tolerance 0 mm is not a number from 1e-06 mm on");
    EXPECT_EQ(numbers({.threads = 1, .maximum = 0}), "the max 0 mm is not a number above 0 mm");
    EXPECT_EQ(numbers({.threads = 1, .maxSteps = 0}), "at most 0 steps are allowed, a search takes at least one step");
    EXPECT_EQ(refused([](auto& task) { task.target[1] = std::nan(""); }),
              "the target is not within 1e+09 mm of the origin");
    EXPECT_NE(refused([](auto& task) { task.target[2] = 1e18; }).find("the target"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.obstacles = {}; }).find("no obstacles"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.margin = -1; }).find("margin"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.needle.diameter = 0; }).find("needle"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.needle.length = 1; }).find("needle"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.surface.radius = 0; }).find("radius"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.surface.radius = 1e-3; }).find("mm is not above 0.001"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.surface.entries = 0; }).find("entries"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.longest = 5; }).find("too long"), std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.steepest = 95; }).find("angle"), std::string::npos);
    const cpu::Mesh mesh = take(cpu::Mesh::create(take(makeNeedle(1, 2)).view()));
    EXPECT_NE(refused([&](auto& task) {
                  task.mesh = cpu::PlanMesh{&mesh, {}, {0, 0, 0}};
              }).find("axis"),
              std::string::npos);
    EXPECT_NE(refused([](auto& task) { task.mesh = cpu::PlanMesh{}; }).find("mesh is null"), std::string::npos);
    EXPECT_NE(refused([&](auto& task) {
                  task.mesh = cpu::PlanMesh{&mesh, {1e300, 0, 0}, {0, 0, 1}};
              }).find("the tip"),
              std::string::npos);
    EXPECT_NE(refused([&](auto& task) {
                  task.surface = {.entries = 12, .labels = &scene.labels, .label = 99};
              }).find("no label 99"),
              std::string::npos);
    EXPECT_NE(refused([&](auto& task) {
                  task.surface.volume = &*scene.volume;
                  task.surface.labels = &scene.labels;
              }).find("both given"),
              std::string::npos);
    const std::atomic<bool> cancelled{true};
    EXPECT_NE(refused([&](auto& task) { task.cancel = &cancelled; }).find("cancelled"), std::string::npos);
}

} // namespace
} // namespace voxtact::test
