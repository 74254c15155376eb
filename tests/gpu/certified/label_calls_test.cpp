// SPDX-License-Identifier: MIT
// Clearances to labels on the device: what is asked together, what each call says of itself, and what is refused.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/label_searches.h"
#include "core/base/infinity.h"
#include "few_kinds.h"
#include "gpu/context_impl.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class LabelCallsTest : public CertifiedTest {};

/// Head, scalpel and a map of blocks: what is asked together, and what each call says of itself.
struct LabelledHead : Head {
    LabelData labels;
    LabelMap map;

    LabelledHead(const Context& context, const QueueAccess& queue, std::size_t count, std::uint64_t seed,
                 LabelData given)
        : Head(context, queue, take(makeBuiltinMesh("scalpel:300")), count, seed), labels(std::move(given)),
          map(take(LabelMap::upload(context, queue, labels))) {
        item.labels = &map;
    }
    [[nodiscard]] Batch batch(std::span<const std::int32_t> asked) const {
        return {{&item, 1}, {}, kDefaultThreshold, asked};
    }
    [[nodiscard]] std::vector<LabelClearance> onHost(std::span<const std::int32_t> asked,
                                                     const cpu::ClearanceDesc& desc = {.threads = 1}) const {
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create(desc));
        cpu::BatchItem of = hostItem();
        of.labels = &labels;
        return take(meter.measureLabels({{&of, 1}, {}, kDefaultThreshold}, asked)).labels;
    }
};

/// Blocks of 8 voxels, numbered one after the other.
LabelData blocks(const Grid& grid) {
    return mapOf(grid, [](auto x, auto y, auto z) { return static_cast<double>(x / 8 + 6 * (y / 8) + 36 * (z / 8)); });
}

Grid headGrid() {
    return take(makeBuiltinVolume("head:48")).grid;
}

/// More labels than a node has bits, so that numbers share some: all of them are still told apart.
TEST_F(LabelCallsTest, OfMoreLabelsThanNodesTellApart) {
    constexpr std::uint32_t kPoses = 6;
    constexpr double kTolerance = 0.05; // mm
    const std::uint64_t seed = testSeed();
    const LabelledHead scene(context(), queue(), kPoses, seed, blocks(headGrid()));
    ASSERT_GT(scene.labels.values.size(), 128U);
    // 20 and 148 share a bit, and so do 86 and 214.
    const std::array<std::int32_t, 6> asked{20, 148, 86, 214, 128, 0};
    for (const bool anyOpacity : {false, true}) {
        const std::vector<LabelClearance> host = scene.onHost(asked, {.threads = 1, .labelsAtAnyOpacity = anyOpacity});
        const Answered found =
            detect(toLabels({.tolerance = kTolerance}, anyOpacity), scene.batch(asked), kPoses, 2048);
        ASSERT_EQ(found.labels.size(), host.size());
        for (std::size_t i = 0; i < host.size(); ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(i));
            EXPECT_EQ(found.labels[i].pair, host[i].pair);
            EXPECT_EQ(found.labels[i].pose, host[i].pose);
            EXPECT_EQ(found.labels[i].label, host[i].label);
            expectBothCanBe(found.labels[i].bounds, host[i].bounds);
            // What is a hundred voxels away single precision may know a little less well.
            EXPECT_NE(found.labels[i].end, ClearanceEnd::Budget);
            if (host[i].bounds.hi < kInfinity) {
                EXPECT_LE(found.labels[i].bounds.hi - found.labels[i].bounds.lo, 3 * kTolerance);
            }
        }
        const std::vector<PairClearance> all = found.clearances;
        for (std::size_t i = 0; i < host.size() && !anyOpacity; ++i) {
            EXPECT_LE(all.at(found.labels[i].pair).bounds.lo, found.labels[i].bounds.hi) << "a part is no nearer";
        }
    }
}

TEST_F(LabelCallsTest, BeyondTheMaximumNothingIsMeasured) {
    constexpr std::uint32_t kPoses = 12;
    const std::uint64_t seed = testSeed();
    const LabelledHead scene(context(), queue(), kPoses, seed,
                             mapOf(headGrid(), [](auto x, auto, auto) { return x < 24 ? 1.0 : 2.0; }));
    const std::array<std::int32_t, 3> asked{1, 9, 2};
    const std::vector<LabelClearance> all = scene.onHost(asked);
    std::size_t beyond = 0;
    for (const double maximum : {0.5, 10.0}) {
        const Answered found = detect(toLabels({.maximum = maximum}), scene.batch(asked), kPoses, 2048);
        for (std::size_t i = 0; i < all.size(); ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(i) + ", maximum " +
                         std::to_string(maximum));
            const LabelClearance& label = found.labels.at(i);
            if (label.label == 9) {
                EXPECT_EQ(label.bounds.lo, kInfinity) << "the map has it not";
                EXPECT_EQ(label.end, ClearanceEnd::Closed);
            } else if (label.end == ClearanceEnd::Beyond) {
                EXPECT_EQ(label.bounds.lo, maximum);
                EXPECT_EQ(label.bounds.hi, kInfinity);
                EXPECT_GE(all[i].bounds.hi, maximum);
                ++beyond;
            } else {
                EXPECT_LE(all[i].bounds.lo, maximum * (1 + 1e-4));
                expectBothCanBe(label.bounds, all[i].bounds);
            }
        }
    }
    EXPECT_GT(beyond, 0U);
}

