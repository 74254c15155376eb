// SPDX-License-Identifier: MIT
// The bits of a brick's cells.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/scene/stored_voxels.h"
#include "host/touch/cells/cell_block.h"
#include "host/touch/cells/certified_bricks.h"
#include "host/touch/cells/certified_occupancy.h"
#include "host/touch/cells/triangle_cells.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace voxtact::test {
namespace {

using cpu::BrickCells;
using cpu::CellBox;
using cpu::kBrickSide;

/// Most bricks have few cells: a box misses them, or holds one in a single one of its rows.
BrickCells randomCells(std::mt19937_64& random) {
    BrickCells cells;
    for (std::size_t cell = below(random, 6); cell > 0; --cell) {
        cells.mayBeOpaque[below(random, cells.mayBeOpaque.size())] |=
            static_cast<std::uint8_t>(1U << below(random, kBrickSide));
    }
    return cells;
}

CellBox randomBox(std::mt19937_64& random) {
    CellBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto one = static_cast<std::int32_t>(below(random, kBrickSide));
        const auto other = static_cast<std::int32_t>(below(random, kBrickSide));
        box.lo[axis] = std::min(one, other);
        box.hi[axis] = std::max(one, other);
    }
    return box;
}

bool has(const BrickCells& cells, std::int32_t x, std::int32_t y, std::int32_t z) {
    return (cells.mayBeOpaque[static_cast<std::size_t>(y + kBrickSide * z)] >> static_cast<unsigned>(x) & 1U) != 0;
}

TEST(BrickCellsTest, ABoxHasSomeWhereOneOfItsCellsIs) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 20000; ++round) {
        const BrickCells cells = randomCells(random);
        const CellBox box = randomBox(random);
        bool expected = false;
        for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
            for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
                unsigned row = 0;
                for (std::int32_t x = box.lo[0]; x <= box.hi[0]; ++x) {
                    row |= has(cells, x, y, z) ? 1U << static_cast<unsigned>(x) : 0U;
                }
                ASSERT_EQ(cells.row(box, y, z), row);
                expected = expected || row != 0;
            }
        }
        ASSERT_EQ(cells.any(box), expected);
    }
}

TEST(BrickCellsTest, RangesOfCellsMeetAndAreWithin) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 100; ++round) {
        auto ranges = std::make_unique<cpu::CornerRanges>();
        const auto place = [&] { return static_cast<float>(below(random, 9)); };
        for (std::size_t z = 0; z < cpu::CornerRanges::kCorners; ++z) {
            for (std::size_t y = 0; y < cpu::CornerRanges::kCorners; ++y) {
                for (std::size_t x = 0; x < cpu::CornerRanges::kCorners; ++x) {
                    ranges->lo[z][y][x] = place();
                    ranges->hi[z][y][x] = ranges->lo[z][y][x] + place();
                }
            }
        }
        const float error = 0.5F * place();
        const float first = place();
        const float last = first + place();
        const cpu::CellBits meet = cpu::cellsThatMeet(*ranges, error, first, last);
        const cpu::CellBits within = cpu::cellsWithin(*ranges, error, first, last);
        for (std::size_t cell = 0; cell < 512; ++cell) {
            const float lo = ranges->lo[cell / 64][cell / 8 % 8][cell % 8] - error;
            const float hi = ranges->hi[cell / 64][cell / 8 % 8][cell % 8] + error;
            ASSERT_EQ((meet[cell / 8] >> cell % 8 & 1U) != 0, hi >= first && lo <= last);
            ASSERT_EQ((within[cell / 8] >> cell % 8 & 1U) != 0, lo >= first && hi <= last);
        }
    }
}

