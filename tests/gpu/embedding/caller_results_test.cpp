// SPDX-License-Identifier: MIT
// Results in a part of the caller's buffer: the bytes of Results with a buffer of their own, and no byte beside them.
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr VkBufferUsageFlags kUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr std::byte kUntouched{0xcd};
constexpr VkDeviceSize kAhead = 512; // a descriptor may begin there on every device

std::vector<std::byte> bytesOf(std::span<const PairResult> results) {
    const auto bytes = std::as_bytes(results);
    return {bytes.begin(), bytes.end()};
}

class CallerResultsTest : public RawGpuTest {
  protected:
    RawVulkan::HostBuffer untouched(VkDeviceSize size) {
        return raw().makeBuffer(std::span<const std::byte>(std::vector<std::byte>(size, kUntouched)), kUsage);
    }
    /// Everything that a detector can be made for, with poses from the host and from the device.
    std::vector<AnyDesc> detectors() {
        std::vector<AnyDesc> out;
        for (const Projection projection : projections()) {
            for (const CountingMethod method : countingMethods()) {
                if (method == CountingMethod::Cpu || !context().supports(method, projection)) {
                    continue;
                }
                for (const bool devicePoses : {false, true}) {
                    out.push_back({.method = method, .projection = projection, .devicePoses = devicePoses});
                }
            }
        }
        return out;
    }
    void run(const Detector& detector, const Batch& batch, Results& results) {
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
    }
    std::string refusal(const ResultsDesc& desc) {
        const Result<Results> made = Results::create(take(Detector::raster(context(), {})), desc);
        if (made.ok()) {
            return "it is not refused";
        }
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        return made.error().text;
    }
};

/// A head and a scalpel, some poses of which touch.
struct HeadAndScalpel {
    VolumeData head = take(makeBuiltinVolume("head:32"));
    Volume volume;
    TransferFunction function;
    Mesh mesh;
    View view{framingCamera(head.grid, 128, 128), 128, 128};
    std::vector<Mat4> poses;

    HeadAndScalpel(const Context& context, const QueueAccess& queue, std::mt19937_64& random)
        : volume(take(Volume::upload(context, queue, head.view(), {.bricks = true}))),
          function(take(TransferFunction::upload(context, queue,
                                                 {std::array{ControlPoint{40, 0}, ControlPoint{80, 1}}, {0, 255}}))),
          mesh(take(Mesh::upload(context, queue, take(makeScalpel()).view(), {.clusters = true}))),
          poses(randomPoses(head.grid, 21, 1, random)) {
        for (Mat4& pose : poses) { // as a buffer of poses has them
            std::ranges::transform(pose, pose.begin(), [](double element) { return static_cast<float>(element); });
        }
    }
};

TEST_F(CallerResultsTest, EveryDetectorWritesWhatItWouldWriteIntoItsOwn) {
    std::mt19937_64 random(testSeed());
    const HeadAndScalpel scene(context(), queue(), random);
    std::vector<float> floats;
    for (const Mat4& pose : scene.poses) {
        std::ranges::transform(pose, std::back_inserter(floats),
                               [](double element) { return static_cast<float>(element); });
    }
    const RawVulkan::HostBuffer poses =
        raw().makeBuffer(std::span<const float>(floats), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const PoseBuffer onDevice = take(
        PoseBuffer::wrap(context(), {.buffer = poses.buffer, .count = static_cast<std::uint32_t>(scene.poses.size())}));
    // More room than the batch needs: what is behind its pairs is not written either.
    constexpr std::uint32_t kRoom = 30;
    const VkDeviceSize room = kRoom * sizeof(PairResult);
    const VkDeviceSize written = scene.poses.size() * sizeof(PairResult);
    std::size_t hits = 0;
    for (const AnyDesc& desc : detectors()) {
        SCOPED_TRACE(std::string(toString(desc.projection)) + " " + toString(desc.method) +
                     (desc.devicePoses ? ", poses on the device" : ""));
        const Detector detector = take(Detector::create(context(), desc));
        BatchItem item{&scene.mesh, &scene.volume, &scene.function};
        if (desc.devicePoses) {
            item.poses = &onDevice;
        } else {
            item.world_from_object = scene.poses;
        }
        const Batch batch{std::span(&item, 1), scene.view, kDefaultThreshold};
        Results own = take(Results::create(detector, {.maxPairs = kRoom}));
        run(detector, batch, own);
        const std::vector<std::byte> wanted = bytesOf(take(own.read()));

        const RawVulkan::HostBuffer mine = untouched(kAhead + room + kAhead);
        Results results =
            take(Results::create(detector, {.maxPairs = kRoom, .into = {mine.buffer, kAhead, room + kAhead}}));
        EXPECT_EQ(results.buffer(), mine.buffer);
        EXPECT_EQ(results.pairResults().offset, kAhead);
        EXPECT_EQ(results.pairResults().size, room);
        run(detector, batch, results);
        EXPECT_EQ(bytesOf(take(results.read())), wanted);
        const std::vector<std::byte> found = raw().readBuffer(mine.buffer, kAhead + room + kAhead);
        EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), found.begin() + kAhead));
        const auto isUntouched = [](std::byte byte) { return byte == kUntouched; };
        EXPECT_TRUE(std::all_of(found.begin(), found.begin() + kAhead, isUntouched));
        EXPECT_TRUE(
            std::all_of(found.begin() + static_cast<std::ptrdiff_t>(kAhead + written), found.end(), isUntouched));
        hits += static_cast<std::size_t>(
            std::ranges::count_if(take(results.read()), [](const PairResult& pair) { return pair.countLow > 0; }));
    }
    EXPECT_GT(hits, 20U);
}

