// SPDX-License-Identifier: MIT
#pragma once

#include "cli/render/annotation.h"

namespace voxtact::app {

/// Draws a legend with values upwards: a bar per value, with its colour and a width relative to the maximum opacity.
[[nodiscard]] Result<void> drawLegend(Canvas& canvas, const Legend& legend, const Box2& box, double text);

} // namespace voxtact::app
