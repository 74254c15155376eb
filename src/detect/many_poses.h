// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

#include <optional>

namespace voxtact {

/// The host makes the pairs of fewer in the time that the dispatch takes: some 40 us on an H100.
inline constexpr std::uint32_t kFewestHostPoses = 256;

/// For those who ask by batches of so many poses of the host's, in Results that stage them: the description of a
/// detector that makes pairs of them on the device. Nothing where `desc` does as well.
[[nodiscard]] std::optional<DetectorDesc> forManyPoses(const ContextImpl& context, const DetectorDesc& desc,
                                                       std::uint64_t poses);

} // namespace voxtact
