// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/methods.h"
#include "voxtact/motion.h"

namespace voxtact {

// Refuse a number that the enumeration does not have, and name it.
[[nodiscard]] Result<void> checkProjection(Projection projection);
[[nodiscard]] Result<void> checkFilter(Filter filter);
[[nodiscard]] Result<void> checkBoundary(Boundary boundary);
[[nodiscard]] Result<void> checkScalarType(ScalarType type);
[[nodiscard]] Result<void> checkInterpolation(Interpolation interpolation);

} // namespace voxtact
