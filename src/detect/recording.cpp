// SPDX-License-Identifier: MIT
#include "detect/recording.h"
#include "core/geometry/projection.h"
#include "core/method/certified_constants.h"
#include "core/method/method_table.h"
#include "detect/batch.h"
#include "detect/buffer_update.h"
#include "detect/certified_queues.h"
#include "gpu/barriers.h"
#include "gpu/scene_impl.h"

namespace voxtact {

namespace {

static_assert(sizeof(shader::CertifiedPair) <= kMostTransformsPerPair * sizeof(shader::PairTransform));

/// Where a method's shaders run. One that computes names no stage of graphics: its queue may have none.
VkPipelineStageFlags2 shadersOf(const DetectorDesc& desc) {
    return rowOf(desc.method).coverage == Coverage::Rasteriser
               ? VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
               : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
}

std::uint32_t howOf(const DetectorDesc& desc) {
    return static_cast<std::uint32_t>(desc.method) | static_cast<std::uint32_t>(desc.projection) << 8U |
           static_cast<std::uint32_t>(desc.stopAtFirst ? Exactness::LowerBound : exactness(desc.method)) << 16U;
}

/// The transforms that the vertex shader reads.
void recordTransforms(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                      const ResultsImpl& results, Projection projection) {
    const Cameras cameras(projection, batch.view);
    BufferUpdate<shader::PairTransform> update(context, commandBuffer, results.transforms.get());
    for (const BatchItem& item : batch.items) {
        for (const Mat4& world_from_object : item.world_from_object) {
            for (const Mat4& clip_from_world : cameras.clip_from_world()) {
                update.add(pairTransform(clip_from_world, world_from_object, item.volume->impl().texture_from_world));
            }
        }
    }
    update.finish();
}

/// The same for the projection conservative.
void recordCertifiedPairs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                          const ResultsImpl& results) {
    BufferUpdate<shader::CertifiedPair> update(context, commandBuffer, results.transforms.get());
    for (const BatchItem& item : batch.items) {
        const VolumeImpl& volume = item.volume->impl();
        for (const Mat4& world_from_object : item.world_from_object) {
            update.add(certifiedPair(volume.grid, volume.texture_from_world, world_from_object));
        }
    }
    update.finish();
    recordQueueHeaders(context, commandBuffer, results);
}

/// Results with a count of zero that say which pair they are.
void recordEmptyResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                        const ResultsImpl& results, std::uint32_t how) {
    BufferUpdate<PairResult> update(context, commandBuffer, results.results.get());
    std::uint32_t pair = 0;
    for (std::uint32_t item = 0; item < batch.items.size(); ++item) {
        for (std::uint32_t pose = 0; pose < batch.items[item].world_from_object.size(); ++pose) {
            update.add({0, 0, pair++, item, pose, how});
        }
    }
    update.finish();
}

void copyQueries(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results) {
    context.vk.CmdCopyQueryPoolResults(commandBuffer, results.occlusion.get(), 0, results.pairs, results.results.get(),
                                       0, sizeof(PairResult), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
}

void writeTimestamp(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                    std::uint32_t index) {
    if (results.timestamps) {
        context.vk.CmdWriteTimestamp2(commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, results.timestamps.get(),
                                      index);
    }
}

} // namespace

std::uint32_t transformsPerPair(Projection projection) noexcept {
    return rowOf(projection).certified ? kMostTransformsPerPair : viewsPerPair(projection);
}

void prepareResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                    const ResultsImpl& results, const DetectorDesc& desc) {
    if (results.timestamps) {
        context.vk.CmdResetQueryPool(commandBuffer, results.timestamps.get(), 0, 2);
    }
    writeTimestamp(context, commandBuffer, results, 0);
    // Whatever still reads or writes the results of an earlier batch must be done.
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT);
    if (rowOf(desc.projection).certified) {
        recordCertifiedPairs(context, commandBuffer, batch, results);
        if (desc.counters) {
            recordNoCounters(context, commandBuffer, results);
        }
    } else {
        recordTransforms(context, commandBuffer, batch, results, desc.projection);
    }
    recordEmptyResults(context, commandBuffer, batch, results, howOf(desc));
    if (desc.outputs.any()) {
        recordOutputs(context, commandBuffer, batch, *results.outputs);
    }
    if (rowOf(desc.method).query) {
        context.vk.CmdResetQueryPool(commandBuffer, results.occlusion.get(), 0, results.pairs);
    }
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            shadersOf(desc) | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

void publishResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                    const DetectorDesc& desc) {
    if (rowOf(desc.method).query) {
        copyQueries(context, commandBuffer, results);
    }
    barrier(context, commandBuffer, shadersOf(desc) | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_SHADER_READ_BIT);
    writeTimestamp(context, commandBuffer, results, 1);
}

} // namespace voxtact
