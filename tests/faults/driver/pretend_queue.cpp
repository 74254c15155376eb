// SPDX-License-Identifier: MIT
// Command pools, fences and the queue of PretendDriver.
#include "pretend_state.h"

#include <algorithm>

namespace voxtact::test {

namespace {

/// Every object that one reaches: memory of a buffer, the buffers of a set.
class Reach {
  public:
    explicit Reach(PretendState& state) : s_(state) {}

    void add(Id id) {
        if (id == 0 || !reached_.insert(id).second) {
            return;
        }
        if (const PretendBuffer* buffer = s_.buffers.find(id)) {
            add(buffer->memory);
        } else if (const PretendImage* image = s_.images.find(id)) {
            add(image->memory);
        } else if (const PretendImageView* view = s_.views.find(id)) {
            add(view->image);
        } else if (const PretendDescriptorSet* set = s_.sets.find(id)) {
            add(set->pool);
            for (const auto& [binding, descriptor] : set->bindings) {
                add(descriptor.buffer);
                add(descriptor.view);
            }
        } else if (!isLeaf(id)) {
            s_.complain("a command uses an object that does not exist any more: " + std::to_string(id));
        }
    }
    [[nodiscard]] std::unordered_set<Id> take() { return std::move(reached_); }

  private:
    [[nodiscard]] bool isLeaf(Id id) {
        return s_.memories.find(id) != nullptr || s_.pipelines.find(id) != nullptr ||
               s_.queryPools.find(id) != nullptr || s_.descriptorPools.find(id) != nullptr ||
               s_.commandPools.find(id) != nullptr || s_.fences.find(id) != nullptr;
    }

