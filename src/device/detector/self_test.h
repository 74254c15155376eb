// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/arithmetic_check.h"
#include "voxtact/detector.h"

namespace voxtact {

/// As the public one, with `arithmeticGroups` for checkArithmetic(): fewer where it is asked very often.
[[nodiscard]] Result<std::vector<SelfTestVerdict>> selfTest(const Context& context, const QueueAccess& queue,
                                                            std::span<const CountingMethod> methods,
                                                            std::uint32_t arithmeticGroups);

} // namespace voxtact
