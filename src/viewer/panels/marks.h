// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"
#include "voxtact/render.h"

#include <imgui.h>

#include <memory>
#include <vector>

/// Marks over the large picture, for saved pictures of any size: drawn without a device.
namespace voxtact::view {

/// A copy of triangles of Dear ImGui's, in pixels of a picture, and of the font that they are of.
struct Marks {
    struct Font {
        int width = 0;
        int height = 0;
        std::vector<unsigned char> rgba;
    };
    std::shared_ptr<const Font> font;
    std::vector<ImDrawVert> vertices;
    std::vector<std::uint32_t> indices; ///< three of each triangle
};

/// Returns the marks of a state in a picture of that size, scaled with it. Between ImGui::NewFrame() and the next one,
/// on the thread of the panels.
[[nodiscard]] Marks marksOf(const State& state, const Extent& extent);

/// Draws them over a picture. On any thread.
void paint(const Marks& marks, Picture& picture);

} // namespace voxtact::view
