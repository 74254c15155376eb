// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "render/render_impl.h"

namespace voxtact {

RenderBricks::RenderBricks(std::unique_ptr<RenderBricksImpl> impl) noexcept : impl_(std::move(impl)) {}
RenderBricks::RenderBricks(RenderBricks&&) noexcept = default;
RenderBricks& RenderBricks::operator=(RenderBricks&&) noexcept = default;
RenderBricks::~RenderBricks() = default;

Result<RenderBricks> RenderBricks::create(const Renderer& renderer, const Volume& volume) {
    return guard([&]() -> Result<RenderBricks> {
        const VolumeImpl& source = volume.impl();
        ContextImpl& context = renderer.impl().context;
        VOXTACT_TRY(context.alive());
        if (&source.context != &context) {
            return refuse("volume and renderer belong to different Contexts");
        }
        if (!source.bricks.buffer) {
            return refuse("the volume has no bricks: it was made without VolumeOptions::bricks");
        }
        constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
        Result<DescriptorSet> set =
            makeDescriptorSet(context, renderer.impl().bricksLayout.get(), {&kSize, 1}, "render bricks");
        VOXTACT_TRY(set);
        auto impl =
            std::make_unique<RenderBricksImpl>(RenderBricksImpl{.renderer = renderer.impl(), .volume = &source});
        impl->descriptors = std::move(*set);
        writeBuffer(context, impl->descriptors.set, 0, source.bricks.get());
        return RenderBricks(std::move(impl));
    });
}

} // namespace voxtact
