// SPDX-License-Identifier: MIT
// Volumes that are edited in place, against uploads of the edited host data.
#include "device/scene/scene_impl.h"
#include "interception.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "support/special.h"
#include "voxtact/cpu.h"
#include "vulkan/texels.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr ScalarType kTypes[] = {ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32};
constexpr VkBufferUsageFlags kSource = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

std::uint32_t drawnBelow(std::mt19937_64& random, std::uint32_t end) {
    return static_cast<std::uint32_t>(random() % end);
}

std::vector<std::byte> randomVoxels(ScalarType type, std::size_t count, std::mt19937_64& random) {
    std::vector<std::byte> out(count * bytesPerVoxel(type));
    if (type != ScalarType::Float32) {
        std::ranges::generate(out, [&] { return static_cast<std::byte>(random()); });
        return out;
    }
    for (std::size_t at = 0; at < out.size(); at += sizeof(float)) {
        const auto voxel = static_cast<float>(uniform(random, -1000, 1000));
        std::memcpy(out.data() + at, &voxel, sizeof voxel);
    }
    return out;
}

/// A voxel of a type with a value that it can have.
std::vector<std::byte> voxelOf(ScalarType type, double value) {
    VolumeData one;
    switch (type) {
    case ScalarType::UInt8:
        one = makeVolume<std::uint8_t>(unitGrid(1), type, [&](auto...) { return value; });
        break;
    case ScalarType::Int16:
        one = makeVolume<std::int16_t>(unitGrid(1), type, [&](auto...) { return value; });
        break;
    case ScalarType::UInt16:
        one = makeVolume<std::uint16_t>(unitGrid(1), type, [&](auto...) { return value; });
        break;
    case ScalarType::Float32:
        one = makeVolume<float>(unitGrid(1), type, [&](auto...) { return value; });
        break;
    }
    return one.voxels;
}

double randomValue(ScalarType type, std::mt19937_64& random) {
    switch (type) {
    case ScalarType::UInt8:
        return drawnBelow(random, 256);
    case ScalarType::Int16:
        return static_cast<double>(drawnBelow(random, 65536)) - 32768;
    case ScalarType::UInt16:
        return drawnBelow(random, 65536);
    case ScalarType::Float32:
        break;
    }
    return static_cast<float>(uniform(random, -1000, 1000));
}

VolumeData randomVolume(std::array<std::uint32_t, 3> size, ScalarType type, std::mt19937_64& random) {
    VolumeData out;
    out.grid.size = size;
    out.grid.spacing = {uniform(random, 0.3, 2), uniform(random, 0.3, 2), uniform(random, 0.3, 2)};
    out.grid.origin = {uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -50, 50)};
    const Mat4 turn = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(turn.begin() + static_cast<std::ptrdiff_t>(4 * axis), 3,
                    out.grid.direction.begin() + static_cast<std::ptrdiff_t>(3 * axis));
    }
    out.type = type;
    out.voxels = randomVoxels(type, voxelCount(out.grid), random);
    return out;
}

VoxelBox randomBox(const Grid& grid, std::mt19937_64& random) {
    VoxelBox box;
    const bool one = drawnBelow(random, 3) == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.first[axis] = drawnBelow(random, grid.size[axis]);
        box.size[axis] = one ? 1 : 1 + drawnBelow(random, grid.size[axis] - box.first[axis]);
    }
    return box;
}

Ball randomBall(const Grid& grid, std::mt19937_64& random) {
    const Vec3 centre{uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2)};
    const double side = *std::ranges::max_element(grid.size);
    return {transformPoint(worldFromTexture(grid), centre), uniform(random, 0, 0.7 * side)};
}

