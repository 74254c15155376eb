// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>

namespace voxtact {

// Every Vulkan function that voxtact calls.
#define VOXTACT_INSTANCE_FUNCTIONS(X)                                                                                  \
    X(GetDeviceProcAddr)                                                                                               \
    X(GetPhysicalDeviceProperties2)                                                                                    \
    X(GetPhysicalDeviceMemoryProperties)                                                                               \
    X(GetPhysicalDeviceQueueFamilyProperties)                                                                          \
    X(GetPhysicalDeviceFormatProperties)                                                                               \
    X(GetPhysicalDeviceImageFormatProperties)

#define VOXTACT_DEVICE_FUNCTIONS(X)                                                                                    \
    X(AllocateCommandBuffers)                                                                                          \
    X(AllocateDescriptorSets)                                                                                          \
    X(AllocateMemory)                                                                                                  \
    X(BeginCommandBuffer)                                                                                              \
    X(BindBufferMemory)                                                                                                \
    X(BindImageMemory)                                                                                                 \
    X(CmdBeginQuery)                                                                                                   \
    X(CmdBeginRendering)                                                                                               \
    X(CmdBindDescriptorSets)                                                                                           \
    X(CmdBindIndexBuffer)                                                                                              \
    X(CmdBindPipeline)                                                                                                 \
    X(CmdBindVertexBuffers2)                                                                                           \
    X(CmdCopyBuffer)                                                                                                   \
    X(CmdCopyBufferToImage)                                                                                            \
    X(CmdCopyImageToBuffer)                                                                                            \
    X(CmdCopyQueryPoolResults)                                                                                         \
    X(CmdDispatch)                                                                                                     \
    X(CmdDispatchIndirect)                                                                                             \
    X(CmdDraw)                                                                                                         \
    X(CmdDrawIndexed)                                                                                                  \
    X(CmdEndQuery)                                                                                                     \
    X(CmdEndRendering)                                                                                                 \
    X(CmdFillBuffer)                                                                                                   \
    X(CmdPipelineBarrier2)                                                                                             \
    X(CmdPushConstants)                                                                                                \
    X(CmdResetQueryPool)                                                                                               \
    X(CmdSetScissor)                                                                                                   \
    X(CmdSetViewport)                                                                                                  \
    X(CmdUpdateBuffer)                                                                                                 \
    X(CmdWriteTimestamp2)                                                                                              \
    X(CreateComputePipelines)                                                                                          \
    X(CreateBuffer)                                                                                                    \
    X(CreateCommandPool)                                                                                               \
    X(CreateDescriptorPool)                                                                                            \
    X(CreateDescriptorSetLayout)                                                                                       \
    X(CreateFence)                                                                                                     \
    X(CreateGraphicsPipelines)                                                                                         \
    X(CreateImage)                                                                                                     \
    X(CreateImageView)                                                                                                 \
    X(CreatePipelineLayout)                                                                                            \
    X(CreateQueryPool)                                                                                                 \
    X(CreateSampler)                                                                                                   \
    X(CreateShaderModule)                                                                                              \
    X(DestroyBuffer)                                                                                                   \
    X(DestroyCommandPool)                                                                                              \
    X(DestroyDescriptorPool)                                                                                           \
    X(DestroyDescriptorSetLayout)                                                                                      \
    X(DestroyFence)                                                                                                    \
    X(DestroyImage)                                                                                                    \
    X(DestroyImageView)                                                                                                \
    X(DestroyPipeline)                                                                                                 \
    X(DestroyPipelineLayout)                                                                                           \
    X(DestroyQueryPool)                                                                                                \
    X(DestroySampler)                                                                                                  \
    X(DestroyShaderModule)                                                                                             \
    X(EndCommandBuffer)                                                                                                \
    X(FreeMemory)                                                                                                      \
    X(GetBufferMemoryRequirements)                                                                                     \
    X(GetImageMemoryRequirements)                                                                                      \
    X(GetQueryPoolResults)                                                                                             \
    X(InvalidateMappedMemoryRanges)                                                                                    \
    X(FlushMappedMemoryRanges)                                                                                         \
    X(MapMemory)                                                                                                       \
    X(QueueSubmit2)                                                                                                    \
    X(QueueWaitIdle)                                                                                                   \
    X(ResetCommandPool)                                                                                                \
    X(ResetFences)                                                                                                     \
    X(UpdateDescriptorSets)                                                                                            \
    X(WaitForFences)

// Looked up only when VK_EXT_debug_utils was enabled; null otherwise.
#define VOXTACT_DEBUG_FUNCTIONS(X)                                                                                     \
    X(SetDebugUtilsObjectNameEXT)                                                                                      \
    X(CmdBeginDebugUtilsLabelEXT)                                                                                      \
    X(CmdEndDebugUtilsLabelEXT)

/// The private function table of one context. Members have Vulkan's names without the `vk`.
struct DeviceFunctions {
#define VOXTACT_MEMBER(name) PFN_vk##name name = nullptr;
    VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_MEMBER)
    VOXTACT_DEVICE_FUNCTIONS(VOXTACT_MEMBER)
    VOXTACT_DEBUG_FUNCTIONS(VOXTACT_MEMBER)
#undef VOXTACT_MEMBER

    /// Returns the name of the first function that the loader does not give, or null when all are there.
    const char* load(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance, VkDevice device,
                     bool debugUtils) noexcept;
};

} // namespace voxtact