/// Each item has a map of its own, which knows other labels by other numbers.
TEST_F(LabelCallsTest, OfSeveralItems) {
    constexpr std::uint32_t kPoses = 3;
    const std::uint64_t seed = testSeed();
    const LabelledHead first(context(), queue(), kPoses, seed,
                             mapOf(headGrid(), [](auto x, auto, auto) { return x < 24 ? 1.0 : 200.0; }));
    const LabelledHead second(context(), queue(), kPoses, seed + 1,
                              mapOf(headGrid(), [](auto, auto y, auto) { return y < 24 ? 200.0 : 3.0; }));
    const BatchItem items[] = {first.item, second.item};
    const std::array<std::int32_t, 3> asked{200, 1, 3};
    const Answered found = detect(toLabels(), {items, {}, kDefaultThreshold, asked}, 2 * kPoses, 2048);
    std::vector<LabelClearance> host = first.onHost(asked);
    for (const LabelClearance& label : second.onHost(asked)) {
        host.push_back(label);
    }
    ASSERT_EQ(found.labels.size(), host.size());
    for (std::size_t i = 0; i < host.size(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(i));
        EXPECT_EQ(found.labels[i].item, i / (kPoses * asked.size()));
        EXPECT_EQ(found.labels[i].label, host[i].label);
        expectBothCanBe(found.labels[i].bounds, host[i].bounds);
        EXPECT_EQ(found.labels[i].bounds.lo == kInfinity, host[i].bounds.lo == kInfinity);
    }
}

/// Poses on the device, one of which is none; next to no room; and the part of a device buffer.
TEST_F(LabelCallsTest, IsOnTheDeviceForTheNextPass) {
    constexpr std::uint32_t kPoses = 4;
    LabelledHead scene(context(), queue(), kPoses, testSeed(),
                       mapOf(headGrid(), [](auto x, auto, auto) { return x < 24 ? 1.0 : 2.0; }));
    std::vector<float> floats;
    for (Mat4& pose : scene.poses) {
        for (double& element : pose) {
            floats.push_back(static_cast<float>(element));
            element = static_cast<double>(floats.back());
        }
    }
    const std::array<std::int32_t, 2> asked{2, 1};
    const std::vector<LabelClearance> host = scene.onHost(asked);
    floats[16 * 3] = std::numeric_limits<float>::quiet_NaN();
    const RawVulkan::HostBuffer buffer =
        raw().makeBuffer(std::span<const float>(floats), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const PoseBuffer poses =
        take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer, .stride = 64, .count = kPoses}));
    scene.item.world_from_object = {};
    scene.item.poses = &poses;
    DetectorDesc desc = toLabels();
    desc.devicePoses = true;
    const Detector device = take(Detector::create(context(), desc));
    for (const bool closest : {false, true}) {
        Results results = take(Results::create(context(), {.maxPairs = kPoses + 1,
                                                           .clustersAtOnce = closest ? 2048 : 64,
                                                           .clearances = true,
                                                           .closest = closest,
                                                           .labelClearances = 3}));
        EXPECT_EQ(results.readLabelClearances().error().code, ErrorCode::NotReady);
        const BufferRange range = results.labelClearances();
        EXPECT_EQ(range.size, (kPoses + 1) * 3 * sizeof(ClearanceResult));
        EXPECT_EQ(range.offset % 256, 0U);
        const RawVulkan::HostBuffer copy = raw().makeBuffer(range.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        const VkCommandBuffer commands = raw().begin();
        take(device.cmdDetect(commands, scene.batch(asked), results));
        take(results.cmdReadBack(commands));
        const VkBufferCopy region{range.offset, 0, range.size};
        raw().vk().vkCmdCopyBuffer(commands, range.buffer, copy.buffer, 1, &region);
        raw().submitAndWait(commands);
        const std::vector<LabelClearance> read = take(results.readLabelClearances());
        ASSERT_EQ(read.size(), host.size());
        for (std::size_t i = 0; i < read.size(); ++i) {
            SCOPED_TRACE(i);
            ClearanceResult found{};
            std::memcpy(&found, static_cast<const std::byte*>(copy.mapped) + i * sizeof found, sizeof found);
            EXPECT_EQ(static_cast<double>(found.lo), read[i].bounds.lo);
            EXPECT_EQ(static_cast<double>(found.hi), read[i].bounds.hi);
            EXPECT_EQ(found.end, static_cast<std::uint32_t>(read[i].end));
            EXPECT_EQ(found.reserved, 0U);
            if (read[i].pose == 3) {
                EXPECT_EQ(read[i].bounds.lo, 0);
                EXPECT_EQ(read[i].bounds.hi, kInfinity);
                EXPECT_EQ(read[i].end, ClearanceEnd::Rounding);
            } else {
                expectBothCanBe(read[i].bounds, host[i].bounds);
            }
        }
    }
}

