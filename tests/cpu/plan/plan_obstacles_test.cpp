// SPDX-License-Identifier: MIT
// Plans with several obstacles, loose bounds, and instruments that point anywhere.
#include "cpu/scenes/box_scene.h"
#include "support/host_meters.h"
#include "voxtact/samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxtact::test {
namespace {

/// Each obstacle some of the boxes: what is found of one says nothing of the others.
TEST(PlanObstacles, BoundsHoldForAllOfThemHoweverLooseTheyAre) {
    std::mt19937_64 random(testSeed());
    std::size_t unsafe = 0;
    for (std::size_t scenes = 0; scenes < randomCases(600, 12); ++scenes) {
        BoxScene scene(random, 12);
        std::vector<cpu::PlanObstacle> obstacles(1 + random() % 3, scene.obstacle);
        for (cpu::PlanObstacle& each : obstacles) {
            each.avoid.clear();
        }
        for (const std::int32_t label : scene.obstacle.avoid) {
            obstacles[random() % obstacles.size()].avoid.push_back(label);
        }
        std::erase_if(obstacles, [](const cpu::PlanObstacle& each) { return each.avoid.empty(); });
        scene.task.obstacles = obstacles;
        scene.task.margin = uniform(random, 0, 8);
        cpu::Planner planner = take(cpu::Planner::create({.threads = 1,
                                                          .tolerance = std::pow(10.0, uniform(random, -1, 1.5)),
                                                          .maximum = uniform(random, 1, 20),
                                                          .maxSteps = std::uint64_t{1} << (4 + random() % 12)}));
        for (const PlannedPath& path : take(planner.plan(scene.task)).paths) {
            const double truth = scene.clearance(toGlm(path.position));
            const auto [lo, hi] = path.clearance;
            EXPECT_LE(lo, truth + 1e-6) << "margin " << scene.task.margin << ", " << obstacles.size() << " obstacles";
            EXPECT_GE(hi, truth - 1e-6);
            EXPECT_EQ(path.end == StopReason::Beyond, std::isinf(hi));
            EXPECT_EQ(path.nearest.has_value(), std::isfinite(hi));
            EXPECT_TRUE(path.safety != Safety::Safe || truth > scene.task.margin);
            EXPECT_TRUE(path.safety != Safety::Unsafe || truth < scene.task.margin + 1e-6);
            unsafe += path.safety == Safety::Unsafe ? 1 : 0;
        }
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(unsafe, 100U);
}

/// A wall at x = 20, and a sliver that is held along `axis`, its tip at the object's origin.
std::vector<PlannedPath> besideAWall(const Vec3& axis, const dvec3& along) {
    Grid grid;
    grid.size = {8, 8, 8};
    grid.spacing = {10, 60, 60};
    grid.origin = {-35, -210, -210};
    const LabelData labels =
        take(makeLabels(makeBytes(grid, [](auto x, auto, auto) { return x == 6 ? 1.0 : 0.0; }).view()));
    const VolumeData nothing = makeBytes(grid, [](auto...) { return 0; });
    const cpu::Volume volume = take(cpu::Volume::create(nothing.view()));
    const cpu::PlanObstacle wall{&volume, nullptr, kDefaultThreshold, &labels, {1}};
    const dvec3 end = 80.0 * glm::normalize(along);
    const std::vector<double> corners{0, 0, 0, static_cast<float>(end.x), 0, static_cast<float>(end.z), 0, 1e-4F, 0};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    const cpu::Mesh sliver = take(cpu::Mesh::create({corners, indices}));
    cpu::Plan task;
    task.obstacles = std::span(&wall, 1);
    task.surface = {.entries = 12, .radius = 30};
    task.mesh = cpu::PlanMesh{&sliver, {}, axis};
    return take(take(cpu::Planner::create({.threads = 1, .tolerance = 1e-6, .maximum = 40})).plan(task)).paths;
}

/// Patches with entries near and far, and obstacles of which any may be the one that is near.
TEST(PlanObstacles, PatchesAreSafeFromAllOfThemAndForTheLongestPath) {
    std::mt19937_64 random(testSeed());
    Grid grid;
    grid.size = {60, 60, 60};
    grid.origin = {-29.5, -29.5, -29.5};
    const LabelData surface = take(makeLabels(
        makeBytes(grid, [](auto x, auto y, auto z) { return x < 40 && y >= 15 && z >= 8 && z < 50 ? 1 : 0; }).view()));
    std::size_t safe = 0;
    for (std::size_t scenes = 0; scenes < randomCases(2000, 25); ++scenes) {
        BoxScene scene(random, 12);
        std::vector<cpu::PlanObstacle> obstacles(2, scene.obstacle);
        for (cpu::PlanObstacle& each : obstacles) {
            each.avoid.clear();
        }
        for (const std::int32_t label : scene.obstacle.avoid) {
            obstacles[random() % 2].avoid.push_back(label);
        }
        std::erase_if(obstacles, [](const cpu::PlanObstacle& each) { return each.avoid.empty(); });
        scene.task.obstacles = obstacles;
        scene.task.surface = {.entries = 42, .labels = &surface, .label = 1};
        scene.task.needle = {0.2, 3}; // what is between the entries is not near to them
        scene.task.margin = uniform(random, 0, 0.2);
        const PlanAnswer answer = take(take(cpu::Planner::create({.threads = 1})).plan(scene.task));
        for (const EntryTriangle& triangle : answer.triangles) {
            for (int sample = 0; triangle.safe && sample < 20; ++sample) {
                const double a = uniform(random, 0, 1);
                const double b = uniform(random, 0, 1 - a);
                const dvec3 corner = toGlm(answer.paths[triangle.paths[0]].position);
                const dvec3 entry = corner + a * (toGlm(answer.paths[triangle.paths[1]].position) - corner) +
                                    b * (toGlm(answer.paths[triangle.paths[2]].position) - corner);
                EXPECT_GT(scene.clearance(entry), scene.task.margin);
            }
            safe += triangle.safe ? 1 : 0;
        }
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(safe, 150U); // half of what is usual
}

/// Around one box: what a thick needle between the entries is near to may be beside all lines that it comes along.
TEST(PlanObstacles, PatchesAreSafeFromWhatIsOnlyNearToTheNeedlesSide) {
    std::mt19937_64 random(testSeed());
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1}));
    std::size_t near = 0;
    std::size_t safe = 0;
    for (std::size_t scenes = 0; scenes < randomCases(4000, 10); ++scenes) {
        BoxScene scene(random, 1);
        scene.task.surface.entries = chance(random, 0.5) ? 42 : 162;
        scene.task.needle.diameter = uniform(random, 4, 7);
        scene.task.margin = chance(random, 0.5) ? 0 : uniform(random, 0, 1);
        const double radius = scene.task.needle.diameter / 2;
        const PlanAnswer answer = take(planner.plan(scene.task));
        for (const EntryTriangle& triangle : answer.triangles) {
            for (std::size_t edge = 0; triangle.safe && edge < 3; ++edge) {
                const dvec3 one = toGlm(answer.paths[triangle.paths[edge]].position);
                const dvec3 other = toGlm(answer.paths[triangle.paths[(edge + 1) % 3]].position);
                const double least = scene.clearance(0.5 * (one + other));
                EXPECT_GT(least, scene.task.margin);
                near += least < scene.task.margin + radius ? 1 : 0;
            }
            safe += triangle.safe ? 1 : 0;
        }
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(safe, 10000U);
    EXPECT_GT(near, 500U);
}

TEST(PlanObstacles, AMeshIsTurnedToTheOppositeWithoutALossOfDigits) {
    for (const double tilt : {0.0, 1e-9, 1e-7, 1.2e-6, 1e-5, 1e-3}) {
        const dvec3 along(-tilt, 0, 1);
        const std::vector<PlannedPath> paths = besideAWall({along.x, along.y, along.z}, along);
        // The first two directions are those of z: the sliver comes to lie beside the wall, 20 mm from it.
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_NEAR(paths[i].clearance.lower, 20, 1e-5) << "tilt " << tilt << ", path " << i;
            EXPECT_NEAR(paths[i].clearance.upper, 20, 1e-5) << "tilt " << tilt << ", path " << i;
        }
    }
}

