// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"

namespace voxtact::app {

/// Values upwards; of each its colour, as wide as it is opaque compared with the most opaque.
[[nodiscard]] Result<void> drawLegend(Canvas& canvas, const Legend& legend, const Box2& box, double text);

} // namespace voxtact::app
