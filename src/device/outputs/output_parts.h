// SPDX-License-Identifier: MIT
#pragma once

#include "exact/contact.h"
#include "voxtact/detector.h"

#include <array>
#include <memory>
#include <span>

namespace voxtact {

/// What readOutputs() needs of a batch item.
struct OutputItem {
    std::uint32_t pairs = 0;
    std::uint32_t triangles = 0;
    std::shared_ptr<const std::vector<std::int32_t>> labels{}; ///< null: no label map
};

/// Parts of an outputs buffer, at most.
inline constexpr std::size_t kMostOutputParts = 16;
/// Where each part begins, in words, and, behind the last, where all of them end. Each begins where a descriptor may.
using OutputLayout = std::array<std::uint64_t, kMostOutputParts + 1>;

/// The words of a part as the host has them, and what they are of.
struct OutputWords {
    const std::uint32_t* words = nullptr;
    std::span<const OutputItem> items{};
    const OutputRoom& room;
};

/// Everything that is known of a part. Either each pair has words of its own, in the order of the pairs, which are
/// zero before the batch, or all pairs share one list that begins with OUTPUT_HEADER_WORDS.
struct OutputPartRow {
    const char* name;                                                        ///< of the output; null: a second part
    bool Outputs::*output;                                                   ///< what asks for it
    std::uint32_t bit;                                                       ///< OUTPUT_*, as the shaders know it
    std::uint32_t shader::OutputPair::*first;                                ///< where a pair's words begin
    std::uint64_t (*room)(const OutputRoom& room, std::uint64_t pairs);      ///< words of all pairs
    std::uint64_t (*ofPair)(const OutputItem& item);                         ///< words of a pair; null: a list
    Result<void> (*unpack)(const OutputWords& words, BatchAnswer& answer){}; ///< null: it stays on the device
};

/// In their order.
[[nodiscard]] std::span<const OutputPartRow> outputParts() noexcept;

/// VOXTACT_CONSTANT_OUTPUTS of a pipeline: the OUTPUT_* bits of the requested outputs.
[[nodiscard]] std::uint32_t outputsConstant(const Outputs& outputs) noexcept;

/// Empties an answer of outputs.
void clearOutputs(BatchAnswer& answer) noexcept;

} // namespace voxtact
