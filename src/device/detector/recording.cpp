// SPDX-License-Identifier: MIT
#include "device/detector/recording.h"
#include "core/base/try.h"
#include "core/geometry/projection.h"
#include "core/geometry/recentre.h"
#include "core/method/certified_constants.h"
#include "core/method/method_table.h"
#include "device/detector/batch.h"
#include "device/detector/buffer_update.h"
#include "device/scene/scene_impl.h"
#include "device/touch/certified_queues.h"
#include "vulkan/barriers.h"

namespace voxtact {

namespace {

/// Of fewer pairs the command buffer has what they need: it is small, and a copy of its own takes longer.
constexpr std::uint32_t kFewestStaged = 64;

static_assert(sizeof(shader::CertifiedPair) <= kMostTransformsPerPair * sizeof(shader::PairTransform));

/// Where a method's shaders run. One that computes names no stage of graphics: its queue may have none.
VkPipelineStageFlags2 shadersOf(const PassDesc& desc) {
    return rowOf(desc.method).coverage == Coverage::Rasteriser
               ? VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
               : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
}

std::uint32_t howOf(const PassDesc& desc) {
    return static_cast<std::uint32_t>(desc.method) | static_cast<std::uint32_t>(desc.projection) << 8U |
           static_cast<std::uint32_t>(desc.stopAtFirst ? Exactness::LowerBound : exactness(desc.method)) << 16U;
}

/// Calls `pair` for every pose that the host has, with its numbers in the batch and in the item; `skip` for items whose
/// poses are on the device, with how many these are.
template <class Pair, class Skip> void eachHostPair(const Batch& batch, const Pair& pair, const Skip& skip) {
    std::uint32_t number = 0;
    for (std::uint32_t item = 0; item < batch.items.size(); ++item) {
        const BatchItem& of = batch.items[item];
        if (of.poses != nullptr) {
            skip(of.pairs());
        }
        for (std::uint32_t pose = 0; pose < of.world_from_object.size(); ++pose) {
            pair(of, item, pose, number + pose);
        }
        number += static_cast<std::uint32_t>(of.pairs());
    }
}

/// The transforms that the vertex shader reads.
void recordTransforms(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                      const ResultsImpl& results, Projection projection, Staging& staging) {
    const Cameras cameras(projection, batch.view);
    BufferUpdate<shader::PairTransform> update(context, commandBuffer, results.transforms.get(), 0, &staging);
    eachHostPair(
        batch,
        [&](const BatchItem& item, std::uint32_t, std::uint32_t pose, std::uint32_t) {
            for (const Mat4& clip_from_world : cameras.clip_from_world()) {
                const Mat4 world_from_floats =
                    worldFromFloats(item.world_from_object[pose], item.mesh->impl().known.origin);
                update.add(pairTransform(clip_from_world, world_from_floats, item.volume->impl().texture_from_world));
            }
        },
        [&](std::size_t pairs) { update.skip(pairs * cameras.clip_from_world().size()); });
    update.finish();
}

/// The same for the projection certified.
void recordCertifiedPairs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                          const ResultsImpl& results, Staging& staging) {
    BufferUpdate<shader::CertifiedPair> update(context, commandBuffer, results.transforms.get(), 0, &staging);
    eachHostPair(
        batch,
        [&](const BatchItem& item, std::uint32_t, std::uint32_t pose, std::uint32_t) {
            update.add(certifiedPair(item.volume->impl().pairGrid, item.world_from_object[pose],
                                     item.mesh->impl().known.origin));
        },
        [&](std::size_t pairs) { update.skip(pairs); });
    update.finish();
}

/// Results with a count of zero that say which pair they are.
void recordEmptyResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                        const ResultsImpl& results, std::uint32_t how, Staging& staging) {
    BufferUpdate<PairResult> update(context, commandBuffer, results.results.buffer, results.results.offset, &staging);
    eachHostPair(
        batch,
        [&](const BatchItem&, std::uint32_t item, std::uint32_t pose, std::uint32_t pair) {
            update.add({0, 0, pair, item, pose, how});
        },
        [&](std::size_t pairs) { update.skip(pairs); });
    update.finish();
}

/// What the passes need of the pairs whose poses the host has, made by the host.
Result<void> recordPairs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                         const ResultsImpl& results, const PassDesc& desc) {
    Staging staging;
    if (results.staging.buffer && results.pairs >= kFewestStaged) {
        staging.buffer = &results.staging;
    }
    if (rowOf(desc.projection).certified) {
        recordCertifiedPairs(context, commandBuffer, batch, results, staging);
    } else {
        recordTransforms(context, commandBuffer, batch, results, desc.projection, staging);
    }
    recordEmptyResults(context, commandBuffer, batch, results, howOf(desc), staging);
    return staging.used > 0 ? flush(results.context, results.staging) : Result<void>();
}

/// What was written is ready for the shaders of a method, and for commands that write the results.
void barrierToShaders(const ContextImpl& context, VkCommandBuffer commandBuffer, VkPipelineStageFlags2 stages,
                      VkAccessFlags2 access, const PassDesc& desc) {
    barrier(context, commandBuffer, stages, access, shadersOf(desc) | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

void copyQueries(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results) {
    context.vk.CmdCopyQueryPoolResults(commandBuffer, results.occlusion.get(), 0, results.pairs, results.results.buffer,
                                       results.results.offset, sizeof(PairResult),
                                       VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
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

Result<void> prepareResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                            const ResultsImpl& results, const PassDesc& desc, const std::optional<PairSetup>& setup,
                            std::uint32_t rounds) {
    if (results.timestamps) {
        context.vk.CmdResetQueryPool(commandBuffer, results.timestamps.get(), 0, 2);
    }
    writeTimestamp(context, commandBuffer, results, 0);
    // Whatever still reads or writes the results of an earlier batch must be done.
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT);
    const bool staged = setup && setup->stagePoses(batch, results);
    if (staged) {
        VOXTACT_TRY(flush(results.context, results.staging));
    } else {
        VOXTACT_TRY(recordPairs(context, commandBuffer, batch, results, desc));
    }
    if (rowOf(desc.projection).certified) {
        recordQueueHeaders(context, commandBuffer, results, rounds);
        if (desc.counters) {
            recordNoCounters(context, commandBuffer, results);
        }
    }
    if (desc.outputs.any()) {
        recordOutputs(context, commandBuffer, batch, *results.outputs);
    }
    if (rowOf(desc.method).query) {
        context.vk.CmdResetQueryPool(commandBuffer, results.occlusion.get(), 0, results.pairs);
    }
    if (!setup || !(staged || hasDevicePoses(batch))) {
        barrierToShaders(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         desc);
        return {};
    }
    setup->recordItems(commandBuffer, batch, results, staged);
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    setup->record(commandBuffer, batch, results, staged, howOf(desc));
    barrierToShaders(context, commandBuffer,
                     VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, desc);
    return {};
}

void publishResults(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                    const PassDesc& desc) {
    if (rowOf(desc.method).query) {
        copyQueries(context, commandBuffer, results);
    }
    barrier(context, commandBuffer, shadersOf(desc) | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_SHADER_READ_BIT);
    writeTimestamp(context, commandBuffer, results, 1);
}

} // namespace voxtact
