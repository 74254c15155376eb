// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/pass_desc.h"
#include "device/results/results_impl.h"
#include "vulkan/context_impl.h"

namespace voxtact {

/// Binds what a compute pass needs of an item, with or without outputs. Returns the layout.
VkPipelineLayout bindForCompute(const ContextImpl& context, VkCommandBuffer commandBuffer, const BatchItem& item,
                                const ResultsImpl& results, const Outputs& outputs);

/// Refuses a label map of another Context, and one that was never uploaded. `which` begins the text.
[[nodiscard]] Result<void> checkLabelMap(const ContextImpl& context, const LabelMap& labels, const std::string& which);

/// Refuses outputs that the device cannot do with the method, and a maximal depth that is not a positive number.
[[nodiscard]] Result<void> checkOutputs(const ContextImpl& context, const PassDesc& desc);

/// Refuses Results without one of the outputs, and a checked batch whose outputs have no room in them, whose items have
/// no label map where labels are asked for, or one of another Context.
[[nodiscard]] Result<void> checkOutputs(const ContextImpl& context, const Batch& batch, const Outputs& outputs,
                                        const ResultsImpl& results);

} // namespace voxtact
