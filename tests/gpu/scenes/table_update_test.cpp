// SPDX-License-Identifier: MIT
// Transfer functions that change between the commands of one command buffer.
#include "device/scene/scene_impl.h"
#include "gpu_fixture.h"
#include "raw_vulkan.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr ControlPoint kThousandRamp[] = {{0, 0}, {1000, 1}};

class TableUpdateTest : public GpuTest {
  protected:
    static void expectTexels(RawVulkan& raw, const TransferFunction& function, const TransferFunctionDesc& desc) {
        const Buffer& texels = function.impl().texels;
        const std::vector<std::byte> bytes = raw.readBuffer(texels.get(), texels.size);
        std::vector<float> found(bytes.size() / sizeof(float));
        std::memcpy(found.data(), bytes.data(), bytes.size());
        EXPECT_EQ(found, take(sampleTable(desc)));
    }
};

TEST_F(TableUpdateTest, TheTexelsFollow) {
    RawVulkan raw(gpu().device);
    for (const std::uint32_t size : {2U, 3U, 256U, 4000U}) {
        TransferFunction function =
            take(TransferFunction::upload(context(), queue(), {byteRamp(), kBytes, size}, "texels"));
        expectTexels(raw, function, {byteRamp(), kBytes, size});
        const TransferFunctionDesc next{kThousandRamp, {-500, 1500}, size};
        const VkCommandBuffer commands = raw.begin();
        take(function.cmdUpdate(commands, {kAllOpaque, kBytes, size}));
        take(function.cmdUpdate(commands, next));
        raw.submitAndWait(commands);
        expectTexels(raw, function, next);
        EXPECT_EQ(function.domain().lo, -500);
        EXPECT_EQ(function.tableSize(), size);
    }
}

/// An upload after an update has the first table again, and its domain.
TEST_F(TableUpdateTest, AnUploadTakesItBack) {
    RawVulkan raw(gpu().device);
    const Volume volume = upload(makeBytes(unitGrid(8), [](auto...) { return 200.0; }));
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Mat4 pose = identity();
    const TransferFunctionDesc first{byteRamp(), kBytes, 256};
    TransferFunction function = take(TransferFunction::create(context(), first));
    const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    const Batch batch{std::span(&item, 1), {}, 0.5};
    const Detector asking =
        take(Detector::raster(context(), {.method = CountingMethod::Compute, .projection = Projection::DominantAxis}));
    Results results = take(Results::create(asking, {.maxPairs = 1}));
    const VkCommandBuffer commands = raw.begin();
    take(function.cmdUpload(commands));
    take(function.cmdUpdate(commands, {kThousandRamp, {0, 1000}}));
    EXPECT_EQ(function.domain().hi, 1000);
    take(function.cmdUpload(commands));
    EXPECT_EQ(function.domain().hi, kBytes.hi);
    EXPECT_EQ(function.impl().table, take(sampleTable(first)));
    take(asking.cmdDetect(commands, batch, results));
    take(results.cmdReadBack(commands));
    raw.submitAndWait(commands);
    EXPECT_TRUE(unpack(take(results.read())[0]).hit);
    expectTexels(raw, function, first);
}

TEST_F(TableUpdateTest, TakesEffectInCommandBufferOrder) {
    RawVulkan raw(gpu().device);
    // The half of the volume below x = 0.5 is 255.
    const Volume volume = upload(makeBytes(unitGrid(8), [](std::uint32_t x, auto...) { return x < 4 ? 255.0 : 0.0; }));
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Mat4 pose = identity();
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Compute}) {
        TransferFunction function = upload(byteRamp(), kBytes);
        const Detector counting = take(Detector::raster(context(), {.method = method}));
        const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
        const Batch batch{std::span(&item, 1), flatView(0, 1, 64, 64), 0.5};
        std::vector<Results> results;
        for (int i = 0; i < 4; ++i) {
            results.push_back(take(Results::create(counting, {.maxPairs = 1})));
        }
        const VkCommandBuffer commands = raw.begin();
        take(counting.cmdDetect(commands, batch, results[0]));
        take(function.cmdUpdate(commands, {kAllOpaque, kBytes}));
        take(counting.cmdDetect(commands, batch, results[1]));
        take(function.cmdUpdate(commands, {kThousandRamp, {0, 1000}}));
        take(counting.cmdDetect(commands, batch, results[2]));
        take(function.cmdUpdate(commands, {byteRamp(), kBytes}));
        take(counting.cmdDetect(commands, batch, results[3]));
        for (Results& each : results) {
            take(each.cmdReadBack(commands));
        }
        raw.submitAndWait(commands);
        const std::uint64_t expected[] = {64 * 32, 64 * 64, 0, 64 * 32};
        for (std::size_t i = 0; i < results.size(); ++i) {
            EXPECT_EQ(unpack(take(results[i].read())[0]).count, expected[i]) << toString(method) << " " << i;
        }
    }
}

