// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/try.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/submit.h"
#include "render/render_impl.h"

#include <cstring>

namespace voxtact {

namespace {

constexpr std::uint32_t kBitsOfWord = 32;
constexpr VkDeviceSize kOffsets = 256; ///< what BufferRange promises; more than any minStorageBufferOffsetAlignment

Error refuse(std::string text) {
    return {ErrorCode::InvalidArgument, 0, std::move(text)};
}

Result<void> checkDevice(const ContextImpl& context, VkDeviceSize bytes) {
    VOXTACT_TRY(context.alive());
    if (!context.features.geometryShader) {
        return Error{ErrorCode::Unsupported, 0,
                     "painting triangles: geometryShader is not enabled (gl_PrimitiveID needs it)"};
    }
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the bits of the painted triangles are " + std::to_string(bytes) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    return {};
}

Result<std::vector<std::uint32_t>> bitsOf(std::uint32_t meshTriangles, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> bits((std::size_t{meshTriangles} + kBitsOfWord - 1) / kBitsOfWord);
    for (const std::uint32_t triangle : triangles) {
        if (triangle >= meshTriangles) {
            return refuse("triangle " + std::to_string(triangle) + " is to be painted, the mesh has " +
                          std::to_string(meshTriangles));
        }
        bits[triangle / kBitsOfWord] |= 1U << triangle % kBitsOfWord;
    }
    return bits;
}

Result<void> makeBuffers(PaintedTrianglesImpl& impl, std::span<const std::byte> bytes) {
    VOXTACT_TRY(makeStaged(impl.context, bytes.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "painted triangles",
                           impl.buffer, impl.staging));
    std::memcpy(impl.staging.mapped, bytes.data(), bytes.size());
    return flush(impl.context, impl.staging);
}

Result<void> describe(PaintedTrianglesImpl& impl, const RendererImpl& renderer, const BufferRange& mask) {
    constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    Result<DescriptorSet> set =
        makeDescriptorSet(impl.context, renderer.bricksLayout.get(), {&kSize, 1}, "painted triangles");
    VOXTACT_TRY(set);
    impl.descriptors = std::move(*set);
    impl.room = mask.size / sizeof(std::uint32_t) * kBitsOfWord;
    writeBuffer(impl.context, impl.descriptors.set, 0, mask.buffer, mask.size, mask.offset);
    return {};
}

} // namespace

PaintedTriangles::PaintedTriangles(std::unique_ptr<PaintedTrianglesImpl> impl) noexcept : impl_(std::move(impl)) {}
PaintedTriangles::PaintedTriangles(PaintedTriangles&&) noexcept = default;
PaintedTriangles& PaintedTriangles::operator=(PaintedTriangles&&) noexcept = default;
PaintedTriangles::~PaintedTriangles() = default;

Result<PaintedTriangles> PaintedTriangles::create(const Renderer& renderer, std::uint32_t meshTriangles,
                                                  std::span<const std::uint32_t> triangles) {
    return guard([&]() -> Result<PaintedTriangles> {
        ContextImpl& context = renderer.impl().context;
        if (meshTriangles == 0) {
            return refuse("a mesh without triangles cannot be painted");
        }
        const Result<std::vector<std::uint32_t>> bits = bitsOf(meshTriangles, triangles);
        VOXTACT_TRY(bits);
        const std::span<const std::byte> bytes = std::as_bytes(std::span(*bits));
        VOXTACT_TRY(checkDevice(context, bytes.size()));
        auto impl = std::make_unique<PaintedTrianglesImpl>(PaintedTrianglesImpl{.context = context});
        VOXTACT_TRY(makeBuffers(*impl, bytes));
        VOXTACT_TRY(describe(*impl, renderer.impl(), {impl->buffer.get(), 0, bytes.size()}));
        return PaintedTriangles(std::move(impl));
    });
}

Result<PaintedTriangles> PaintedTriangles::upload(const Renderer& renderer, const QueueAccess& queue,
                                                  std::uint32_t meshTriangles,
                                                  std::span<const std::uint32_t> triangles) {
    return guard([&] { return uploaded(renderer.impl().context, queue, create(renderer, meshTriangles, triangles)); });
}

Result<PaintedTriangles> PaintedTriangles::wrap(const Renderer& renderer, const BufferRange& mask) {
    return guard([&]() -> Result<PaintedTriangles> {
        ContextImpl& context = renderer.impl().context;
        if (mask.buffer == VK_NULL_HANDLE || mask.size < sizeof(std::uint32_t)) {
            return refuse("the bits of the painted triangles are a null buffer, or fewer bytes than a uint has");
        }
        if (mask.offset % kOffsets != 0) {
            return refuse("the bits of the painted triangles begin at byte " + std::to_string(mask.offset) +
                          ", which is no multiple of " + std::to_string(kOffsets));
        }
        VOXTACT_TRY(checkDevice(context, mask.size));
        auto impl = std::make_unique<PaintedTrianglesImpl>(PaintedTrianglesImpl{.context = context});
        VOXTACT_TRY(describe(*impl, renderer.impl(), mask));
        impl->uploaded = true;
        return PaintedTriangles(std::move(impl));
    });
}

Result<void> PaintedTriangles::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!live(impl_).staging.buffer) {
            return notUploadable("painted triangles");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Label label(live(impl_).context, commandBuffer, "voxtact painted triangles upload");
        cmdFillBuffer(live(impl_).context, commandBuffer, live(impl_).staging, live(impl_).buffer);
        live(impl_).uploaded = true;
        return {};
    });
}

void PaintedTriangles::releaseStaging() noexcept {
    live(impl_).staging = {};
}

} // namespace voxtact
