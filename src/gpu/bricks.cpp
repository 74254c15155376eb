// SPDX-License-Identifier: MIT
#include "gpu/bricks.h"
#include "core/base/try.h"
#include "core/volume/bricks.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/pipeline.h"

#include "brick_levels.h"

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

std::array<std::int32_t, 3> sizeOf(const VolumeImpl& volume) {
    return {static_cast<std::int32_t>(volume.grid.size[0]), static_cast<std::int32_t>(volume.grid.size[1]),
            static_cast<std::int32_t>(volume.grid.size[2])};
}

std::int32_t levelsOf(const VolumeImpl& volume) {
    const auto [x, y, z] = sizeOf(volume);
    return shader::brickLevels(x, y, z);
}

shader::BrickLevel levelOf(const VolumeImpl& volume, std::int32_t level) {
    const auto [x, y, z] = sizeOf(volume);
    return shader::brickLevel(x, y, z, level);
}

} // namespace

Result<void> makeBricks(VolumeImpl& volume, const char* name) {
    ContextImpl& context = volume.context;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        volume.brickCount[axis] = brickCount(static_cast<std::int32_t>(volume.grid.size[axis]));
    }
    VkDeviceSize bytes = 0;
    for (std::int32_t level = 0; level < levelsOf(volume); ++level) {
        const shader::BrickLevel nodes = levelOf(volume, level);
        bytes += sizeof(shader::vec4) * static_cast<VkDeviceSize>(nodes.countX) *
                 static_cast<VkDeviceSize>(nodes.countY) * static_cast<VkDeviceSize>(nodes.countZ);
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
    std::array<BrickSpan, 3> spans{spanOf(volume, changed, 0), spanOf(volume, changed, 1), spanOf(volume, changed, 2)};
    const auto [sizeX, sizeY, sizeZ] = sizeOf(volume);
    for (std::int32_t level = 0; level < levelsOf(volume); ++level) {
        if (level > 0) {
            barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
            for (BrickSpan& span : spans) {
                span = {span.first >> VOXTACT_LEVEL_SHIFT, ((span.end - 1) >> VOXTACT_LEVEL_SHIFT) + 1};
            }
        }
        const auto [x, y, z] = spans;
        const shader::BrickConstants constants{x.first, y.first, z.first, sizeX,
                                               sizeY,   sizeZ,   level,   static_cast<float>(volume.storedUnit)};
        vk.CmdPushConstants(commandBuffer, context.computeLayout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants,
                            &constants);
        vk.CmdDispatch(commandBuffer, static_cast<std::uint32_t>(x.end - x.first),
                       static_cast<std::uint32_t>(y.end - y.first), static_cast<std::uint32_t>(z.end - z.first));
    }
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

} // namespace voxtact
