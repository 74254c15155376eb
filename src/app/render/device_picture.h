// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/open_session.h"
#include "app/render/inputs.h"

namespace voxtact::app {

/// Of --lighting's name, in pictures of such a volume.
[[nodiscard]] Lighting lightingOf(const std::string& name, const Grid& grid);

/// The volume and the meshes in it, by ray casting on the device.
[[nodiscard]] Result<Picture> renderOn(const RenderOptions& options, const RenderInputs& inputs,
                                       const device::Session& session);

} // namespace voxtact::app
