// SPDX-License-Identifier: MIT
// The objects of PretendDriver but for its command buffers.
#include "exact/shared.h"
#include "pretend_state.h"
#include "vulkan/float_controls.h"

#include "voxtact_shaders/bricks_comp.h"
#include "voxtact_shaders/certified_tally_comp.h"
#include "voxtact_shaders/edit_comp.h"
#include "voxtact_shaders/operations_doubles_comp.h"

#include <algorithm>
#include <cstring>

namespace voxtact::test::pretended {

namespace {

constexpr std::byte kNeverWritten{0xA5};

std::size_t texelBytes(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R8_UNORM:
        return 1;
    case VK_FORMAT_R16_UNORM:
    case VK_FORMAT_R16_UINT:
        return 2;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return 8;
    default:
        return 4;
    }
}

std::uint64_t hashOf(std::span<const std::uint32_t> words) {
    Hash hash;
    hash.add(std::as_bytes(words));
    return hash.value();
}

/// Of a shader as the library gives it to this driver.
std::uint64_t moduleHash(std::span<const std::uint32_t> words) {
    return hashOf(withFloatControls(words, {.keepsSpecials = true, .roundsToNearest = true}));
}
std::uint64_t bricksHash() {
    static const std::uint64_t hash = moduleHash(spirv::bricks_comp);
    return hash;
}
std::uint64_t editHash() {
    static const std::uint64_t hash = moduleHash(spirv::edit_comp);
    return hash;
}
std::uint64_t tallyHash() {
    static const std::uint64_t hash = moduleHash(spirv::certified_tally_comp);
    return hash;
}
std::uint64_t operationsHash() {
    static const std::uint64_t hash = moduleHash(spirv::operations_doubles_comp);
    return hash;
}

/// The specialization constants of a stage, as the library writes them.
void specialize(PretendPipeline& pipeline, Hash& hash, const VkSpecializationInfo* info) {
    for (std::uint32_t i = 0; info != nullptr && i < info->mapEntryCount; ++i) {
        const VkSpecializationMapEntry& entry = info->pMapEntries[i];
        std::uint32_t value = 0;
        std::memcpy(&value, static_cast<const std::byte*>(info->pData) + entry.offset, sizeof value);
        hash.number(entry.constantID);
        hash.number(value);
        if (entry.constantID == VOXTACT_CONSTANT_VIEWS) {
            pipeline.views = value;
        } else if (entry.constantID == VOXTACT_CONSTANT_OUTPUTS) {
            pipeline.outputs = value;
        } else if (entry.constantID == VOXTACT_CONSTANT_STOP_AT_FIRST) {
            pipeline.certified = true;
        }
    }
}

VkPipeline makePipeline(std::span<const VkPipelineShaderStageCreateInfo> stages, VkPipelineLayout layoutHandle,
                        std::uint32_t vertexBuffers, bool draws) {
    PretendState& s = pretend();
    PretendPipeline pipeline;
    pipeline.vertexBuffers = vertexBuffers;
    Hash hash;
    for (const VkPipelineShaderStageCreateInfo& stage : stages) {
        if (const PretendShaderModule* module = s.get(s.modules, stage.module)) {
            hash.number(module->hash);
            pipeline.bricks = pipeline.bricks || module->bricks;
            pipeline.operations = pipeline.operations || module->operations;
            pipeline.edits = pipeline.edits || module->edits;
            pipeline.tally = pipeline.tally || module->tally;
        }
        specialize(pipeline, hash, stage.pSpecializationInfo);
    }
    pipeline.hash = hash.value();
    if (const PretendPipelineLayout* layout = s.get(s.pipelineLayouts, layoutHandle)) {
        pipeline.sets = layout->sets.size();
        const PretendSetLayout* last =
            pipeline.sets == VOXTACT_SET_TRACE + 1 ? s.get(s.setLayouts, layout->sets.back()) : nullptr;
        pipeline.lists = draws && last != nullptr && last->bindings.size() == 1;
    }
    return s.pipelines.add(s.next++, pipeline);
}

/// The device's and the host's bytes of a mapped range.
std::pair<std::span<std::byte>, std::span<std::byte>> bothSides(const VkMappedMemoryRange& range) {
    PretendState& s = pretend();
    PretendMemory* memory = s.get(s.memories, range.memory);
    if (memory == nullptr) {
        return {};
    }
    const VkDeviceSize all = memory->bytes.size();
    const VkDeviceSize end = range.size == VK_WHOLE_SIZE ? all : range.offset + range.size;
    if (memory->host.empty() || end > all || range.offset % kAtom != 0 || (end % kAtom != 0 && end != all)) {
        s.complain("a range is flushed or invalidated that is not mapped, beyond its memory or not of whole atoms");
        return {};
    }
    return {std::span(memory->bytes).subspan(range.offset, end - range.offset),
            std::span(memory->host).subspan(range.offset, end - range.offset)};
}

} // namespace

