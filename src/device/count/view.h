// SPDX-License-Identifier: MIT
#pragma once

#include "core/method/method_table.h"
#include "device/detector/pass_desc.h"
#include "device/results/results_impl.h"
#include "vulkan/context_impl.h"
#include "vulkan/pipeline.h"

#include <array>

namespace voxtact {

/// The pass of the projections that rasterise: the batch as the caller's camera sees it (and, two-view, from the
/// side), or each triangle along its dominant axis. One fragment program for all counting methods of the raster path.
class ViewPass {
  public:
    [[nodiscard]] static Result<ViewPass> create(ContextImpl& context, const PassDesc& desc);
    /// The same draws with a fragment shader that lists survivors instead of counting them. `layout` extends
    /// ContextImpl::rasterLayout by sets that the caller binds.
    [[nodiscard]] static Result<ViewPass> createTrace(ContextImpl& context, Filter filter, VkPipelineLayout layout);

    /// Records the draws of a checked batch, inside renderings of its own. Expects the transforms and results of
    /// `results` ready for the vertex and fragment stages, and its queries reset. `boundaryOf` says for each item
    /// whether to test the range or to clamp.
    template <class BoundaryOf>
    void record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                BoundaryOf&& boundaryOf) const {
        bindPairs(commandBuffer, results);
        const bool together = !eachAlone();
        if (together) {
            beginRendering(commandBuffer, largestViewport(batch));
        }
        std::uint32_t firstPair = 0;
        for (const BatchItem& item : batch.items) {
            recordItem(commandBuffer, batch, item, boundaryOf(item), firstPair, results);
            firstPair += static_cast<std::uint32_t>(item.pairs());
        }
        if (together) {
            context_->vk.CmdEndRendering(commandBuffer);
        }
    }

    /// Of a checked batch of one pair, some triangles of the mesh, each alone in a query: number i of `queries`, which
    /// are reset, has the survivors of triangles[i]. For methods that count by query; tests the range.
    void recordTriangles(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                         std::span<const std::uint32_t> triangles, VkQueryPool queries) const;

  private:
    ViewPass(ContextImpl& context, const PassDesc& desc) noexcept : context_(&context), desc_(desc) {}

    [[nodiscard]] Result<void> makePipelines(std::span<const std::uint32_t> fragmentSpirv, VkPipelineLayout layout,
                                             bool withCarry, const std::string& name);
    /// What sets are bound with.
    [[nodiscard]] VkPipelineLayout layout() const noexcept;
    /// Whether each pair is a rendering of its own, flushed before the next: see ContextImpl::flushAfterQuery.
    [[nodiscard]] bool eachAlone() const noexcept;
    [[nodiscard]] bool dominantAxis() const noexcept { return rowOf(desc_.projection).voxelGrid; }
    [[nodiscard]] VkExtent2D largestViewport(const Batch& batch) const noexcept;
    void bindPairs(VkCommandBuffer commandBuffer, const ResultsImpl& results) const;
    void bindMesh(VkCommandBuffer commandBuffer, const BatchItem& item) const;
    void beginRendering(VkCommandBuffer commandBuffer, VkExtent2D viewport) const;
    void bindItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                  const ResultsImpl& results) const;
    void recordItem(VkCommandBuffer commandBuffer, const Batch& batch, const BatchItem& item, Boundary boundary,
                    std::uint32_t firstPair, const ResultsImpl& results) const;
    void recordQueries(VkCommandBuffer commandBuffer, VkExtent2D viewport, const BatchItem& item,
                       std::uint32_t firstPair, const ResultsImpl& results) const;
    void beginQuery(VkCommandBuffer commandBuffer, VkExtent2D viewport, VkQueryPool queries, std::uint32_t query) const;
    void endQuery(VkCommandBuffer commandBuffer, VkQueryPool queries, std::uint32_t query) const;
    /// As many draws as ContextDesc::fragmentsAtOnce asks for.
    void draw(VkCommandBuffer commandBuffer, VkExtent2D viewport, const BatchItem& item, std::uint32_t firstPair,
              std::uint32_t pairs) const;
    void drawPart(VkCommandBuffer commandBuffer, const BatchItem& item, std::uint32_t firstTriangle,
                  std::uint32_t triangles, std::uint32_t firstView, std::uint32_t views) const;

    ContextImpl* context_;
    PassDesc desc_;
    std::array<std::array<Owned<VkPipeline>, 2>, 2> pipelines_; ///< [range test][carry]; no carry for queries
};

} // namespace voxtact
