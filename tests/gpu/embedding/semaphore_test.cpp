// SPDX-License-Identifier: MIT
// A blocking call behind a semaphore of the engine's: a submission without commands waits for it on the same queue, and
// what is submitted to that queue later waits too (docs/embedding.md).
#include "gpu_fixture.h"

#include "support/scenes.h"

#include <chrono>
#include <future>

namespace voxtact::test {
namespace {

using namespace std::chrono_literals;

/// A timeline semaphore of the engine's, on its device.
class Timeline {
  public:
    explicit Timeline(const device::VulkanDevice& device) : device_(device) {
        VkSemaphoreTypeCreateInfo type{};
        type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
        type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
        VkSemaphoreCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        info.pNext = &type;
        EXPECT_EQ(device.table().vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore_), VK_SUCCESS);
    }
    Timeline(const Timeline&) = delete;
    Timeline& operator=(const Timeline&) = delete;
    ~Timeline() {
        device_.table().vkDeviceWaitIdle(device_.handle());
        device_.table().vkDestroySemaphore(device_.handle(), semaphore_, nullptr);
    }

    /// All that is submitted to the queue from now on waits for a value.
    void makeQueueWait(const QueueAccess& queue, std::uint64_t value) const {
        VkSemaphoreSubmitInfo wait{};
        wait.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
        wait.semaphore = semaphore_;
        wait.value = value;
        wait.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        VkSubmitInfo2 submission{};
        submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
        submission.waitSemaphoreInfoCount = 1;
        submission.pWaitSemaphoreInfos = &wait;
        if (queue.lock != nullptr) {
            queue.lock(queue.user);
        }
        EXPECT_EQ(device_.table().vkQueueSubmit2(queue.queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
        if (queue.unlock != nullptr) {
            queue.unlock(queue.user);
        }
    }
    void signal(std::uint64_t value) const {
        VkSemaphoreSignalInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO;
        info.semaphore = semaphore_;
        info.value = value;
        EXPECT_EQ(device_.table().vkSignalSemaphore(device_.handle(), &info), VK_SUCCESS);
    }

  private:
    const device::VulkanDevice& device_;
    VkSemaphore semaphore_ = VK_NULL_HANDLE;
};

class SemaphoreTest : public GpuTest {};

TEST_F(SemaphoreTest, ABlockingCallWaitsBehindWhatTheQueueWaitsFor) {
    // Without validation: the layer of Debian 12 waits 10 s for a value that the host signals, and then says that this
    // is "most likely a validation bug".
    const device::VulkanInstance instance = take(device::VulkanInstance::create({}));
    const auto devices = take(instance.devices());
    const device::VulkanDevice own = take(device::VulkanDevice::create(
        instance, take(device::chooseDevice(devices, {})),
        {.adjustFeatures = [](FeatureRequest& features) { features.vulkan12.timelineSemaphore = VK_TRUE; }}));
    const Context context = take(Context::create(own.contextDesc()));
    const QueueAccess queue = own.queueAccess();
    const VolumeData half = makeBytes(unitGrid(4), [](std::uint32_t x, auto, auto) { return x < 2 ? 255.0 : 0.0; });
    const Volume volume = take(Volume::upload(context, queue, half.view()));
    const TransferFunction function =
        take(TransferFunction::upload(context, queue, {byteRamp(), {0, 255}, kDefaultTableSize}));
    const Mesh mesh = take(Mesh::upload(context, queue, makeFlat(0, 1, 0, 1, 0.5).view()));
    BlockingDetector detector =
        take(BlockingDetector::create(context, RasterDesc{.method = CountingMethod::Atomic}, queue));
    const Timeline engine(own);
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    for (std::uint64_t frame = 1; frame <= 3; ++frame) {
        engine.makeQueueWait(queue, frame);
        auto answer = std::async(std::launch::async, [&] {
            return detector.detect({std::span(&item, 1), flatView(0, 1, 16, 16), 0.5});
        });
        EXPECT_EQ(answer.wait_for(200ms), std::future_status::timeout) << "it did not wait, in frame " << frame;
        engine.signal(frame);
        EXPECT_EQ(take(answer.get()).pairs.at(0).count, 128U);
    }
}

} // namespace
} // namespace voxtact::test
