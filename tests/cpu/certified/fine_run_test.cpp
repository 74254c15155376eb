// SPDX-License-Identifier: MIT
// What is said of small triangles together, against what is said of each by itself.
#include "host/touch/cells/fine_run.h"

#include "cpu/scenes/random_scene.h"
#include "exact/certified_overlap.h"
#include "support/scenes.h"

#include <hwy/targets.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

namespace voxtact::test {
namespace {

using cpu::CellBlock;
using cpu::FineRun;
using shader::CertifiedVertex;
using shader::VoxelPoint;

using Vertices = std::array<CertifiedVertex, 3>;

shader::CertifiedItem itemOf(std::mt19937_64& random) {
    shader::CertifiedItem item{};
    const auto size = [&] { return 1 + static_cast<int>(below(random, 30)); };
    item.sizeX = size();
    item.sizeY = size();
    item.sizeZ = size();
    return item;
}

/// In and around the domain, on the planes of voxels and between them, and some that are no numbers.
Vertices drawnVertices(std::mt19937_64& random, const shader::CertifiedItem& item) {
    const double size = std::pow(10, uniform(random, -2, 0.5));
    const float error = chance(random, 0.9) ? drawn(random, 0, 1e-4) : drawn(random, 0, 1e-3);
    Vertices vertices{};
    const VoxelPoint middle{drawn(random, -1.5, item.sizeX + 1), drawn(random, -1.5, item.sizeY + 1),
                            drawn(random, -1.5, item.sizeZ + 1)};
    const bool onPlane = chance(random, 0.2);
    for (CertifiedVertex& vertex : vertices) {
        vertex = {{middle.x + drawn(random, -size, size), middle.y + drawn(random, -size, size),
                   middle.z + drawn(random, -size, size)},
                  chance(random, 0.5) ? error : drawn(random, 0, error)};
        if (onPlane) {
            vertex.point.y = 0.5F * std::round(2 * middle.y);
        }
    }
    if (chance(random, 0.02)) {
        const std::array<float, 3> none{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                                        -1e30F};
        CertifiedVertex& vertex = vertices[below(random, 3)];
        (chance(random, 0.5) ? vertex.error : vertex.point.z) = std::abs(none[below(random, 3)]);
    }
    return vertices;
}

/// A run of them.
struct SmallRun {
    shader::CertifiedItem item;
    std::vector<Vertices> triangles;
};

SmallRun drawnSmallRun(std::mt19937_64& random) {
    SmallRun run{itemOf(random), {}};
    const std::size_t count = 1 + below(random, FineRun::kMost);
    for (std::size_t i = 0; i < count; ++i) {
        run.triangles.push_back(drawnVertices(random, run.item));
    }
    return run;
}

std::array<std::int32_t, 3> bricksOf(const shader::CertifiedItem& item) {
    const auto count = [](int size) { return (size >> kBrickShift) + 1; };
    return {count(item.sizeX), count(item.sizeY), count(item.sizeZ)};
}

void look(const SmallRun& run, FineRun& small) {
    for (const Vertices& of : run.triangles) {
        small.add(of[0], of[1], of[2]);
    }
    small.test(run.item, bricksOf(run.item));
}

bool isIn(const VoxelPoint& point, const std::array<std::int32_t, 3>& cell) {
    const VoxelPoint at = shader::voxelDifference(
        point, {static_cast<float>(cell[0]), static_cast<float>(cell[1]), static_cast<float>(cell[2])});
    return at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1 && at.z >= 0 && at.z <= 1;
}

void expectPlace(const CellBlock& block, const std::array<std::int32_t, 3>& bricks) {
    std::array<std::int32_t, 3> brick{};
    std::array<std::int32_t, 3> within{};
    bool oneBrick = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        brick[axis] = (block.first[axis] + 1) / cpu::kBrickSide;
        within[axis] = (block.first[axis] + 1) % cpu::kBrickSide;
        const bool two = (block.cells >> (1U << axis) & 1U) != 0;
        oneBrick = oneBrick && !(two && within[axis] == cpu::kBrickSide - 1);
    }
    EXPECT_EQ(block.brick, static_cast<std::uint32_t>((brick[2] * bricks[1] + brick[1]) * bricks[0] + brick[0]));
    EXPECT_EQ(block.row, static_cast<std::uint32_t>(within[1] + cpu::kBrickSide * within[2]));
    EXPECT_EQ(block.column, static_cast<std::uint32_t>(within[0]));
    EXPECT_EQ(block.oneBrick, oneBrick);
}

/// Of one triangle; returns whether it is small and meets the volume.
bool expectBlock(const SmallRun& run, const FineRun& small, std::size_t i) {
    const auto& [a, b, c] = run.triangles[i];
    const shader::CertifiedBounds bounds = shader::certifiedBounds(run.item, a, b, c);
    const std::array<int, 3> more{bounds.lastX - bounds.firstX, bounds.lastY - bounds.firstY,
                                  bounds.lastZ - bounds.firstZ};
    const bool none = *std::ranges::min_element(more) < 0;
    const bool few = none || *std::ranges::max_element(more) <= 1;
    const bool certain = bounds.delta <= CERTIFIED_OVERLAP_DELTA;
    const bool finite = std::abs(a.point.z) + std::abs(b.point.z) + std::abs(c.point.z) < 1e9F;
    EXPECT_EQ(small.isSmall(i), few && certain && finite);
    if (!small.isSmall(i)) {
        return false;
    }
    const FineRun::Small found = small[i];
    EXPECT_EQ(found.delta, bounds.delta);
    if (none) {
        EXPECT_EQ(found.block.cells, 0U);
        return false;
    }
    EXPECT_EQ(found.block.first, (std::array{bounds.firstX, bounds.firstY, bounds.firstZ}));
    expectPlace(found.block, bricksOf(run.item));
    unsigned cells = 0;
    std::array<unsigned, 3> corners{};
    for (unsigned number = 0; number < CellBlock::kMost; ++number) {
        const std::array<std::int32_t, 3> cell = found.block.at(number);
        const bool inside = cell[0] <= bounds.lastX && cell[1] <= bounds.lastY && cell[2] <= bounds.lastZ;
        cells |= (inside ? 1U : 0U) << number;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const bool isHere = inside && isIn(run.triangles[i][corner].point, cell);
            corners[corner] |= (isHere ? 1U : 0U) << number;
            EXPECT_TRUE(isHere || (found.corner[corner] >> number & 1U) == 0);
        }
    }
    EXPECT_EQ(found.block.cells, cells);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(found.corner[corner] == 0, corners[corner] == 0);
    }
    return true;
}

