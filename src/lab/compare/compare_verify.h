// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare/compare_result.h"

#include <functional>

namespace voxtact::lab {

/// Counts every pose by every method.
[[nodiscard]] Result<std::vector<NamedCounts>> countAll(const Engines& engines, const Work& work);
/// The rules for counts: who must agree, and how far the two groups are apart.
[[nodiscard]] std::vector<Verdict> judgeCounts(const std::vector<NamedCounts>& counts,
                                               std::span<const std::uint32_t> poses);

/// The device's fragments against the oracle's, on a sample of the poses. Adds to `result` the checks, the verdicts
/// and the oracle's counts and time.
[[nodiscard]] Result<void> checkFragments(const Session& session, const CompareSettings& settings, const Scene& scene,
                                          CompareResult& result, const std::function<void()>& step);

} // namespace voxtact::lab
