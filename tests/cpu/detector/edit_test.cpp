// SPDX-License-Identifier: MIT
// A volume edited in place is the volume that is created from the edited voxels.
#include "core/volume/edit_rows.h"
#include "core/volume/voxel_value.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/scene/scene_impl.h"
#include "support/host_meters.h"
#include "support/special.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

VoxelBox randomBox(std::mt19937_64& random, const Grid& grid) {
    VoxelBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = chance(random, 0.3) ? 0 : below(random, grid.size[axis] + std::size_t{1});
        const std::size_t most = grid.size[axis] - first;
        const std::size_t size = chance(random, 0.3) ? most : below(random, most + 1);
        box.first[axis] = static_cast<std::uint32_t>(first);
        box.size[axis] = static_cast<std::uint32_t>(size);
    }
    return box;
}

VoxelRegion randomRegion(std::mt19937_64& random, const Grid& grid) {
    if (chance(random, 0.4)) {
        return randomBox(random, grid);
    }
    const Mat4 pose = randomPoses(grid, 1, 1.2, random).front();
    return Ball{{pose[12], pose[13], pose[14]}, std::pow(10, uniform(random, -1, 1.5))};
}

/// One that the volume has already, or one of the type's ends.
double randomValue(std::mt19937_64& random, const VolumeData& volume) {
    const ValueRange range = take(checkVolume(volume.view()));
    const double value = chance(random, 0.4) ? range.lo : chance(random, 0.5) ? range.hi : (range.lo + range.hi) / 2;
    return volume.type == ScalarType::Float32 ? value : std::floor(value);
}

void edit(VolumeData& volume, const VoxelRegion& region, double value) {
    const VoxelBytes voxel = take(voxelOf(volume.type, value));
    const std::size_t bytes = bytesPerVoxel(volume.type);
    for (const VoxelRow& row : voxelRows(region, volume.grid)) {
        for (std::uint32_t x = row.firstX; x < row.endX; ++x) {
            const std::size_t at = (std::size_t{row.z} * volume.grid.size[1] + row.y) * volume.grid.size[0] + x;
            std::copy_n(voxel.begin(), bytes, volume.voxels.begin() + static_cast<std::ptrdiff_t>(at * bytes));
        }
    }
}

/// Takes the box of `source`, with the same grid and type, over into `volume`. Returns its voxels.
std::vector<std::byte> copyBox(VolumeData& volume, const VolumeData& source, const VoxelBox& box) {
    const std::size_t bytes = bytesPerVoxel(volume.type);
    std::vector<std::byte> copied;
    for (std::size_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
        for (std::size_t y = box.first[1]; y < box.first[1] + box.size[1]; ++y) {
            const std::size_t at = (z * volume.grid.size[1] + y) * volume.grid.size[0] + box.first[0];
            const auto first = source.voxels.begin() + static_cast<std::ptrdiff_t>(at * bytes);
            const auto end = first + static_cast<std::ptrdiff_t>(box.size[0] * bytes);
            std::copy(first, end, volume.voxels.begin() + static_cast<std::ptrdiff_t>(at * bytes));
            copied.insert(copied.end(), first, end);
        }
    }
    return copied;
}

/// The same voxels in another order.
VolumeData shuffled(std::mt19937_64& random, const VolumeData& volume) {
    VolumeData out = volume;
    const std::size_t bytes = bytesPerVoxel(volume.type);
    const std::size_t voxels = volume.voxels.size() / bytes;
    for (std::size_t voxel = 0; voxel < voxels; ++voxel) {
        std::copy_n(volume.voxels.begin() + static_cast<std::ptrdiff_t>(below(random, voxels) * bytes), bytes,
                    out.voxels.begin() + static_cast<std::ptrdiff_t>(voxel * bytes));
    }
    return out;
}

void expectSame(const cpu::Volume& edited, const cpu::Volume& fresh) {
    ASSERT_TRUE(edited.impl().image.bytes == fresh.impl().image.bytes);
    ASSERT_EQ(edited.impl().bricks.lo, fresh.impl().bricks.lo);
    ASSERT_EQ(edited.impl().bricks.hi, fresh.impl().bricks.hi);
}

TEST(Edits, AreAsIfTheVolumeWereMadeAnew) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 150; ++round) {
        VolumeData mirror = randomVolume(random);
        const VolumeData other = shuffled(random, mirror);
        cpu::Volume volume = take(cpu::Volume::create(mirror.view()));
        for (int step = 0; step < 8; ++step) {
            const std::uint64_t before = volume.impl().id;
            bool empty = false;
            if (chance(random, 0.5)) {
                const VoxelRegion region = randomRegion(random, mirror.grid);
                const double value = randomValue(random, mirror);
                edit(mirror, region, value);
                ASSERT_TRUE(volume.set(region, value).ok());
                empty = voxelRows(region, mirror.grid).empty();
            } else {
                const VoxelBox box = randomBox(random, mirror.grid);
                const std::vector<std::byte> voxels = copyBox(mirror, other, box);
                ASSERT_TRUE(volume.write(box, voxels).ok());
                empty = voxels.empty();
            }
            ASSERT_EQ(volume.impl().id == before, empty);
            const VoxelBox seen = randomBox(random, mirror.grid);
            VolumeData copy = mirror;
            const std::vector<std::byte> wanted = copyBox(copy, mirror, seen);
            std::vector<std::byte> read(wanted.size());
            ASSERT_TRUE(volume.read(seen, read).ok());
            ASSERT_TRUE(read == wanted);
            ASSERT_NO_FATAL_FAILURE(expectSame(volume, take(cpu::Volume::create(mirror.view()))));
        }
    }
}

