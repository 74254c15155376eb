// SPDX-License-Identifier: MIT
#include "viewer/panels/panels.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

/// Step of the wheel: a voxel, at least along the nearest axis.
double stepOf(const State& state) {
    return *std::ranges::min_element(state.volume.grid.spacing);
}

void takeMouse(State& state, std::size_t slice, const SlicePlace& place, const Point2& mouse) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        state.cursor = worldAt(place, {std::clamp(mouse[0], 0.0, 1.0), std::clamp(mouse[1], 0.0, 1.0)});
    } else if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        // Right: more contrast; down: brighter, because the window moves down.
        constexpr double kShare = 1.0 / 300;
        const ImVec2 by = draggedBy();
        const double width = state.window.hi - state.window.lo;
        const double least = (state.values.hi - state.values.lo) / 1e4;
        const double wider = std::max(width * (1 - kShare * static_cast<double>(by.x)), least);
        const double level = (state.window.lo + state.window.hi) / 2 -
                             kShare * static_cast<double>(by.y) * (state.values.hi - state.values.lo);
        state.window = {level - wider / 2, level + wider / 2};
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        const std::size_t axis = kSlices[slice].axis;
        const Box box = transformBox(worldFromTexture(state.volume.grid), {{0, 0, 0}, {1, 1, 1}});
        const double to = state.cursor[axis] + static_cast<double>(io.MouseWheel) * stepOf(state);
        state.cursor[axis] = std::clamp(to, box.lo[axis], box.hi[axis]);
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        const auto own = static_cast<Maximised>(static_cast<int>(Maximised::Slice0) + static_cast<int>(slice));
        state.maximised = state.maximised == Maximised::None ? own : Maximised::None;
    }
}

struct Rect {
    ImVec2 corner;
    ImVec2 size;

    [[nodiscard]] ImVec2 at(const Point2& point) const {
        return {corner.x + static_cast<float>(point[0]) * size.x, corner.y + static_cast<float>(point[1]) * size.y};
    }
};

void drawMesh(const State& state, const Instrument& instrument, std::size_t slice, const SlicePlace& place,
              const Rect& rect, ImDrawList& list) {
    const std::size_t axis = kSlices[slice].axis;
    const MeshAnswer* answer = state.answer ? state.answer->of(instrument.mesh) : nullptr;
    const ImU32 colour = ImGui::GetColorU32(instrumentColour(instrument.mesh));
    for (const OutlinePiece& piece :
         outline(state.meshes[instrument.mesh].view(), instrument.world_from_object, axis, state.cursor[axis], place)) {
        // An answer has them by their numbers.
        const bool touches = answer != nullptr && std::ranges::binary_search(answer->triangles, piece.triangle);
        list.AddLine(rect.at(piece.from), rect.at(piece.to), touches ? kContactColour : colour, scaled(1.6F));
    }
}

/// Faint where it is outside the slice.
void drawClosest(const State& state, std::size_t slice, const SlicePlace& place, const Rect& rect, ImDrawList& list) {
    const MeshMeasures* measured = state.chosenDistance();
    const auto segment = measured != nullptr ? closestSegment(measured->pair) : std::nullopt;
    if (!segment) {
        return;
    }
    const std::size_t axis = kSlices[slice].axis;
    const bool here = distanceOfPlane(*segment, axis, state.cursor[axis]) <= stepOf(state);
    const bool current = state.distances->revision == state.revision;
    const ImU32 colour = closestColour((here ? 1.0F : 0.45F) * (current ? 1.0F : 0.5F));
    const ImVec2 from = rect.at(pictureAt(place, (*segment)[0]));
    const ImVec2 to = rect.at(pictureAt(place, (*segment)[1]));
    list.AddLine(from, to, colour, scaled(here ? 2.0F : 1.0F));
    list.AddCircleFilled(from, scaled(2.5F), colour);
    list.AddCircleFilled(to, scaled(2.5F), colour);
}

/// Draws the position of the slice as text that fits. Returns its size, to the right and down.
ImVec2 drawCaption(const State& state, const SliceKind& kind, const Rect& rect, ImDrawList& list) {
    const std::string place = mmText(state.volume.grid, 1, state.cursor[kind.axis]);
    const std::string name = kind.name;
    const ImVec2 from{scaled(6), scaled(3)};
    const std::string text =
        fitting({name + ' ' + place + " mm", name + ' ' + place, place + " mm", place}, rect.size.x - 2 * from.x);
    addRimmed(list, {rect.corner.x + from.x, rect.corner.y + from.y}, IM_COL32(180, 188, 198, 255), text.c_str());
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    return {from.x + size.x, from.y + size.y};
}

/// `caption`: how far it reaches from the upper left corner.
void drawLetters(const SliceKind& kind, const Rect& rect, const ImVec2& caption, ImDrawList& list) {
    const ImU32 colour = IM_COL32(225, 229, 235, 255);
    const float size = ImGui::GetFontSize();
    const float middle = rect.size.x / 2 - size * 0.3F;
    const auto text = [&](float x, float y, const char* letter) {
        addRimmed(list, {rect.corner.x + x, rect.corner.y + y}, colour, letter);
    };
    text(scaled(4), rect.size.y / 2 - size / 2, kind.left);
    text(rect.size.x - size * 0.8F, rect.size.y / 2 - size / 2, kind.right);
    text(middle, caption.x + scaled(4) < middle ? scaled(2) : caption.y, kind.top);
    text(middle, rect.size.y - size - scaled(3), kind.bottom);
}

} // namespace

void drawSlice(State& state, std::size_t slice) {
    const SliceKind& kind = kSlices[slice];
    Pane& pane = state.slices[slice];
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImVec2 size = ImGui::GetContentRegionAvail();
    size = {std::max(size.x, 8.0F), std::max(size.y, 8.0F)};
    const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
    pane.extent = {static_cast<std::uint32_t>(size.x * scale.x), static_cast<std::uint32_t>(size.y * scale.y)};
    ImGui::InvisibleButton("slice", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    SlicePlace place = slicePlace(kind, state.volume.grid, state.cursor, pane.extent);
    const Point2 mouse = mouseIn(corner, size);
    takeMouse(state, slice, place, mouse);
    if (ImGui::IsItemHovered()) {
        state.say(
            placeText(state.volume.view(), state.texture_from_world, state.labelsOrNull(), worldAt(place, mouse)));
    }
    place = slicePlace(kind, state.volume.grid, state.cursor, pane.extent);
    const Rect rect{corner, size};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{corner.x + size.x, corner.y + size.y};
    if (pane.texture != nullptr) {
        list.AddImage(pane.texture, corner, end);
    }
    list.PushClipRect(corner, end, true);
    const ImVec2 cross = rect.at(pictureAt(place, state.cursor));
    const ImU32 line = IM_COL32(110, 160, 250, 90);
    list.AddLine({corner.x, cross.y}, {end.x, cross.y}, line, scaled(1));
    list.AddLine({cross.x, corner.y}, {cross.x, end.y}, line, scaled(1));
    for (const Instrument& instrument : state.document.edit.instruments) {
        if (instrument.shown) {
            drawMesh(state, instrument, slice, place, rect, list);
        }
    }
    drawClosest(state, slice, place, rect, list);
    drawLetters(kind, rect, drawCaption(state, kind, rect, list), list);
    list.PopClipRect();
}

} // namespace voxtact::view
