// SPDX-License-Identifier: MIT
#include "device/touch/round_recorder.h"
#include "device/touch/certified_queues.h"
#include "vulkan/barriers.h"

namespace voxtact {

void queuesBarrier(const ContextImpl& context, VkCommandBuffer commandBuffer) {
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

void RoundRecorder::record(std::span<const RoundPass> passes, VkPipelineLayout layout,
                           const shader::CertifiedConstants& given, const RoundCut& cut) {
    shader::CertifiedConstants constants = given;
    eachRound(cut, [&](const Round& round) {
        constants.firstPair = given.firstPair + round.firstPair;
        constants.firstCluster = round.firstCluster;
        constants.endCluster = round.endCluster;
        recordRound(passes, layout, constants, round.pairs);
    });
}

void RoundRecorder::dispatch(const RoundPass& pass, const shader::CertifiedConstants& constants, std::uint32_t pairs) {
    const DeviceFunctions& vk = context_->vk;
    if (pass.queue == kNoQueue) {
        const std::uint32_t clusters = constants.endCluster - constants.firstCluster;
        vk.CmdDispatch(commandBuffer_, (clusters + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, pairs, 1);
        return;
    }
    const VkDeviceSize command = VkDeviceSize{constants.headerWord} + 4 * pass.queue;
    vk.CmdDispatchIndirect(commandBuffer_, results_->transforms.get(), command * sizeof(std::uint32_t));
}

void RoundRecorder::recordRound(std::span<const RoundPass> passes, VkPipelineLayout layout,
                                const shader::CertifiedConstants& given, std::uint32_t pairs) {
    const DeviceFunctions& vk = context_->vk;
    if (rounds_ > 0 && rounds_ % VOXTACT_HEADERS == 0) {
        renewHeaders(layout);
    } else if (rounds_ > 0) {
        queuesBarrier(*context_, commandBuffer_);
    }
    shader::CertifiedConstants constants = given;
    constants.headerWord = given.queueWord + rounds_ % VOXTACT_HEADERS * VOXTACT_HEADER_WORDS;
    ++rounds_;
    vk.CmdPushConstants(commandBuffer_, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
    VkPipeline bound = VK_NULL_HANDLE;
    for (const RoundPass& pass : passes) {
        if (pass.pipeline != bound) {
            vk.CmdBindPipeline(commandBuffer_, VK_PIPELINE_BIND_POINT_COMPUTE, pass.pipeline);
        }
        // The last pass again, for what had no room, only adds to what the other one adds to.
        if (pass.queue != kNoQueue && pass.pipeline != bound) {
            queuesBarrier(*context_, commandBuffer_);
        }
        dispatch(pass, constants, pairs);
        bound = pass.pipeline;
    }
}

void RoundRecorder::finish(VkPipelineLayout layout) {
    if (tally_ != VK_NULL_HANDLE && rounds_ > 0) {
        queuesBarrier(*context_, commandBuffer_);
        recordTally(layout, (rounds_ - 1) % VOXTACT_HEADERS + 1);
    }
}

void RoundRecorder::recordTally(VkPipelineLayout layout, std::uint32_t rounds) {
    const DeviceFunctions& vk = context_->vk;
    const shader::TallyConstants constants{firstQueueWord(*results_), results_->queueRoom, rounds};
    vk.CmdPushConstants(commandBuffer_, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
    vk.CmdBindPipeline(commandBuffer_, VK_PIPELINE_BIND_POINT_COMPUTE, tally_);
    vk.CmdDispatch(commandBuffer_, 1, 1, 1);
}

void RoundRecorder::renewHeaders(VkPipelineLayout layout) {
    if (tally_ != VK_NULL_HANDLE) {
        queuesBarrier(*context_, commandBuffer_);
        recordTally(layout, VOXTACT_HEADERS);
    }
    barrier(*context_, commandBuffer_, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
            VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    recordQueueHeaders(*context_, commandBuffer_, *results_);
    barrier(*context_, commandBuffer_, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

} // namespace voxtact