/// The outputs have buffers of their own, and find the pairs in the caller's.
TEST_F(CallerResultsTest, OutputsAreThoseOfResultsWithABufferOfTheirOwn) {
    std::mt19937_64 random(testSeed());
    const HeadAndScalpel scene(context(), queue(), random);
    const BatchItem item{&scene.mesh, &scene.volume, &scene.function, scene.poses};
    const Batch batch{std::span(&item, 1), scene.view, kDefaultThreshold};
    for (const AnyDesc& each : detectors()) {
        AnyDesc desc = each;
        desc.outputs = {.triangles = true, .contacts = true, .bounds = true};
        if (desc.devicePoses || desc.method == CountingMethod::QueryAny) {
            continue;
        }
        SCOPED_TRACE(std::string(toString(desc.projection)) + " " + toString(desc.method));
        const Detector detector = take(Detector::create(context(), desc));
        const RawVulkan::HostBuffer mine = untouched(kAhead + 30 * sizeof(PairResult));
        ResultsDesc resultsDesc{.maxPairs = 30, .room = {.triangles = std::uint64_t{30} * scene.mesh.triangles()}};
        BatchAnswer wanted;
        BatchAnswer found;
        for (BatchAnswer* answer : {&wanted, &found}) {
            Results results = take(Results::create(detector, resultsDesc));
            run(detector, batch, results);
            take(results.readOutputs(*answer));
            resultsDesc.into = {mine.buffer, kAhead, 30 * sizeof(PairResult)};
        }
        EXPECT_EQ(found.contactsFound, wanted.contactsFound);
        EXPECT_GT(found.contactsFound, 0U);
        ASSERT_EQ(found.bounds.size(), wanted.bounds.size());
        for (std::size_t pair = 0; pair < wanted.bounds.size(); ++pair) {
            ASSERT_EQ(found.bounds[pair].has_value(), wanted.bounds[pair].has_value());
            EXPECT_TRUE(!wanted.bounds[pair] || (found.bounds[pair]->lo == wanted.bounds[pair]->lo &&
                                                 found.bounds[pair]->hi == wanted.bounds[pair]->hi));
        }
        EXPECT_TRUE(std::ranges::equal(found.triangles, wanted.triangles,
                                       [](const TouchedTriangle& a, const TouchedTriangle& b) {
                                           return a.pair == b.pair && a.triangle == b.triangle && a.count == b.count;
                                       }));
    }
}

