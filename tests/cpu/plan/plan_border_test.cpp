// SPDX-License-Identifier: MIT
// Entries where the image ends within the thing: a head is cut at the neck by the scan, and nobody enters there.
#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace voxtact::test {
namespace {

constexpr double kRadius = 15; // mm, of a ball about the origin
constexpr double kCut = 9.5;   // mm below the origin, where the image ends

/// The ball, in voxels of a millimetre; something to avoid that is beyond all paths.
class PlanBorder : public testing::Test {
  protected:
    PlanBorder() {
        grid_.size = {40, 40, 30};
        grid_.origin = {-19.5, -19.5, -kCut + 0.5};
        const auto radius = [this](auto x, auto y, auto z) {
            return std::hypot(x + grid_.origin[0], y + grid_.origin[1], z + grid_.origin[2]);
        };
        ball_ = makeBytes(grid_, [&](auto x, auto y, auto z) {
            return std::clamp(100 + 20 * (kRadius - radius(x, y, z)), 0.0, 255.0);
        });
        labels_ = take(makeLabels(makeBytes(grid_, [&](auto x, auto y, auto z) {
                                      return radius(x, y, z) < kRadius ? 7.0 : x == 0 && y == 0 && z == 29 ? 9.0 : 0.0;
                                  }).view()));
        volume_.emplace(take(cpu::Volume::create(ball_.view())));
        function_.emplace(take(cpu::TransferFunction::create({steps_, {0, 255}})));
        obstacle_ = {&*volume_, nullptr, kDefaultThreshold, &labels_, {9}};
        task_.obstacles = std::span(&obstacle_, 1);
        task_.surface = {
            .entries = 2562, .volume = &*volume_, .transferFunction = &*function_, .threshold = 100.0 / 255};
        task_.needle = {1, 5};
    }

