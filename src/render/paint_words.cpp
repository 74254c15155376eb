// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"

#include <cstring>
#include <string>

namespace voxtact {

namespace {

constexpr VkDeviceSize kOffsets = 256; ///< alignment of a BufferRange; more than any minStorageBufferOffsetAlignment

Result<void> describe(PaintWords& paint, const RendererImpl& renderer, const BufferRange& words, std::uint64_t perWord,
                      const PaintName& name) {
    constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    Result<DescriptorSet> set = makeDescriptorSet(paint.context, renderer.bricksLayout.get(), {&kSize, 1}, name.whole);
    VOXTACT_TRY(set);
    paint.descriptors = std::move(*set);
    paint.room = words.size / sizeof(std::uint32_t) * perWord;
    writeBuffer(paint.context, paint.descriptors.set, 0, words.buffer, words.size, words.offset);
    return {};
}

} // namespace

Result<void> checkPaintBytes(const ContextImpl& context, VkDeviceSize bytes, const PaintName& name) {
    VOXTACT_TRY(context.alive());
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::string(name.words) + " are " + std::to_string(bytes) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    return {};
}

Result<void> makePaintWords(PaintWords& paint, const RendererImpl& renderer, std::span<const std::uint32_t> words,
                            std::uint64_t perWord, const PaintName& name) {
    VOXTACT_TRY(checkPaintBytes(paint.context, words.size_bytes(), name));
    VOXTACT_TRY(makeStaged(paint.context, words.size_bytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, name.whole,
                           paint.buffer, paint.staging));
    std::memcpy(paint.staging.mapped, words.data(), words.size_bytes());
    VOXTACT_TRY(flush(paint.context, paint.staging));
    return describe(paint, renderer, {paint.buffer.get(), 0, words.size_bytes()}, perWord, name);
}

Result<void> wrapPaintWords(PaintWords& paint, const RendererImpl& renderer, const BufferRange& words,
                            std::uint64_t perWord, const PaintName& name) {
    if (words.buffer == VK_NULL_HANDLE || words.size < sizeof(std::uint32_t)) {
        return refuse(std::string(name.words) + " are a null buffer, or fewer bytes than a uint has");
    }
    if (words.offset % kOffsets != 0) {
        return refuse(std::string(name.words) + " begin at byte " + std::to_string(words.offset) +
                      ", which is no multiple of " + std::to_string(kOffsets));
    }
    VOXTACT_TRY(checkPaintBytes(paint.context, words.size, name));
    VOXTACT_TRY(describe(paint, renderer, words, perWord, name));
    paint.uploaded = true;
    return {};
}

Result<void> cmdUploadPaintWords(PaintWords& paint, VkCommandBuffer commandBuffer, const PaintName& name) {
    if (!paint.staging.buffer) {
        return notUploadable(name.whole);
    }
    VOXTACT_TRY(paint.context.recordable(commandBuffer));
    const Label label(paint.context, commandBuffer, (std::string("voxtact ") + name.whole + " upload").c_str());
    cmdFillBuffer(paint.context, commandBuffer, paint.staging, paint.buffer);
    paint.uploaded = true;
    return {};
}

} // namespace voxtact
