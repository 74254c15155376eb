// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare/compare_result.h"

namespace voxtact::lab {

/// The same pairs by every method: verified first, then timed, unless a verdict failed and the run is not to go on.
/// `result` has the machine.
[[nodiscard]] Result<void> compare(const CompareSettings& settings, const Scene& scene, const Session& session,
                                   const Steps& steps, CompareResult& result);

} // namespace voxtact::lab
