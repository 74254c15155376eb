// SPDX-License-Identifier: MIT
// The bricks on the device: the host's ranges, and a wide range counted voxel by voxel.
#include "device/scene/scene_impl.h"
#include "host/scene/stored_image.h"
#include "raw_fixture.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class BricksTest : public RawGpuTest {
  protected:
    std::vector<shader::vec4> readBricks(const Volume& volume) {
        const Buffer& bricks = volume.impl().bricks;
        const std::vector<std::byte> bytes = raw().readBuffer(bricks.get(), bricks.size);
        std::vector<shader::vec4> out(bytes.size() / sizeof(shader::vec4));
        std::memcpy(out.data(), bytes.data(), bytes.size());
        return out;
    }

    void cmdUpdate(Volume& volume, const VoxelBox& changed) {
        const VkCommandBuffer commands = raw().begin();
        take(volume.cmdUpdateBricks(commands, changed));
        raw().submitAndWait(commands);
    }
};

VolumeData randomBricks(const Grid& grid, ScalarType type, std::mt19937_64& random) {
    VolumeData out;
    out.grid = grid;
    out.type = type;
    out.voxels.resize(voxelCount(grid) * bytesPerVoxel(type));
    if (type == ScalarType::Float32) {
        for (std::size_t at = 0; at < out.voxels.size(); at += sizeof(float)) {
            const auto voxel = static_cast<float>(uniform(random, -1e6, 1e6));
            std::memcpy(out.voxels.data() + at, &voxel, sizeof voxel);
        }
        return out;
    }
    std::ranges::generate(out.voxels, [&] { return static_cast<std::byte>(random()); });
    return out;
}

Grid randomGrid(std::mt19937_64& random) {
    const auto side = [&] { return static_cast<std::uint32_t>(random() % 20 + 1); };
    return unitGrid(side(), side(), side());
}

/// The stored value of a voxel of the image, its number clamped to the grid.
float clampedStored(const cpu::StoredImage& image, std::int32_t x, std::int32_t y, std::int32_t z) {
    const auto padded = [&](std::int32_t voxel, std::size_t axis) {
        return std::int64_t{std::clamp(voxel, 0, image.size[axis] - 1)} + 1;
    };
    return image.visit([&](const auto* voxels) {
        return static_cast<float>(
            voxels[padded(x, 0) + padded(y, 1) * image.stride[1] + padded(z, 2) * image.stride[2]]);
    });
}

/// The corners of the cells of a brick and of those one farther out, cell by cell.
ValueRange wideRange(const cpu::StoredImage& image, std::int32_t brickX, std::int32_t brickY, std::int32_t brickZ) {
    ValueRange range{HUGE_VAL, -HUGE_VAL};
    // Padded cells 8b-1 to 8b+8 are cells 8b-2 to 8b+7; the upper corner of a cell is the next voxel.
    for (std::int32_t z = 8 * brickZ - 2; z <= 8 * brickZ + 8; ++z) {
        for (std::int32_t y = 8 * brickY - 2; y <= 8 * brickY + 8; ++y) {
            for (std::int32_t x = 8 * brickX - 2; x <= 8 * brickX + 8; ++x) {
                const double stored = clampedStored(image, x, y, z);
                range = {std::min(range.lo, stored), std::max(range.hi, stored)};
            }
        }
    }
    return range;
}

void expectBricks(const std::vector<shader::vec4>& bricks, const VolumeView& volume) {
    const cpu::StoredImage image(volume);
    const cpu::BrickRanges ranges(image);
    ASSERT_EQ(bricks.size(), ranges.lo.size());
    std::size_t at = 0;
    for (std::int32_t z = 0; z < ranges.count[2]; ++z) {
        for (std::int32_t y = 0; y < ranges.count[1]; ++y) {
            for (std::int32_t x = 0; x < ranges.count[0]; ++x, ++at) {
                const ValueRange wide = wideRange(image, x, y, z);
                ASSERT_EQ(bricks[at][0], ranges.lo[at]) << at;
                ASSERT_EQ(bricks[at][1], ranges.hi[at]) << at;
                ASSERT_EQ(bricks[at][2], wide.lo) << at;
                ASSERT_EQ(bricks[at][3], wide.hi) << at;
            }
        }
    }
}

constexpr ScalarType kBrickTypes[] = {ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32};

TEST_F(BricksTest, AreTheHostsRanges) {
    std::mt19937_64 random(testSeed());
    std::vector<Grid> grids{unitGrid(1), unitGrid(7, 8, 9), unitGrid(16), unitGrid(15, 17, 1), unitGrid(24, 8, 3)};
    for (int i = 0; i < 12; ++i) {
        grids.push_back(randomGrid(random));
    }
    for (const Grid& grid : grids) {
        for (const ScalarType type : kBrickTypes) {
            const VolumeData data = randomBricks(grid, type, random);
            const Volume volume = take(Volume::upload(context(), queue(), data.view(), {.bricks = true}));
            SCOPED_TRACE(std::to_string(grid.size[0]) + "x" + std::to_string(grid.size[1]) + "x" +
                         std::to_string(grid.size[2]) + " " + toString(type));
            ASSERT_NO_FATAL_FAILURE(expectBricks(readBricks(volume), data.view()));
        }
    }
}

