// SPDX-License-Identifier: MIT
#include "core/volume/label_nodes.h"
#include "brick_levels.h"
#include "core/volume/bricks.h"

#include <algorithm>

namespace voxtact {

namespace {

shader::BrickLevel levelOf(const Grid& grid, int level) {
    return shader::brickLevel(static_cast<int>(grid.size[0]), static_cast<int>(grid.size[1]),
                              static_cast<int>(grid.size[2]), level);
}

int levelsOf(const Grid& grid) {
    return shader::brickLevels(static_cast<int>(grid.size[0]), static_cast<int>(grid.size[1]),
                               static_cast<int>(grid.size[2]));
}

std::uint64_t countOf(const shader::BrickLevel& level) {
    return static_cast<std::uint64_t>(level.countX) * static_cast<std::uint64_t>(level.countY) *
           static_cast<std::uint64_t>(level.countZ);
}

void join(LabelBits& to, const LabelBits& from) {
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] |= from[i];
    }
}

/// A voxel is a corner of the padded cells i and i + 1 along an axis: of one brick, or of two.
std::uint32_t lastBrick(std::uint32_t voxel) {
    return (voxel + 1) >> VOXTACT_BRICK_SHIFT;
}

std::uint32_t firstBrick(std::uint32_t voxel) {
    return voxel >> VOXTACT_BRICK_SHIFT;
}

/// The bits of a row of voxels, by the bricks along it.
void fillRow(const std::uint16_t* voxels, std::uint32_t count, std::vector<LabelBits>& row) {
    std::ranges::fill(row, LabelBits{});
    for (std::uint32_t x = 0; x < count; ++x) {
        const std::uint32_t number = voxels[x] % VOXTACT_LABEL_BITS;
        for (std::uint32_t brick = firstBrick(x); brick <= lastBrick(x); ++brick) {
            row[brick][number / 32] |= 1U << number % 32;
        }
    }
}

void fillBricks(const LabelData& labels, std::vector<LabelBits>& nodes) {
    const auto& size = labels.grid.size;
    const auto countX = static_cast<std::size_t>(brickCount(static_cast<std::int32_t>(size[0])));
    const auto countY = static_cast<std::size_t>(brickCount(static_cast<std::int32_t>(size[1])));
    std::vector<LabelBits> row(countX);
    const std::uint16_t* voxels = labels.indices.data();
    for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y, voxels += size[0]) {
            fillRow(voxels, size[0], row);
            for (std::uint32_t brickZ = firstBrick(z); brickZ <= lastBrick(z); ++brickZ) {
                for (std::uint32_t brickY = firstBrick(y); brickY <= lastBrick(y); ++brickY) {
                    LabelBits* const to = &nodes[(brickZ * countY + brickY) * countX];
                    for (std::size_t x = 0; x < countX; ++x) {
                        join(to[x], row[x]);
                    }
                }
            }
        }
    }
}

/// The nodes of a level that has others below it.
void fillLevel(const shader::BrickLevel& below, const shader::BrickLevel& level, std::vector<LabelBits>& nodes) {
    int from = below.first;
    for (int z = 0; z < below.countZ; ++z) {
        for (int y = 0; y < below.countY; ++y) {
            for (int x = 0; x < below.countX; ++x, ++from) {
                const int to = level.first + (x >> VOXTACT_LEVEL_SHIFT) +
                               level.countX * ((y >> VOXTACT_LEVEL_SHIFT) + level.countY * (z >> VOXTACT_LEVEL_SHIFT));
                join(nodes[static_cast<std::size_t>(to)], nodes[static_cast<std::size_t>(from)]);
            }
        }
    }
}

} // namespace

std::uint64_t labelNodeCount(const Grid& grid) noexcept {
    std::uint64_t count = 0;
    for (int level = 0; level < levelsOf(grid); ++level) {
        count += countOf(levelOf(grid, level));
    }
    return count;
}

std::vector<LabelBits> labelNodes(const LabelData& labels) {
    std::vector<LabelBits> nodes(labelNodeCount(labels.grid));
    fillBricks(labels, nodes);
    for (int level = 1; level < levelsOf(labels.grid); ++level) {
        fillLevel(levelOf(labels.grid, level - 1), levelOf(labels.grid, level), nodes);
    }
    return nodes;
}

} // namespace voxtact
