// SPDX-License-Identifier: MIT
#include "viewer/model/shown/view_cube.h"
#include "viewer/panels/onto.h"
#include "viewer/panels/panels.h"

#include <array>
#include <utility>

namespace voxtact::view {

namespace {

/// In a picture at that position.
std::optional<ViewCube> cubeOf(const ImVec2& corner, const ImVec2& size) {
    return cubeIn({static_cast<double>(corner.x), static_cast<double>(corner.y)},
                  {static_cast<double>(size.x), static_cast<double>(size.y)},
                  static_cast<double>(ImGui::GetFontSize()));
}

/// A side of the cube in points: its middle, and from there to its edges.
struct Face {
    ImVec2 middle;
    ImVec2 right;
    ImVec2 up;

    [[nodiscard]] ImVec2 at(float along, float above) const {
        return {middle.x + along * right.x + above * up.x, middle.y + along * right.y + above * up.y};
    }
};

Face faceOf(const ViewCube& cube, const SeenSide& side) {
    const auto scaled = [&cube](const std::array<double, 2>& by) {
        return ImVec2{static_cast<float>(cube.half * by[0]), static_cast<float>(cube.half * by[1])};
    };
    const ImVec2 by = scaled(side.middle);
    return {{static_cast<float>(cube.middle[0]) + by.x, static_cast<float>(cube.middle[1]) + by.y},
            scaled(side.right),
            scaled(side.up)};
}

/// Leans with the face.
void drawLetter(const Face& face, const char* letter, ImDrawList& list) {
    const ImFont& font = letterFont();
    const ImFontGlyph* glyph = font.FindGlyph(static_cast<ImWchar>(*letter));
    const ImFontGlyph* tall = font.FindGlyph('I'); // as high as all capitals
    if (glyph == nullptr || tall == nullptr) {
        return;
    }
    constexpr float kHigh = 0.95F; // of half an edge
    const float scale = kHigh / (tall->Y1 - tall->Y0);
    const float middleX = (glyph->X0 + glyph->X1) / 2;
    const float middleY = (tall->Y0 + tall->Y1) / 2;
    const auto at = [&](float x, float y) { return face.at((x - middleX) * scale, (middleY - y) * scale); };
    list.PrimReserve(6, 4);
    list.PrimQuadUV(at(glyph->X0, glyph->Y0), at(glyph->X1, glyph->Y0), at(glyph->X1, glyph->Y1),
                    at(glyph->X0, glyph->Y1), {glyph->U0, glyph->V0}, {glyph->U1, glyph->V0}, {glyph->U1, glyph->V1},
                    {glyph->U0, glyph->V1}, IM_COL32(244, 246, 249, 255));
}

ImU32 shadeOf(double facing) {
    const double shade = 62 + 62 * facing;
    return IM_COL32(static_cast<int>(shade), static_cast<int>(shade * 1.03), static_cast<int>(shade * 1.1), 235);
}

} // namespace

bool takeCube(State& state, const ImVec2& corner, const ImVec2& size) {
    const ImGuiIO& io = ImGui::GetIO();
    const std::optional<ViewCube>& cube = state.cube = cubeOf(corner, size);
    const bool pressedElsewhere = ImGui::IsItemActive() && !ImGui::IsItemActivated() && !state.cubePressed;
    const bool elsewhere = state.gizmoDrag || pressedElsewhere || !ImGui::IsItemHovered();
    state.cubeSide =
        cube && !elsewhere
            ? sideAt(*cube, state.camera, {static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y)})
            : std::nullopt;
    if (state.cubeSide && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        state.cubePressed = state.cubeSide;
    }
    if (!ImGui::IsMouseReleased(ImGuiMouseButton_Left)) {
        return state.cubePressed || state.cubeSide;
    }
    // A drag that began there has turned the picture.
    const float far = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left];
    if (const auto pressed = std::exchange(state.cubePressed, std::nullopt);
        pressed && far < io.MouseDragThreshold * io.MouseDragThreshold) {
        lookAtSide(state.camera, *pressed);
    }
    return state.cubeSide.has_value();
}

void drawCube(const State& state, const Onto& onto, ImDrawList& list) {
    const std::optional<ViewCube> cube = cubeOf(onto.corner, onto.size);
    if (!cube) {
        return;
    }
    for (const SeenSide& side : seenSides(state.camera)) {
        const Face face = faceOf(*cube, side);
        const ImVec2 a = face.at(-1, -1);
        const ImVec2 b = face.at(1, -1);
        const ImVec2 c = face.at(1, 1);
        const ImVec2 d = face.at(-1, 1);
        list.AddQuadFilled(a, b, c, d,
                           state.cubeSide == side.side ? IM_COL32(70, 110, 165, 245) : shadeOf(side.facing));
        list.AddQuad(a, b, c, d, IM_COL32(214, 219, 226, 255), scaled(1.2F));
        drawLetter(face, kPatientSides[side.side].letter, list);
    }
}

} // namespace voxtact::view