    Grid grid_;
    VolumeData ball_;
    LabelData labels_;
    std::vector<ControlPoint> steps_{{0, 0}, {255, 1}};
    std::optional<cpu::Volume> volume_;
    std::optional<cpu::TransferFunction> function_;
    cpu::PlanObstacle obstacle_;
    cpu::Plan task_;
    cpu::Planner planner_ = take(cpu::Planner::create({.threads = 1}));
};

/// mm2 of the sphere above the cut.
constexpr double kSphereArea = 2 * std::numbers::pi * kRadius * (kRadius + kCut);

TEST_F(PlanBorder, NoPathBeginsWhereTheImageEnds) {
    for (const bool byLabel : {false, true}) {
        SCOPED_TRACE(byLabel ? "a label" : "what is opaque");
        const double doubt = byLabel ? 1 : 0.2; // mm: labels fill boxes, and the outer half of a voxel is as its middle
        if (byLabel) {
            task_.surface = {.entries = 2562, .labels = &labels_, .label = 7};
        }
        const PlanAnswer answer = take(planner_.plan(task_));
        EXPECT_EQ(answer.noSurface, 0U);
        EXPECT_EQ(answer.paths.size() + answer.onBorder, answer.directions);
        // The directions are even: the share of the sphere below the cut is (radius - cut) / diameter.
        EXPECT_NEAR(answer.onBorder / static_cast<double>(answer.directions), (kRadius - kCut) / (2 * kRadius), 0.02);
        for (const PlannedPath& path : answer.paths) {
            EXPECT_NEAR(path.length, kRadius, doubt);
            EXPECT_GT(path.position[2], -kCut);
        }
        // What is certified, and its area, is of the sphere alone, less the triangles that the cut goes through.
        EXPECT_LT(answer.area, kSphereArea * (byLabel ? 1.12 : 1));
        EXPECT_GT(answer.area, 0.9 * kSphereArea);
        EXPECT_EQ(answer.area, answer.safeArea);
        for (const EntryTriangle& triangle : answer.triangles) {
            for (const std::uint32_t path : triangle.paths) {
                EXPECT_LT(path, answer.paths.size());
            }
        }
        // A normal is that of the sphere up to its rim.
        const auto steepest = [](const PlanAnswer& of) {
            double most = 0;
            for (const PlannedPath& path : of.paths) {
                most = std::max(most, path.length > kRadius - 1 ? path.angle.value_or(0) : 0);
            }
            return most;
        };
        EXPECT_TRUE(byLabel || steepest(answer) < 16) << steepest(answer);

        task_.surface.borderEntries = true;
        const PlanAnswer all = take(planner_.plan(task_));
        task_.surface.borderEntries = false;
        EXPECT_EQ(all.paths.size(), all.directions);
        EXPECT_EQ(all.onBorder, 0U);
        EXPECT_TRUE(byLabel || steepest(all) > 20) << steepest(all);
        const auto below = std::ranges::count_if(
            all.paths, [](const PlannedPath& path) { return std::abs(path.position[2] + kCut) < 1e-9; });
        EXPECT_EQ(static_cast<std::uint32_t>(below), answer.onBorder);
        const double disc = std::numbers::pi * (kRadius * kRadius - kCut * kCut);
        EXPECT_NEAR(all.area / (kSphereArea + disc), 1, byLabel ? 0.12 : 0.02);
        // The others are the same.
        auto other = all.paths.begin();
        for (const PlannedPath& path : answer.paths) {
            other =
                std::find_if(other, all.paths.end(), [&](const PlannedPath& each) { return each.entry == path.entry; });
            ASSERT_NE(other, all.paths.end());
            EXPECT_EQ(path.position, other->position);
            EXPECT_EQ(path.clearance.lower, other->clearance.lower);
        }
    }
}

/// A pipe of air leads down out of the image, as a windpipe does: its walls are no skin.
TEST_F(PlanBorder, NoPathBeginsInAirWithinTheBody) {
    const auto isPipe = [this](auto x, auto y, auto z) {
        return std::hypot(x + grid_.origin[0], y + grid_.origin[1]) < 4 && z + grid_.origin[2] < 2;
    };
    const VolumeData hollow = makeBytes(grid_, [&](auto x, auto y, auto z) {
        return isPipe(x, y, z) ? 0.0 : static_cast<double>(std::to_integer<int>(ball_.voxels[(z * 40 + y) * 40 + x]));
    });
    const cpu::Volume volume = take(cpu::Volume::create(hollow.view()));
    task_.target = {0, 0, 8};
    task_.surface.volume = &volume;
    const PlanAnswer answer = take(planner_.plan(task_));
    EXPECT_EQ(answer.paths.size() + answer.onBorder, answer.directions);
    for (const PlannedPath& path : answer.paths) {
        EXPECT_NEAR(std::hypot(path.position[0], path.position[1], path.position[2]), kRadius, 0.2);
    }
    task_.surface.borderEntries = true;
    const PlanAnswer all = take(planner_.plan(task_));
    EXPECT_EQ(all.paths.size(), all.directions);
    EXPECT_TRUE(std::ranges::any_of(all.paths, [](const PlannedPath& path) { return path.length < 7; }));
}

/// Each direction is counted once, as what leaves it out first.
TEST_F(PlanBorder, IsCountedBesideTheOtherLimits) {
    const std::uint32_t onBorder = take(planner_.plan(task_)).onBorder;
    task_.target = {0, 0, 6};
    task_.longest = 16;
    task_.steepest = 15;
    const PlanAnswer answer = take(planner_.plan(task_));
    EXPECT_GT(answer.onBorder, 0U);
    EXPECT_LT(answer.onBorder, onBorder) << "the cut is farther away";
    EXPECT_GT(answer.tooLong, 0U);
    EXPECT_GT(answer.tooOblique, 0U);
    EXPECT_EQ(answer.paths.size() + answer.onBorder + answer.tooLong + answer.tooOblique, answer.directions);
}

TEST_F(PlanBorder, WhereAllOfItIsCutThereIsNoEntry) {
    const VolumeData full = makeBytes(grid_, [](auto...) { return 200; });
    const cpu::Volume volume = take(cpu::Volume::create(full.view()));
    task_.surface.volume = &volume;
    EXPECT_EQ(
        planner_.plan(task_).error().text,
        "no entry is left of 2562 directions: 0 meet no surface, 2562 enter where the image ends, 0 are too long, "
        "0 too oblique; allow more, border entries among them");
    task_.surface.borderEntries = true;
    EXPECT_EQ(take(planner_.plan(task_)).paths.size(), 2562U);
}

} // namespace
} // namespace voxtact::test