/// Calls `visitor` with the place in `voxels` and the running number of each voxel of a box.
template <class Visitor> void forBox(const VolumeData& data, const VoxelBox& box, Visitor&& visitor) {
    const std::size_t bytes = bytesPerVoxel(data.type);
    std::size_t number = 0;
    for (std::size_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
        for (std::size_t y = box.first[1]; y < box.first[1] + box.size[1]; ++y) {
            for (std::size_t x = box.first[0]; x < box.first[0] + box.size[0]; ++x, ++number) {
                visitor(bytes * (x + data.grid.size[0] * (y + data.grid.size[1] * z)), bytes * number,
                        Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
            }
        }
    }
}

void setOnHost(VolumeData& data, const VoxelRegion& region, double value) {
    const std::vector<std::byte> voxel = voxelOf(data.type, value);
    const auto put = [&](std::size_t at) { std::ranges::copy(voxel, data.voxels.begin() + static_cast<int>(at)); };
    if (const auto* box = std::get_if<VoxelBox>(&region)) {
        forBox(data, *box, [&](std::size_t at, std::size_t, const Vec3&) { put(at); });
        return;
    }
    const Ball& ball = std::get<Ball>(region);
    const Mat4 world_from_index = worldFromIndex(data.grid);
    forBox(data, {{}, data.grid.size}, [&](std::size_t at, std::size_t, const Vec3& index) {
        const Vec3 point = transformPoint(world_from_index, index);
        if (std::hypot(point[0] - ball.centre[0], point[1] - ball.centre[1], point[2] - ball.centre[2]) <=
            ball.radius) {
            put(at);
        }
    });
}

void writeOnHost(VolumeData& data, const VoxelBox& box, std::span<const std::byte> voxels) {
    forBox(data, box, [&](std::size_t at, std::size_t from, const Vec3&) {
        std::memcpy(data.voxels.data() + at, voxels.data() + from, bytesPerVoxel(data.type));
    });
}

class EditTest : public RawGpuTest {
  protected:
    Volume editable(const VolumeData& data) {
        return take(Volume::upload(context(), queue(), data.view(), {.bricks = true, .editable = true}));
    }

    /// Records one random edit, and does the same to the host's voxels.
    void cmdRandomEdit(VkCommandBuffer commands, Volume& volume, VolumeData& data, std::mt19937_64& random) {
        const VoxelBox box = randomBox(data.grid, random);
        const std::size_t count = std::size_t{box.size[0]} * box.size[1] * box.size[2];
        const std::uint32_t kind = drawnBelow(random, 4);
        if (kind < 2) {
            const VoxelRegion region = kind == 0 ? VoxelRegion(box) : VoxelRegion(randomBall(data.grid, random));
            const double value = randomValue(data.type, random);
            setOnHost(data, region, value);
            take(volume.cmdSet(commands, region, value));
            return;
        }
        const std::vector<std::byte> voxels = randomVoxels(data.type, count, random);
        writeOnHost(data, box, voxels);
        if (kind == 2) {
            take(volume.cmdWrite(commands, box, voxels));
            return;
        }
        constexpr std::size_t kOffset = 12;
        std::vector<std::byte> texels(kOffset + voxels.size());
        fillTexels(data.type, voxels, texels.data() + kOffset);
        const VkBuffer source = raw().makeBuffer(std::span<const std::byte>(texels), kSource).buffer;
        take(volume.cmdCopy(commands, box, source, kOffset));
    }

    /// The image and the bricks are those of a volume that is made of `data`.
    void expectSame(const Volume& volume, const VolumeData& data) {
        const VkExtent3D extent{data.grid.size[0], data.grid.size[1], data.grid.size[2]};
        std::vector<std::byte> texels(data.voxels.size());
        fillTexels(data.type, data.voxels, texels.data());
        ASSERT_TRUE(raw().readImage(volume.impl().image.image.get(), extent, bytesPerVoxel(data.type)) == texels);
        const Volume fresh = editable(data);
        const Buffer& bricks = volume.impl().bricks;
        ASSERT_TRUE(raw().readBuffer(bricks.get(), bricks.size) ==
                    raw().readBuffer(fresh.impl().bricks.get(), bricks.size));
    }
};

TEST_F(EditTest, RandomEditsGiveTheEditedVolume) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 40; ++round) {
        const ScalarType type = kTypes[round % 4];
        const auto side = [&] { return 1 + drawnBelow(random, 33); };
        VolumeData data = randomVolume({side(), side(), side()}, type, random);
        SCOPED_TRACE("round " + std::to_string(round) + " " + toString(type));
        Volume volume = editable(data);
        const VkCommandBuffer commands = raw().begin();
        for (int i = 0; i < 1 + round % 5; ++i) {
            cmdRandomEdit(commands, volume, data, random);
        }
        raw().submitAndWait(commands);
        ASSERT_NO_FATAL_FAILURE(expectSame(volume, data));
    }
}

