// SPDX-License-Identifier: MIT
#include "view/panels/onto.h"
#include "view/panels/panels.h"

#include <array>

namespace voxtact::view {

namespace {

Ray rayUnderMouse(const State& state, const Onto& onto) {
    const ImGuiIO& io = ImGui::GetIO();
    return rayThrough(state.camera, state.picture.extent,
                      {static_cast<double>((io.MousePos.x - onto.corner.x) * io.DisplayFramebufferScale.x),
                       static_cast<double>((io.MousePos.y - onto.corner.y) * io.DisplayFramebufferScale.y)});
}

/// Millimetres of a point of the window.
double millimetresOfPoint(const State& state, const Onto& onto) {
    return 2 * state.camera.halfHeight / static_cast<double>(onto.size.y);
}

Gizmo shown(const State& state, const Onto& onto) {
    return gizmoOf(state.document.edit.world_from_object, state.gizmoOwnAxes, millimetresOfPoint(state, onto));
}

void drawArrow(const Gizmo& gizmo, std::size_t axis, const Onto& onto, ImDrawList& list, ImU32 colour) {
    const ImVec2 from = onto.at(gizmo.centre);
    const ImVec2 to = onto.at(tipOf(gizmo, axis));
    list.AddLine(from, to, colour, 2.5F);
    list.AddCircleFilled(to, 5, colour);
}

/// What is behind the tip is fainter.
void drawRing(const Gizmo& gizmo, std::size_t axis, const Ray& ray, const Onto& onto, ImDrawList& list, ImU32 colour,
              ImU32 faint) {
    const std::vector<Vec3> ring = ringOf(gizmo, axis);
    for (std::size_t piece = 0; piece < ring.size(); ++piece) {
        const Vec3& from = ring[piece];
        double depth = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            depth += (from[i] - gizmo.centre[i]) * ray.direction[i];
        }
        list.AddLine(onto.at(from), onto.at(ring[(piece + 1) % ring.size()]), depth > 0 ? faint : colour, 1.8F);
    }
}

} // namespace

bool takeGizmo(State& state, const Onto& onto) {
    if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && state.showGizmo) {
        const Gizmo gizmo = shown(state, onto);
        const Ray ray = rayUnderMouse(state, onto);
        if (const auto part = partUnder(gizmo, ray, kGizmoReach * millimetresOfPoint(state, onto))) {
            state.history.end();
            state.gizmoDrag = GizmoDrag{gizmo, *part, state.document.edit.world_from_object, ray};
        }
    }
    if (!state.gizmoDrag) {
        return false;
    }
    if (ImGui::IsItemActive()) {
        const Mat4 pose = dragged(*state.gizmoDrag, rayUnderMouse(state, onto));
        state.command([&](Edit& edit) { edit.world_from_object = pose; }, "handle");
    } else {
        state.gizmoDrag.reset();
        state.history.end();
    }
    return true;
}

void drawGizmo(const State& state, const Onto& onto, bool hovered, ImDrawList& list) {
    if (!state.showGizmo) {
        return;
    }
    const Gizmo gizmo = shown(state, onto);
    const Ray ray = rayUnderMouse(state, onto);
    const std::optional<GizmoPart> lit = state.gizmoDrag ? std::optional(state.gizmoDrag->part)
                                         : hovered
                                             ? partUnder(gizmo, ray, kGizmoReach * millimetresOfPoint(state, onto))
                                             : std::nullopt;
    constexpr std::array<std::array<int, 3>, 3> kColours{{{235, 100, 90}, {110, 200, 110}, {110, 160, 250}}};
    for (const Handle handle : {Handle::Ring, Handle::Arrow}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const GizmoPart part{handle, axis};
            if (!isUsable(gizmo, part, ray)) {
                continue;
            }
            const auto& [red, green, blue] = kColours[axis];
            const ImU32 light = IM_COL32(255, 235, 140, 255);
            const ImU32 colour = lit == part ? light : IM_COL32(red, green, blue, 215);
            if (handle == Handle::Arrow) {
                drawArrow(gizmo, axis, onto, list, colour);
            } else {
                drawRing(gizmo, axis, ray, onto, list, colour, lit == part ? light : IM_COL32(red, green, blue, 70));
            }
        }
    }
}

} // namespace voxtact::view