/// A volume of few values, so that whole cells have one, under a table whose entries are at the threshold or next to
/// it.
struct FlatScene {
    explicit FlatScene(std::mt19937_64& random) {
        Grid grid;
        for (std::uint32_t& size : grid.size) {
            size = 1 + static_cast<std::uint32_t>(below(random, 20));
        }
        const double flat = uniform(random, 0, 255);
        data = makeVolume<float>(grid, ScalarType::Float32, [&](auto...) {
            return chance(random, 0.05) ? uniform(random, 0, 255) : flat + (chance(random, 0.3) ? 1e-4 : 0);
        });
        const double threshold = 0.5;
        std::vector<ControlPoint> points;
        for (int value = 0; value < 256; value += 5) {
            const double near = threshold + (static_cast<double>(below(random, 3)) - 1) * 6e-8;
            points.push_back({static_cast<double>(value), chance(random, 0.2) ? 0 : chance(random, 0.5) ? near : 1});
        }
        volume.emplace(take(cpu::Volume::create(data.view())));
        function.emplace(take(cpu::TransferFunction::create({points, {0, 255}, 52})));
        occupancy.emplace(volume->impl(), function->impl(), threshold, 1.0 / 64);
    }

    VolumeData data;
    std::optional<cpu::Volume> volume;
    std::optional<cpu::TransferFunction> function;
    std::optional<cpu::CertifiedOccupancy> occupancy;
};

/// Of a cell that is in the domain.
shader::CertifiedCell cellAt(const FlatScene& scene, const std::array<std::int32_t, 3>& cell, float delta) {
    const cpu::VolumeImpl& volume = scene.volume->impl();
    std::array<float, 8> values{};
    volume.image.visit([&](const auto* voxels) {
        for (std::size_t i = 0; i < 8; ++i) {
            const std::int64_t x = cell[0] + 1 + static_cast<std::int64_t>(i & 1U);
            const std::int64_t y = cell[1] + 1 + static_cast<std::int64_t>(i >> 1U & 1U);
            const std::int64_t z = cell[2] + 1 + static_cast<std::int64_t>(i >> 2U);
            values[i] = cpu::storedValue(voxels[x + y * volume.image.stride[1] + z * volume.image.stride[2]]);
        }
    });
    std::array<std::int32_t, 3> brick{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        brick[axis] = (cell[axis] + 1) >> kBrickShift;
    }
    const BrickCells& known = scene.occupancy->cells(volume, brick);
    return shader::certifiedCell(scene.occupancy->item(),
                                 {values[0], values[1], values[2], values[3], values[4], values[5], values[6],
                                  values[7], known.wideLo, known.wideHi},
                                 cell[0], cell[1], cell[2], delta);
}