TEST_F(BricksTest, OfAWrappedImage) {
    std::mt19937_64 random(testSeed());
    const Grid grid = randomGrid(random);
    const VolumeData data = randomBricks(grid, ScalarType::Int16, random);
    WrappedVolume wrapped;
    wrapped.grid = grid;
    wrapped.bricks = true;
    wrapped.layout = VK_IMAGE_LAYOUT_GENERAL;
    wrapped.format = VK_FORMAT_R16_SNORM;
    wrapped.view = raw().makeImage(VK_IMAGE_TYPE_3D, wrapped.format, {grid.size[0], grid.size[1], grid.size[2]},
                                   data.voxels, wrapped.layout);
    Volume volume = take(Volume::wrap(context(), wrapped));
    cmdUpdate(volume, {{}, grid.size});

    // SNORM has one value less: -32768 is -32767. Stored values here have no sign bit flipped.
    VolumeData clamped = makeVolume<float>(grid, ScalarType::Float32, [&](auto x, auto y, auto z) {
        std::int16_t voxel = 0;
        const std::size_t at = x + grid.size[0] * (y + std::size_t{grid.size[1]} * z);
        std::memcpy(&voxel, data.voxels.data() + at * sizeof voxel, sizeof voxel);
        return std::max<double>(voxel, -32767);
    });
    ASSERT_NO_FATAL_FAILURE(expectBricks(readBricks(volume), clamped.view()));
}

TEST_F(BricksTest, OfFloatsThatAreNotNumbers) {
    // A brick of NaN alone, and one with a single number.
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> voxels(24 * 2 * 2, kNaN);
    voxels[20] = 5;
    WrappedVolume wrapped;
    wrapped.grid = unitGrid(24, 2, 2);
    wrapped.bricks = true;
    wrapped.format = VK_FORMAT_R32_SFLOAT;
    wrapped.view =
        raw().makeImage(VK_IMAGE_TYPE_3D, wrapped.format, {24, 2, 2}, std::as_bytes(std::span(voxels)), wrapped.layout);
    Volume volume = take(Volume::wrap(context(), wrapped));
    cmdUpdate(volume, {{}, wrapped.grid.size});
    const std::vector<shader::vec4> bricks = readBricks(volume);
    ASSERT_EQ(bricks.size(), 4U);
    constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(bricks[0], (shader::vec4{kFloatInfinity, -kFloatInfinity, kFloatInfinity, -kFloatInfinity}));
    EXPECT_EQ(bricks[2], (shader::vec4{5, 5, 5, 5}));
}

TEST_F(BricksTest, FollowEdits) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 12; ++round) {
        const Grid grid =
            unitGrid(static_cast<std::uint32_t>(random() % 60 + 1), static_cast<std::uint32_t>(random() % 60 + 1),
                     static_cast<std::uint32_t>(random() % 20 + 1));
        VolumeData data = makeBytes(grid, [&](auto...) { return static_cast<double>(random() % 100 + 100); });
        Volume volume = take(Volume::upload(context(), queue(), data.view(), {.bricks = true, .editable = true}));
        const auto value = static_cast<double>(random() % 256);
        VoxelBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.first[axis] = static_cast<std::uint32_t>(random() % grid.size[axis]);
            box.size[axis] = static_cast<std::uint32_t>(random() % (grid.size[axis] - box.first[axis]) + 1);
        }
        const VkCommandBuffer commands = raw().begin();
        take(volume.cmdSet(commands, box, value));
        raw().submitAndWait(commands);
        const VolumeData edited = makeBytes(grid, [&](auto x, auto y, auto z) {
            const std::array<std::uint32_t, 3> at{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                                  static_cast<std::uint32_t>(z)};
            bool inside = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                inside = inside && at[axis] >= box.first[axis] && at[axis] < box.first[axis] + box.size[axis];
            }
            const std::size_t number = at[0] + grid.size[0] * (at[1] + std::size_t{grid.size[1]} * at[2]);
            return inside ? value : static_cast<double>(std::to_integer<std::uint8_t>(data.voxels[number]));
        });
        SCOPED_TRACE("round " + std::to_string(round));
        ASSERT_NO_FATAL_FAILURE(expectBricks(readBricks(volume), edited.view()));
    }
}

TEST_F(BricksTest, BadInputIsRefused) {
    const VolumeData data = makeBytes(unitGrid(4, 5, 6), [](auto...) { return 1.0; });
    Volume without = upload(data);
    Volume with = take(Volume::upload(context(), queue(), data.view(), {.name = "bricked", .bricks = true}));
    const VkCommandBuffer commands = raw().begin();
    EXPECT_THAT(without.cmdUpdateBricks(commands, {}).error().text, HasSubstr("no bricks"));
    EXPECT_FALSE(with.cmdUpdateBricks(commands, {{4, 0, 0}, {1, 1, 1}}).ok());
    EXPECT_FALSE(with.cmdUpdateBricks(commands, {{1, 0, 0}, {UINT32_MAX, 1, 1}}).ok());
    EXPECT_TRUE(with.cmdUpdateBricks(commands, {{4, 5, 6}, {0, 0, 0}}).ok());
    EXPECT_TRUE(with.cmdUpdateBricks(commands, {{3, 4, 5}, {1, 1, 1}}).ok());
    raw().submitAndWait(commands);
    ASSERT_NO_FATAL_FAILURE(expectBricks(readBricks(with), data.view()));
}

} // namespace
} // namespace voxtact::test
