// SPDX-License-Identifier: MIT
#include "viewer/panels/onto.h"
#include "viewer/panels/panels.h"

#include <array>
#include <cmath>
#include <numbers>

namespace voxtact::view {

namespace {

constexpr float kLength = 5; // heights of a line: an arrow's length
constexpr float kReach = 6;  // points, scaled()
constexpr int kRingParts = 48;

/// By the direction of the axis: red, green, blue.
ImU32 colourOf(std::size_t axis, bool taken, int alpha) {
    constexpr std::array<std::array<int, 3>, 3> kAxes{{{235, 100, 90}, {110, 200, 110}, {110, 160, 250}}};
    return taken ? IM_COL32(255, 235, 120, 255) : IM_COL32(kAxes[axis][0], kAxes[axis][1], kAxes[axis][2], alpha);
}

Vec3 along(const Gizmo& gizmo, std::size_t axis, double part, const Vec3& from) {
    Vec3 out = from;
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] += part * gizmo.size * gizmo.axes[axis][i];
    }
    return out;
}

void drawRing(const Gizmo& gizmo, std::size_t axis, const Onto& onto, ImU32 colour, ImDrawList& list) {
    for (int part = 0; part < kRingParts; ++part) {
        const double angle = 2 * std::numbers::pi * part / kRingParts;
        const Vec3 across = along(gizmo, (axis + 1) % 3, kRingRadius * std::cos(angle), gizmo.at);
        list.PathLineTo(onto.at(along(gizmo, (axis + 2) % 3, kRingRadius * std::sin(angle), across)));
    }
    list.PathStroke(colour, ImDrawFlags_Closed, scaled(1.6F));
}

void drawSquare(const Gizmo& gizmo, std::size_t axis, const Onto& onto, ImU32 colour, ImDrawList& list) {
    const auto corner = [&](double first, double second) {
        return onto.at(along(gizmo, (axis + 2) % 3, second, along(gizmo, (axis + 1) % 3, first, gizmo.at)));
    };
    list.AddQuadFilled(corner(kSquareBegin, kSquareBegin), corner(kSquareEnd, kSquareBegin),
                       corner(kSquareEnd, kSquareEnd), corner(kSquareBegin, kSquareEnd), colour);
}

void drawArrow(const Gizmo& gizmo, std::size_t axis, const Onto& onto, ImU32 colour, ImDrawList& list) {
    const ImVec2 from = onto.at(along(gizmo, axis, kArrowBegin, gizmo.at));
    const ImVec2 to = onto.at(along(gizmo, axis, 1, gizmo.at));
    list.AddLine(from, to, colour, scaled(2.4F));
    list.AddCircleFilled(to, scaled(4), colour);
}

Gizmo shownGizmo(const State& state, float height) {
    const double mmOfPoint = 2 * state.camera.halfHeight / static_cast<double>(height);
    return gizmoOf(state.document.edit.pose(), state.camera, state.gizmoAxes,
                   mmOfPoint * static_cast<double>(kLength * ImGui::GetFontSize()));
}

Ray mouseRay(const State& state, const ImVec2& corner) {
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 scale = io.DisplayFramebufferScale;
    return rayThrough(state.camera, state.picture.extent, static_cast<double>((io.MousePos.x - corner.x) * scale.x),
                      static_cast<double>((io.MousePos.y - corner.y) * scale.y));
}

void drag(State& state, const Ray& ray) {
    // Multiples of the keyboard's steps.
    const bool snapping = ImGui::GetIO().KeyCtrl;
    const Snap snap{snapping ? state.stepMillimetres : 0, snapping ? state.stepDegrees : 0};
    const GizmoDrag& begun = *state.gizmoDrag;
    state.command(
        [&](Edit& edit) {
            edit.pose() = dragged(begun.world_from_object, begun.gizmo, begun.handle, begun.from, ray, snap);
        },
        "gizmo");
}

} // namespace

bool takeGizmo(State& state, const ImVec2& corner, const ImVec2& size) {
    const Ray ray = mouseRay(state, corner);
    if (state.gizmoDrag) {
        if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
            drag(state, ray);
            return true;
        }
        state.gizmoDrag.reset();
        state.history.end();
    }
    state.gizmoHandle = {};
    if (!state.showGizmo || !ImGui::IsItemHovered()) {
        return false;
    }
    const Gizmo gizmo = shownGizmo(state, size.y);
    const double reach =
        2 * state.camera.halfHeight / static_cast<double>(size.y) * static_cast<double>(scaled(kReach));
    state.gizmoHandle = handleAt(gizmo, ray, reach);
    if (state.gizmoHandle.kind == HandleKind::None || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        return false;
    }
    state.history.end(); // each drag is a command of its own
    state.gizmoDrag = {state.gizmoHandle, gizmo, state.document.edit.pose(), ray};
    return true;
}

void drawGizmo(const State& state, const Onto& onto, ImDrawList& list) {
    if (!state.showGizmo) {
        return;
    }
    constexpr int kStrong = 230;
    constexpr int kWeak = 110;
    const Gizmo gizmo = shownGizmo(state, onto.size.y);
    const Handle& taken = state.gizmoHandle;
    const Vec3 eye = rayThrough(state.camera, state.picture.extent, 0, 0).direction;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!edgeOn(gizmo, axis, eye)) { // else it cannot be taken
            drawSquare(gizmo, axis, onto, colourOf(axis, taken == Handle{HandleKind::Square, axis}, kWeak), list);
            drawRing(gizmo, axis, onto, colourOf(axis, taken == Handle{HandleKind::Ring, axis}, kWeak), list);
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        drawArrow(gizmo, axis, onto, colourOf(axis, taken == Handle{HandleKind::Arrow, axis}, kStrong), list);
    }
}

void drawGizmoChoice(State& state) {
    ImGui::Checkbox("handles", &state.showGizmo);
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("arrows move along an axis, squares in a plane, rings turn; control: in steps");
    }
    constexpr std::array<const char*, 3> kNames{"world", "view", "own"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        sameLine(widthOfCheckbox(kNames[i]));
        const auto axes = static_cast<GizmoAxes>(i);
        if (ImGui::RadioButton(kNames[i], state.gizmoAxes == axes)) {
            state.gizmoAxes = axes;
        }
    }
}

} // namespace voxtact::view
