// SPDX-License-Identifier: MIT
// Plans against the oracle of clearances, on random scenes: what is opaque, and labels at any opacity.
#include "core/geometry/glm_bridge.h"
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/clearance_oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using glm::dvec3;

/// A scene's image, some labels on it, and a needle that goes to somewhere in it.
struct PlanCase {
    PlanCase(std::uint64_t seed, std::uint64_t number, std::mt19937_64& random)
        : scene(makeCertifiedCase(seed, number).scene), volume(take(cpu::Volume::create(scene.volume.view()))),
          function(take(cpu::TransferFunction::create({scene.points, scene.domain, scene.tableSize}))) {
        const Grid& grid = scene.volume.grid;
        const std::uint64_t key = random();
        labels = take(makeLabels(makeBytes(grid, [&](auto x, auto y, auto z) {
                                     std::uint64_t h = key ^ (x / 2 + 31ULL * (y / 2) + 1009ULL * (z / 2));
                                     h = (h ^ h >> 31U) * 0x9e3779b97f4a7c15ULL;
                                     return static_cast<double>((h >> 40U) % 4);
                                 }).view()));
        opaque = number % 2 == 0;
        obstacle.volume = &volume;
        if (opaque) {
            obstacle.transferFunction = &function;
            obstacle.threshold = scene.threshold;
        } else {
            obstacle.labels = &labels;
            obstacle.avoid = {labels.values.back()};
        }
        task.obstacles = std::span(&obstacle, 1);
        const Vec3 place{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
        task.target = transformPoint(worldFromTexture(grid), place);
        const double side = grid.spacing[0] * grid.size[0];
        task.needle = {0.3 * grid.spacing[1] * uniform(random, 0.2, 2), side};
        task.needle.length = std::max(side * uniform(random, 0.2, 1), task.needle.diameter);
        task.surface.radius = side * uniform(random, 0.3, 1.5);
        task.surface.entries = 12;
        task.margin = chance(random, 0.5) ? 0 : grid.spacing[2] * uniform(random, 0, 2);
    }
    PlanCase(const PlanCase&) = delete;
    PlanCase& operator=(const PlanCase&) = delete;

    /// Of the needle on its whole way from an entry: by a line, as a triangle without area, less its radius.
    [[nodiscard]] oracle::OracleClearance truth(const PlannedPath& path) const {
        const double radius = task.needle.diameter / 2;
        const dvec3 direction = (toGlm(path.position) - toGlm(task.target)) / path.length;
        MeshData axis;
        for (const double part : {0.0, 1.0, 0.5}) {
            const dvec3 at =
                toGlm(task.target) + (radius + part * (path.length + task.needle.length - 2 * radius)) * direction;
            for (int i = 0; i < 3; ++i) {
                axis.positions.push_back(static_cast<float>(at[i]));
            }
        }
        axis.indices = {0, 1, 2};
        oracle::OraclePair pair = scene.pair();
        pair.mesh = axis.view();
        pair.world_from_object = identity();
        oracle::OracleClearance found = distance(pair);
        found.lo = std::max(found.lo - radius, 0.0);
        found.hi = std::max(found.hi - radius, 0.0);
        return found;
    }

  private:
    [[nodiscard]] oracle::OracleClearance distance(oracle::OraclePair& pair) const {
        if (opaque) {
            return take(oracle::clearanceOracle(pair, 1.0 / 32));
        }
        const std::vector<ControlPoint> all{{0, 1}, {1, 1}};
        pair.transferFunction.points = all;
        return take(oracle::labelClearanceOracle(pair, labels, obstacle.avoid.front(), 1.0 / 32));
    }

  public:
    OracleScene scene;
    cpu::Volume volume;
    cpu::TransferFunction function;
    LabelData labels;
    bool opaque = false;
    cpu::PlanObstacle obstacle;
    cpu::Plan task;
};

TEST(PlanOracle, ConfirmsPathsThatAreSafe) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::array<std::size_t, 3> verdicts{};
    const std::size_t cases = randomCases(20000, 100);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const PlanCase c(seed, number, random);
        const double side = c.scene.volume.grid.spacing[0] * c.scene.volume.grid.size[0];
        cpu::Planner planner =
            take(cpu::Planner::create({.threads = 1, .tolerance = std::max(1e-3 * side, 1e-6), .maximum = 10 * side}));
        const PlanAnswer answer = take(planner.plan(c.task));
        // Floats are what the line is rounded to.
        double slack = 1e-6 * (c.task.needle.length + c.task.surface.radius);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            slack += 1e-6 * (std::abs(c.task.target[axis]) + std::abs(c.scene.volume.grid.origin[axis]));
        }
        for (const PlannedPath& path : answer.paths) {
            const oracle::OracleClearance truth = c.truth(path);
            ++verdicts[static_cast<std::size_t>(path.safety)];
            EXPECT_LE(path.clearance.lower, truth.hi + slack) << path.clearance.lower << " to " << path.clearance.upper
                                                              << ", truth " << truth.lo << " to " << truth.hi;
            EXPECT_GE(path.clearance.upper, truth.lo - slack) << path.clearance.lower << " to " << path.clearance.upper
                                                              << ", truth " << truth.lo << " to " << truth.hi;
            EXPECT_TRUE(path.safety != Safety::Safe || truth.hi + slack > c.task.margin);
        }
        ASSERT_FALSE(HasFailure());
    }
    std::cout << verdicts[0] << " unsafe, " << verdicts[1] << " safe, " << verdicts[2] << " possible\n";
    EXPECT_GT(verdicts[0], cases);
    EXPECT_GT(verdicts[1], cases);
    EXPECT_LT(verdicts[2], cases / 4);
}

} // namespace
} // namespace voxtact::test
