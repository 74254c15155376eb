// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

namespace voxtact::cpu {

/// Refuses numbers outside the ranges of PlannerDesc.
[[nodiscard]] Result<void> checkPlanner(const PlannerDesc& desc);
/// Refuses what Planner::plan() refuses before it looks along any direction.
[[nodiscard]] Result<void> checkTask(const PlanTask& task);

} // namespace voxtact::cpu
