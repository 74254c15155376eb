// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>

namespace voxtact::cpu {

/// Tells one label map from another by what it holds: maps are the caller's, who may edit one in place, or free it and
/// make another where it was. Of different maps one in 2^64 has the
/// same.
[[nodiscard]] std::uint64_t labelFingerprint(const LabelData& labels) noexcept;

} // namespace voxtact::cpu
