// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/submit.h"

#include <cmath>

namespace voxtact {

namespace {

constexpr PaintName kVerticesName{"the colours of the vertices", "painted vertices"};

/// Same layout as unpackUnorm4x8.
Result<std::uint32_t> packed(const Colour& colour) {
    VOXTACT_TRY(checkColour(colour, "a vertex's colour"));
    constexpr double kMost = 255;
    std::uint32_t word = 0;
    for (std::size_t channel = 0; channel < colour.size(); ++channel) {
        word |= static_cast<std::uint32_t>(std::lround(kMost * colour[channel])) << 8 * channel;
    }
    return word;
}

} // namespace

PaintedVertices::PaintedVertices(std::unique_ptr<PaintedVerticesImpl> impl) noexcept : impl_(std::move(impl)) {}
PaintedVertices::PaintedVertices(PaintedVertices&&) noexcept = default;
PaintedVertices& PaintedVertices::operator=(PaintedVertices&&) noexcept = default;
PaintedVertices::~PaintedVertices() = default;

Result<PaintedVertices> PaintedVertices::create(const Renderer& renderer, std::span<const Colour> colours) {
    return guard([&]() -> Result<PaintedVertices> {
        if (colours.empty()) {
            return refuse("there are no colours of vertices");
        }
        std::vector<std::uint32_t> words;
        words.reserve(colours.size());
        for (const Colour& colour : colours) {
            const Result<std::uint32_t> word = packed(colour);
            VOXTACT_TRY(word);
            words.push_back(*word);
        }
        auto impl = std::make_unique<PaintedVerticesImpl>(renderer.impl().context);
        VOXTACT_TRY(makePaintWords(*impl, renderer.impl(), words, 1, kVerticesName));
        return PaintedVertices(std::move(impl));
    });
}

Result<PaintedVertices> PaintedVertices::upload(const Renderer& renderer, const QueueAccess& queue,
                                                std::span<const Colour> colours) {
    return guard([&] { return uploaded(renderer.impl().context, queue, create(renderer, colours)); });
}

Result<PaintedVertices> PaintedVertices::wrap(const Renderer& renderer, const BufferRange& colours) {
    return guard([&]() -> Result<PaintedVertices> {
        auto impl = std::make_unique<PaintedVerticesImpl>(renderer.impl().context);
        VOXTACT_TRY(wrapPaintWords(*impl, renderer.impl(), colours, 1, kVerticesName));
        return PaintedVertices(std::move(impl));
    });
}

Result<void> PaintedVertices::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&] { return cmdUploadPaintWords(live(impl_), commandBuffer, kVerticesName); });
}

void PaintedVertices::releaseStaging() noexcept {
    live(impl_).staging = {};
}

} // namespace voxtact
