// SPDX-License-Identifier: MIT
// Safe paths in a real head with an atlas, one by one, against the oracle of clearances.
#include "core/geometry/glm_bridge.h"
#include "oracle/clearance_oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/io.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace voxtact::test {
namespace {

using glm::dvec3;

constexpr double kNeedleRadius = 1; // mm, of the needle
constexpr double kLength = 200;     // mm
constexpr double kMargin = 2;       // mm

/// A label alone, on the part of the grid around it: for an oracle that goes through all cells.
struct LabelCrop {
    LabelCrop(const LabelData& all, std::int32_t label) {
        const auto& size = all.grid.size;
        std::array<std::uint32_t, 3> lo = size;
        std::array<std::uint32_t, 3> hi{};
        const auto has = [&](const std::array<std::uint32_t, 3>& at) {
            return all.values[all.indices[(std::size_t{at[2]} * size[1] + at[1]) * size[0] + at[0]]] == label;
        };
        std::array<std::uint32_t, 3> at{};
        for (at[2] = 0; at[2] < size[2]; ++at[2]) {
            for (at[1] = 0; at[1] < size[1]; ++at[1]) {
                for (at[0] = 0; at[0] < size[0]; ++at[0]) {
                    for (std::size_t axis = 0; has(at) && axis < 3; ++axis) {
                        lo[axis] = std::min(lo[axis], at[axis]);
                        hi[axis] = std::max(hi[axis], at[axis]);
                    }
                }
            }
        }
        Grid grid = all.grid;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis] -= lo[axis] > 0 ? 1 : 0;
            hi[axis] = std::min(hi[axis] + 1, size[axis] - 1);
            grid.size[axis] = hi[axis] - lo[axis] + 1;
        }
        grid.origin = transformPoint(worldFromIndex(all.grid), {static_cast<double>(lo[0]), static_cast<double>(lo[1]),
                                                                static_cast<double>(lo[2])});
        volume = makeBytes(grid, [&](auto x, auto y, auto z) {
            return has({lo[0] + x, lo[1] + y, lo[2] + z}) ? 1 : 0;
        });
        labels = makeLabels(volume.view()).value();
    }

    /// Of a needle on its whole way, whose axis is a triangle without area.
    [[nodiscard]] oracle::OracleClearance distance(const dvec3& from, const dvec3& to, double resolution) const {
        MeshData axis;
        for (const dvec3& at : {from, to, (from + to) / 2.0}) {
            for (int i = 0; i < 3; ++i) {
                axis.positions.push_back(static_cast<float>(at[i]));
            }
        }
        axis.indices = {0, 1, 2};
        const std::vector<ControlPoint> all{{0, 1}, {1, 1}};
        oracle::OraclePair pair;
        pair.mesh = axis.view();
        pair.volume = volume.view();
        pair.transferFunction = {all, {0, 1}};
        oracle::OracleClearance found = oracle::labelClearanceOracle(pair, labels, 1, resolution).value();
        found.lo -= kNeedleRadius;
        found.hi -= kNeedleRadius;
        return found;
    }

    /// No point of a segment is nearer to the label than this: of a ball around all of the grid.
    [[nodiscard]] double leastDistance(const dvec3& from, const dvec3& to) const {
        const Mat4 world = worldFromTexture(volume.grid);
        const dvec3 middle = toGlm(transformPoint(world, {0.5, 0.5, 0.5}));
        const double part = std::clamp(glm::dot(middle - from, to - from) / glm::dot(to - from, to - from), 0.0, 1.0);
        return glm::distance(middle, from + part * (to - from)) -
               glm::distance(middle, toGlm(transformPoint(world, {0, 0, 0})));
    }

    VolumeData volume;
    LabelData labels;
};

TEST(PlanHead, TheOracleConfirmsSafePaths) {
    const std::filesystem::path atlas = std::filesystem::path(headPath()).parent_path() / "aal.nii.gz";
    if (!std::filesystem::exists(headPath()) || !std::filesystem::exists(atlas)) {
        GTEST_SKIP() << "no head and atlas: install mricron-data";
    }
    const VolumeData head = io::readVolume(headPath()).value();
    const LabelData labels = makeLabels(io::readVolume(atlas).value().view()).value();
    const cpu::Volume volume = cpu::Volume::create(head.view()).value();
    const std::vector<ControlPoint> opacity{{40, 0}, {80, 1}};
    const cpu::TransferFunction skin = cpu::TransferFunction::create({opacity, {0, 255}}).value();
    // Left insula, hippocampus, caudate and putamen; the target is in the left thalamus.
    const cpu::PlanObstacle obstacle{&volume, nullptr, 0, &labels, {29, 37, 71, 73}};
    cpu::Plan task;
    task.target = {12, 18, 8};
    task.surface = {.entries = 10000, .volume = &volume, .transferFunction = &skin};
    task.obstacles = std::span(&obstacle, 1);
    task.needle = {2 * kNeedleRadius, kLength};
    task.margin = kMargin;
    cpu::Planner planner = cpu::Planner::create().value();
    const PlanAnswer answer = planner.plan(task).value();
    std::vector<const PlannedPath*> safe;
    for (const PlannedPath& path : answer.paths) {
        if (path.safety == Safety::Safe) {
            safe.push_back(&path);
        }
    }
    ASSERT_GT(safe.size(), 3000U);
    std::mt19937_64 random(testSeed());
    std::shuffle(safe.begin(), safe.end(), random);
    safe.resize(randomCases(1000, 40));
    std::vector<LabelCrop> crops;
    for (const std::int32_t label : obstacle.avoid) {
        crops.emplace_back(labels, label);
    }
    const dvec3 target = toGlm(task.target);
    constexpr double kFloats = 1e-4; // mm: the oracle's line is of floats
    std::size_t confirmed = 0;
    double farthest = 0; // of the oracle's bounds beyond the planner's, mm
    for (const PlannedPath* path : safe) {
        const dvec3 direction = (toGlm(path->position) - target) / path->length;
        const dvec3 from = target + kNeedleRadius * direction;
        const dvec3 to = target + (path->length + kLength - kNeedleRadius) * direction;
        double lo = 1e9;
        double hi = 1e9;
        for (const LabelCrop& crop : crops) {
            if (crop.leastDistance(from, to) > kNeedleRadius + 2 * kDefaultPlanMaximum) {
                continue; // the oracle would need as long to say that
            }
            oracle::OracleClearance found = crop.distance(from, to, 1.0 / 4);
            if (found.lo <= kMargin) {
                found = crop.distance(from, to, 1.0 / 64);
            }
            lo = std::min(lo, found.lo);
            hi = std::min(hi, found.hi);
        }
        confirmed += lo + kFloats > kMargin ? 1 : 0;
        farthest = std::max({farthest, path->clearance.lower - hi, lo - path->clearance.upper});
        EXPECT_GT(hi + kFloats, kMargin) << "entry " << path->entry << " is not safe: " << lo << " to " << hi << " mm";
        EXPECT_GE(hi + kFloats, path->clearance.lower) << "entry " << path->entry;
        EXPECT_LE(lo - kFloats, path->clearance.upper) << "entry " << path->entry;
    }
    std::cout << "the oracle confirms " << confirmed << " of " << safe.size()
              << " safe paths; its bounds are apart from the planner's by " << std::max(farthest, 0.0)
              << " mm at most\n";
    // Of the others it says less than that they are not safe: the margin is within its resolution.
    EXPECT_GE(confirmed, safe.size() - safe.size() / 100);
}

} // namespace
} // namespace voxtact::test
