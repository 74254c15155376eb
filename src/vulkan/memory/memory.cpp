// SPDX-License-Identifier: MIT
#include "vulkan/memory/memory.h"

#include "core/base/try.h"
#include "vulkan/debug.h"

#include <string>

namespace voxtact {

namespace {

Result<Owned<VkImageView>> makeView(ContextImpl& context, VkImage image, const ImageDesc& desc) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image;
    info.viewType = desc.viewType;
    info.format = desc.format;
    info.subresourceRange = {desc.aspect, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateImageView(context.device, &info, context.allocator, &view);
        result != VK_SUCCESS) {
        return context.failure(result, "making an image view");
    }
    return Owned<VkImageView>(context, view, [](ContextImpl& c, VkImageView handle) {
        c.vk.DestroyImageView(c.device, handle, c.allocator);
    });
}

} // namespace

Result<Buffer> makeBuffer(ContextImpl& context, VkDeviceSize size, VkBufferUsageFlags usage, MemoryUse use,
                          const char* name) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    context.share(info);
    info.size = size;
    info.usage = usage;
    VkBuffer handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateBuffer(context.device, &info, context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, "making a buffer");
    }
    Buffer out;
    out.size = size;
    out.buffer = Owned<VkBuffer>(
        context, handle, [](ContextImpl& c, VkBuffer buffer) { c.vk.DestroyBuffer(c.device, buffer, c.allocator); });
    VkMemoryRequirements needs{};
    context.vk.GetBufferMemoryRequirements(context.device, handle, &needs);
    Result<Memory> memory = MemoryPool::allocate(
        context, {.requirements = needs, .use = use, .buffer = handle, .what = name, .name = name});
    VOXTACT_TRY(memory);
    out.memory = std::move(*memory);
    const DeviceMemory& place = out.memory.get();
    if (const VkResult result = context.vk.BindBufferMemory(context.device, handle, place.memory, place.offset);
        result != VK_SUCCESS) {
        return context.failure(result, "binding a buffer's memory");
    }
    out.mapped = use == MemoryUse::Device ? nullptr : place.mapped;
    nameObject(context, VK_OBJECT_TYPE_BUFFER, handle, name);
    return out;
}

Result<VkBuffer> emptyBuffer(ContextImpl& context) {
    constexpr VkDeviceSize kBytes = 16;
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.nothing.buffer) {
        Result<Buffer> made =
            makeBuffer(context, kBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::Device, "empty binding");
        VOXTACT_TRY(made);
        context.nothing = std::move(*made);
    }
    return context.nothing.get();
}

Result<void> makeStaged(ContextImpl& context, VkDeviceSize size, VkBufferUsageFlags usage, const char* name,
                        Buffer& buffer, Buffer& staging) {
    Result<Buffer> onDevice =
        makeBuffer(context, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Device, name);
    VOXTACT_TRY(onDevice);
    Result<Buffer> mapped = makeBuffer(context, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload,
                                       (std::string(name) + " staging").c_str());
    VOXTACT_TRY(mapped);
    buffer = std::move(*onDevice);
    staging = std::move(*mapped);
    return {};
}

Result<void> flush(ContextImpl& context, const Buffer& buffer) {
    if (const auto range = buffer.memory.incoherent()) {
        if (const VkResult result = context.vk.FlushMappedMemoryRanges(context.device, 1, &*range);
            result != VK_SUCCESS) {
            return context.failure(result, "flushing host memory");
        }
    }
    return {};
}

Result<void> invalidate(ContextImpl& context, const Buffer& buffer) {
    if (const auto range = buffer.memory.incoherent()) {
        if (const VkResult result = context.vk.InvalidateMappedMemoryRanges(context.device, 1, &*range);
            result != VK_SUCCESS) {
            return context.failure(result, "invalidating host memory");
        }
    }
    return {};
}

Result<Image> makeImage(ContextImpl& context, const ImageDesc& desc, const char* what, const char* name) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    context.share(info);
    info.imageType = desc.type;
    info.format = desc.format;
    info.extent = desc.extent;
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    VkImage handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateImage(context.device, &info, context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, (std::string("making the image of ") + what).c_str());
    }
    Image out;
    out.image = Owned<VkImage>(context, handle,
                               [](ContextImpl& c, VkImage image) { c.vk.DestroyImage(c.device, image, c.allocator); });
    VkMemoryRequirements needs{};
    context.vk.GetImageMemoryRequirements(context.device, handle, &needs);
    Result<Memory> memory =
        MemoryPool::allocate(context, {.requirements = needs, .image = handle, .what = what, .name = name});
    VOXTACT_TRY(memory);
    out.memory = std::move(*memory);
    const DeviceMemory& place = out.memory.get();
    if (const VkResult result = context.vk.BindImageMemory(context.device, handle, place.memory, place.offset);
        result != VK_SUCCESS) {
        return context.failure(result, "binding an image's memory");
    }
    Result<Owned<VkImageView>> view = makeView(context, handle, desc);
    VOXTACT_TRY(view);
    out.view = std::move(*view);
    nameObject(context, VK_OBJECT_TYPE_IMAGE, handle, name);
    nameObject(context, VK_OBJECT_TYPE_IMAGE_VIEW, out.view.get(), name);
    return out;
}

Result<DescriptorSet> makeDescriptorSet(ContextImpl& context, VkDescriptorSetLayout layout,
                                        std::span<const VkDescriptorPoolSize> sizes, const char* name) {
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateDescriptorPool(context.device, &poolInfo, context.allocator, &pool);
        result != VK_SUCCESS) {
        return context.failure(result, "making a descriptor pool");
    }
    DescriptorSet out;
    out.pool = Owned<VkDescriptorPool>(context, pool, [](ContextImpl& c, VkDescriptorPool handle) {
        c.vk.DestroyDescriptorPool(c.device, handle, c.allocator);
    });
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    if (const VkResult result = context.vk.AllocateDescriptorSets(context.device, &info, &out.set);
        result != VK_SUCCESS) {
        return context.failure(result, "allocating a descriptor set");
    }
    nameObject(context, VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, name);
    nameObject(context, VK_OBJECT_TYPE_DESCRIPTOR_SET, out.set, name);
    return out;
}

void writeImage(ContextImpl& context, VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                VkImageView view, VkImageLayout layout, VkSampler sampler) {
    const bool combined = type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const VkDescriptorImageInfo image{combined && sampler == VK_NULL_HANDLE ? context.sampler : sampler, view, layout};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    write.pImageInfo = &image;
    context.vk.UpdateDescriptorSets(context.device, 1, &write, 0, nullptr);
}

void writeBuffer(ContextImpl& context, VkDescriptorSet set, std::uint32_t binding, VkBuffer buffer, VkDeviceSize range,
                 VkDeviceSize offset) {
    const VkDescriptorBufferInfo part{buffer, offset, range};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &part;
    context.vk.UpdateDescriptorSets(context.device, 1, &write, 0, nullptr);
}

} // namespace voxtact
