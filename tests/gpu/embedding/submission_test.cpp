// SPDX-License-Identifier: MIT
// One Vulkan call fails, and the next ones do not. An error says so; no answer is ever an old one; nothing that the
// device still uses is destroyed or recorded again (the validation layer sees that); and the next call is right.
#include "call_faults.h"
#include "gpu_fixture.h"
#include "support/scenes.h"
#include "voxtact/render.h"

#include <gmock/gmock.h>

#include <array>
#include <optional>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr const char* kSubmission[] = {"vkResetCommandPool", "vkBeginCommandBuffer", "vkEndCommandBuffer",
                                       "vkQueueSubmit2",     "vkWaitForFences",      "vkResetFences"};
constexpr VkResult kTransient[] = {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_UNKNOWN};

class SubmissionTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        callFault = {};
        loader_.emplace(gpu().instance.getInstanceProcAddr());
        const VolkDeviceTable& table = gpu().device.table();
        faultyCall<&VolkDeviceTable::vkResetCommandPool>(*loader_, table, "vkResetCommandPool");
        faultyCall<&VolkDeviceTable::vkBeginCommandBuffer>(*loader_, table, "vkBeginCommandBuffer");
        faultyCall<&VolkDeviceTable::vkEndCommandBuffer>(*loader_, table, "vkEndCommandBuffer");
        faultyCall<&VolkDeviceTable::vkQueueSubmit2>(*loader_, table, "vkQueueSubmit2");
        faultyCall<&VolkDeviceTable::vkWaitForFences>(*loader_, table, "vkWaitForFences");
        faultyCall<&VolkDeviceTable::vkResetFences>(*loader_, table, "vkResetFences");
        faultyCall<&VolkDeviceTable::vkQueueWaitIdle>(*loader_, table, "vkQueueWaitIdle");
        faultyCall<&VolkDeviceTable::vkGetQueryPoolResults>(*loader_, table, "vkGetQueryPoolResults");
        ContextDesc desc = gpu().device.contextDesc();
        desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
        context_.emplace(take(Context::create(desc)));
        volume_.emplace(take(Volume::upload(
            faulty(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true})));
        function_.emplace(take(TransferFunction::upload(faulty(), queue(), {byteRamp(), {0, 255}, 256})));
        mesh_.emplace(take(Mesh::upload(faulty(), queue(), makeFlat(0, 1, 0, 1, 0.5).view())));
    }
    void TearDown() override {
        callFault = {};
        mesh_.reset();
        function_.reset();
        volume_.reset();
        context_.reset();
        loader_.reset();
        GpuTest::TearDown();
    }

    /// The context whose calls can fail.
    [[nodiscard]] const Context& faulty() const { return *context_; }

    /// Poses of which the first `touching` of `poses` touch.
    [[nodiscard]] static std::vector<Mat4> someTouch(std::size_t touching, std::size_t poses) {
        std::vector<Mat4> out(poses, translation({0, 0, 3}));
        std::fill_n(out.begin(), touching, identity());
        return out;
    }
    [[nodiscard]] Result<BatchAnswer> detect(BlockingDetector& detector, std::span<const Mat4> poses) const {
        const BatchItem item{&*mesh_, &*volume_, &*function_, poses};
        return detector.detect({std::span(&item, 1), flatView(0, 1, kSide, kSide), 0.5});
    }
    /// Every answer of a good detect().
    static void expectAnswer(const BatchAnswer& answer, std::size_t touching, std::size_t poses) {
        ASSERT_EQ(answer.pairs.size(), poses);
        for (std::size_t i = 0; i < poses; ++i) {
            ASSERT_EQ(answer.pairs[i].count, i < touching ? std::uint64_t{kSide} * kSide : 0U) << "pair " << i;
        }
    }
    [[nodiscard]] const Volume& volume() const { return *volume_; }
    [[nodiscard]] const Mesh& mesh() const { return *mesh_; }

    static constexpr std::uint32_t kSide = 32;

  private:
    std::optional<Interception> loader_;
    std::optional<Context> context_;
    std::optional<Volume> volume_;
    std::optional<TransferFunction> function_;
    std::optional<Mesh> mesh_;
};

