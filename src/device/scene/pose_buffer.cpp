// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "device/scene/scene_impl.h"
#include "vulkan/layouts.h"

#include <cmath>

namespace voxtact {

namespace {

constexpr VkDeviceSize kPoseBytes = 16 * sizeof(float);

Result<void> checkWrapped(const ContextImpl& context, const WrappedPoses& wrapped) {
    if (wrapped.buffer == VK_NULL_HANDLE) {
        return refuse("WrappedPoses::buffer is null");
    }
    if (wrapped.count == 0) {
        return refuse("WrappedPoses::count is 0");
    }
    if (wrapped.stride < kPoseBytes || wrapped.stride % 4 != 0 || wrapped.offset % 4 != 0) {
        return refuse("WrappedPoses::stride must be at least 64, and it and offset multiples of 4");
    }
    if (!(wrapped.maxScale > 0) || !std::isfinite(wrapped.maxScale)) {
        return refuse("WrappedPoses::maxScale is " + number(wrapped.maxScale) + ", it must be a positive number");
    }
    const VkDeviceSize most = context.limits.maxStorageBufferRange;
    const VkDeviceSize others = wrapped.count - 1;
    if (wrapped.offset > most - kPoseBytes ||
        (others > 0 && wrapped.stride > (most - kPoseBytes - wrapped.offset) / others)) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(wrapped.count) + " poses of " + std::to_string(wrapped.stride) +
                         " bytes from one to the next, from byte " + std::to_string(wrapped.offset) +
                         " on, are beyond the device's maxStorageBufferRange, " + std::to_string(most)};
    }
    return {};
}

} // namespace

Result<VkDescriptorSetLayout> poseSetLayout(ContextImpl& context) {
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.poseSetLayout) {
        const VkDescriptorSetLayoutBinding poses{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                                 nullptr};
        VOXTACT_TRY(makeSetLayout(context, context.poseSetLayout, {&poses, 1}, "poses"));
    }
    return context.poseSetLayout.get();
}

PoseBuffer::PoseBuffer(std::unique_ptr<PoseBufferImpl> impl) noexcept : impl_(std::move(impl)) {}
PoseBuffer::PoseBuffer(PoseBuffer&&) noexcept = default;
PoseBuffer& PoseBuffer::operator=(PoseBuffer&&) noexcept = default;
PoseBuffer::~PoseBuffer() = default;

Result<PoseBuffer> PoseBuffer::wrap(const Context& context, const WrappedPoses& wrapped, const char* name) {
    return guard([&]() -> Result<PoseBuffer> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkWrapped(c, wrapped));
        const Result<VkDescriptorSetLayout> layout = poseSetLayout(c);
        VOXTACT_TRY(layout);
        auto impl = std::make_unique<PoseBufferImpl>(PoseBufferImpl{.context = c});
        impl->firstWord = static_cast<std::uint32_t>(wrapped.offset / sizeof(float));
        impl->words = static_cast<std::uint32_t>(wrapped.stride / sizeof(float));
        impl->count = wrapped.count;
        impl->maxScale = wrapped.maxScale;
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
        Result<DescriptorSet> set = makeDescriptorSet(c, *layout, {&size, 1}, name == nullptr ? "poses" : name);
        VOXTACT_TRY(set);
        impl->descriptors = std::move(*set);
        writeBuffer(c, impl->descriptors.set, 0, wrapped.buffer,
                    wrapped.offset + wrapped.stride * (wrapped.count - 1) + kPoseBytes);
        return PoseBuffer(std::move(impl));
    });
}

std::uint32_t PoseBuffer::count() const noexcept {
    return live(impl_).count;
}

} // namespace voxtact