TEST_F(LabelCallsTest, RefusesWhatHasNoAnswer) {
    const auto refusal = [&](const DetectorDesc& desc) {
        const Result<Detector> made = Detector::create(context(), desc);
        EXPECT_FALSE(made.ok());
        return made.ok() ? std::string() : made.error().text;
    };
    DetectorDesc desc = toLabels();
    desc.clearance.reset();
    EXPECT_THAT(refusal(desc), HasSubstr("clearances to labels are clearances"));
    desc = toLabels({}, true);
    desc.labelClearances = false;
    EXPECT_THAT(refusal(desc), HasSubstr("labelsAtAnyOpacity is about clearances to labels"));

    const auto noResults = [&](const ResultsDesc& wanted) {
        const Result<Results> made = Results::create(context(), wanted);
        EXPECT_FALSE(made.ok());
        return made.ok() ? std::string() : made.error().text;
    };
    EXPECT_THAT(noResults({.labelClearances = 1}), HasSubstr("ResultsDesc::clearances is false"));
    EXPECT_THAT(noResults({.clearances = true, .labelClearances = 4097}), HasSubstr("at most 4096 labels"));
    EXPECT_THAT(noResults({.maxPairs = 100000, .clearances = true, .labelClearances = 4096}),
                HasSubstr("maxStorageBufferRange"));

    LabelledHead scene(context(), queue(), 1, 1, blocks(headGrid()));
    BlockingDetector device = detector(toLabels({.maximum = 1}));
    const auto refused = [&](std::span<const std::int32_t> asked) {
        const Result<BatchAnswer> answer = device.detect(scene.batch(asked));
        return answer.ok() ? std::string() : answer.error().text;
    };
    EXPECT_EQ(refused({}), "");
    const std::vector<std::int32_t> many(5000, 1);
    EXPECT_EQ(refused(many), "5000 labels are asked for, one call measures at most 4096; ask for fewer");
    const std::array<std::int32_t, 1> one{1};
    EXPECT_EQ(refused(one), "");
    const LabelData coarse = mapOf(unitGrid(4), [](auto...) { return 1.0; });
    const LabelMap elsewhere = take(LabelMap::upload(context(), queue(), coarse));
    scene.item.labels = &elsewhere;
    EXPECT_EQ(refused(one), "batch item 0: the label map is not on the grid of the volume; resample it to that");
    scene.item.labels = nullptr;
    EXPECT_EQ(refused(one), "batch item 0: labels is null, and clearances to labels are asked for");
    const LabelMap never = take(LabelMap::create(context(), scene.labels));
    scene.item.labels = &never;
    EXPECT_THAT(refused(one), HasSubstr("batch item 0: the label map"));

    scene.item.labels = &scene.map;
    Results results = take(Results::create(context(), {.maxPairs = 1, .clearances = true}));
    EXPECT_EQ(results.labelClearances().buffer, VK_NULL_HANDLE);
    const VkCommandBuffer commands = raw().begin();
    const Result<void> recorded = device.detector().cmdDetect(commands, scene.batch(one), results);
    raw().submitAndWait(commands);
    ASSERT_FALSE(recorded.ok());
    EXPECT_THAT(recorded.error().text, HasSubstr("have room for the clearances to 0 (ResultsDesc::labelClearances)"));
}

/// A device with less: the label map can be had, and what cannot is refused.
TEST_F(LabelCallsTest, NeedsRoomForWhatIsKnownOfLabels) {
    ContextImpl& impl = context().impl();
    const VkPhysicalDeviceLimits limits = impl.limits;
    LabelledHead scene(context(), queue(), 1, 1, blocks(headGrid()));
    impl.limits.maxPerStageDescriptorStorageBuffers = 6;
    const Result<Detector> few = Detector::create(context(), toLabels());
    impl.limits = limits;
    ASSERT_FALSE(few.ok());
    EXPECT_EQ(few.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(few.error().text, HasSubstr("maxPerStageDescriptorStorageBuffers 6, 7 are needed"));

    impl.limits.maxStorageBufferRange = 4096; // 7^3 bricks of 16 bytes are more
    const Result<LabelMap> large = LabelMap::upload(context(), queue(), scene.labels);
    impl.limits = limits;
    ASSERT_TRUE(large.ok());
    scene.item.labels = &*large;
    BlockingDetector device = detector(toLabels({.maximum = 1}));
    const std::array<std::int32_t, 1> one{1};
    const Result<BatchAnswer> answer = device.detect(scene.batch(one));
    ASSERT_FALSE(answer.ok());
    EXPECT_EQ(answer.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(answer.error().text, HasSubstr("batch item 0: the label map is too large for clearances"));
}

} // namespace
} // namespace voxtact::test
