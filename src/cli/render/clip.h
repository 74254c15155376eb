// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/looks.h"
#include "voxtact/render.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// A --clip: a side to remove, or a plane.
struct ClipOption {
    std::string text;         ///< as given
    std::string side;         ///< left, ..., or near (towards the eye); empty: `plane`
    std::optional<double> at; ///< mm; empty: the middle of the volume
    ClipPlane plane{};
};

/// Returns the error of a text, if any.
[[nodiscard]] std::optional<std::string> parseClip(const std::string& text, ClipOption& clip);

/// Returns the planes in world space. Refuses planes that remove the whole volume, alone or together; notes a plane
/// that removes nothing.
[[nodiscard]] Result<std::vector<ClipPlane>> clipPlanes(const std::vector<ClipOption>& clips, const Grid& grid,
                                                        const Mat4& clip_from_world);

} // namespace voxtact::app