TEST(BrickCellsTest, WhatIsOpaqueAllOverIsSoForEveryTriangle) {
    std::mt19937_64 random(testSeed());
    std::size_t all = 0;
    for (int round = 0; (round < 400 || (all <= 5000 && round < 8000)) && !HasFailure(); ++round) {
        const FlatScene scene(random);
        const cpu::VolumeImpl& volume = scene.volume->impl();
        const auto& size = volume.image.size;
        for (std::int32_t z = -1; z < size[2]; ++z) {
            for (std::int32_t y = -1; y < size[1]; ++y) {
                for (std::int32_t x = -1; x < size[0]; ++x) {
                    const std::array<std::int32_t, 3> brick{(x + 1) >> kBrickShift, (y + 1) >> kBrickShift,
                                                            (z + 1) >> kBrickShift};
                    if (!scene.occupancy->mayBeOpaque(scene.occupancy->brickNumber(brick))) {
                        continue;
                    }
                    const cpu::CellBits& bits = scene.occupancy->allOpaque(volume, brick);
                    const auto row = static_cast<std::size_t>(((y + 1) & 7) + kBrickSide * ((z + 1) & 7));
                    const bool said = (bits[row] >> static_cast<unsigned>((x + 1) & 7) & 1U) != 0;
                    const bool inside =
                        x >= 0 && y >= 0 && z >= 0 && x < size[0] - 1 && y < size[1] - 1 && z < size[2] - 1;
                    EXPECT_TRUE(inside || !said);
                    for (const float delta : {0.0F, 1e-5F, cpu::TriangleCells::kMostDelta}) {
                        const bool is =
                            shader::certifiedCellAllOpaque(scene.occupancy->opaque(), cellAt(scene, {x, y, z}, delta));
                        EXPECT_TRUE(is || !said) << "round " << round;
                    }
                    const bool may =
                        shader::certifiedCellMayBeOpaque(scene.occupancy->opaque(), cellAt(scene, {x, y, z}, 0));
                    const BrickCells& known = scene.occupancy->cells(volume, brick);
                    EXPECT_TRUE(!may || has(known, (x + 1) & 7, (y + 1) & 7, (z + 1) & 7)) << "round " << round;
                    all += said ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(all, 5000U);
}

/// A block somewhere in a volume of that size.
cpu::CellBlock drawnBlock(std::mt19937_64& random, const std::array<std::int32_t, 3>& size,
                          const std::array<std::int32_t, 3>& bricks) {
    cpu::CellBlock block;
    block.cells = 0xFF;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        constexpr std::array<unsigned, 3> kFirst{0x55, 0x33, 0x0F};
        block.first[axis] = static_cast<std::int32_t>(below(random, static_cast<std::uint64_t>(size[axis]) + 1)) - 1;
        const bool two = block.first[axis] + 1 < size[axis] && chance(random, 0.7);
        block.cells &= two ? 0xFFU : kFirst[axis];
        block.oneBrick = block.oneBrick && !(two && (block.first[axis] + 1) % kBrickSide == kBrickSide - 1);
    }
    const auto padded = [&](std::size_t axis) { return block.first[axis] + 1; };
    block.brick = static_cast<std::uint32_t>((padded(2) / kBrickSide * bricks[1] + padded(1) / kBrickSide) * bricks[0] +
                                             padded(0) / kBrickSide);
    block.row = static_cast<std::uint32_t>(padded(1) % kBrickSide + padded(2) % kBrickSide * kBrickSide);
    block.column = static_cast<std::uint32_t>(padded(0) % kBrickSide);
    return block;
}

TEST(BrickCellsTest, OfABlockAreThoseOfItsBricks) {
    std::mt19937_64 random(testSeed());
    std::size_t some = 0;
    for (int round = 0; round < 100 && !HasFailure(); ++round) {
        const FlatScene scene(random);
        const cpu::VolumeImpl& volume = scene.volume->impl();
        cpu::BlockLookup look(volume, *scene.occupancy);
        for (int i = 0; i < 200; ++i) {
            const cpu::CellBlock block = drawnBlock(random, volume.image.size, scene.occupancy->bricks());
            unsigned mayBe = 0;
            unsigned all = 0;
            for (unsigned number = 0; number < cpu::CellBlock::kMost; ++number) {
                const std::array<std::int32_t, 3> cell = block.at(number);
                const std::array<std::int32_t, 3> brick = CellBox{cell, cell}.bricks().lo;
                if ((block.cells >> number & 1U) == 0 ||
                    !scene.occupancy->mayBeOpaque(scene.occupancy->brickNumber(brick))) {
                    continue;
                }
                const CellBox within = CellBox{cell, cell}.within(brick);
                const unsigned may = scene.occupancy->cells(volume, brick).row(within, within.lo[1], within.lo[2]);
                const unsigned row = scene.occupancy->allOpaque(
                    volume, brick)[static_cast<std::size_t>(within.lo[1] + kBrickSide * within.lo[2])];
                mayBe |= (may != 0 ? 1U : 0U) << number;
                all |= ((may & row) != 0 ? 1U : 0U) << number;
            }
            const cpu::BlockBits bits = look.at(block);
            EXPECT_EQ(bits.mayBeOpaque, mayBe) << "round " << round << ", block " << i;
            EXPECT_EQ(bits.allOpaque, all) << "round " << round << ", block " << i;
            some += mayBe != 0 && mayBe != block.cells ? 1 : 0;
        }
    }
    EXPECT_GT(some, 500U);
}

} // namespace
} // namespace voxtact::test
