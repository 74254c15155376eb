// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/export.h"
#include "voxtact/methods.h"
#include "voxtact/outputs.h"
#include "voxtact/pair_result.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace voxtact {

/// A PairResult unpacked.
struct PairAnswer {
    std::uint32_t pair = 0;  ///< number of the pair in its batch
    std::uint32_t item = 0;  ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0;  ///< number of the pose within that item
    bool hit = false;        ///< at least one survivor: the pair certainly touches
    bool possible = false;   ///< no survivor, but conservative fragments that could not be decided: it may touch
    std::uint64_t count = 0; ///< survivors; 1 for a hit of a boolean query or an early exit
    Exactness exactness = Exactness::Exact;        ///< what the count is worth
    CountingMethod method = CountingMethod::Query; ///< what counted
    Projection projection = Projection::View;      ///< what gave the fragments
};

/// Reads the packed words of a PairResult: its count, its numbers, and how it was counted.
[[nodiscard]] VOXTACT_API PairAnswer unpack(const PairResult& result) noexcept;

/// What a batch gave: the pairs, and what the detector's Outputs asked for. What was not asked for is empty.
struct BatchAnswer {
    std::vector<PairAnswer> pairs;          ///< in the order of the batch
    std::vector<TouchedTriangle> triangles; ///< by pair, then by triangle
    std::vector<Contact> contacts;          ///< by pair, then by triangle, then by position
    std::uint64_t contactsFound = 0;        ///< more than contacts.size(): the list was cut, arbitrarily
    std::vector<std::optional<Box>> bounds; ///< world, of each pair; nothing where it has no survivor
    std::vector<LabelCount> labels;         ///< by pair, then by label
    double gpuMilliseconds = 0;             ///< device time of the batch; 0 where the queue has no timestamps
    double wallMilliseconds = 0;            ///< from the start of recording to the results in host memory
};

} // namespace voxtact
