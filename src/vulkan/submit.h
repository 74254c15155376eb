// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/try.h"
#include "voxtact/context.h"
#include "vulkan/memory/memory.h"

namespace voxtact {

/// A command buffer of voxtact's own on the caller's queue, for the blocking conveniences. One submission at a time.
/// An object that owns one has it as its last member: what a submission uses then ends after the wait for it.
class Submitter {
  public:
    /// Refuses a queue whose family has none of `anyOf`.
    [[nodiscard]] static Result<Submitter> create(ContextImpl& context, const QueueAccess& queue,
                                                  VkQueueFlags anyOf = VK_QUEUE_GRAPHICS_BIT);
    Submitter(Submitter&& other) noexcept;
    Submitter& operator=(Submitter&&) = delete;
    /// Waits for what is in flight. Where even that fails, the context is given up: ContextImpl::giveUp().
    ~Submitter();

    /// Begins the command buffer again. Nothing is in flight then: a submission whose wait failed is waited for, and
    /// where that fails again, so does this. What earlier submissions used may be replaced only afterwards.
    [[nodiscard]] Result<VkCommandBuffer> begin();
    /// Ends it, submits it between the caller's lock callbacks, and waits for the fence. After an error it tries to
    /// wait in other ways, so that nothing is in flight as a rule.
    [[nodiscard]] Result<void> submitAndWait();

  private:
    Submitter(ContextImpl& context, const QueueAccess& queue) noexcept : context_(&context), queue_(queue) {}
    /// What the device may still be doing.
    enum class Work {
        None,
        Submitted, ///< the fence will say when it is done
        Unknown,   ///< the submission failed in a way that does not say that nothing was submitted
    };
    /// Waits for the fence.
    VkResult wait() noexcept;
    /// Waits until nothing is in flight, by the fence or, without one, by the whole queue.
    VkResult settle() noexcept;

    ContextImpl* context_;
    QueueAccess queue_;
    Work work_ = Work::None;
    Owned<VkCommandPool> pool_;
    Owned<VkFence> fence_;
    VkCommandBuffer commandBuffer_ = VK_NULL_HANDLE;
};

/// One upload(): records `object.cmdUpload()`, submits, waits, and frees the staging buffer.
template <class Object>
[[nodiscard]] Result<void> uploadNow(ContextImpl& context, const QueueAccess& queue, Object& object) {
    Result<Submitter> submitter = Submitter::create(context, queue, VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT);
    VOXTACT_TRY(submitter);
    const Result<VkCommandBuffer> commandBuffer = submitter->begin();
    VOXTACT_TRY(commandBuffer);
    VOXTACT_TRY(object.cmdUpload(*commandBuffer));
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
        VOXTACT_TRY(uploadNow(context, queue, *created));
    }
    return created;
}

/// What the users of an object say whose cmdUpload() was not recorded. `what` begins the text ("the volume").
[[nodiscard]] inline Error neverUploaded(const std::string& what) {
    return {ErrorCode::NotReady, 0, what + " was never uploaded: record its cmdUpload() first"};
}

/// What cmdUpload() says when there is nothing to upload from.
[[nodiscard]] inline Error notUploadable(const char* what) {
    return {ErrorCode::NotReady, 0,
            std::string("the ") + what +
                " has no staging buffer: it is wrapped, or upload() or releaseStaging() has freed it"};
}

} // namespace voxtact
