// SPDX-License-Identifier: MIT
// Outputs where a caller's own commands find them: the device's layout, read-back by frames, and room.
#include "outputs_fixture.h"

#include "device/results/results_impl.h"
#include "vulkan/context_impl.h"
#include "vulkan/submit.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class RecordedOutputsTest : public OutputsTest {
  protected:
    /// Detects, and copies everything that the outputs hold on the device by a command of the test's own.
    [[nodiscard]] std::vector<std::uint32_t> wordsAfter(const Detector& detector, const Batch& batch,
                                                        Results& results) const {
        ContextImpl& impl = context().impl();
        const Buffer host = take(makeBuffer(impl, results.impl().outputs->words.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                            MemoryUse::ReadBack, "the test's copy"));
        Submitter submitter = take(Submitter::create(impl, queue()));
        const VkCommandBuffer commandBuffer = take(submitter.begin());
        take(detector.cmdDetect(commandBuffer, batch, results));
        const VkBufferCopy region{0, 0, host.size};
        impl.vk.CmdCopyBuffer(commandBuffer, results.triangleMask().buffer, host.get(), 1, &region);
        take(submitter.submitAndWait());
        take(invalidate(impl, host));
        const auto* mapped = static_cast<const std::uint32_t*>(host.mapped);
        return {mapped, mapped + host.size / sizeof *mapped};
    }

    static std::vector<std::uint32_t> wordsOf(const BufferRange& range, const std::vector<std::uint32_t>& all) {
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(range.offset / 4);
        return {first, first + static_cast<std::ptrdiff_t>(range.size / 4)};
    }
};

/// Bits go on in the next word.
TEST_F(RecordedOutputsTest, AMeshOfMoreTrianglesThanAWordHasBits) {
    constexpr std::uint32_t kTriangles = 40;
    Simple scene = simple();
    MeshData strips;
    for (std::uint32_t strip = 0; strip < kTriangles / 2; ++strip) {
        const MeshData one = makeFlat(strip / 20.0, (strip + 1) / 20.0, 0, 1, 0.5);
        const auto first = static_cast<std::uint32_t>(strips.positions.size() / 3);
        strips.positions.insert(strips.positions.end(), one.positions.begin(), one.positions.end());
        std::ranges::transform(one.indices, std::back_inserter(strips.indices),
                               [first](std::uint32_t index) { return first + index; });
    }
    scene.mesh = upload(strips);
    const BatchItem item = scene.item();
    const View view = flatView(0, 1, 80, 80);
    const Detector detector =
        take(Detector::raster(context(), {.method = CountingMethod::Atomic, .outputs = {.triangles = true}}));
    Results results = take(Results::create(detector, {.maxPairs = 1, .room = {.triangles = kTriangles}}));
    const std::vector<std::uint32_t> all = wordsAfter(detector, {std::span(&item, 1), view, 0.5}, results);
    const std::vector<std::uint32_t> mask = wordsOf(results.triangleMask(), all);
    EXPECT_EQ(mask[0], 0xffffffffU);
    EXPECT_EQ(mask[1], 0xffU);
}

TEST_F(RecordedOutputsTest, TheDevicesLayoutIsAsDocumented) {
    const Simple scene = simple();
    const Mesh cube = upload(makeCube(0.25, 0.75));
    BatchItem items[] = {scene.item(), scene.item()};
    items[0].mesh = &cube;
    const Detector detector =
        take(Detector::raster(context(), {.method = CountingMethod::Atomic, .outputs = kAllOutputs}));
    Results results =
        take(Results::create(detector, {.maxPairs = 3, .room = {.triangles = 20, .labels = 5, .contacts = 8}}));
    const std::vector<std::uint32_t> all = wordsAfter(detector, {items, sixteen(), 0.5}, results);
    const std::vector<std::uint32_t> counts = wordsOf(results.triangleCounts(), all);
    const std::vector<std::uint32_t> mask = wordsOf(results.triangleMask(), all);
    std::uint32_t sum = 0;
    for (std::uint32_t triangle = 0; triangle < 14; ++triangle) {
        // The cube has twelve triangles, the square two: its bits are in the next word.
        const std::uint32_t word = triangle < 12 ? mask[0] >> triangle : mask[1] >> (triangle - 12);
        EXPECT_EQ(word & 1U, counts[triangle] > 0 ? 1U : 0U) << triangle;
        sum += counts[triangle];
    }
    EXPECT_EQ(sum, 128U + 256U);
    EXPECT_EQ(counts[12] + counts[13], 256U);
    EXPECT_EQ(mask[1], 3U);
    const std::vector<std::uint32_t> labels = wordsOf(results.labelCounts(), all);
    EXPECT_EQ((std::vector<std::uint32_t>(labels.begin(), labels.begin() + 4)),
              (std::vector<std::uint32_t>{64, 64, 128, 128}));
    const std::vector<std::uint32_t> bounds = wordsOf(results.bounds(), all);
    const auto bound = [&](std::size_t word) {
        return static_cast<double>(std::bit_cast<float>(VOXTACT_BOUND_BITS(bounds[word])));
    };
    EXPECT_NEAR(-bound(6), 0.5 / 16, 1e-6);
    EXPECT_NEAR(bound(9), 15.5 / 16, 1e-6);
    EXPECT_NEAR(-bound(2), 0.25, 1e-6);
    EXPECT_NEAR(bound(5), 0.75, 1e-6);
    const std::vector<std::uint32_t> contacts = wordsOf(results.contacts(), all);
    EXPECT_EQ((std::vector<std::uint32_t>(contacts.begin(), contacts.begin() + 4)),
              (std::vector<std::uint32_t>{384, 0, 8, 0}));
    for (std::size_t i = 0; i < 8; ++i) {
        ContactResult contact{};
        std::memcpy(&contact, contacts.data() + 4 + 12 * i, sizeof contact);
        EXPECT_LT(contact.pair, 2U);
        EXPECT_LT(contact.triangle, 12U);
        EXPECT_EQ(contact.value, 255);
    }
}