TEST_F(EditTest, MoreThanOneCommandTakes) {
    // A slice is more than a vkCmdUpdateBuffer takes, the ball has more rows than are copied at once.
    std::mt19937_64 random(testSeed());
    VolumeData data = randomVolume({301, 299, 3}, ScalarType::UInt8, random);
    Volume volume = editable(data);
    const VoxelBox all{{}, data.grid.size};
    const std::vector<std::byte> voxels = randomVoxels(data.type, voxelCount(data.grid), random);
    const Ball ball{transformPoint(worldFromTexture(data.grid), {0.5, 0.5, 0.5}), 120.3 * data.grid.spacing[1]};
    writeOnHost(data, all, voxels);
    setOnHost(data, ball, 77);
    const VkCommandBuffer commands = raw().begin();
    take(volume.cmdWrite(commands, all, voxels));
    take(volume.cmdSet(commands, ball, 77));
    raw().submitAndWait(commands);
    ASSERT_NO_FATAL_FAILURE(expectSame(volume, data));
}

TEST_F(EditTest, ABallOfSeveralMiB) {
    // The box around it has more texels than are changed at once, and more rows.
    std::mt19937_64 random(testSeed());
    for (const auto& [size, type] : {std::pair(std::array<std::uint32_t, 3>{90, 91, 95}, ScalarType::Float32),
                                     std::pair(std::array<std::uint32_t, 3>{9, 150, 140}, ScalarType::UInt8)}) {
        VolumeData data = randomVolume(size, type, random);
        Volume volume = editable(data);
        const double reach = 0.49 * std::min(data.grid.spacing[1] * size[1], data.grid.spacing[2] * size[2]);
        const Ball ball{transformPoint(worldFromTexture(data.grid), {0.51, 0.48, 0.5}), reach};
        setOnHost(data, ball, 7);
        const VkCommandBuffer commands = raw().begin();
        take(volume.cmdSet(commands, ball, 7));
        raw().submitAndWait(commands);
        ASSERT_NO_FATAL_FAILURE(expectSame(volume, data));
    }
}

/// What an edit records.
struct Recorded {
    int dispatches = 0;
    int copies = 0; ///< regions
    int updates = 0;

    PFN_vkCmdDispatch realDispatch = nullptr;
    PFN_vkCmdCopyBufferToImage realCopy = nullptr;
    PFN_vkCmdUpdateBuffer realUpdate = nullptr;
    bool operator==(const Recorded&) const = default;
};
Recorded recorded;

void VKAPI_PTR countDispatch(VkCommandBuffer commands, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    ++recorded.dispatches;
    recorded.realDispatch(commands, x, y, z);
}
void VKAPI_PTR countCopy(VkCommandBuffer commands, VkBuffer from, VkImage to, VkImageLayout layout, std::uint32_t count,
                         const VkBufferImageCopy* regions) {
    recorded.copies += static_cast<int>(count);
    recorded.realCopy(commands, from, to, layout, count, regions);
}
void VKAPI_PTR countUpdate(VkCommandBuffer commands, VkBuffer to, VkDeviceSize offset, VkDeviceSize size,
                           const void* data) {
    ++recorded.updates;
    recorded.realUpdate(commands, to, offset, size, data);
}

