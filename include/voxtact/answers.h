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
    std::uint32_t pair = 0;
    std::uint32_t item = 0;
    std::uint32_t pose = 0;
    bool hit = false;        ///< at least one survivor: the pair certainly touches
    bool possible = false;   ///< no survivor, but conservative fragments that could not be decided: it may touch
    std::uint64_t count = 0; ///< survivors; 1 for a hit of a boolean query or an early exit
    Exactness exactness = Exactness::Exact;
    CountingMethod method = CountingMethod::Query;
    Projection projection = Projection::View;
};

[[nodiscard]] VOXTACT_API PairAnswer unpack(const PairResult& result) noexcept;

struct BatchAnswer {
    std::vector<PairAnswer> pairs;
    std::vector<TouchedTriangle> triangles; ///< by pair, then by triangle
    std::vector<Contact> contacts;          ///< by pair, then by triangle, then by position
    std::uint64_t contactsFound = 0;        ///< more than contacts.size(): the list was cut, arbitrarily
    std::vector<std::optional<Box>> bounds; ///< world, of each pair; nothing where it has no survivor
    std::vector<LabelCount> labels;         ///< by pair, then by label
    double gpuMilliseconds = 0;             ///< device time of the batch; 0 where the queue has no timestamps
    double wallMilliseconds = 0;            ///< from the start of recording to the results in host memory
};

} // namespace voxtact
