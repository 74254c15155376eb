// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>

namespace voxtact::cpu {

/// Identifies a label map by its contents: the caller may edit a map in place, or replace it at the same address.
/// Collisions have a probability of 2^-64.
[[nodiscard]] std::uint64_t labelFingerprint(const LabelData& labels) noexcept;

} // namespace voxtact::cpu