TEST_F(SubmissionTest, NoFailureGivesAnOldAnswer) {
    // Answers that differ from call to call, and batches that need larger Results.
    constexpr std::array<std::array<std::size_t, 2>, 4> kCalls{{{4, 4}, {0, 4}, {3, 70}, {1, 4}}};
    std::size_t points = 0;
    for (const char* function : kSubmission) {
        for (const VkResult result : kTransient) {
            for (std::uint32_t at = 1; at <= kCalls.size() + 1; ++at) {
                SCOPED_TRACE(std::string(function) + " fails at call " + std::to_string(at));
                BlockingDetector detector = take(BlockingDetector::create(faulty(), RasterDesc{}, queue()));
                callFault = {.functions = {function}, .result = result, .first = at};
                std::size_t errors = 0;
                for (const auto& [touching, poses] : kCalls) {
                    const Result<BatchAnswer> answer = detect(detector, someTouch(touching, poses));
                    if (answer.ok()) {
                        expectAnswer(*answer, touching, poses);
                    } else {
                        ++errors;
                        EXPECT_EQ(answer.error().vkResult, result) << answer.error().text;
                    }
                }
                EXPECT_EQ(errors, callFault.fired() ? 1U : 0U);
                points += errors;
            }
        }
    }
    EXPECT_EQ(points, std::size(kTransient) * std::size(kSubmission) * kCalls.size());
}

TEST_F(SubmissionTest, WhatCannotBeWaitedForIsNotTouched) {
    BlockingDetector detector = take(BlockingDetector::create(faulty(), RasterDesc{}, queue()));
    expectAnswer(take(detect(detector, someTouch(4, 4))), 4, 4);
    callFault = {.functions = {"vkWaitForFences", "vkQueueWaitIdle"}, .failing = UINT32_MAX};
    for (const char* text : {"waiting for the device", "an earlier submission"}) {
        const Result<BatchAnswer> answer = detect(detector, someTouch(0, 4));
        ASSERT_FALSE(answer.ok());
        EXPECT_EQ(answer.error().code, ErrorCode::OutOfMemory);
        EXPECT_THAT(answer.error().text, HasSubstr(text));
    }
    callFault = {};
    expectAnswer(take(detect(detector, someTouch(2, 80))), 2, 80);
    EXPECT_FALSE(faulty().deviceLost());
}

TEST_F(SubmissionTest, AnUploadThatFailsLeavesNothingInUse) {
    const VolumeData data = makeBytes(unitGrid(32), [](auto x, auto...) { return x % 256; });
    for (const char* function : kSubmission) {
        for (const VkResult result : kTransient) {
            SCOPED_TRACE(function);
            callFault = {.functions = {function}, .result = result};
            const Result<Volume> volume = Volume::upload(faulty(), queue(), data.view(), {.bricks = true});
            EXPECT_EQ(volume.ok(), !callFault.fired());
            if (!volume.ok()) {
                EXPECT_EQ(volume.error().vkResult, result) << volume.error().text;
            }
        }
    }
    // The wait, the wait again and the wait for the queue: what is left is to wait at the end of the upload.
    callFault = {.functions = {"vkWaitForFences", "vkQueueWaitIdle"}, .failing = 3};
    EXPECT_FALSE(Volume::upload(faulty(), queue(), data.view(), {.bricks = true}).ok());
    EXPECT_EQ(callFault.calls, 4U);
    callFault = {};
    EXPECT_TRUE(Volume::upload(faulty(), queue(), data.view(), {.bricks = true}).ok());
    EXPECT_FALSE(faulty().deviceLost());
}

TEST_F(SubmissionTest, ADeviceThatNobodyCanWaitForCountsAsLost) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "what is left to the device is a leak";
#endif
    // A device of its own, which what cannot be destroyed is left to, and no validation layer, which would say so.
    const device::VulkanInstance instance = take(device::VulkanInstance::create());
    const device::PhysicalDevice physical = take(device::chooseDevice(take(instance.devices()), {}));
    const device::VulkanDevice device = take(device::VulkanDevice::create(instance, physical));
    Interception loader(instance.getInstanceProcAddr());
    faultyCall<&VolkDeviceTable::vkWaitForFences>(loader, device.table(), "vkWaitForFences");
    faultyCall<&VolkDeviceTable::vkQueueWaitIdle>(loader, device.table(), "vkQueueWaitIdle");
    {
        ContextDesc desc = device.contextDesc();
        desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
        const Context context = take(Context::create(desc));
        callFault = {.functions = {"vkWaitForFences", "vkQueueWaitIdle"}, .failing = UINT32_MAX};
        const MeshData square = makeFlat(0, 1, 0, 1, 0.5);
        const Result<Mesh> mesh = Mesh::upload(context, device.queueAccess(), square.view());
        ASSERT_FALSE(mesh.ok());
        EXPECT_EQ(mesh.error().code, ErrorCode::OutOfMemory) << "what failed, before all else was tried";
        EXPECT_TRUE(context.deviceLost());
        const Result<Mesh> next = Mesh::create(context, square.view());
        ASSERT_FALSE(next.ok());
        EXPECT_EQ(next.error().code, ErrorCode::DeviceLost);
        EXPECT_THAT(next.error().text, HasSubstr("could not be waited for"));
    }
    callFault = {};
    device.table().vkDeviceWaitIdle(device.handle());
}

