// SPDX-License-Identifier: MIT
// A look at a run of triangles and a cell, against what is decided of each triangle by itself; the boxes before it and
// the set of cells after it.
#include "host/touch/cells/point_hull.h"

#include "core/method/certified_constants.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/look_scene.h"
#include "cpu/scenes/random_scene.h"
#include "host/touch/cells/box_cells.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

namespace voxtact::test {
namespace {

using cpu::CellBox;
using cpu::CellSet;
using cpu::RunPoints;
using shader::CertifiedVertex;
using shader::VoxelPoint;

/// A patch near the cell (20, 20, 20), flat or not, of triangles of some size.
std::vector<std::array<CertifiedVertex, 3>> drawnRun(std::mt19937_64& random) {
    const float error = drawn(random, 0, 1e-4);
    const double size = std::pow(10, uniform(random, -2, 0.5));
    const double thickness = size * std::pow(10, uniform(random, -3, 0));
    const std::array<double, 3> thin{chance(random, 0.5) ? thickness : size, size, size};
    const std::array<double, 3> from{uniform(random, 19.5, 21.5), uniform(random, 19.5, 21.5),
                                     uniform(random, 19.5, 21.5)};
    std::vector<std::array<CertifiedVertex, 3>> run(1 + below(random, kRunTriangles));
    for (auto& triangle : run) {
        for (CertifiedVertex& vertex : triangle) {
            const double along = uniform(random, -size, size);
            vertex = {{static_cast<float>(from[0] + uniform(random, -thin[0], thin[0]) + along),
                       static_cast<float>(from[1] + uniform(random, -thin[1], thin[1]) - along),
                       static_cast<float>(from[2] + uniform(random, -thin[2], thin[2]))},
                      error};
        }
    }
    return run;
}

TEST(PointHullTest, LeavesOutOnlyWhatIsNoneForEachTriangle) {
    std::mt19937_64 random(testSeed());
    std::size_t without = 0;   // an opaque point, by each triangle
    std::size_t leftOut = 0;   // of these
    std::size_t byItself = 0;  // triangles in cells without, and those of them that a look at themselves leaves out
    std::size_t leftAlone = 0; // see byItself
    for (std::size_t round = 0; round < randomCases(100000, 10) && !HasFailure(); ++round) {
        const LookScene scene(random);
        const shader::CertifiedCorners corners = scene.corners(random);
        const auto run = drawnRun(random);
        RunPoints points;
        for (const auto& triangle : run) {
            for (const CertifiedVertex& vertex : triangle) {
                points.add(vertex, 0);
            }
        }
        const shader::CertifiedBounds bounds = points.bounds(scene.item());
        ASSERT_TRUE(bounds.usable);
        const int x = 20 + static_cast<int>(below(random, 2));
        const shader::CertifiedCell cell = shader::certifiedCell(scene.item(), corners, x, 20, 20, bounds.delta);
        if (!shader::certifiedCellMayBeOpaque(scene.opaque(), cell)) {
            continue;
        }
        const shader::OpaqueValues opaque = scene.opaque();
        const bool may = cpu::hullMayMeet(opaque, points.hull(bounds.delta), cell, x, 20, 20);
        bool none = true;
        for (const auto& triangle : run) {
            const bool isNone = scene.verdict(corners, triangle, {x, 20, 20}) == CERTIFIED_NONE;
            const cpu::TriangleHull hull(triangle[0].point, triangle[1].point, triangle[2].point, bounds.delta);
            const bool mayAlone = cpu::hullMayMeetLinearly(opaque, hull.hull(), cell, x, 20, 20);
            EXPECT_TRUE(isNone || (may && mayAlone)) << "round " << round;
            none = none && isNone;
            byItself += isNone ? 1 : 0;
            leftAlone += isNone && !mayAlone ? 1 : 0;
        }
        without += none ? 1 : 0;
        leftOut += none && !may ? 1 : 0;
    }
    std::cout << leftOut << " of " << without << " runs without an opaque point are left out, and " << leftAlone
              << " of " << byItself << " triangles\n";
    EXPECT_GT(leftOut, without / 20);
    EXPECT_GT(leftAlone, byItself / 40);
}

/// A value that is not a number is nothing that a look may pass over.
TEST(PointHullTest, LeavesWhatIsNotANumber) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 1000; ++round) {
        const LookScene scene(random);
        shader::CertifiedCorners corners = scene.corners(random);
        (round % 2 == 0 ? corners.s101 : corners.s000) = std::numeric_limits<float>::quiet_NaN();
        const auto run = drawnRun(random);
        const cpu::TriangleHull hull(run[0][0].point, run[0][1].point, run[0][2].point, 1e-4F);
        const shader::CertifiedCell cell = shader::certifiedCell(scene.item(), corners, 20, 20, 20, 1e-4F);
        const shader::OpaqueValues opaque = scene.opaque();
        EXPECT_TRUE(cpu::hullMayMeetLinearly(opaque, hull.hull(), cell, 20, 20, 20)) << "round " << round;
    }
}