TEST_F(TableUpdateTest, TheProofOfTheBoundaryFollows) {
    RawVulkan raw(gpu().device);
    const Volume volume = upload(makeBytes(unitGrid(8), [](auto...) { return 0.0; }));
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    TransferFunction function = upload(byteRamp(), kBytes);
    const Detector counting = take(Detector::raster(context(), {}));
    EXPECT_EQ(counting.boundaryFor({&mesh, &volume, &function, {}}, 0.5), Boundary::Clamp);
    const VkCommandBuffer commands = raw.begin();
    take(function.cmdUpdate(commands, {kAllOpaque, kBytes}));
    EXPECT_EQ(counting.boundaryFor({&mesh, &volume, &function, {}}, 0.5), Boundary::Range);
    raw.submitAndWait(commands);
}

TEST_F(TableUpdateTest, WrappedTables) {
    RawVulkan raw(gpu().device);
    const std::vector<float> table = take(sampleTable({byteRamp(), kBytes, 64}));
    WrappedTransferFunction wrapped;
    wrapped.domain = kBytes;
    wrapped.view = raw.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {64, 1, 1}, std::as_bytes(std::span(table)),
                                 wrapped.layout);
    TransferFunction without = take(TransferFunction::wrap(context(), wrapped));
    EXPECT_TRUE(without.impl().known.points.empty());
    wrapped.domain = {-1e308, 1e308};
    EXPECT_THAT(TransferFunction::wrap(context(), wrapped).error().text,
                HasSubstr("WrappedTransferFunction::domain -1e+308:1e+308 is too wide"));
    wrapped.domain = kBytes;
    std::vector<float> damaged = table;
    damaged[3] = std::numeric_limits<float>::quiet_NaN();
    wrapped.table = damaged;
    EXPECT_THAT(TransferFunction::wrap(context(), wrapped).error().text, HasSubstr("not from 0 to 1"));
    wrapped.table = table;
    TransferFunction with = take(TransferFunction::wrap(context(), wrapped));
    ASSERT_EQ(with.impl().known.points.size(), 64U);
    EXPECT_EQ(with.impl().known.points[1].value, 255.0 / 64 * 1.5);
    EXPECT_EQ(with.impl().known.points[1].opacity, static_cast<double>(table[1]));

    const VkCommandBuffer commands = raw.begin();
    EXPECT_THAT(with.cmdUpdate(commands, {byteRamp(), kBytes, 64}).error().text, HasSubstr("wrapped"));
    raw.submitAndWait(commands);
}

TEST_F(TableUpdateTest, BadInputIsRefusedAndChangesNothing) {
    RawVulkan raw(gpu().device);
    TransferFunction function = upload(byteRamp(), kBytes);
    const VkCommandBuffer commands = raw.begin();
    EXPECT_THAT(function.cmdUpdate(commands, {byteRamp(), {0, 9}, 255}).error().text,
                HasSubstr("255 entries, that of the transfer function 256"));
    EXPECT_THAT(function.cmdUpdate(commands, {{}, {0, 9}}).error().text, HasSubstr("no control points"));
    EXPECT_THAT(function.cmdUpdate(commands, {byteRamp(), {9, 9}}).error().text, HasSubstr("domain 9:9"));
    raw.submitAndWait(commands);
    EXPECT_EQ(function.domain().hi, 255);
    expectTexels(raw, function, {byteRamp(), kBytes});
}

} // namespace
} // namespace voxtact::test
