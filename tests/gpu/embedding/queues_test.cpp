// SPDX-License-Identifier: MIT
// The queues between the passes of the projection `certified`: answers do not depend on their room.
#include "device/touch/certified_queues.h"
#include "device/touch/certified_rounds.h"
#include "exact/shared.h"
#include "raw_fixture.h"

#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class QueuesTest : public RawGpuTest {
  protected:
    /// What a batch gives where so many clusters are examined at once.
    BatchAnswer detect(const AnyDesc& desc, const Batch& batch, std::uint32_t pairs, std::uint32_t clusters) {
        const Detector detector = take(Detector::create(context(), desc));
        Results results = take(Results::create(
            detector,
            {.maxPairs = pairs, .room = {.triangles = std::size_t{pairs} * 4096}, .clustersAtOnce = clusters}));
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        BatchAnswer answer;
        take(results.readOutputs(answer));
        const std::span<const PairResult> found = take(results.read());
        for (const PairResult& pair : found) {
            answer.pairs.push_back(unpack(pair));
        }
        return answer;
    }
};

void expectSame(const BatchAnswer& device, const BatchAnswer& host, const std::string& which) {
    ASSERT_EQ(device.pairs.size(), host.pairs.size()) << which;
    for (std::size_t i = 0; i < host.pairs.size(); ++i) {
        EXPECT_EQ(device.pairs[i].count, host.pairs[i].count) << which << ", pair " << i;
        EXPECT_EQ(device.pairs[i].possible, host.pairs[i].possible) << which << ", pair " << i;
        EXPECT_EQ(device.pairs[i].exactness, host.pairs[i].exactness) << which << ", pair " << i;
    }
    ASSERT_EQ(device.triangles.size(), host.triangles.size()) << which;
    for (std::size_t i = 0; i < host.triangles.size(); ++i) {
        EXPECT_EQ(device.triangles[i].triangle, host.triangles[i].triangle) << which;
        EXPECT_EQ(device.triangles[i].count, host.triangles[i].count) << which;
    }
}

/// Triangles about the origin in any direction, of such a size.
MeshData hugeTriangles(std::uint32_t count, double size, std::mt19937_64& random) {
    MeshData out;
    for (std::uint32_t corner = 0; corner < 3 * count; ++corner) {
        const double turn = 2.0943951 * (corner % 3) + uniform(random, -0.3, 0.3);
        const double height = uniform(random, -0.4, 0.4);
        const std::array<double, 3> place{size * std::cos(turn), size * std::sin(turn), size * height};
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            out.positions.push_back(static_cast<float>(place[(axis + corner / 3) % 3]));
        }
        out.indices.push_back(corner);
    }
    return out;
}

