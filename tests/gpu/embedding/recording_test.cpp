// SPDX-License-Identifier: MIT
// Several batches into one Results in one command buffer, in their order. Synchronization validation, which every test
// here runs under, finds a barrier that is not there.
#include "raw_fixture.h"
#include "support/scenes.h"

#include <array>

namespace voxtact::test {
namespace {

class RecordingTest : public RawGpuTest {};

TEST_F(RecordingTest, OneResultsTakesOneBatchAfterTheOther) {
    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const std::array poses{translation({0, 0, 3}), identity()}; // that misses and that touches
    std::vector<AnyDesc> descs;
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Compute}) {
        if (context().supports(method)) {
            descs.push_back({.method = method});
            descs.push_back({.method = method, .outputs = {.triangles = true, .contacts = true, .bounds = true}});
        }
    }
    if (context().supports(CountingMethod::Compute, Projection::Certified)) {
        descs.push_back({.method = CountingMethod::Compute, .projection = Projection::Certified});
    }
    for (const AnyDesc& desc : descs) {
        SCOPED_TRACE(std::string(toString(desc.method)) + " " + toString(desc.projection));
        const Detector detector = take(Detector::create(context(), desc));
        for (const bool readBetween : {true, false}) {
            Results results = take(Results::create(detector, {.room = {.triangles = 64}}));
            const VkCommandBuffer commands = raw().begin();
            for (const std::size_t touching : {1, 0, 1}) {
                const BatchItem item{&mesh, &volume, &function, std::span(poses).subspan(touching, 1)};
                take(detector.cmdDetect(commands, {std::span(&item, 1), flatView(0, 1, 64, 64), 0.5}, results));
                if (readBetween) {
                    take(results.cmdReadBack(commands));
                }
            }
            if (!readBetween) {
                take(results.cmdReadBack(commands));
            }
            raw().submitAndWait(commands);
            const std::uint32_t count = (*results.read())[0].countLow;
            if (desc.projection == Projection::Certified) {
                EXPECT_GT(count, 0U);
            } else {
                EXPECT_EQ(count, 64U * 64U);
            }
            if (desc.outputs.contacts) {
                BatchAnswer answer;
                take(results.readOutputs(answer));
                EXPECT_EQ(answer.contacts.size(), 64U * 64U);
            }
        }
    }
}

TEST_F(RecordingTest, AFrameHasNothingOfTheOneBeforeIt) {
    const Detector detector = take(Detector::raster(context(), {.method = CountingMethod::QueryAny}));
    ResultRing ring = take(ResultRing::create(detector, 1, {.maxPairs = 1}));
    const Volume volume = upload(makeBytes(unitGrid(4), [](auto...) { return 255.0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Mat4 pose = identity();
    const BatchItem good{&mesh, &volume, &function, std::span(&pose, 1)};
    const Batch batch{std::span(&good, 1), flatView(0, 1, 16, 16), 0.5};
    const auto answer = [&](std::uint64_t frame) {
        Results& results = *take(ring.begin(frame));
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
    };
    answer(1);
    EXPECT_GT(take(ring.read(1))[0].countLow, 0U);
    EXPECT_EQ(take(ring.begin(1)), take(ring.results(1))) << "the same frame once more";
    EXPECT_GT(take(ring.read(1))[0].countLow, 0U);
    Results& next = *take(ring.begin(2));
    EXPECT_EQ(ring.read(2).error().code, ErrorCode::NotReady);
    BatchItem bad = good;
    bad.volume = nullptr;
    const VkCommandBuffer commands = raw().begin();
    EXPECT_FALSE(detector.cmdDetect(commands, {std::span(&bad, 1), batch.view, 0.5}, next).ok());
    EXPECT_EQ(next.cmdReadBack(commands).error().code, ErrorCode::NotReady);
    raw().submitAndWait(commands);
    EXPECT_EQ(ring.read(2).error().code, ErrorCode::NotReady);
    answer(3);
    EXPECT_GT(take(ring.read(3))[0].countLow, 0U);
}

} // namespace
} // namespace voxtact::test