TEST_F(EditTest, ABallIsOneDispatchHoweverManyRowsItHas) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    recorded = {};
    recorded.realDispatch = raw().vk().vkCmdDispatch;
    recorded.realCopy = raw().vk().vkCmdCopyBufferToImage;
    recorded.realUpdate = raw().vk().vkCmdUpdateBuffer;
    loader.replace("vkCmdDispatch", &countDispatch);
    loader.replace("vkCmdCopyBufferToImage", &countCopy);
    loader.replace("vkCmdUpdateBuffer", &countUpdate);
    const Context counting = take(Context::create(desc));
    const VolumeData data = makeBytes(unitGrid(64), [](auto...) { return 0.0; });
    Volume volume = take(Volume::upload(counting, queue(), data.view(), {.editable = true}));
    for (const double radius : {0.02, 0.1, 0.45}) { // of 4, 130 and 2,600 rows
        recorded.dispatches = recorded.copies = recorded.updates = 0;
        const VkCommandBuffer commands = raw().begin();
        take(volume.cmdSet(commands, Ball{{0.5, 0.5, 0.5}, radius}, 9));
        EXPECT_EQ(recorded.dispatches, 1) << radius;
        EXPECT_EQ(recorded.copies, 1) << radius;
        EXPECT_EQ(recorded.updates, 1) << radius;
        take(volume.cmdSet(commands, VoxelBox{{1, 2, 3}, {60, 59, 58}}, 4));
        EXPECT_EQ(recorded.copies, 2) << radius;
        raw().submitAndWait(commands);
    }
}

TEST_F(EditTest, CountsFollow) {
    std::mt19937_64 random(testSeed());
    VolumeData data = makeBytes(unitGrid(12), [&](auto...) { return drawnBelow(random, 256); });
    Volume volume = editable(data);
    const TransferFunction function = upload(byteRamp(), kBytes);
    const Mesh mesh = upload(makeCube(0.2, 0.9));
    const View view = flatView(0, 1, 97, 89);
    const Mat4 pose = identity();
    for (int round = 0; round < 4; ++round) {
        const VkCommandBuffer commands = raw().begin();
        cmdRandomEdit(commands, volume, data, random);
        raw().submitAndWait(commands);
        const Volume fresh = upload(data);
        for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Compute}) {
            const PairAnswer edited = detectOne({.method = method}, {&mesh, &volume, &function, {&pose, 1}}, view);
            const PairAnswer uploaded = detectOne({.method = method}, {&mesh, &fresh, &function, {&pose, 1}}, view);
            EXPECT_EQ(edited.count, uploaded.count) << toString(method);
        }
    }
}

TEST_F(EditTest, TakeEffectInCommandBufferOrder) {
    const VolumeData data = makeBytes(unitGrid(8), [](std::uint32_t x, auto...) { return x < 4 ? 255.0 : 0.0; });
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Mat4 pose = identity();
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Compute}) {
        Volume volume = editable(data);
        TransferFunction function = upload(byteRamp(), kBytes);
        const Detector counting = take(Detector::raster(context(), {.method = method}));
        const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
        const Batch batch{std::span(&item, 1), flatView(0, 1, 64, 64), 0.5};
        std::vector<Results> results;
        const VkCommandBuffer commands = raw().begin();
        const auto detect = [&] {
            results.push_back(take(Results::create(counting, {.maxPairs = 1})));
            take(counting.cmdDetect(commands, batch, results.back()));
            take(results.back().cmdReadBack(commands));
        };
        detect();
        // What is opaque ends half-way between voxels 1 and 2, at a quarter of 64 columns.
        take(volume.cmdSet(commands, VoxelBox{{2, 0, 0}, {2, 8, 8}}, 0));
        detect();
        take(function.cmdUpdate(commands, {kAllOpaque, kBytes}));
        detect();
        take(function.cmdUpdate(commands, {byteRamp(), kBytes}));
        take(volume.cmdWrite(commands, {{7, 0, 0}, {1, 8, 8}}, std::vector<std::byte>(64, std::byte{255})));
        detect();
        take(volume.cmdSet(commands, Ball{{0.5, 0.5, 0.5}, 2}, 0));
        detect();
        raw().submitAndWait(commands);
        const std::uint64_t expected[] = {64 * 32, 64 * 16, 64 * 64, 64 * (16 + 8), 0};
        ASSERT_EQ(results.size(), std::size(expected));
        for (std::size_t i = 0; i < results.size(); ++i) {
            EXPECT_EQ(unpack(take(results[i].read())[0]).count, expected[i]) << toString(method) << " " << i;
        }
    }
}

