// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/submit.h"

namespace voxtact {

namespace {

constexpr std::uint32_t kBitsOfWord = 32;
constexpr PaintName kTrianglesName{"the bits of the painted triangles", "painted triangles"};

Result<void> checkDevice(const ContextImpl& context) {
    VOXTACT_TRY(context.alive());
    if (!context.features.geometryShader) {
        return Error{ErrorCode::Unsupported, 0,
                     "painting triangles: geometryShader is not enabled (gl_PrimitiveID needs it)"};
    }
    return {};
}

std::size_t wordsOf(std::uint32_t meshTriangles) {
    return (std::size_t{meshTriangles} + kBitsOfWord - 1) / kBitsOfWord;
}

Result<std::vector<std::uint32_t>> bitsOf(std::uint32_t meshTriangles, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> bits(wordsOf(meshTriangles));
    for (const std::uint32_t triangle : triangles) {
        if (triangle >= meshTriangles) {
            return refuse("triangle " + std::to_string(triangle) + " is to be painted, the mesh has " +
                          std::to_string(meshTriangles));
        }
        bits[triangle / kBitsOfWord] |= 1U << triangle % kBitsOfWord;
    }
    return bits;
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
        VOXTACT_TRY(checkDevice(context));
        VOXTACT_TRY(checkPaintBytes(context, wordsOf(meshTriangles) * sizeof(std::uint32_t), kTrianglesName));
        const Result<std::vector<std::uint32_t>> bits = bitsOf(meshTriangles, triangles);
        VOXTACT_TRY(bits);
        auto impl = std::make_unique<PaintedTrianglesImpl>(context);
        VOXTACT_TRY(makePaintWords(*impl, renderer.impl(), *bits, kBitsOfWord, kTrianglesName));
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
        VOXTACT_TRY(checkDevice(context));
        auto impl = std::make_unique<PaintedTrianglesImpl>(context);
        VOXTACT_TRY(wrapPaintWords(*impl, renderer.impl(), mask, kBitsOfWord, kTrianglesName));
        return PaintedTriangles(std::move(impl));
    });
}

Result<void> PaintedTriangles::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&] { return cmdUploadPaintWords(live(impl_), commandBuffer, kTrianglesName); });
}

void PaintedTriangles::releaseStaging() noexcept {
    live(impl_).staging = {};
}

} // namespace voxtact
