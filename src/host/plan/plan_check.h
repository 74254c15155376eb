// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

namespace voxtact::cpu {

/// Checks of HostEngine::ask() before it tests any direction.
[[nodiscard]] Result<void> checkPlan(const Plan& task);

} // namespace voxtact::cpu