TEST_F(EditTest, WhatTheHostKnowsIsWidened) {
    const VolumeData data = makeBytes(unitGrid(8), [](auto...) { return 10.0; });
    Volume volume = editable(data);
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const TransferFunction function = upload(byteRamp(), kBytes);
    const Detector counting = take(Detector::raster(context(), {}));
    const auto boundary = [&] { return counting.boundaryFor({&mesh, &volume, &function, {}}, 0.5); };
    const VkCommandBuffer commands = raw().begin();
    take(volume.cmdSet(commands, VoxelBox{{1, 1, 1}, {6, 6, 6}}, 255));
    EXPECT_EQ(boundary(), Boundary::Clamp);
    EXPECT_EQ(volume.valueRange()->lo, 10);
    EXPECT_EQ(volume.valueRange()->hi, 255);
    const std::byte dark[] = {std::byte{3}, std::byte{4}};
    take(volume.cmdWrite(commands, {{1, 1, 1}, {2, 1, 1}}, dark));
    EXPECT_EQ(volume.valueRange()->lo, 3);
    take(volume.cmdSet(commands, VoxelBox{{0, 8, 0}, {8, 0, 8}}, 0));
    EXPECT_EQ(volume.valueRange()->lo, 3) << "an empty box changes nothing";
    take(volume.cmdSet(commands, VoxelBox{{1, 1, 7}, {1, 1, 1}}, 10));
    EXPECT_EQ(boundary(), Boundary::Range) << "on a face";
    take(volume.cmdCopy(commands, {{1, 1, 1}, {1, 1, 1}}, raw().makeBuffer(4, kSource).buffer, 0));
    EXPECT_FALSE(volume.valueRange());
    take(volume.cmdSet(commands, VoxelBox{{1, 1, 1}, {1, 1, 1}}, 10));
    EXPECT_FALSE(volume.valueRange());
    raw().submitAndWait(commands);
}

TEST_F(EditTest, ValuesThatATypeCannotHold) {
    std::mt19937_64 random(testSeed());
    const std::vector<double> refused[] = {{-1, 256, 0.5}, {-32769, 32768, 0.1}, {-1, 65536, 1e300}, {-1e39, 3.41e38}};
    const std::vector<double> taken[] = {{0, 255}, {-32768, 32767}, {0, 65535}, {0.1, -3.4028234663852886e38}};
    for (std::size_t i = 0; i < 4; ++i) {
        const VolumeData data = randomVolume({3, 3, 3}, kTypes[i], random);
        Volume volume = editable(data);
        cpu::Volume onHost = take(cpu::Volume::create(data.view()));
        const VoxelBox box{{0, 0, 0}, {1, 1, 1}};
        const VkCommandBuffer commands = raw().begin();
        std::vector<double> values = refused[i];
        values.insert(values.end(), {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity});
        for (const double value : values) {
            const std::string text = volume.cmdSet(commands, box, value).error().text;
            EXPECT_THAT(text, HasSubstr("is not one that a voxel"));
            EXPECT_EQ(text, onHost.set(box, value).error().text) << "one contract on both sides";
        }
        raw().submitAndWait(commands);
        ASSERT_NO_FATAL_FAILURE(expectSame(volume, data));
        for (const double value : taken[i]) {
            VolumeData edited = data;
            setOnHost(edited, box, value);
            const VkCommandBuffer more = raw().begin();
            take(volume.cmdSet(more, box, value));
            raw().submitAndWait(more);
            ASSERT_NO_FATAL_FAILURE(expectSame(volume, edited));
            EXPECT_TRUE(onHost.set(box, value).ok());
            // A float is held as the nearest one, and the range holds that.
            const double held =
                kTypes[i] == ScalarType::Float32 ? static_cast<double>(static_cast<float>(value)) : value;
            EXPECT_LE(volume.valueRange()->lo, held);
            EXPECT_GE(volume.valueRange()->hi, held);
        }
    }
}

