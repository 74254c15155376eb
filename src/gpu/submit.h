// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/memory.h"
#include "voxtact/context.h"

namespace voxtact {

/// A command buffer of voxtact's own on the caller's queue, for the blocking conveniences. One submission at a time.
class Submitter {
  public:
    [[nodiscard]] static Result<Submitter> create(ContextImpl& context, const QueueAccess& queue);

    /// Begins the command buffer anew.
    [[nodiscard]] Result<VkCommandBuffer> begin();
    /// Ends it, submits it between the caller's lock callbacks, and waits for the fence.
    [[nodiscard]] Result<void> submitAndWait();

  private:
    Submitter(ContextImpl& context, const QueueAccess& queue) noexcept : context_(&context), queue_(queue) {}

    ContextImpl* context_;
    QueueAccess queue_;
    Owned<VkCommandPool> pool_;
    Owned<VkFence> fence_;
    VkCommandBuffer commandBuffer_ = VK_NULL_HANDLE;
};

/// One upload(): records `object.cmdUpload()`, submits, waits, and frees the staging buffer.
template <class Object>
[[nodiscard]] Result<void> uploadNow(ContextImpl& context, const QueueAccess& queue, Object& object) {
    Result<Submitter> submitter = Submitter::create(context, queue);
    if (!submitter.ok()) {
        return submitter.error();
    }
    const Result<VkCommandBuffer> commandBuffer = submitter->begin();
    if (!commandBuffer.ok()) {
        return commandBuffer.error();
    }
    if (Result<void> recorded = object.cmdUpload(*commandBuffer); !recorded.ok()) {
        return recorded;
    }
    Result<void> done = submitter->submitAndWait();
    if (done.ok()) {
        object.releaseStaging();
    }
    return done;
}

/// The last step of every upload(): passes a failed create() on, or uploads what it made.
template <class Object>
[[nodiscard]] Result<Object> uploaded(ContextImpl& context, const QueueAccess& queue, Result<Object> created) {
    if (created.ok()) {
        if (Result<void> done = uploadNow(context, queue, *created); !done.ok()) {
            return done.error();
        }
    }
    return created;
}

/// What cmdUpload() says when there is nothing to upload from.
[[nodiscard]] inline Error notUploadable(const char* what) {
    return {ErrorCode::NotReady, 0,
            std::string("the ") + what + " has no staging buffer: it is wrapped, or releaseStaging() was called"};
}

} // namespace voxtact
