// SPDX-License-Identifier: MIT
#pragma once

#include "host/search/label_part.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace voxtact::cpu {

using LabelSets = std::shared_ptr<const std::vector<LabelSet>>;

/// The labels of the last question.
struct KeptLabels {
    std::shared_ptr<const OpaquePart> part; ///< keeps its address from being another's
    std::uint64_t labels = 0;               ///< fingerprint of the map
    std::vector<std::uint32_t> indices;
    LabelSets sets;
};

} // namespace voxtact::cpu