TEST(FineRunTest, HaveTheCellsOfEachAlone) {
    std::mt19937_64 random(testSeed());
    FineRun small;
    std::size_t found = 0;
    for (std::size_t round = 0; round < randomCases(100000, 10) && !HasFailure(); ++round) {
        const SmallRun run = drawnSmallRun(random);
        look(run, small);
        for (std::size_t i = 0; i < run.triangles.size(); ++i) {
            SCOPED_TRACE("round " + std::to_string(round) + ", triangle " + std::to_string(i));
            found += expectBlock(run, small, i) ? 1 : 0;
        }
    }
    std::cout << found << " small triangles\n";
    EXPECT_GT(found, 10000U);
}

TEST(FineRunTest, PassThroughTheCellsOfEachAlone) {
    std::mt19937_64 random(testSeed());
    FineRun small;
    std::array<std::size_t, 3> verdicts{};
    for (std::size_t round = 0; round < randomCases(100000, 10) && !HasFailure(); ++round) {
        const SmallRun run = drawnSmallRun(random);
        look(run, small);
        for (std::size_t i = 0; i < run.triangles.size(); ++i) {
            if (small.isSmall(i)) {
                small.ask(i, small[i].block.cells);
            }
        }
        small.answer();
        for (std::size_t i = 0; i < run.triangles.size(); ++i) {
            if (!small.isSmall(i)) {
                continue;
            }
            const auto& [a, b, c] = run.triangles[i];
            const shader::CertifiedTriangle triangle =
                shader::certifiedTriangle(a.point, b.point, c.point, small[i].delta);
            const FineRun::Overlap overlap = small.overlap(i);
            EXPECT_EQ((overlap.some | overlap.none) & ~small[i].block.cells, 0U);
            for (unsigned number = 0; number < CellBlock::kMost; ++number) {
                const auto [x, y, z] = small[i].block.at(number);
                if ((small[i].block.cells >> number & 1U) == 0 || isIn(a.point, {x, y, z}) ||
                    isIn(b.point, {x, y, z}) || isIn(c.point, {x, y, z})) {
                    continue;
                }
                const int verdict = shader::certifiedOverlap(triangle, x, y, z);
                EXPECT_EQ((overlap.some >> number & 1U) != 0, verdict == CERTIFIED_CERTAIN) << "round " << round;
                EXPECT_EQ((overlap.none >> number & 1U) != 0, verdict == CERTIFIED_NONE) << "round " << round;
                ++verdicts[static_cast<std::size_t>(verdict)];
            }
        }
    }
    std::cout << verdicts[CERTIFIED_CERTAIN] << " pass, " << verdicts[CERTIFIED_NONE] << " do not, "
              << verdicts[CERTIFIED_UNDECIDED] << " are unclear\n";
    EXPECT_GT(verdicts[CERTIFIED_CERTAIN], 1000U);
    EXPECT_GT(verdicts[CERTIFIED_NONE], 1000U);
}

/// All that is said of a run, as numbers.
std::vector<float> saidOf(const SmallRun& run) {
    FineRun small;
    look(run, small);
    std::vector<float> said;
    for (std::size_t i = 0; i < run.triangles.size(); ++i) {
        said.push_back(small.isSmall(i) ? 1.0F : 0.0F);
        if (small.isSmall(i)) {
            const FineRun::Small of = small[i];
            small.ask(i, of.block.cells);
            for (const unsigned bits :
                 {of.block.cells, of.corner[0], of.corner[1], of.corner[2], of.block.cells == 0 ? 0 : of.block.brick}) {
                said.push_back(static_cast<float>(bits));
            }
        }
    }
    small.answer();
    for (std::size_t i = 0; i < run.triangles.size(); ++i) {
        if (small.isSmall(i)) {
            said.push_back(static_cast<float>(small.overlap(i).some));
            said.push_back(static_cast<float>(small.overlap(i).none));
        }
    }
    return said;
}

TEST(FineRunTest, AreTheSameByEveryInstructionSet) {
    std::mt19937_64 random(testSeed());
    std::vector<SmallRun> runs;
    for (int i = 0; i < 200; ++i) {
        runs.push_back(drawnSmallRun(random));
    }
    std::vector<std::vector<float>> said;
    std::ranges::transform(runs, std::back_inserter(said), saidOf);
    for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
        hwy::SetSupportedTargetsForTest(rest & -rest);
        for (std::size_t i = 0; i < runs.size(); ++i) {
            EXPECT_EQ(saidOf(runs[i]), said[i]) << hwy::TargetName(rest & -rest) << ", run " << i;
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(FineRunTest, BitsAreCounted) {
    for (unsigned bits = 0; bits < 256; ++bits) {
        EXPECT_EQ(cpu::bitsIn(bits), static_cast<unsigned>(std::popcount(bits)));
    }
}

} // namespace
} // namespace voxtact::test