VkResult VKAPI_CALL AllocateMemory(VkDevice, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks*,
                                   VkDeviceMemory* out) {
    PretendState& s = pretend();
    PretendMemory memory;
    memory.bytes.assign(info->allocationSize, kNeverWritten);
    *out = s.memories.add(s.next++, std::move(memory));
    return VK_SUCCESS;
}
void VKAPI_CALL FreeMemory(VkDevice, VkDeviceMemory memory, const VkAllocationCallbacks*) {
    pretend().end(pretend().memories, memory);
}
VkResult VKAPI_CALL MapMemory(VkDevice, VkDeviceMemory handle, VkDeviceSize, VkDeviceSize, VkMemoryMapFlags,
                              void** out) {
    PretendMemory* memory = pretend().get(pretend().memories, handle);
    if (memory != nullptr) {
        memory->host.assign(memory->bytes.size(), kNeverWritten);
        *out = memory->host.data();
    }
    return VK_SUCCESS;
}

VkResult VKAPI_CALL FlushMappedMemoryRanges(VkDevice, std::uint32_t count, const VkMappedMemoryRange* ranges) {
    for (const VkMappedMemoryRange& range : std::span(ranges, count)) {
        const auto [device, host] = bothSides(range);
        std::ranges::copy(host, device.begin());
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL InvalidateMappedMemoryRanges(VkDevice, std::uint32_t count, const VkMappedMemoryRange* ranges) {
    for (const VkMappedMemoryRange& range : std::span(ranges, count)) {
        const auto [device, host] = bothSides(range);
        std::ranges::copy(device, host.begin());
    }
    return VK_SUCCESS;
}

VkResult VKAPI_CALL CreateBuffer(VkDevice, const VkBufferCreateInfo* info, const VkAllocationCallbacks*,
                                 VkBuffer* out) {
    PretendState& s = pretend();
    *out = s.buffers.add(s.next++, {info->size, 0, 0});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyBuffer(VkDevice, VkBuffer buffer, const VkAllocationCallbacks*) {
    PretendState& s = pretend();
    if (const PretendBuffer* found = s.buffers.find(bitsOf(buffer))) {
        s.unbind(found->memory, found->offset);
    }
    s.end(s.buffers, buffer);
}
void VKAPI_CALL GetBufferMemoryRequirements(VkDevice, VkBuffer handle, VkMemoryRequirements* out) {
    const PretendBuffer* buffer = pretend().get(pretend().buffers, handle);
    *out = {buffer == nullptr ? 0 : buffer->size, kAlignment, 0b11};
}
VkResult VKAPI_CALL BindBufferMemory(VkDevice, VkBuffer handle, VkDeviceMemory memory, VkDeviceSize offset) {
    if (PretendBuffer* buffer = pretend().get(pretend().buffers, handle)) {
        buffer->memory = bitsOf(memory);
        buffer->offset = offset;
        pretend().bind(buffer->memory, offset, buffer->size);
    }
    return VK_SUCCESS;
}

VkResult VKAPI_CALL CreateImage(VkDevice, const VkImageCreateInfo* info, const VkAllocationCallbacks*, VkImage* out) {
    PretendState& s = pretend();
    *out = s.images.add(s.next++, {info->extent, texelBytes(info->format), 0, 0});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyImage(VkDevice, VkImage image, const VkAllocationCallbacks*) {
    PretendState& s = pretend();
    if (const PretendImage* found = s.images.find(bitsOf(image))) {
        s.unbind(found->memory, found->offset);
    }
    s.end(s.images, image);
}
void VKAPI_CALL GetImageMemoryRequirements(VkDevice, VkImage handle, VkMemoryRequirements* out) {
    const PretendImage* image = pretend().get(pretend().images, handle);
    *out = {image == nullptr ? 0 : image->bytes(), kAlignment, 0b01};
}
VkResult VKAPI_CALL BindImageMemory(VkDevice, VkImage handle, VkDeviceMemory memory, VkDeviceSize offset) {
    if (PretendImage* image = pretend().get(pretend().images, handle)) {
        image->memory = bitsOf(memory);
        image->offset = offset;
        pretend().bind(image->memory, offset, image->bytes());
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL CreateImageView(VkDevice, const VkImageViewCreateInfo* info, const VkAllocationCallbacks*,
                                    VkImageView* out) {
    PretendState& s = pretend();
    *out = s.views.add(s.next++, {bitsOf(info->image)});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyImageView(VkDevice, VkImageView view, const VkAllocationCallbacks*) {
    pretend().end(pretend().views, view);
}

VkResult VKAPI_CALL CreateSampler(VkDevice, const VkSamplerCreateInfo*, const VkAllocationCallbacks*, VkSampler* out) {
    *out = pretend().samplers.add(pretend().next++, 0);
    return VK_SUCCESS;
}
void VKAPI_CALL DestroySampler(VkDevice, VkSampler sampler, const VkAllocationCallbacks*) {
    pretend().end(pretend().samplers, sampler);
}

VkResult VKAPI_CALL CreateDescriptorSetLayout(VkDevice, const VkDescriptorSetLayoutCreateInfo* info,
                                              const VkAllocationCallbacks*, VkDescriptorSetLayout* out) {
    PretendState& s = pretend();
    *out = s.setLayouts.add(s.next++, {{info->pBindings, info->pBindings + info->bindingCount}});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyDescriptorSetLayout(VkDevice, VkDescriptorSetLayout layout, const VkAllocationCallbacks*) {
    pretend().end(pretend().setLayouts, layout);
}
VkResult VKAPI_CALL CreatePipelineLayout(VkDevice, const VkPipelineLayoutCreateInfo* info, const VkAllocationCallbacks*,
                                         VkPipelineLayout* out) {
    PretendState& s = pretend();
    PretendPipelineLayout layout;
    for (std::uint32_t i = 0; i < info->setLayoutCount; ++i) {
        layout.sets.push_back(bitsOf(info->pSetLayouts[i]));
    }
    *out = s.pipelineLayouts.add(s.next++, std::move(layout));
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyPipelineLayout(VkDevice, VkPipelineLayout layout, const VkAllocationCallbacks*) {
    pretend().end(pretend().pipelineLayouts, layout);
}

VkResult VKAPI_CALL CreateShaderModule(VkDevice, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks*,
                                       VkShaderModule* out) {
    PretendState& s = pretend();
    const std::uint64_t hash = hashOf({info->pCode, info->codeSize / sizeof(std::uint32_t)});
    *out = s.modules.add(
        s.next++, {hash, hash == bricksHash(), hash == operationsHash(), hash == editHash(), hash == tallyHash()});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyShaderModule(VkDevice, VkShaderModule module, const VkAllocationCallbacks*) {
    pretend().end(pretend().modules, module);
}
VkResult VKAPI_CALL CreateGraphicsPipelines(VkDevice, VkPipelineCache, std::uint32_t count,
                                            const VkGraphicsPipelineCreateInfo* infos, const VkAllocationCallbacks*,
                                            VkPipeline* out) {
    for (std::uint32_t i = 0; i < count; ++i) {
        out[i] = makePipeline({infos[i].pStages, infos[i].stageCount}, infos[i].layout,
                              infos[i].pVertexInputState->vertexBindingDescriptionCount, true);
    }
    return VK_SUCCESS;
}
VkResult VKAPI_CALL CreateComputePipelines(VkDevice, VkPipelineCache, std::uint32_t count,
                                           const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks*,
                                           VkPipeline* out) {
    for (std::uint32_t i = 0; i < count; ++i) {
        out[i] = makePipeline({&infos[i].stage, 1}, infos[i].layout, 0, false);
    }
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyPipeline(VkDevice, VkPipeline pipeline, const VkAllocationCallbacks*) {
    pretend().end(pretend().pipelines, pipeline);
}

VkResult VKAPI_CALL CreateDescriptorPool(VkDevice, const VkDescriptorPoolCreateInfo*, const VkAllocationCallbacks*,
                                         VkDescriptorPool* out) {
    *out = pretend().descriptorPools.add(pretend().next++, {});
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyDescriptorPool(VkDevice, VkDescriptorPool handle, const VkAllocationCallbacks*) {
    PretendState& s = pretend();
    if (const std::vector<Id>* pool = s.descriptorPools.find(bitsOf(handle))) {
        std::ranges::for_each(*pool, [&](Id set) { s.sets.remove(set); });
    }
    s.end(s.descriptorPools, handle);
}
VkResult VKAPI_CALL AllocateDescriptorSets(VkDevice, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* out) {
    PretendState& s = pretend();
    std::vector<Id>* pool = s.get(s.descriptorPools, info->descriptorPool);
    for (std::uint32_t i = 0; pool != nullptr && i < info->descriptorSetCount; ++i) {
        pool->push_back(s.next);
        out[i] = s.sets.add(s.next++, {bitsOf(info->descriptorPool), {}});
    }
    return VK_SUCCESS;
}
void VKAPI_CALL UpdateDescriptorSets(VkDevice, std::uint32_t count, const VkWriteDescriptorSet* writes, std::uint32_t,
                                     const VkCopyDescriptorSet*) {
    PretendState& s = pretend();
    for (const VkWriteDescriptorSet& write : std::span(writes, count)) {
        PretendDescriptorSet* set = s.get(s.sets, write.dstSet);
        if (set == nullptr) {
            continue;
        }
        s.expectIdle(write.dstSet, "written");
        PretendDescriptor descriptor{.type = write.descriptorType};
        if (write.pBufferInfo != nullptr) {
            descriptor.buffer = bitsOf(write.pBufferInfo->buffer);
            descriptor.offset = write.pBufferInfo->offset;
            descriptor.range = write.pBufferInfo->range;
            s.get(s.buffers, descriptor.buffer);
        } else {
            descriptor.view = bitsOf(write.pImageInfo->imageView);
            s.get(s.views, descriptor.view);
        }
        set->bindings[write.dstBinding] = descriptor;
    }
}

VkResult VKAPI_CALL CreateQueryPool(VkDevice, const VkQueryPoolCreateInfo* info, const VkAllocationCallbacks*,
                                    VkQueryPool* out) {
    PretendQueryPool pool;
    pool.values.resize(info->queryCount);
    *out = pretend().queryPools.add(pretend().next++, std::move(pool));
    return VK_SUCCESS;
}
void VKAPI_CALL DestroyQueryPool(VkDevice, VkQueryPool pool, const VkAllocationCallbacks*) {
    pretend().end(pretend().queryPools, pool);
}
VkResult VKAPI_CALL GetQueryPoolResults(VkDevice, VkQueryPool handle, std::uint32_t first, std::uint32_t count,
                                        std::size_t, void* out, VkDeviceSize stride, VkQueryResultFlags flags) {
    PretendState& s = pretend();
    const PretendQueryPool* pool = s.get(s.queryPools, handle);
    for (std::uint32_t i = 0; pool != nullptr && i < count; ++i) {
        const std::optional<std::uint64_t>& value = pool->values.at(first + i);
        if (!value && (flags & VK_QUERY_RESULT_WAIT_BIT) != 0) {
            s.complain("a query is waited for that will never be there");
        }
        if (!value) {
            return VK_NOT_READY;
        }
        std::memcpy(static_cast<std::byte*>(out) + i * stride, &*value, sizeof *value);
    }
    return VK_SUCCESS;
}

} // namespace voxtact::test::pretended