TEST_F(SubmissionTest, NoFailureGivesAnOldPicture) {
    constexpr ControlPoint kNothing[] = {{0, 0}, {255, 0}};
    constexpr VkExtent2D kExtents[] = {{64, 48}, {64, 48}, {32, 24}};
    const Renderer renderer = take(Renderer::create(faulty()));
    const RenderTransferFunction function =
        take(RenderTransferFunction::upload(renderer, queue(), {.opacity = {kNothing, {0, 255}, 16}}));
    Scene scene;
    scene.volume = &volume();
    scene.transferFunction = &function;
    scene.clip_from_world = flatView(0, 1, 64, 48).clip_from_world;
    for (const char* name : kSubmission) {
        for (std::uint32_t at = 1; at <= std::size(kExtents); ++at) {
            SCOPED_TRACE(std::string(name) + " fails at call " + std::to_string(at));
            BlockingRenderer blocking = take(BlockingRenderer::create(faulty(), queue()));
            callFault = {.functions = {name}, .first = at};
            for (std::size_t i = 0; i < std::size(kExtents); ++i) {
                scene.background = {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
                const Result<Picture> picture = blocking.render(scene, kExtents[i]);
                if (picture.ok()) {
                    for (std::size_t channel = 0; channel < 3; ++channel) {
                        EXPECT_EQ(picture->rgba[channel], channel == i ? 255 : 0) << "picture " << i;
                    }
                }
            }
        }
    }
}

TEST_F(SubmissionTest, AFailedReadOfTimesIsAnError) {
    BlockingDetector detector = take(BlockingDetector::create(faulty(), RasterDesc{}, queue()));
    const BatchAnswer good = take(detect(detector, someTouch(4, 4)));
    if (good.gpuMilliseconds == 0) {
        GTEST_SKIP() << "the queue has no timestamps";
    }
    callFault = {.functions = {"vkGetQueryPoolResults"}};
    const Result<BatchAnswer> answer = detect(detector, someTouch(4, 4));
    ASSERT_FALSE(answer.ok());
    EXPECT_THAT(answer.error().text, HasSubstr("reading timestamps"));
    expectAnswer(take(detect(detector, someTouch(1, 4))), 1, 4);
}

TEST_F(SubmissionTest, AFailedCreateLeavesNothingToDestroy) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    const VolkDeviceTable& table = gpu().device.table();
    faultyCall<&VolkDeviceTable::vkCreateSampler>(loader, table, "vkCreateSampler");
    faultyCall<&VolkDeviceTable::vkCreateDescriptorSetLayout>(loader, table, "vkCreateDescriptorSetLayout");
    faultyCall<&VolkDeviceTable::vkCreatePipelineLayout>(loader, table, "vkCreatePipelineLayout");
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    std::size_t points = 0;
    for (const char* function : {"vkCreateSampler", "vkCreateDescriptorSetLayout", "vkCreatePipelineLayout"}) {
        for (std::uint32_t at = 1;; ++at) {
            callFault = {.functions = {function}, .first = at};
            const Result<Context> made = Context::create(desc);
            if (!callFault.fired()) {
                EXPECT_TRUE(made.ok());
                break;
            }
            ++points;
            ASSERT_FALSE(made.ok()) << function << " " << at;
            EXPECT_EQ(made.error().code, ErrorCode::OutOfMemory);
        }
    }
    EXPECT_EQ(points, 13U) << "two samplers, six set layouts and five pipeline layouts";
}

} // namespace
} // namespace voxtact::test
