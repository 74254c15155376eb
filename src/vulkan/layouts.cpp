// SPDX-License-Identifier: MIT
#include "vulkan/layouts.h"
#include "core/base/try.h"
#include "vulkan/context_impl.h"
#include "vulkan/debug.h"

namespace voxtact {

Result<void> makeSetLayout(ContextImpl& context, VkDescriptorSetLayout& out,
                           std::span<const VkDescriptorSetLayoutBinding> bindings, const char* name) {
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    // What a failed call leaves in it is nothing to destroy.
    VkDescriptorSetLayout made = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateDescriptorSetLayout(context.device, &info, context.allocator, &made);
        result != VK_SUCCESS) {
        return context.failure(result, "making a descriptor set layout");
    }
    out = made;
    nameObject(context, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, out, name);
    return {};
}

Result<void> makeSetLayout(ContextImpl& context, Owned<VkDescriptorSetLayout>& out,
                           std::span<const VkDescriptorSetLayoutBinding> bindings, const char* name) {
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    VOXTACT_TRY(makeSetLayout(context, layout, bindings, name));
    out = {context, layout, [](ContextImpl& c, VkDescriptorSetLayout handle) {
               c.vk.DestroyDescriptorSetLayout(c.device, handle, c.allocator);
           }};
    return {};
}

Result<void> makePipelineLayout(ContextImpl& context, VkPipelineLayout& out,
                                std::span<const VkDescriptorSetLayout> sets,
                                std::span<const VkPushConstantRange> constants, const char* name) {
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = static_cast<std::uint32_t>(constants.size());
    info.pPushConstantRanges = constants.data();
    VkPipelineLayout made = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreatePipelineLayout(context.device, &info, context.allocator, &made);
        result != VK_SUCCESS) {
        return context.failure(result, "making a pipeline layout");
    }
    out = made;
    nameObject(context, VK_OBJECT_TYPE_PIPELINE_LAYOUT, out, name);
    return {};
}

Result<void> makePipelineLayout(ContextImpl& context, Owned<VkPipelineLayout>& out,
                                std::span<const VkDescriptorSetLayout> sets,
                                std::span<const VkPushConstantRange> constants, const char* name) {
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VOXTACT_TRY(makePipelineLayout(context, layout, sets, constants, name));
    out = {context, layout,
           [](ContextImpl& c, VkPipelineLayout handle) { c.vk.DestroyPipelineLayout(c.device, handle, c.allocator); }};
    return {};
}

} // namespace voxtact
