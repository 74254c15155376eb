// SPDX-License-Identifier: MIT
#pragma once

#include "lab/measure/machine.h"
#include "lab/paper/paper_result.h"

#include <functional>

namespace voxtact::lab {

/// The making of the pre-integrated table, in several sizes: a warm-up, then rounds that make each size once, every
/// time of a function that has changed. `step` is called once for the warm-up and once a round.
[[nodiscard]] Result<std::vector<IntegrationPoint>> timeIntegration(const Session& session, std::uint32_t repetitions,
                                                                    const std::function<void()>& step);

} // namespace voxtact::lab