TEST_F(RecordedOutputsTest, ResultsAreUsedAgainAndReadByFrames) {
    const Simple scene = simple();
    const Mat4 away = translation({0, 0, 5});
    BatchItem item = scene.item();
    const Detector detector =
        take(Detector::raster(context(), {.method = CountingMethod::Query, .outputs = kAllOutputs}));
    ResultRing ring = take(ResultRing::create(detector, 2, {.room = {.triangles = 2, .labels = 2, .contacts = 256}}));
    Submitter submitter = take(Submitter::create(context().impl(), queue()));
    for (std::uint64_t frame = 0; frame < 6; ++frame) {
        item.world_from_object = frame % 3 == 0 ? std::span(&away, 1) : std::span(&scene.pose, 1);
        Results* results = take(ring.begin(frame));
        const VkCommandBuffer commandBuffer = take(submitter.begin());
        take(detector.cmdDetect(commandBuffer, {std::span(&item, 1), sixteen(), 0.5}, *results));
        BatchAnswer answer;
        EXPECT_EQ(ring.readOutputs(frame, answer).error().code, ErrorCode::NotReady);
        take(results->cmdReadBack(commandBuffer));
        take(submitter.submitAndWait());
        take(ring.readOutputs(frame, answer));
        const std::uint64_t expected = frame % 3 == 0 ? 0 : 256;
        EXPECT_EQ(answer.contactsFound, expected);
        EXPECT_EQ(answer.contacts.size(), expected);
        EXPECT_EQ(answer.triangles.size(), expected == 0 ? 0U : 2U);
        EXPECT_EQ(answer.bounds[0].has_value(), expected > 0);
        EXPECT_EQ(answer.labels.size(), expected == 0 ? 0U : 2U);
    }
    BatchAnswer answer;
    EXPECT_EQ(ring.readOutputs(1, answer).error().code, ErrorCode::NotReady);
}

TEST_F(RecordedOutputsTest, RoomIsCheckedBeforeAnythingIsRecorded) {
    const Simple scene = simple();
    const BatchItem items[] = {scene.item(), scene.item()};
    const Detector detector = take(Detector::raster(
        context(), {.method = CountingMethod::Atomic, .outputs = {.triangles = true, .labels = true}}));
    const auto refusal = [&](const Detector& of, const OutputRoom& room) {
        Results results = take(Results::create(of, {.maxPairs = 2, .room = room}));
        Submitter submitter = take(Submitter::create(context().impl(), queue()));
        const Result<void> recorded = detector.cmdDetect(take(submitter.begin()), {items, sixteen(), 0.5}, results);
        return recorded.ok() ? std::string() : recorded.error().text;
    };
    const Detector fewer = take(Detector::raster(context(), {.outputs = {.triangles = true, .contacts = true}}));
    const Detector all = take(Detector::raster(context(), {.outputs = kAllOutputs}));
    EXPECT_EQ(refusal(fewer, {.triangles = 4}), "the detector has outputs that the detector of the Results lacks");
    EXPECT_THAT(refusal(detector, {.triangles = 3, .labels = 4}),
                HasSubstr("have 4 triangles, the Results have room for 3"));
    EXPECT_THAT(refusal(detector, {.triangles = 4, .labels = 3}),
                HasSubstr("have 4 labels, the Results have room for 3"));
    EXPECT_EQ(refusal(detector, {.triangles = 4, .labels = 4, .contacts = 0}), "");
    EXPECT_EQ(refusal(all, {.triangles = 4, .labels = 4}), "");
    EXPECT_EQ(Results::create(all, {.room = {.triangles = 4}}).error().text,
              "ResultsDesc::room.labels is 0; the detector has the output labels");
    for (const OutputRoom& room : {OutputRoom{std::numeric_limits<std::uint64_t>::max(), 1, 1},
                                   OutputRoom{1, std::numeric_limits<std::uint64_t>::max(), 1},
                                   OutputRoom{1, 1, std::numeric_limits<std::uint32_t>::max()}}) {
        const Result<Results> results = Results::create(all, {.room = room});
        ASSERT_FALSE(results.ok());
        EXPECT_EQ(results.error().code, ErrorCode::LimitExceeded);
        EXPECT_THAT(results.error().text, HasSubstr("maxStorageBufferRange"));
    }
}

} // namespace
} // namespace voxtact::test
