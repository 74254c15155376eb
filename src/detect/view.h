// SPDX-License-Identifier: MIT
#pragma once

#include "detect/results_impl.h"
#include "gpu/context_impl.h"
#include "gpu/pipeline.h"
#include "voxtact/detector.h"

#include <array>

namespace voxtact {

/// The pass of the `view` projection: rasterises the batch with the caller's camera, one fragment program for all
/// counting methods of the raster path.
class ViewPass {
  public:
    [[nodiscard]] static Result<ViewPass> create(ContextImpl& context, CountingMethod method, Filter filter,
                                                 const Outputs& outputs = {});
    /// The same draws with a fragment shader that lists survivors instead of counting them. `layout` extends
    /// ContextImpl::rasterLayout by sets that the caller binds.
    [[nodiscard]] static Result<ViewPass> createTrace(ContextImpl& context, Filter filter, VkPipelineLayout layout);

    /// Records the draws of a checked batch, inside renderings of its own. Expects the transforms and results of
    /// `results` ready for the vertex and fragment stages, and its queries reset. `boundaryOf` says for each item
    /// whether to test the range or to clamp.
    template <class BoundaryOf>
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                BoundaryOf&& boundaryOf) const {
        bindBatch(commandBuffer, batch.view, results);
        const bool together = !eachAlone();
        if (together) {
            beginRendering(commandBuffer, batch.view);
        }
        std::uint32_t firstPair = 0;
        for (const BatchItem& item : batch.items) {
            recordItem(commandBuffer, batch, item, boundaryOf(item), firstPair, results);
            firstPair += static_cast<std::uint32_t>(item.world_from_object.size());
        }
        if (together) {
            context_->vk.CmdEndRendering(commandBuffer);
        }
    }

  private:
    ViewPass(ContextImpl& context, CountingMethod method, Filter filter) noexcept
        : context_(&context), method_(method), filter_(filter) {}

    [[nodiscard]] Result<void> makePipelines(std::span<const std::uint32_t> fragmentSpirv, VkPipelineLayout layout,
                                             bool withCarry, const std::string& name);
    /// What sets are bound with.
    [[nodiscard]] VkPipelineLayout layout() const noexcept;
    /// Whether each pair is a rendering of its own, flushed before the next: see ContextImpl::flushAfterQuery.
    [[nodiscard]] bool eachAlone() const noexcept;
    void bindBatch(VkCommandBuffer commandBuffer, const View& view, const ResultsImpl& results) const;
    void beginRendering(VkCommandBuffer commandBuffer, const View& view) const;
    void recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                    std::uint32_t firstPair, const ResultsImpl& results) const;
    void recordQueries(VkCommandBuffer commandBuffer, const View& view, const BatchItem& item, std::uint32_t firstPair,
                       const ResultsImpl& results) const;
    void draw(VkCommandBuffer commandBuffer, const BatchItem& item, std::uint32_t firstPair, std::uint32_t pairs) const;

    ContextImpl* context_;
    CountingMethod method_;
    Filter filter_;
    Outputs outputs_{};
    std::array<std::array<Owned<VkPipeline>, 2>, 2> pipelines_; ///< [range test][carry]; no carry for queries
};

} // namespace voxtact
