// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

namespace voxtact::cpu {

/// Refuses what HostEngine::ask() refuses before it looks along any direction.
[[nodiscard]] Result<void> checkPlan(const Plan& task);

} // namespace voxtact::cpu
