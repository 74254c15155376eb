// SPDX-License-Identifier: MIT
#include "device/scene/edit_pass.h"
#include "core/base/try.h"
#include "exact/shared.h"
#include "vulkan/layouts.h"
#include "vulkan/pipeline.h"

#include "voxtact_shaders/edit_comp.h"

#include <algorithm>

namespace voxtact {

namespace {

constexpr VkDeviceSize kWord = 4;
/// Room for texels, where a slice needs less; and for rows: what one vkCmdUpdateBuffer takes.
constexpr VkDeviceSize kTexelBytes = VkDeviceSize{1} << 20U;
constexpr VkDeviceSize kRowBytes = 65536;
constexpr VkDeviceSize kBytesOfRow = 2 * sizeof(std::uint32_t);

/// Made for the first volume that can be edited. Its set is like that of pairs: two storage buffers.
Result<VkPipelineLayout> editLayout(ContextImpl& context) {
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.editLayout) {
        constexpr VkPushConstantRange kConstants{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(shader::EditConstants)};
        VOXTACT_TRY(makePipelineLayout(context, context.editLayout, {&context.setLayouts[VOXTACT_SET_PAIRS], 1},
                                       {&kConstants, 1}, "edit pipeline layout"));
    }
    return context.editLayout.get();
}

VkDeviceSize roundedUp(VkDeviceSize bytes) {
    return (bytes + kWord - 1) / kWord * kWord;
}

} // namespace

Result<void> makeEditPass(VolumeImpl& volume) {
    ContextImpl& context = volume.context;
    static_assert(VOXTACT_BINDING_EDIT_ROWS == VOXTACT_BINDING_TRANSFORMS &&
                  VOXTACT_BINDING_EDIT_TEXELS == VOXTACT_BINDING_RESULTS);
    const Result<VkPipelineLayout> layout = editLayout(context);
    VOXTACT_TRY(layout);
    const Result<VkPipeline> pipeline = computePipeline(context, spirv::edit_comp, {}, *layout, "volume edit");
    VOXTACT_TRY(pipeline);
    volume.editPipeline = *pipeline;
    const auto& size = volume.grid.size;
    const VkDeviceSize slice = roundedUp(VkDeviceSize{size[0]} * size[1] * bytesPerVoxel(volume.type));
    if (slice > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "a slice of the editable volume has " + std::to_string(slice) +
                         " bytes, the device's maxStorageBufferRange is " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    const VkDeviceSize whole = roundedUp(voxelCount(volume.grid) * bytesPerVoxel(volume.type));
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Result<Buffer> scratch = makeBuffer(context, std::min(std::max(slice, kTexelBytes), whole),
                                        kUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Device, "volume edits");
    VOXTACT_TRY(scratch);
    volume.editScratch = std::move(*scratch);
    Result<Buffer> rows = makeBuffer(context, std::max<VkDeviceSize>(size[1] * kBytesOfRow, kRowBytes), kUsage,
                                     MemoryUse::Device, "rows of volume edits");
    VOXTACT_TRY(rows);
    volume.editRows = std::move(*rows);
    const VkDescriptorPoolSize buffers{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    Result<DescriptorSet> set =
        makeDescriptorSet(context, context.setLayouts[VOXTACT_SET_PAIRS], {&buffers, 1}, "volume edits");
    VOXTACT_TRY(set);
    volume.editSet = std::move(*set);
    writeBuffer(context, volume.editSet.set, VOXTACT_BINDING_EDIT_ROWS, volume.editRows.get());
    writeBuffer(context, volume.editSet.set, VOXTACT_BINDING_EDIT_TEXELS, volume.editScratch.get());
    return {};
}

std::uint32_t slicesAtOnce(const VolumeImpl& volume, const VoxelBox& box) noexcept {
    const VkDeviceSize slice = VkDeviceSize{box.size[0]} * box.size[1] * bytesPerVoxel(volume.type);
    const VkDeviceSize slices =
        std::min(volume.editScratch.size / slice, volume.editRows.size / (kBytesOfRow * box.size[1]));
    return static_cast<std::uint32_t>(std::clamp<VkDeviceSize>(slices, 1, box.size[2]));
}

void cmdChangeRows(const VolumeImpl& volume, VkCommandBuffer commandBuffer, const VoxelBox& box, std::uint32_t word) {
    const ContextImpl& context = volume.context;
    const DeviceFunctions& vk = context.vk;
    const VkPipelineLayout layout = context.editLayout.get();
    const auto texelBytes = static_cast<std::uint32_t>(bytesPerVoxel(volume.type));
    const shader::EditConstants constants{box.size[0], box.size[1] * box.size[2], texelBytes, word};
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, volume.editPipeline);
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &volume.editSet.set, 0,
                             nullptr);
    vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
    const VkDeviceSize words = roundedUp(VkDeviceSize{constants.rowTexels} * constants.rows * texelBytes) / kWord;
    const VkDeviceSize groups = (words + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
    const VkDeviceSize across = std::min<VkDeviceSize>(groups, context.limits.maxComputeWorkGroupCount[0]);
    vk.CmdDispatch(commandBuffer, static_cast<std::uint32_t>(across),
                   static_cast<std::uint32_t>((groups + across - 1) / across), 1);
}

std::vector<std::uint32_t> rowTable(std::span<const VoxelRow> rows, const VoxelBox& box) {
    std::vector<std::uint32_t> table(std::size_t{2} * box.size[1] * box.size[2]);
    for (const VoxelRow& row : rows) {
        const std::size_t at =
            std::size_t{2} * ((row.y - box.first[1]) + std::size_t{box.size[1]} * (row.z - box.first[2]));
        table[at] = row.firstX - box.first[0];
        table[at + 1] = row.endX - box.first[0];
    }
    return table;
}

} // namespace voxtact
