// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/looks.h"
#include "voxtact/render.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// One --clip: a side that is taken away, or a plane by its numbers.
struct ClipOption {
    std::string text;         ///< as it was given
    std::string side;         ///< left, ..., or near: towards the eye; empty: `plane`
    std::optional<double> at; ///< mm; nothing: the middle of the volume
    ClipPlane plane{};
};

/// Returns the error of a text, if any.
[[nodiscard]] std::optional<std::string> parseClip(const std::string& text, ClipOption& clip);

/// Planes in world space. Refuses one that takes all of the volume away, and several that do together; says of one that
/// takes nothing.
[[nodiscard]] Result<std::vector<ClipPlane>> clipPlanes(const std::vector<ClipOption>& clips, const Grid& grid,
                                                        const Mat4& clip_from_world);

} // namespace voxtact::app
