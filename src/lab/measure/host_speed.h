// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

namespace voxtact::lab {

/// What measureMethods() does for a device's methods, for the host engine. Not trusted where it fails.
[[nodiscard]] MethodSpeed measureHost(const MeasureScene& scene, std::uint32_t repetitions);

} // namespace voxtact::lab