TEST(PointHullTest, ARunsBoundsHoldThoseOfItsTriangles) {
    std::mt19937_64 random(testSeed());
    const LookScene scene(random);
    for (int round = 0; round < 10000; ++round) {
        const auto run = drawnRun(random);
        RunPoints points;
        for (const auto& triangle : run) {
            for (const CertifiedVertex& vertex : triangle) {
                points.add(vertex, 0);
            }
        }
        const shader::CertifiedBounds all = points.bounds(scene.item());
        for (const auto& [a, b, c] : run) {
            const shader::CertifiedBounds one = shader::certifiedBounds(scene.item(), a, b, c);
            ASSERT_LE(one.delta, all.delta);
            ASSERT_TRUE(one.firstX >= all.firstX && one.firstY >= all.firstY && one.firstZ >= all.firstZ);
            ASSERT_TRUE(one.lastX <= all.lastX && one.lastY <= all.lastY && one.lastZ <= all.lastZ);
        }
    }
    RunPoints lost;
    lost.add({{1, 1, 1}, std::numeric_limits<float>::quiet_NaN()}, 0);
    lost.add({{1, 1, 1}, 0}, 0);
    EXPECT_FALSE(lost.bounds(scene.item()).usable);
}

TEST(BoxCellsTest, HasTheCellsThatABoxByItselfHas) {
    std::mt19937_64 random(testSeed());
    std::size_t usable = 0;
    for (int round = 0; round < 2000; ++round) {
        const double scale = std::pow(10, uniform(random, -1, 4));
        std::vector<RunBox> runs(1 + below(random, 200));
        for (RunBox& run : runs) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                run.lo[axis] = drawn(random, -scale, scale);
                run.hi[axis] = run.lo[axis] + drawn(random, 0, chance(random, 0.1) ? scale : scale / 50);
            }
        }
        const cpu::ClusterTree tree(runs);
        const Grid grid = unitGrid(64);
        const shader::CertifiedItem item = certifiedItem(grid, OpaqueNumbers{}, 1e-3);
        const shader::CertifiedPair pair =
            certifiedPair(pairGrid(grid, take(textureFromWorld(grid))), randomMotion(random));
        const cpu::BoxCells look(item, pair, tree);
        if (!look.usable()) {
            continue;
        }
        ++usable;
        for (std::uint32_t level = 0; level < tree.levels(); ++level) {
            for (const RunBox& box : tree.boxes(level)) {
                const shader::CertifiedBounds own = shader::certifiedBoxBounds(
                    item, pair, {box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]});
                ASSERT_LE(own.delta, look.delta());
                if (own.lastX < own.firstX || own.lastY < own.firstY || own.lastZ < own.firstZ) {
                    continue;
                }
                const CellBox cells = look.cells(box);
                ASSERT_TRUE(cells.lo[0] <= own.firstX && cells.lo[1] <= own.firstY && cells.lo[2] <= own.firstZ);
                ASSERT_TRUE(cells.hi[0] >= own.lastX && cells.hi[1] >= own.lastY && cells.hi[2] >= own.lastZ);
            }
        }
    }
    EXPECT_GT(usable, 500U);
}

TEST(CellSetTest, HasTheCellsThatWereAdded) {
    std::mt19937_64 random(testSeed());
    const auto always = [] { return true; };
    for (int round = 0; round < 2000; ++round) {
        CellBox box;
        CellBox part;
        std::int32_t count = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto side = static_cast<std::int32_t>(1 + below(random, 6));
            box.lo[axis] = static_cast<std::int32_t>(below(random, 100)) - 1;
            box.hi[axis] = box.lo[axis] + side - 1;
            part.lo[axis] = box.lo[axis] + static_cast<std::int32_t>(below(random, static_cast<std::size_t>(side)));
            part.hi[axis] =
                part.lo[axis] +
                static_cast<std::int32_t>(below(random, static_cast<std::size_t>(box.hi[axis] - part.lo[axis] + 1)));
            count *= side;
        }
        CellSet set;
        ASSERT_EQ(set.begin(box), count <= CellSet::kMost);
        if (count > CellSet::kMost) {
            continue;
        }
        std::vector<std::array<std::int32_t, 3>> in; // in order
        std::vector<std::size_t> numbers;
        std::vector<std::size_t> places;
        std::size_t number = 0;
        for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
            for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
                for (std::int32_t x = box.lo[0]; x <= box.hi[0]; ++x) {
                    if (chance(random, 0.4)) {
                        places.push_back(set.add(x, y, z));
                        const bool inside = x >= part.lo[0] && x <= part.hi[0] && y >= part.lo[1] && y <= part.hi[1] &&
                                            z >= part.lo[2] && z <= part.hi[2];
                        if (inside) {
                            in.push_back({x, y, z});
                            numbers.push_back(number);
                        }
                        ++number;
                    }
                }
            }
        }
        EXPECT_EQ(set.empty(), places.empty());
        std::size_t next = 0;
        set.forPlaces([&](std::size_t place) { EXPECT_EQ(place, places.at(next++)); });
        EXPECT_EQ(next, places.size());
        next = 0;
        set.forEach(part, always, [&](std::int32_t x, std::int32_t y, std::int32_t z, std::size_t at) {
            EXPECT_EQ((std::array{x, y, z}), in.at(next));
            EXPECT_EQ(at, numbers.at(next++));
        });
        EXPECT_EQ(next, in.size());
    }
}

} // namespace
} // namespace voxtact::test