/// A scalpel of small triangles, and one whose triangles are large: with room for all, and with queues that hold a few
/// triangles' cells, so that nearly everything is left to the last pass.
TEST_F(QueuesTest, NoAnswerDependsOnTheirRoom) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunctionDesc table{points, {0, 255}, kDefaultTableSize};
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
    const cpu::Volume hostVolume = take(cpu::Volume::create(head.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
    const std::vector<Mat4> poses = randomPoses(head.grid, 3, 1, random);
    for (const char* source : {"scalpel:1500", "scalpel:100"}) {
        const MeshData data = take(makeBuiltinMesh(source));
        const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
        const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
        const BatchItem item{&mesh, &volume, &function, poses};
        const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
        struct Question {
            Outputs outputs;
            bool stopAtFirst;
        };
        // Without outputs, cells that are opaque all over are counted at once.
        for (const auto& [outputs, stopAtFirst] : {Question{{.triangles = true}, false}, {{}, false}, {{}, true}}) {
            const BatchAnswer onHost =
                take(take(cpu::Detector::create(
                              {.stopAtFirst = stopAtFirst, .projection = Projection::Certified, .outputs = outputs}))
                         .detect({{&hostItem, 1}, {}, kDefaultThreshold}));
            const AnyDesc desc{.method = CountingMethod::Compute,
                               .projection = Projection::Certified,
                               .outputs = outputs,
                               .stopAtFirst = stopAtFirst};
            for (const std::uint32_t clusters : {16U, 16384U, kMostQueueRoom}) {
                const auto pairs = static_cast<std::uint32_t>(poses.size());
                expectSame(detect(desc, {{&item, 1}, {}, kDefaultThreshold}, pairs, clusters), onHost,
                           std::string(source) + ", " + std::to_string(clusters) + " clusters at once, seed " +
                               std::to_string(seed));
            }
        }
    }
}

/// Triangles through the whole of a volume, obliquely: some 10,000 cells each, which the last pass finds and decides.
/// More than llvmpipe lets one invocation do (docs/facts.md), and of several pairs in a work group.
TEST_F(QueuesTest, HugeTrianglesThatAreLeftAreCountedWhole) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    // A cell of noise takes many pieces.
    const VolumeData ball = take(makeBuiltinVolume("sphere:128"));
    const VolumeData noise = makeBytes(ball.grid, [&](auto...) { return static_cast<double>(random() % 256); });
    const std::array ramp{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const std::array peak{ControlPoint{120, 0}, ControlPoint{122, 1}, ControlPoint{124, 0}};
    struct Noise {
        const VolumeData& image;
        std::span<const ControlPoint> points;
        double threshold;
        std::uint32_t clusters;
    };
    const std::array poses{identity(), translation({1e4, 0, 0}), translation({-1, 2.5, 3})};
    const MeshData data = hugeTriangles(4, 0.9 * 128, random);
    const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
    const AnyDesc desc{
        .method = CountingMethod::Compute, .projection = Projection::Certified, .outputs = {.triangles = true}};
    for (const Noise& scene :
         {Noise{ball, ramp, 0.05, 16}, Noise{ball, ramp, 0.05, 2048}, Noise{noise, peak, 0.5, 16}}) {
        const TransferFunctionDesc table{scene.points, {0, 255}, kDefaultTableSize};
        const Volume volume = take(Volume::upload(context(), queue(), scene.image.view(), {.bricks = true}));
        const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
        const cpu::Volume hostVolume = take(cpu::Volume::create(scene.image.view()));
        const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
        const BatchItem item{&mesh, &volume, &function, poses};
        const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
        const BatchAnswer onHost =
            take(take(cpu::Detector::create({.projection = Projection::Certified, .outputs = {.triangles = true}}))
                     .detect({{&hostItem, 1}, {}, scene.threshold}));
        EXPECT_GT(onHost.pairs[0].count, 10000U);
        expectSame(detect(desc, {{&item, 1}, {}, scene.threshold}, 3, scene.clusters), onHost,
                   std::to_string(scene.clusters) + " clusters at once, seed " + std::to_string(seed));
    }
}

/// Cells that are opaque all over are counted before the list of the others has its room. Where that is refused, the
/// last pass counts all of them, and they must not have been counted before: by large triangles and by small ones.
TEST_F(QueuesTest, WhatIsCountedWithoutADecisionIsCountedOnce) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData grid = take(makeBuiltinVolume("sphere:64"));
    // Blocks of noise and opaque ones: each brick has cells of both kinds.
    const VolumeData mixed = makeBytes(grid.grid, [&](auto x, auto y, auto z) {
        const auto block =
            static_cast<std::uint32_t>(x) / 4 + static_cast<std::uint32_t>(y) / 4 + static_cast<std::uint32_t>(z) / 4;
        return block % 2 == 0 ? 255.0 : static_cast<double>(random() % 80);
    });
    const std::array ramp{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const TransferFunctionDesc table{ramp, {0, 255}, kDefaultTableSize};
    const Volume volume = take(Volume::upload(context(), queue(), mixed.view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
    const cpu::Volume hostVolume = take(cpu::Volume::create(mixed.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
    const std::array poses{identity(), translation({1e4, 0, 0}), translation({-1, 2.5, 3})};
    for (const MeshData& data : {hugeTriangles(4, 0.9 * 64, random), take(makeBuiltinMesh("ellipsoid:4000"))}) {
        const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
        const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
        const BatchItem item{&mesh, &volume, &function, poses};
        const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
        const BatchAnswer onHost = take(take(cpu::Detector::create({.projection = Projection::Certified}))
                                            .detect({{&hostItem, 1}, {}, kDefaultThreshold}));
        EXPECT_GT(onHost.pairs[0].count, 1000U);
        const AnyDesc desc{.method = CountingMethod::Compute, .projection = Projection::Certified};
        // At 96 and 128 there is room for parts of large triangles, and not for all of their cells.
        for (const std::uint32_t clusters : {16U, 96U, 128U, 16384U}) {
            expectSame(detect(desc, {{&item, 1}, {}, kDefaultThreshold}, 3, clusters), onHost,
                       std::to_string(data.indices.size() / 3) + " triangles, " + std::to_string(clusters) +
                           " clusters at once, seed " + std::to_string(seed));
        }
    }
}

/// Where a list of cells has no more room, what is left of the queue is no pair's: it is not taken for the first cell
/// of the first triangle of the first pair, which all of these triangles touch.
TEST_F(QueuesTest, WhatIsLeftOfAFullQueueIsNoCell) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData solid = makeBytes(take(makeBuiltinVolume("sphere:96")).grid, [](auto...) { return 200.0; });
    const std::array ramp{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const TransferFunctionDesc table{ramp, {0, 255}, kDefaultTableSize};
    const auto place = [&](double x, double y, double z) {
        return transformPoint(worldFromIndex(solid.grid), {x, y, z});
    };
    MeshData data;
    for (std::uint32_t triangle = 0; triangle < 6; ++triangle) {
        const auto across = [&] { return uniform(random, 20, 95); };
        const auto corner = [&] { return uniform(random, -0.4, -0.1); };
        for (const Vec3& at :
             {place(corner(), corner(), corner()), place(95, across(), across()), place(across(), 95, across())}) {
            for (const double coordinate : at) {
                data.positions.push_back(static_cast<float>(coordinate));
            }
            data.indices.push_back(static_cast<std::uint32_t>(data.indices.size()));
        }
    }
    const Volume volume = take(Volume::upload(context(), queue(), solid.view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
    const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
    const cpu::Volume hostVolume = take(cpu::Volume::create(solid.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
    const std::array poses{identity(), identity()};
    const BatchItem item{&mesh, &volume, &function, poses};
    const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
    const AnyDesc desc{
        .method = CountingMethod::Compute, .projection = Projection::Certified, .outputs = {.triangles = true}};
    const BatchAnswer onHost =
        take(take(cpu::Detector::create({.projection = Projection::Certified, .outputs = {.triangles = true}}))
                 .detect({{&hostItem, 1}, {}, kDefaultThreshold}));
    EXPECT_GT(onHost.pairs[0].count, 10000U);
    for (const std::uint32_t clusters : {1024U, 2048U}) {
        expectSame(detect(desc, {{&item, 1}, {}, kDefaultThreshold}, 2, clusters), onHost,
                   std::to_string(clusters) + " clusters at once, seed " + std::to_string(seed));
    }
}

/// More rounds than there are headers of queues: a round does not find what an earlier one has left in its header.
TEST_F(QueuesTest, RoundsBeyondTheHeadersBeginEmpty) {
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const MeshData data = take(makeBuiltinMesh("scalpel:500")); // 8 clusters, 4 of them a round
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunctionDesc table{points, {0, 255}, kDefaultTableSize};
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
    const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
    const cpu::Volume hostVolume = take(cpu::Volume::create(head.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
    std::vector<Mat4> poses(3 * VOXTACT_HEADERS, translation({1e4, 0, 0}));
    poses.front() = poses[VOXTACT_HEADERS] = poses.back() = identity();
    const BatchItem item{&mesh, &volume, &function, poses};
    const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
    const BatchAnswer onHost = take(take(cpu::Detector::create({.projection = Projection::Certified}))
                                        .detect({{&hostItem, 1}, {}, kDefaultThreshold}));
    EXPECT_GT(onHost.pairs[0].count, 0U);
    EXPECT_EQ(onHost.pairs[1].count, 0U);
    expectSame(detect({.method = CountingMethod::Compute, .projection = Projection::Certified},
                      {{&item, 1}, {}, kDefaultThreshold}, static_cast<std::uint32_t>(poses.size()), 16),
               onHost, "16 clusters at once");
}

TEST_F(QueuesTest, RoomsThatCannotBe) {
    const Detector detector = take(Detector::certified(context()));
    for (const std::uint32_t clusters : {1U, 15U, 262145U}) {
        const Result<Results> refused = Results::create(detector, {.clustersAtOnce = clusters});
        ASSERT_FALSE(refused.ok());
        EXPECT_THAT(refused.error().text, HasSubstr("ResultsDesc::clustersAtOnce is " + std::to_string(clusters)));
    }
}

TEST(RoomTest, IsWhatWasAskedForOrWhatTheDeviceAllows) {
    constexpr VkDeviceSize kMuch = VkDeviceSize{1} << 33U;
    const RoomLimits any{kMuch, kMuch, kMostRoomAnywhere};
    const RoomLimits large{kMuch, kMuch, kMostQueueRoom};
    const RoomLimits little{kMuch, VkDeviceSize{64} << 20U, kMostQueueRoom};
    const RoomLimits tight{VkDeviceSize{1} << 20U, kMuch, kMostQueueRoom};
    const auto room = [](std::uint32_t clusters, std::uint32_t pairs, const RoomLimits& limits) {
        return queueRoomFor({.maxPairs = pairs, .clustersAtOnce = clusters}, limits, 0);
    };
    // By the pairs, up to what the device allows.
    EXPECT_EQ(room(0, 1, large), kUsualQueueRoom);
    EXPECT_EQ(room(0, 100, large), 128U * 64);
    EXPECT_EQ(room(0, 1000, any), kMostRoomAnywhere);
    EXPECT_EQ(room(0, 1000, large), 65536U);
    EXPECT_EQ(room(0, 1U << 30U, large), kMostQueueRoom);
    // No more of its memory than usual, unless that is asked for.
    EXPECT_EQ(room(0, 1U << 30U, little), 65536U);
    EXPECT_LE(queueBytes(65536), little.usualBytes);
    EXPECT_EQ(room(kMostQueueRoom, 1, little), kMostQueueRoom);
    EXPECT_EQ(room(0, 1U << 30U, {kMuch, 0, kMostQueueRoom}), kMostRoomAnywhere);
    // What is asked for, in steps of 16.
    EXPECT_EQ(room(kMostQueueRoom, 1, any), kMostRoomAnywhere);
    EXPECT_EQ(room(1000, 1, any), 992U);
    // The buffer is the last word.
    EXPECT_LE(queueBytes(room(0, 1U << 30U, tight)), tight.bytes);
    EXPECT_GT(queueBytes(2 * room(0, 1U << 30U, tight)), tight.bytes);
    EXPECT_EQ(room(0, 1, {1000, kMuch, kMostQueueRoom}), 0U);
}

/// Only their number bounds what the clusters of a mesh ask for whose vertices the host does not know.
TEST(RoomTest, ClustersOfAnUnknownMeshHaveTheOldBound) {
    const std::array<double, 2> before{0, 1};
    const MeshLooks known{.pairs = 1, .clusters = 1, .before = before};
    for (const bool stopAtFirst : {false, true}) {
        EXPECT_EQ(clustersOf(known, kMostQueueRoom, stopAtFirst), clustersOfRound(kMostQueueRoom, stopAtFirst));
        EXPECT_EQ(clustersOf({}, kMostQueueRoom, stopAtFirst), clustersOfRound(kMostRoomAnywhere, stopAtFirst));
        EXPECT_EQ(clustersOf({}, 2048, stopAtFirst), clustersOfRound(2048, stopAtFirst));
    }
}

TEST(RoomTest, FollowsTheWorkGroupsAndTheMemoryOfADevice) {
    VkPhysicalDeviceLimits device{};
    device.maxStorageBufferRange = UINT32_MAX;
    VkPhysicalDeviceMemoryProperties memory{};
    memory.memoryHeapCount = 2;
    memory.memoryHeaps[0] = {VkDeviceSize{1} << 40U, 0}; // the host's
    memory.memoryHeaps[1] = {VkDeviceSize{8} << 30U, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    for (const auto& [groups, room] : {std::pair{65535U, 16384U},
                                       {131069U, 16384U},
                                       {131070U, 32768U},
                                       {196605U, 32768U},
                                       {655350U, 131072U},
                                       {0x7fffffffU, kMostQueueRoom},
                                       {UINT32_MAX, kMostQueueRoom}}) {
        device.maxComputeWorkGroupCount[0] = groups;
        const RoomLimits limits = roomLimits(device, VkDeviceSize{1} << 31U, memory);
        EXPECT_EQ(limits.room, room) << groups;
        EXPECT_EQ(limits.bytes, VkDeviceSize{1} << 31U);
        EXPECT_EQ(limits.usualBytes, VkDeviceSize{64} << 20U);
        EXPECT_LE(room, groups);
    }
}

TEST_F(QueuesTest, ResultsAreForDetectorsOfTheirKind) {
    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
    const Batch batch{{&item, 1}, flatView(0, 1, 64, 64), 0.5};
    const Detector view = take(Detector::raster(context(), {.method = CountingMethod::Compute}));
    const Detector dominant =
        take(Detector::raster(context(), {.method = CountingMethod::Compute, .projection = Projection::DominantAxis}));
    const Detector certified = take(Detector::certified(context()));
    const Detector yesNo = take(Detector::certified(context(), {.stopAtFirst = true}));
    Results ofView = take(Results::create(view, {}));
    Results ofCertified = take(Results::create(certified, {}));
    EXPECT_EQ(ofView.impl().queueRoom, 0U);
    EXPECT_EQ(ofCertified.impl().queueRoom, kUsualQueueRoom);
    const VkCommandBuffer commands = raw().begin();
    take(dominant.cmdDetect(commands, batch, ofView));
    take(yesNo.cmdDetect(commands, batch, ofCertified));
    EXPECT_EQ(certified.cmdDetect(commands, batch, ofView).error().text,
              "the detector is certified, and the Results are not of a certified one");
    EXPECT_EQ(view.cmdDetect(commands, batch, ofCertified).error().text,
              "the Results are of a certified detector, and this one is not certified");
    raw().submitAndWait(commands);
}

} // namespace
} // namespace voxtact::test