    PretendState& s_;
    std::unordered_set<Id> reached_;
};

} // namespace

void PretendState::executeUntil(Id fence) {
    while (!pending.empty()) {
        // Its objects are in use until its commands are done.
        for (PretendCommand& command : pending.front().commands) {
            command.execute();
        }
        const Id signals = pending.front().fence;
        pending.pop_front();
        if (PretendFence* done = signals == 0 ? nullptr : fences.find(signals)) {
            done->signalled = true;
        }
        if (signals == fence && fence != 0) {
            return;
        }
    }
}

namespace pretended {

VkResult VKAPI_CALL CreateFence(VkDevice, const VkFenceCreateInfo* info, const VkAllocationCallbacks*, VkFence* out) {
    *out = pretend().fences.add(pretend().next++, {(info->flags & VK_FENCE_CREATE_SIGNALED_BIT) != 0});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyFence(VkDevice, VkFence fence, const VkAllocationCallbacks*) {
    pretend().end(pretend().fences, fence);
}
VkResult VKAPI_CALL ResetFences(VkDevice, std::uint32_t count, const VkFence* fences) {
    PretendState& s = pretend();
    for (const VkFence handle : std::span(fences, count)) {
        if (PretendFence* fence = s.get(s.fences, handle)) {
            s.expectIdle(handle, "reset");
            fence->signalled = false;
        }
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL WaitForFences(VkDevice, std::uint32_t count, const VkFence* fences, VkBool32, std::uint64_t) {
    PretendState& s = pretend();
    if (s.lost) {
        return VK_ERROR_DEVICE_LOST;
    }
    for (const VkFence handle : std::span(fences, count)) {
        const PretendFence* fence = s.get(s.fences, handle);
        if (fence == nullptr || fence->signalled) {
            continue;
        }
        if (!s.inUse(bitsOf(handle))) {
            s.complain("a fence is waited for that nothing will signal");
            continue;
        }
        s.executeUntil(bitsOf(handle));
    }
    return VK_SUCCESS;
}

VkResult VKAPI_CALL QueueWaitIdle(VkQueue) {
    if (pretend().lost) {
        return VK_ERROR_DEVICE_LOST;
    }
    pretend().executeUntil(0);
    return VK_SUCCESS;
}

VkResult VKAPI_CALL CreateCommandPool(VkDevice, const VkCommandPoolCreateInfo*, const VkAllocationCallbacks*,
                                      VkCommandPool* out) {
    *out = pretend().commandPools.add(pretend().next++, {});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyCommandPool(VkDevice, VkCommandPool handle, const VkAllocationCallbacks*) {
    PretendState& s = pretend();
    if (const PretendCommandPool* pool = s.commandPools.find(bitsOf(handle))) {
        std::ranges::for_each(pool->buffers, [&](Id buffer) { s.commandBuffers.remove(buffer); });
    }
    s.end(s.commandPools, handle);
}
VkResult VKAPI_CALL ResetCommandPool(VkDevice, VkCommandPool handle, VkCommandPoolResetFlags) {
    PretendState& s = pretend();
    if (const PretendCommandPool* pool = s.get(s.commandPools, handle)) {
        s.expectIdle(handle, "reset");
        for (const Id id : pool->buffers) {
            PretendCommandBuffer* buffer = s.commandBuffers.find(id);
            buffer->state = PretendCommandBuffer::State::Initial;
            buffer->commands.clear();
        }
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL AllocateCommandBuffers(VkDevice, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* out) {
    PretendState& s = pretend();
    PretendCommandPool* pool = s.get(s.commandPools, info->commandPool);
    for (std::uint32_t i = 0; pool != nullptr && i < info->commandBufferCount; ++i) {
        pool->buffers.push_back(s.next);
        PretendCommandBuffer buffer;
        buffer.pool = bitsOf(info->commandPool);
        out[i] = s.commandBuffers.add(s.next++, std::move(buffer));
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL BeginCommandBuffer(VkCommandBuffer handle, const VkCommandBufferBeginInfo*) {
    PretendState& s = pretend();
    if (PretendCommandBuffer* buffer = s.get(s.commandBuffers, handle)) {
        if (buffer->state != PretendCommandBuffer::State::Initial) {
            s.complain("a command buffer is begun that was not reset");
        }
        buffer->state = PretendCommandBuffer::State::Recording;
        buffer->bound = {};
        buffer->commands.clear();
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL EndCommandBuffer(VkCommandBuffer handle) {
    PretendState& s = pretend();
    if (PretendCommandBuffer* buffer = s.get(s.commandBuffers, handle)) {
        if (buffer->state != PretendCommandBuffer::State::Recording) {
            s.complain("a command buffer is ended that was not begun");
        }
        buffer->state = PretendCommandBuffer::State::Executable;
    }
    return VK_SUCCESS;
}

VkResult VKAPI_CALL QueueSubmit2(VkQueue, std::uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
    PretendState& s = pretend();
    if (s.lost) {
        return VK_ERROR_DEVICE_LOST;
    }
    if (fence != VK_NULL_HANDLE) {
        if (const PretendFence* given = s.get(s.fences, fence); given != nullptr && given->signalled) {
            s.complain("a fence is submitted that is signalled already");
        }
        s.expectIdle(fence, "submitted");
    }
    for (const VkSubmitInfo2& info : std::span(infos, count)) {
        Submission submission;
        Reach reach(s);
        for (std::uint32_t i = 0; i < info.commandBufferInfoCount; ++i) {
            const PretendCommandBuffer* buffer = s.get(s.commandBuffers, info.pCommandBufferInfos[i].commandBuffer);
            if (buffer == nullptr) {
                continue;
            }
            if (buffer->state != PretendCommandBuffer::State::Executable) {
                s.complain("a command buffer is submitted that was not ended");
            }
            reach.add(buffer->pool);
            for (const PretendCommand& command : buffer->commands) {
                std::ranges::for_each(command.uses, [&](Id id) { reach.add(id); });
                submission.commands.push_back(command);
            }
        }
        reach.add(bitsOf(fence));
        submission.fence = bitsOf(fence);
        submission.uses = reach.take();
        s.pending.push_back(std::move(submission));
    }
    return VK_SUCCESS;
}

} // namespace pretended

} // namespace voxtact::test
