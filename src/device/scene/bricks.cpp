// SPDX-License-Identifier: MIT
#include "device/scene/bricks.h"
#include "core/base/try.h"
#include "core/volume/bricks.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/pipeline.h"

#include "voxtact_shaders/bricks_comp.h"

namespace voxtact {

namespace {

Result<VkPipeline> bricksPipeline(ContextImpl& context) {
    if (context.computeLayout == VK_NULL_HANDLE) {
        return Error{ErrorCode::Unsupported, 0,
                     "bricks cannot be had on this device: its maxPerStageDescriptorStorageBuffers is " +
                         std::to_string(context.limits.maxPerStageDescriptorStorageBuffers) + ", " +
                         std::to_string(kComputeStorageBuffers) + " are needed"};
    }
    return computePipeline(context, spirv::bricks_comp, {}, context.computeLayout, "bricks");
}

BrickSpan spanOf(const VolumeImpl& volume, const VoxelBox& changed, std::size_t axis) {
    return bricksOfVoxels(static_cast<std::int32_t>(changed.first[axis]),
                          static_cast<std::int32_t>(changed.first[axis] + changed.size[axis]),
                          static_cast<std::int32_t>(volume.grid.size[axis]));
}

} // namespace

Result<void> makeBricks(VolumeImpl& volume, const char* name) {
    ContextImpl& context = volume.context;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        volume.brickCount[axis] = brickCount(static_cast<std::int32_t>(volume.grid.size[axis]));
    }
    VkDeviceSize bytes = sizeof(shader::vec4);
    for (const std::int32_t count : volume.brickCount) {
        bytes *= static_cast<VkDeviceSize>(count);
    }
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the volume's bricks have " + std::to_string(bytes) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    const Result<VkPipeline> pipeline = bricksPipeline(context);
    VOXTACT_TRY(pipeline);
    volume.brickPipeline = *pipeline;
    Result<Buffer> buffer =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                   MemoryUse::Device, (std::string(name) + " bricks").c_str());
    VOXTACT_TRY(buffer);
    volume.bricks = std::move(*buffer);
    return {};
}

void cmdBricks(VolumeImpl& volume, VkCommandBuffer commandBuffer, const VoxelBox& changed) {
    ContextImpl& context = volume.context;
    volume.bricksFilled = volume.bricksFilled || changed.size == volume.grid.size;
    const DeviceFunctions& vk = context.vk;
    const Label label(context, commandBuffer, "voxtact bricks");
    // Earlier readers of the bricks must be done, earlier writers of the bricks and of the image too.
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, volume.brickPipeline);
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, context.computeLayout, VOXTACT_SET_VOLUME,
                             1, &volume.descriptors.set, 0, nullptr);
    const BrickSpan x = spanOf(volume, changed, 0);
    const BrickSpan y = spanOf(volume, changed, 1);
    const BrickSpan z = spanOf(volume, changed, 2);
    const shader::BrickConstants constants{x.first, y.first, z.first, static_cast<float>(volume.storedUnit)};
    vk.CmdPushConstants(commandBuffer, context.computeLayout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants,
                        &constants);
    vk.CmdDispatch(commandBuffer, static_cast<std::uint32_t>(x.end - x.first),
                   static_cast<std::uint32_t>(y.end - y.first), static_cast<std::uint32_t>(z.end - z.first));
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

} // namespace voxtact