TEST_F(EditTest, BadInputIsRefused) {
    const VolumeData data = makeBytes(unitGrid(4, 5, 6), [](auto...) { return 1.0; });
    Volume fixed = upload(data);
    WrappedVolume wrap;
    wrap.grid = data.grid;
    wrap.format = VK_FORMAT_R8_UNORM;
    wrap.view = raw().makeImage(VK_IMAGE_TYPE_3D, wrap.format, {4, 5, 6}, data.voxels, wrap.layout);
    Volume wrapped = take(Volume::wrap(context(), wrap));
    Volume volume = editable(data);
    const VkBuffer source = raw().makeBuffer(256, kSource).buffer;
    const VoxelBox one{{3, 4, 5}, {1, 1, 1}};
    const VoxelBox beyond{{3, 4, 5}, {1, 2, 1}};
    const std::byte voxels[2] = {};
    const std::span<const std::byte> two(voxels);
    const VkCommandBuffer commands = raw().begin();
    EXPECT_THAT(fixed.cmdSet(commands, one, 1).error().text, HasSubstr("without VolumeOptions::editable"));
    EXPECT_THAT(wrapped.cmdWrite(commands, one, two.first(1)).error().text, HasSubstr("wrapped"));
    EXPECT_THAT(wrapped.cmdCopy(commands, one, source, 0).error().text, HasSubstr("wrapped"));
    EXPECT_THAT(volume.cmdSet(commands, beyond, 1).error().text, HasSubstr("ends at 6 along y"));
    EXPECT_THAT(volume.cmdWrite(commands, beyond, two).error().text, HasSubstr("ends at 6 along y"));
    EXPECT_THAT(volume.cmdCopy(commands, beyond, source, 0).error().text, HasSubstr("ends at 6 along y"));
    EXPECT_FALSE(volume.cmdSet(commands, Ball{{0, 0, 0}, -1}, 1).ok());
    EXPECT_EQ(volume.cmdWrite(commands, one, two).error().text,
              take(cpu::Volume::create(data.view())).write(one, two).error().text)
        << "too many voxels";
    EXPECT_FALSE(volume.cmdWrite(commands, one, {}).ok()) << "too few voxels";
    EXPECT_FALSE(volume.cmdWrite(commands, {}, two).ok()) << "voxels for an empty box";
    EXPECT_THAT(volume.cmdCopy(commands, one, VK_NULL_HANDLE, 0).error().text, HasSubstr("null"));
    EXPECT_THAT(volume.cmdCopy(commands, one, source, 2).error().text, HasSubstr("not a multiple of 4"));
    EXPECT_TRUE(volume.cmdWrite(commands, {}, {}).ok());
    EXPECT_TRUE(volume.cmdCopy(commands, {}, source, 0).ok());
    EXPECT_TRUE(volume.cmdSet(commands, Ball{{500, 0, 0}, 1}, 1).ok()) << "a ball outside";
    raw().submitAndWait(commands);
    ASSERT_NO_FATAL_FAILURE(expectSame(volume, data));

    std::vector<float> floats(8, std::numeric_limits<float>::quiet_NaN());
    Volume real = editable(makeVolume<float>(unitGrid(2), ScalarType::Float32, [](auto...) { return 0.0; }));
    const VkCommandBuffer more = raw().begin();
    EXPECT_THAT(real.cmdWrite(more, {{}, {2, 2, 2}}, std::as_bytes(std::span(floats))).error().text, HasSubstr("NaN"));
    take(real.cmdSet(more, VoxelBox{{}, {1, 1, 1}}, 0.1));
    EXPECT_EQ(real.valueRange()->hi, static_cast<double>(0.1F)) << "what is held";
    raw().submitAndWait(more);
}

} // namespace
} // namespace voxtact::test
