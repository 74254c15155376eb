// SPDX-License-Identifier: MIT
// What the device drops at once with a margin, for several triangles or for a box of several cells: nothing that is
// within it, and nothing that it would not drop one by one.
#include "certified_margin_look.h"
#include "core/method/certified_constants.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>

namespace voxtact::test {
namespace {

using shader::VoxelPoint;

VoxelPoint placeNear(std::mt19937_64& random, double reach, VoxelPoint about = {}) {
    const auto coordinate = [&](float from) { return static_cast<float>(from + uniform(random, -reach, reach)); };
    return {coordinate(about.x), coordinate(about.y), coordinate(about.z)};
}

Vec3 worldOf(const Grid& grid, VoxelPoint at) {
    return transformPoint(worldFromIndex(grid), {at.x, at.y, at.z});
}

double distanceOf(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Some triangles near each other, and a box of cells.
struct Near {
    std::vector<std::array<VoxelPoint, 3>> corners;
    std::vector<shader::CertifiedTriangle> triangles;
    shader::CertifiedReach reach{};
    VoxelPoint middle, radius;

    explicit Near(std::mt19937_64& random) {
        const std::size_t count = 1 + random() % 4;
        for (std::size_t i = 0; i < count; ++i) {
            const VoxelPoint about = placeNear(random, 2);
            const double side = random() % 3 == 0 ? 0 : 2;
            corners.push_back(
                {placeNear(random, side, about), placeNear(random, side, about), placeNear(random, side, about)});
            const auto vertex = [&](std::size_t corner) {
                return shader::CertifiedVertex{corners.back()[corner], i == 1 ? 1e-3F : 1e-5F};
            };
            const shader::CertifiedReach own = shader::certifiedReach(vertex(0), vertex(1), vertex(2));
            reach = i == 0 ? own : shader::marginUnion(reach, own);
            triangles.push_back(
                shader::certifiedTriangle(corners.back()[0], corners.back()[1], corners.back()[2], own.delta));
        }
        middle = placeNear(random, 14);
        radius = {static_cast<float>(uniform(random, 0.5, 4)), static_cast<float>(uniform(random, 0.5, 4)),
                  static_cast<float>(uniform(random, 0.5, 4))};
    }
    /// mm from the box of all triangles to the box, where the grid's axes are at right angles.
    [[nodiscard]] double apart(const Grid& grid) const {
        const auto along = [&](float lo, float hi, float at, float half) {
            return std::max({0.0, double{at} - half - hi, double{lo} - at - half});
        };
        const Vec3 gap{along(reach.lo.x, reach.hi.x, middle.x, radius.x) * grid.spacing[0],
                       along(reach.lo.y, reach.hi.y, middle.y, radius.y) * grid.spacing[1],
                       along(reach.lo.z, reach.hi.z, middle.z, radius.z) * grid.spacing[2]};
        return std::hypot(gap[0], gap[1], gap[2]);
    }
    /// A place in the box: what is nearest to a triangle's first corner along each axis, a corner, or any.
    [[nodiscard]] VoxelPoint inBox(std::mt19937_64& random, std::size_t triangle) const {
        if (random() % 3 == 0) {
            const VoxelPoint to = corners[triangle][0];
            return {std::clamp(to.x, middle.x - radius.x, middle.x + radius.x),
                    std::clamp(to.y, middle.y - radius.y, middle.y + radius.y),
                    std::clamp(to.z, middle.z - radius.z, middle.z + radius.z)};
        }
        const bool corner = random() % 2 == 0;
        const auto along = [&](float at, float half) {
            const double side = uniform(random, -1, 1);
            return static_cast<float>(at + half * (corner ? std::copysign(1.0, side) : side));
        };
        return {along(middle.x, radius.x), along(middle.y, radius.y), along(middle.z, radius.z)};
    }
    [[nodiscard]] VoxelPoint inTriangle(std::mt19937_64& random, std::size_t triangle) const {
        const std::array<VoxelPoint, 3>& at = corners[triangle];
        const float b = static_cast<float>(uniform(random, 0, 1));
        const float c = static_cast<float>(uniform(random, 0, 1)) * (1 - b);
        return shader::voxelStep(shader::voxelStep(at[0], shader::voxelDifference(at[1], at[0]), b),
                                 shader::voxelDifference(at[2], at[0]), c);
    }
};

/// The least box that a cell is halved into.
VoxelPoint leastRadius(const shader::MarginSpace& by) {
    return {0.5F * MARGIN_LEAST_SIDE / std::abs(by.xx), 0.5F * MARGIN_LEAST_SIDE / (std::abs(by.xy) + std::abs(by.yy)),
            0.5F * MARGIN_LEAST_SIDE / (std::abs(by.xz) + std::abs(by.yz) + std::abs(by.zz))};
}

TEST(MarginText, WhatIsDroppedAtOnceIsDroppedOneByOne) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t together = 0;
    std::size_t alone = 0;
    constexpr int kRounds = 6000;
    for (int round = 0; round < kRounds && !HasFailure(); ++round) {
        SCOPED_TRACE("round " + std::to_string(round) + " of seed " + std::to_string(seed));
        const bool sheared = round % 2 == 0;
        const Grid grid = obliqueGrid(random, sheared);
        const Near near(random);
        const double apart = near.apart(grid);
        const double longest = std::max({grid.spacing[0], grid.spacing[1], grid.spacing[2]});
        const double margin = std::max(0.01, (round % 3 == 0 ? uniform(random, 0.3, 1.1) : 1) * apart -
                                                 uniform(random, 0, 0.1 * longest));
        const shader::CertifiedItem item =
            withMargin(certifiedItem(grid, 1, 0, {0, 256}, 256, 0.5, kDefaultResolution), grid, margin);
        const shader::MarginSpace by = shader::marginOf(item);
        const bool all = shader::marginReachFarther(by, near.reach, near.middle, near.radius);
        together += all ? 1U : 0U;
        if (!sheared && apart > margin + 0.05 * longest) {
            EXPECT_TRUE(all);
        }
        for (std::size_t i = 0; i < near.triangles.size(); ++i) {
            const bool one = shader::marginBoxFarther(by, near.triangles[i], near.middle, near.radius);
            alone += one ? 1U : 0U;
            for (int sample = 0; sample < 8 && (all || one); ++sample) {
                const VoxelPoint at = near.inBox(random, i);
                EXPECT_GT(distanceOf(worldOf(grid, at), worldOf(grid, near.inTriangle(random, i))), margin);
                const shader::MarginTriangle about = shader::marginTriangle(by, near.triangles[i], at, 1);
                EXPECT_TRUE(
                    shader::marginBoxBeyond(by, about, shader::marginNear(by, about, {0, 0, 0}), leastRadius(by)));
            }
        }
    }
    std::cout << "  " << kRounds << " rounds: " << together << " boxes dropped at once, " << alone
              << " times for a triangle\n";
    EXPECT_GT(together, kRounds / 20U);
    EXPECT_LT(together, kRounds * 9U / 10U);
    EXPECT_GT(alone, together);
}

} // namespace
} // namespace voxtact::test
