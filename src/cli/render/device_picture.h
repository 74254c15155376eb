// SPDX-License-Identifier: MIT
#pragma once

#include "cli/options/open_session.h"
#include "cli/render/inputs.h"

namespace voxtact::app {

/// Draws the volume and its meshes by ray casting on the device.
[[nodiscard]] Result<Picture> renderOn(const RenderOptions& options, const RenderInputs& inputs,
                                       const device::Session& session);

} // namespace voxtact::app
