// SPDX-License-Identifier: MIT
#include "viewer/model/document/pose.h"
#include "viewer/panels/onto.h"
#include "viewer/panels/panels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::view {

namespace {

void takeMouse(State& state, const ImVec2& corner) {
    const ImGuiIO& io = ImGui::GetIO();
    const Extent& extent = state.picture.extent;
    const ImVec2 scale = io.DisplayFramebufferScale;
    if (ImGui::IsItemActive()) {
        const ImVec2 by = draggedBy();
        const double right = static_cast<double>(by.x * scale.x);
        const double down = static_cast<double>(by.y * scale.y);
        const bool panning = ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
        if (right != 0 || down != 0) {
            panning ? pan(state.camera, right, down, extent) : orbit(state.camera, right, down, extent);
        }
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        constexpr double kFactor = 0.88;
        zoom(state.camera, std::pow(kFactor, static_cast<double>(io.MouseWheel)),
             static_cast<double>((io.MousePos.x - corner.x) * scale.x),
             static_cast<double>((io.MousePos.y - corner.y) * scale.y), extent);
    }
    if (ImGui::IsItemHovered() && !state.cubeSide && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        state.maximised = state.maximised == Maximised::None ? Maximised::Picture : Maximised::None;
    }
}

void drawContactPoints(const MeshAnswer& answer, const Onto& onto, ImDrawList& list) {
    constexpr double kNormal = 4; // mm
    const float width = scaled(1);
    for (const Contact& contact : answer.contacts) {
        const ImVec2 at = onto.at(contact.position);
        const ImVec2 end = onto.at({contact.position[0] + kNormal * contact.normal[0],
                                    contact.position[1] + kNormal * contact.normal[1],
                                    contact.position[2] + kNormal * contact.normal[2]});
        list.AddLine(at, end, IM_COL32(255, 214, 120, 70), width);
        list.AddRectFilled({at.x - width, at.y - width}, {at.x + width, at.y + width}, IM_COL32(255, 214, 120, 220));
    }
}

void drawPath(const State& state, const Onto& onto, ImDrawList& list) {
    const std::vector<Mat4>& poses = state.document.poses;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
        list.AddLine(onto.at(originOf(poses[i])), onto.at(originOf(poses[i + 1])), IM_COL32(120, 190, 255, 110),
                     scaled(1));
    }
}

void drawClosest(const State& state, const Onto& onto, ImDrawList& list) {
    const MeshMeasures* measured = state.chosenDistance();
    const auto segment = measured != nullptr ? closestSegment(measured->pair) : std::nullopt;
    if (!segment) {
        return;
    }
    const bool current = state.distances->revision == state.revision;
    const ImU32 colour = closestColour(current ? 1.0F : 0.4F);
    const ImVec2 from = onto.at((*segment)[0]);
    const ImVec2 to = onto.at((*segment)[1]);
    list.AddLine(from, to, colour, scaled(2));
    list.AddCircleFilled(from, scaled(3.5F), colour);
    list.AddCircleFilled(to, scaled(3.5F), colour);
    const std::string text = upperText(measured->pair.bounds.upper) + " mm";
    const ImVec2 at{(from.x + to.x) / 2 + scaled(8), (from.y + to.y) / 2 - ImGui::GetFontSize() / 2};
    list.AddText({at.x + scaled(1), at.y + scaled(1)}, IM_COL32(0, 0, 0, 200), text.c_str());
    list.AddText(at, colour, text.c_str());
}

void drawBar(const State& state, const Onto& onto, ImDrawList& list) {
    const double mmOfPoint = 2 * state.camera.halfHeight / static_cast<double>(onto.size.y);
    const double length = barLength(mmOfPoint * static_cast<double>(onto.size.x) / 5);
    const auto points = static_cast<float>(length / mmOfPoint);
    const ImVec2 right{onto.corner.x + onto.size.x - scaled(14), onto.corner.y + onto.size.y - scaled(14)};
    list.AddLine({right.x - points, right.y}, right, IM_COL32(235, 238, 242, 230), scaled(2));
    char text[32];
    std::snprintf(text, sizeof text, "%g mm", length);
    list.AddText({right.x - points, right.y - ImGui::GetFontSize() - scaled(5)}, IM_COL32(235, 238, 242, 230), text);
}

void drawVerdict(const State& state, const Onto& onto, ImDrawList& list) {
    if (state.chosenAnswer() == nullptr) {
        return;
    }
    const MeshAnswer& answer = *state.chosenAnswer();
    std::string text = answer.pair.hit ? "touches" : answer.pair.possible ? "undecided" : "does not touch";
    const float size = ImGui::GetFontSize() * 1.3F;
    const ImVec2 at{onto.corner.x + scaled(12), onto.corner.y + scaled(9)};
    list.AddText(ImGui::GetFont(), size, {at.x + scaled(1), at.y + scaled(1)}, IM_COL32(0, 0, 0, 200), text.c_str());
    list.AddText(ImGui::GetFont(), size, at, ImGui::GetColorU32(verdictOnPicture(hitNumber(answer.pair))),
                 text.c_str());
    if (const std::uint32_t coarser = state.document.sources.coarser; coarser > 1) {
        const std::string copy = "for a copy that is coarser by " + std::to_string(coarser);
        list.AddText({at.x, at.y + size * 1.2F}, IM_COL32(245, 196, 66, 255), copy.c_str());
    }
}

} // namespace

void drawMarks(const State& state, const Onto& onto, ImDrawList& list) {
    drawPath(state, onto, list);
    for (const Instrument& instrument : state.document.edit.instruments) {
        const MeshAnswer* answer = state.answer ? state.answer->of(instrument.mesh) : nullptr;
        if (state.showContacts && instrument.shown && answer != nullptr) {
            drawContactPoints(*answer, onto, list);
        }
    }
    drawClosest(state, onto, list);
    drawBar(state, onto, list);
    drawVerdict(state, onto, list);
    drawCube(state, onto, list);
}

void drawPicture(State& state) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImVec2 size = ImGui::GetContentRegionAvail();
    size = {std::max(size.x, 8.0F), std::max(size.y, 8.0F)};
    const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
    state.picture.extent = {static_cast<std::uint32_t>(size.x * scale.x), static_cast<std::uint32_t>(size.y * scale.y)};
    state.picture.corner = {static_cast<double>(corner.x), static_cast<double>(corner.y)};
    state.picture.size = {static_cast<double>(size.x), static_cast<double>(size.y)};
    ImGui::InvisibleButton("picture", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    const bool onCube = takeCube(state, corner, size);
    if (onCube) {
        state.gizmoHandle = {};
    }
    if (onCube || !takeGizmo(state, corner, size)) {
        takeMouse(state, corner);
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{corner.x + size.x, corner.y + size.y};
    if (state.picture.texture != nullptr) {
        list.AddImage(state.picture.texture, corner, end);
    }
    list.PushClipRect(corner, end, true);
    // Depth does not matter here.
    const Onto onto{clipFromWorld(state.camera, state.picture.extent, 1), corner, size};
    drawMarks(state, onto, list);
    drawGizmo(state, onto, list);
    list.PopClipRect();
}

} // namespace voxtact::view