TEST(PlanObstacles, TheLengthOfAnAxisDoesNotMatter) {
    const std::vector<PlannedPath> usual = besideAWall({1, 0, 0}, {1, 0, 0});
    for (const double length : {1e-300, 1e-200, 1e-9, 1e200, 1e300}) {
        const std::vector<PlannedPath> paths = besideAWall({length, 0, 0}, {1, 0, 0});
        ASSERT_EQ(paths.size(), usual.size());
        for (std::size_t i = 0; i < paths.size(); ++i) {
            EXPECT_EQ(paths[i].clearance.lower, usual[i].clearance.lower) << length;
            EXPECT_EQ(paths[i].clearance.upper, usual[i].clearance.upper) << length;
        }
    }
}

TEST(PlanObstacles, LabelsThatAreNotThereAreRefused) {
    std::mt19937_64 random(testSeed());
    BoxScene scene(random, 1);
    for (std::uint16_t& index : scene.labels.indices) {
        index = index == 0 ? 0 : 1;
    }
    scene.labels.values = {0, 5, 7};
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1}));
    const auto refused = [&] {
        const Result<PlanAnswer> answer = planner.plan(scene.task);
        return answer.ok() ? std::string() : answer.error().text;
    };
    scene.obstacle.avoid = {5, 7};
    EXPECT_EQ(refused(), "");
    scene.obstacle.avoid = {5, 6};
    EXPECT_EQ(refused(), "obstacle 0: the label 6 is to be avoided, which the label map has not");
    scene.obstacle.avoid.clear();
    EXPECT_EQ(refused(), "obstacle 0: there is a label map, and none of its labels is to be avoided");
    scene.obstacle.avoid = {5};
    scene.task.surface = {.entries = 12, .labels = &scene.labels, .label = 6};
    EXPECT_EQ(refused(), "the entries' surface: the label map has no label 6");
    scene.task.surface = {.entries = 12, .radius = 5};
    scene.labels.indices.back() = 3;
    EXPECT_NE(refused().find("has the index 3, there are 3 values"), std::string::npos);
}

TEST(PlanObstacles, AGridThatAFileHasRoundedIsTheSame) {
    std::mt19937_64 random(testSeed());
    BoxScene scene(random, 3);
    cpu::Planner planner = take(cpu::Planner::create({.threads = 1}));
    const PlanAnswer usual = take(planner.plan(scene.task));
    scene.labels.grid.spacing[1] *= 1 + 1e-7;
    scene.labels.grid.origin[2] += 1e-5;
    const PlanAnswer answer = take(planner.plan(scene.task));
    for (std::size_t i = 0; i < usual.paths.size(); ++i) {
        EXPECT_EQ(answer.paths[i].clearance.upper, usual.paths[i].clearance.upper);
    }
    for (const auto change :
         {+[](Grid& grid) { grid.origin[0] += 1e-3; }, +[](Grid& grid) { grid.spacing[2] *= 1.001; },
          +[](Grid& grid) { grid.direction[0] = -1; }}) {
        BoxScene other(random, 3);
        change(other.labels.grid);
        EXPECT_EQ(planner.plan(other.task).error().code, ErrorCode::Unsupported);
    }
}

} // namespace
} // namespace voxtact::test
