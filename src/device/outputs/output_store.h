// SPDX-License-Identifier: MIT
#pragma once

#include "device/outputs/output_parts.h"
#include "vulkan/memory/memory.h"

#include <memory>

namespace voxtact {

/// Bytes of what OutputLayout counts.
inline constexpr VkDeviceSize kOutputWord = sizeof(std::uint32_t);

/// The outputs of a Results that has room for them.
struct OutputStore {
    std::uint32_t maxPairs = 0;
    OutputRoom room{};
    Outputs outputs{}; ///< that have room
    OutputLayout layout{};
    Buffer pairs{};                  ///< maxPairs OutputPairs
    Buffer words{};                  ///< everything that shaders write, by `layout`
    Buffer readBack{};               ///< the host's copy of it; empty when not asked for
    Image noLabels{};                ///< a single voxel that stands in where an item has no label map; never read
    DescriptorSet noLabelsSet{};     ///< of it
    DescriptorSet descriptors{};     ///< as VOXTACT_SET_PAIRS
    Outputs recorded{};              ///< of the detector of the batch recorded last
    std::vector<OutputItem> items{}; ///< of that batch
};

/// Refuses room beyond the device's limits (which limit, how large), and none for one of the outputs.
[[nodiscard]] Result<std::unique_ptr<OutputStore>> makeOutputStore(ContextImpl& context, const ResultsDesc& desc,
                                                                   const Outputs& outputs, VkBuffer transforms,
                                                                   const BufferRange& results);

/// Room that the outputs of a batch need, its contacts aside. Null meshes and label maps need none.
[[nodiscard]] OutputRoom roomFor(const Batch& batch, const Outputs& outputs) noexcept;

/// Records the clearing of what the outputs of a batch go to, and what the shaders need to know of its pairs. Between
/// the barriers of prepareResults(). Remembers the batch for unpackOutputs().
void recordOutputs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch, OutputStore& store);

/// Records the copies of the outputs of the batch recorded last to the host. Between the barriers of cmdReadBack().
void copyOutputs(const ContextImpl& context, VkCommandBuffer commandBuffer, const OutputStore& store);

/// From the host's copy. Internal where that holds a pair, triangle or label that the batch does not have.
[[nodiscard]] Result<void> unpackOutputs(const OutputStore& store, BatchAnswer& answer);

/// Where a part is, by its number in outputParts(); empty where there is no store, or no room for the part.
[[nodiscard]] BufferRange rangeOf(const OutputStore* store, std::size_t part) noexcept;

/// The set that VOXTACT_SET_LABELS is bound to.
[[nodiscard]] VkDescriptorSet labelSetOf(const BatchItem& item, const OutputStore& store) noexcept;

} // namespace voxtact