TEST(Edits, AreReadBackIntoMemoryThatFits) {
    const VolumeData data = makeBytes(unitGrid(4), [](auto x, auto...) { return x; });
    const cpu::Volume volume = take(cpu::Volume::create(data.view()));
    std::vector<std::byte> memory(8);
    EXPECT_TRUE(volume.read({{2, 2, 2}, {2, 2, 2}}, memory).ok());
    EXPECT_THAT(volume.read({{2, 2, 2}, {2, 2, 1}}, memory).error().text, HasSubstr("need 4"));
    EXPECT_THAT(volume.read({{3, 2, 2}, {2, 2, 2}}, memory).error().text, HasSubstr("along x"));
}

TEST(Edits, AreSeenByTheNextCount) {
    std::mt19937_64 random(testSeed());
    cpu::Detector detector = take(cpu::Detector::create({.threads = 2}));
    std::size_t changed = 0;
    for (int round = 0; round < 100; ++round) {
        RandomScene scene = makeRandomScene(random, 8);
        cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const cpu::Mesh mesh = take(cpu::Mesh::create(scene.mesh.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(scene.transferFunction()));
        const auto counts = [&](const cpu::Volume& of) {
            const cpu::BatchItem item{&mesh, &of, &function, scene.poses};
            std::vector<std::uint64_t> out;
            const BatchAnswer answer = take(detector.detect({std::span(&item, 1), scene.view, scene.threshold}));
            for (const PairAnswer& pair : answer.pairs) {
                out.push_back(pair.count);
            }
            return out;
        };
        std::vector<std::uint64_t> last = counts(volume);
        for (int step = 0; step < 4; ++step) {
            const VoxelRegion region = randomRegion(random, scene.volume.grid);
            const double value = randomValue(random, scene.volume);
            edit(scene.volume, region, value);
            ASSERT_TRUE(volume.set(region, value).ok());
            const std::vector<std::uint64_t> now = counts(volume);
            ASSERT_EQ(now, counts(take(cpu::Volume::create(scene.volume.view()))));
            changed += now != last ? 1U : 0U;
            last = now;
        }
    }
    EXPECT_GT(changed, 3U) << "the edits were nowhere to be seen";
}

TEST(Edits, BadOnesAreRefusedAndChangeNothing) {
    Grid grid = unitGrid(4, 5, 6);
    const auto text = [&](ScalarType type, double value) {
        const VolumeData data{grid, type, std::vector<std::byte>(voxelCount(grid) * bytesPerVoxel(type)), {}, {}};
        cpu::Volume volume = take(cpu::Volume::create(data.view()));
        std::string out = volume.set(VoxelBox{{1, 1, 1}, {2, 2, 2}}, value).error().text;
        expectSame(volume, take(cpu::Volume::create(data.view())));
        return out;
    };
    EXPECT_THAT(text(ScalarType::UInt8, 256), HasSubstr("256 is not one that a voxel of type uint8"));
    EXPECT_THAT(text(ScalarType::UInt8, -1), HasSubstr("a whole number from 0 to 255"));
    EXPECT_THAT(text(ScalarType::UInt16, 1.5), HasSubstr("1.5"));
    EXPECT_THAT(text(ScalarType::Int16, -32769), HasSubstr("from -32768 to 32767"));
    EXPECT_THAT(text(ScalarType::Int16, kNan), HasSubstr("nan"));
    EXPECT_THAT(text(ScalarType::Float32, kNan), HasSubstr("nan"));
    EXPECT_THAT(text(ScalarType::Float32, std::numeric_limits<double>::infinity()), HasSubstr("inf"));
    EXPECT_THAT(text(ScalarType::Float32, 1e39), HasSubstr("1e+39"));

    cpu::Volume volume =
        take(cpu::Volume::create(makeVolume<float>(grid, ScalarType::Float32, [](auto...) { return 0.0; }).view()));
    const std::uint64_t before = volume.impl().id;
    const auto write = [&](const VoxelBox& box, const std::vector<float>& voxels) {
        return volume.write(box, std::as_bytes(std::span(voxels))).error().text;
    };
    const VoxelBox box{{3, 4, 4}, {1, 1, 2}};
    EXPECT_THAT(write(box, {1}), HasSubstr("4 bytes of voxels, the box and the type (float) need 8"));
    EXPECT_THAT(write(box, {1, static_cast<float>(kNan)}), HasSubstr("voxel (0, 0, 1) of the box is NaN"));
    EXPECT_THAT(write({{3, 4, 5}, {1, 1, 2}}, {1, 2}), HasSubstr("ends at 7 along z"));
    EXPECT_THAT(write({{3, 4, 7}, {0, 0, 0}}, {}), HasSubstr("ends at 7 along z"));
    EXPECT_FALSE(volume.set(Ball{{0, 0, 0}, -1}, 0).ok());
    EXPECT_TRUE(volume.write({{3, 4, 6}, {1, 1, 0}}, {}).ok()) << "nothing to do";
    EXPECT_EQ(volume.impl().id, before);
}

} // namespace
} // namespace voxtact::test
