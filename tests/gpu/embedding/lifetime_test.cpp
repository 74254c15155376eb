// SPDX-License-Identifier: MIT
// Objects that outlive the Context and the Renderer that they were made with.
#include "call_faults.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/render.h"

#include <optional>

namespace voxtact::test {
namespace {

class LifetimeTest : public RawGpuTest {};

TEST_F(LifetimeTest, AContextMayEndBeforeWhatWasMadeWithIt) {
    std::optional<Context> context = take(Context::create(gpu().device.contextDesc()));
    const Volume volume = take(Volume::upload(
        *context, queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(*context, queue(), {byteRamp(), {0, 255}}));
    const Mesh mesh = take(Mesh::upload(*context, queue(), makeFlat(0, 1, 0, 1, 0.5).view(), {.clusters = true}));
    BlockingDetector blocking =
        take(BlockingDetector::create(*context, RasterDesc{.outputs = {.contacts = true}}, queue()));
    const Detector detector = take(Detector::raster(*context, {}));
    Results results = take(Results::create(detector, {}));
    const ResultRing ring = take(ResultRing::create(detector, 2, {}));
    context.reset();
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    const Batch batch{std::span(&item, 1), flatView(0, 1, 16, 16), 0.5};
    EXPECT_EQ(take(blocking.detect(batch)).contacts.size(), 256U);
    const VkCommandBuffer commands = raw().begin();
    take(detector.cmdDetect(commands, batch, results));
    take(results.cmdReadBack(commands));
    raw().submitAndWait(commands);
    EXPECT_EQ((*results.read())[0].countLow, 256U);
}

TEST_F(LifetimeTest, ARendererMayEndBeforeWhatWasMadeWithIt) {
    std::optional<Context> context = take(Context::create(gpu().device.contextDesc()));
    std::optional<Renderer> renderer = take(Renderer::create(*context));
    RenderTransferFunction function =
        take(RenderTransferFunction::create(*renderer, {.opacity = {byteRamp(), {0, 255}, 16}}));
    const RenderTargets targets = take(RenderTargets::create(*renderer, {16, 16}));
    const Volume volume = take(Volume::upload(
        *context, queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const RenderBricks bricks = take(RenderBricks::create(*renderer, volume));
    renderer.reset();
    context.reset();
    const VkCommandBuffer commands = raw().begin();
    take(function.cmdUpload(commands));
    raw().submitAndWait(commands);
    EXPECT_EQ(targets.extent().width, 16U);
}

TEST_F(LifetimeTest, GpuTimesOfALostDevice) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    faultyCall<&VolkDeviceTable::vkQueueSubmit2>(loader, gpu().device.table(), "vkQueueSubmit2");
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    const Context context = take(Context::create(desc));
    const Detector detector = take(Detector::raster(context, {}));
    Results results =
        take(Results::create(detector, {.timestamps = gpu().device.hasTimestamps(), .queueFamily = queue().family}));
    EXPECT_EQ(results.gpuMilliseconds().error().code, ErrorCode::NotReady) << "nothing was recorded";
    callFault = {.functions = {"vkQueueSubmit2"}, .result = VK_ERROR_DEVICE_LOST};
    EXPECT_FALSE(Mesh::upload(context, queue(), makeFlat(0, 1, 0, 1, 0.5).view()).ok());
    callFault = {};
    EXPECT_EQ(results.gpuMilliseconds().error().code, ErrorCode::DeviceLost);
}

} // namespace
} // namespace voxtact::test