TEST_F(CallerResultsTest, EachFrameOfARingHasItsPart) {
    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Detector detector = take(Detector::raster(context(), {.method = CountingMethod::Atomic}));
    constexpr std::uint32_t kFrames = 3;
    constexpr std::uint32_t kPairs = 11; // 264 bytes: two multiples of 256
    static_assert(resultBytes(kPairs) == 512);
    const VkDeviceSize size = (kFrames - 1) * resultBytes(kPairs) + kPairs * sizeof(PairResult);
    const RawVulkan::HostBuffer mine = untouched(kAhead + size);
    ResultRing ring =
        take(ResultRing::create(detector, kFrames, {.maxPairs = kPairs, .into = {mine.buffer, kAhead, size}}));
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        std::vector<Mat4> poses(kPairs, translation({0, 0, 9}));
        std::fill_n(poses.begin(), frame + 1, identity());
        const BatchItem item{&mesh, &volume, &function, poses};
        run(detector, {std::span(&item, 1), flatView(0, 1, 8, 8), 0.5}, *take(ring.begin(frame)));
    }
    const std::vector<std::byte> found = raw().readBuffer(mine.buffer, kAhead + size);
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        const std::size_t first = kAhead + frame * resultBytes(kPairs);
        std::array<PairResult, kPairs> results{};
        std::memcpy(results.data(), found.data() + first, sizeof results);
        EXPECT_EQ(bytesOf(take(ring.read(frame))), bytesOf(results));
        EXPECT_EQ(std::ranges::count_if(results, [](const PairResult& pair) { return pair.countLow == 64; }),
                  static_cast<std::ptrdiff_t>(frame + 1));
    }
}

/// Who reads the words on the device finds 0 or 1 where yes or no is asked, however many survivors come at once: here
/// no vertex is in the volume, and many cells of a triangle are certain.
TEST_F(CallerResultsTest, AYesIsOne) {
    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(20), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(-3, 4, -2.5, 3.5, 0.43));
    const std::vector<Mat4> poses(10, identity());
    const BatchItem item{&mesh, &volume, &function, poses};
    for (const bool yesNo : {false, true}) {
        const Detector detector = take(Detector::certified(context(), {.stopAtFirst = yesNo}));
        Results results = take(Results::create(detector, {.maxPairs = 10}));
        run(detector, {{&item, 1}}, results);
        for (const PairResult& pair : take(results.read())) {
            EXPECT_EQ(pair.countLow == 1, yesNo) << "pair " << pair.pair << ": " << pair.countLow;
        }
    }
}

TEST_F(CallerResultsTest, WhatHasNoRoomIsRefusedByName) {
    const RawVulkan::HostBuffer mine = untouched(4096);
    EXPECT_THAT(refusal({.maxPairs = 10, .into = {mine.buffer, 0, 239}}),
                HasSubstr("ResultsDesc::into has 239 bytes, 10 pairs need 240"));
    EXPECT_THAT(refusal({.maxPairs = 10, .into = {mine.buffer, 0, VK_WHOLE_SIZE}}),
                HasSubstr("ResultsDesc::into has the size VK_WHOLE_SIZE"));
    EXPECT_THAT(refusal({.maxPairs = 10, .into = {mine.buffer, 4, 240}}),
                HasSubstr("ResultsDesc::into begins at byte 4; on this device that must be a multiple of "));
    for (const BufferRange nowhere : {BufferRange{VK_NULL_HANDLE, 64, 0}, BufferRange{VK_NULL_HANDLE, 0, 240}}) {
        EXPECT_THAT(refusal({.maxPairs = 10, .into = nowhere}), HasSubstr("an offset or a size, but no buffer"));
    }
    const VkDeviceSize last = std::numeric_limits<VkDeviceSize>::max() / 4096 * 4096;
    EXPECT_THAT(refusal({.maxPairs = 10, .into = {mine.buffer, last, 4096}}),
                HasSubstr("ResultsDesc::into of 4096 bytes cannot begin at byte " + std::to_string(last)));
    const Detector detector = take(Detector::raster(context(), {}));
    const Result<ResultRing> ring = ResultRing::create(detector, 3, {.maxPairs = 10, .into = {mine.buffer, 0, 751}});
    ASSERT_FALSE(ring.ok());
    EXPECT_THAT(ring.error().text, HasSubstr("ResultsDesc::into has 751 bytes, 3 frames of 10 pairs need 752"));
    EXPECT_TRUE(ResultRing::create(detector, 3, {.maxPairs = 10, .into = {mine.buffer, 0, 752}}).ok());
    EXPECT_FALSE(ResultRing::create(detector, 3, {.maxPairs = 10, .into = {mine.buffer, 0, VK_WHOLE_SIZE}}).ok());
}

} // namespace
} // namespace voxtact::test
