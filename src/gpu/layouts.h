// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/memory.h"

namespace voxtact {

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
