// SPDX-License-Identifier: MIT
#include "vulkan/submit.h"

#include "core/base/refuse.h"
#include "core/base/try.h"
#include "vulkan/debug.h"

namespace voxtact {

namespace {

/// Before a submission that cannot be waited for is given up.
constexpr int kLastTries = 8;

} // namespace

Result<Submitter> Submitter::create(ContextImpl& context, const QueueAccess& queue, VkQueueFlags anyOf) {
    VOXTACT_TRY(context.alive());
    if (queue.queue == VK_NULL_HANDLE) {
        return refuse("QueueAccess::queue is null");
    }
    if ((queue.lock == nullptr) != (queue.unlock == nullptr)) {
        return refuse("QueueAccess has only one of lock and unlock");
    }
    VOXTACT_TRY(context.checkFamily(queue.family, anyOf, "QueueAccess::family"));
    Submitter out(context, queue);
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = queue.family;
    VkCommandPool pool = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateCommandPool(context.device, &poolInfo, context.allocator, &pool);
        result != VK_SUCCESS) {
        return context.failure(result, "making a command pool");
    }
    out.pool_ = Owned<VkCommandPool>(context, pool, [](ContextImpl& c, VkCommandPool handle) {
        c.vk.DestroyCommandPool(c.device, handle, c.allocator);
    });
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    if (const VkResult result = context.vk.AllocateCommandBuffers(context.device, &info, &out.commandBuffer_);
        result != VK_SUCCESS) {
        return context.failure(result, "allocating a command buffer");
    }
    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateFence(context.device, &fenceInfo, context.allocator, &fence);
        result != VK_SUCCESS) {
        return context.failure(result, "making a fence");
    }
    out.fence_ = Owned<VkFence>(
        context, fence, [](ContextImpl& c, VkFence handle) { c.vk.DestroyFence(c.device, handle, c.allocator); });
    nameObject(context, VK_OBJECT_TYPE_COMMAND_POOL, pool, "blocking command pool");
    nameObject(context, VK_OBJECT_TYPE_COMMAND_BUFFER, out.commandBuffer_, "blocking command buffer");
    nameObject(context, VK_OBJECT_TYPE_FENCE, fence, "blocking fence");
    return out;
}

Submitter::Submitter(Submitter&& other) noexcept
    : context_(other.context_), queue_(other.queue_), work_(std::exchange(other.work_, Work::None)),
      pool_(std::move(other.pool_)), fence_(std::move(other.fence_)), commandBuffer_(other.commandBuffer_) {}

Submitter::~Submitter() {
    VkResult result = VK_SUCCESS;
    for (int tries = 0; work_ != Work::None && tries < kLastTries; ++tries) {
        result = settle();
    }
    if (work_ != Work::None) {
        context_->giveUp(result);
    }
}

VkResult Submitter::wait() noexcept {
    const VkFence fence = fence_.get();
    const VkResult result = context_->vk.WaitForFences(context_->device, 1, &fence, VK_TRUE, UINT64_MAX);
    if (result == VK_SUCCESS) {
        work_ = Work::None;
    }
    return result;
}

VkResult Submitter::settle() noexcept {
    if (work_ == Work::None || (work_ == Work::Submitted && wait() == VK_SUCCESS)) {
        return VK_SUCCESS;
    }
    if (queue_.lock != nullptr) {
        queue_.lock(queue_.user);
    }
    const VkResult result = context_->vk.QueueWaitIdle(queue_.queue);
    if (queue_.unlock != nullptr) {
        queue_.unlock(queue_.user);
    }
    // A lost device uses nothing any more.
    if (result == VK_SUCCESS || result == VK_ERROR_DEVICE_LOST) {
        work_ = Work::None;
    }
    return result;
}

Result<VkCommandBuffer> Submitter::begin() {
    VOXTACT_TRY(context_->alive());
    if (const VkResult result = settle(); result != VK_SUCCESS) {
        return context_->failure(result, "waiting for an earlier submission");
    }
    if (const VkResult result = context_->vk.ResetCommandPool(context_->device, pool_.get(), 0); result != VK_SUCCESS) {
        return context_->failure(result, "resetting a command pool");
    }
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult result = context_->vk.BeginCommandBuffer(commandBuffer_, &info); result != VK_SUCCESS) {
        return context_->failure(result, "beginning a command buffer");
    }
    return commandBuffer_;
}

Result<void> Submitter::submitAndWait() {
    if (const VkResult result = context_->vk.EndCommandBuffer(commandBuffer_); result != VK_SUCCESS) {
        return context_->failure(result, "ending a command buffer");
    }
    // Before the submission, so that a failure leaves no fence that says too early that the next one is done.
    const VkFence fence = fence_.get();
    if (const VkResult result = context_->vk.ResetFences(context_->device, 1, &fence); result != VK_SUCCESS) {
        return context_->failure(result, "resetting a fence");
    }
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = commandBuffer_;
    VkSubmitInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    if (queue_.lock != nullptr) {
        queue_.lock(queue_.user);
    }
    const VkResult submitted = context_->vk.QueueSubmit2(queue_.queue, 1, &info, fence);
    if (queue_.unlock != nullptr) {
        queue_.unlock(queue_.user);
    }
    if (submitted != VK_SUCCESS) {
        // For want of memory nothing was submitted: Vulkan promises that of these two and of no other.
        const bool nothing = submitted == VK_ERROR_OUT_OF_HOST_MEMORY || submitted == VK_ERROR_OUT_OF_DEVICE_MEMORY;
        work_ = nothing ? Work::None : Work::Unknown;
        settle();
        return context_->failure(submitted, "submitting to the queue");
    }
    work_ = Work::Submitted;
    if (const VkResult result = wait(); result != VK_SUCCESS) {
        settle();
        return context_->failure(result, "waiting for the device");
    }
    return {};
}

} // namespace voxtact
