// SPDX-License-Identifier: MIT
#pragma once

#include "exact/shared.h"
#include "vulkan/memory/memory.h"

#include <algorithm>

namespace voxtact {

/// Of all pipelines that compute with the sets of ContextImpl::computeLayout.
inline constexpr VkPushConstantRange kComputeConstants[] = {
    {VK_SHADER_STAGE_COMPUTE_BIT, 0, std::max(sizeof(shader::ComputeConstants), sizeof(shader::CertifiedConstants))},
};

/// Layouts of descriptor sets and of pipelines. A bare handle is the caller's to destroy.
[[nodiscard]] Result<void> makeSetLayout(ContextImpl& context, VkDescriptorSetLayout& out,
                                         std::span<const VkDescriptorSetLayoutBinding> bindings, const char* name);
[[nodiscard]] Result<void> makeSetLayout(ContextImpl& context, Owned<VkDescriptorSetLayout>& out,
                                         std::span<const VkDescriptorSetLayoutBinding> bindings, const char* name);

[[nodiscard]] Result<void> makePipelineLayout(ContextImpl& context, VkPipelineLayout& out,
                                              std::span<const VkDescriptorSetLayout> sets,
                                              std::span<const VkPushConstantRange> constants, const char* name);
[[nodiscard]] Result<void> makePipelineLayout(ContextImpl& context, Owned<VkPipelineLayout>& out,
                                              std::span<const VkDescriptorSetLayout> sets,
                                              std::span<const VkPushConstantRange> constants, const char* name);

} // namespace voxtact
