// SPDX-License-Identifier: MIT
#include "viewer/model/document/pose.h"
#include "viewer/panels/fields.h"
#include "viewer/panels/panels.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

void move(State& state, const Vec3& mm, Axes axes) {
    state.step([&](Edit& edit) { edit.pose() = moved(edit.pose(), mm, axes); }, "nudge");
}

void turn(State& state, std::size_t axis, double degrees, Axes axes) {
    state.step([&](Edit& edit) { edit.pose() = turned(edit.pose(), axis, degrees, axes); }, "nudge");
}

/// The tip in numbers: dragged or typed.
void drawPlace(State& state) {
    Vec3 to = originOf(state.document.edit.pose());
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("tip, mm_").x);
    const int decimals = decimalsOn(state.volume.grid, 2);
    const std::string format = "%." + std::to_string(decimals) + "f";
    const auto speed = static_cast<float>(std::pow(10, 1 - decimals));
    if (dragNumbers("tip, mm", to, speed, format.c_str())) {
        state.command([&](Edit& edit) { edit.pose() = placedAt(edit.pose(), to); }, "tip");
    }
    if (ImGui::IsItemDeactivated()) {
        state.history.end();
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("position of the mesh origin: world x, y, z, mm");
    }
}

/// Like drawPlace(), for the rotation.
void drawAngles(State& state) {
    const Vec3 exact = anglesOf(state.document.edit.pose(), state.typedAngles);
    constexpr double kShown = 100; // parts of a degree
    Vec3 shown = exact;
    for (double& angle : shown) {
        angle = std::round(kShown * angle) / kShown + 0.0; // no -0.0
    }
    Vec3 to = shown;
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("turned \u00B0_").x);
    constexpr float kDegreesOfPoint = 0.5F;
    if (dragNumbers("turned \u00B0", to, kDegreesOfPoint, "%.2f")) {
        constexpr double kMost = 1e6;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool isOther = to[axis] != shown[axis] && std::isfinite(to[axis]);
            to[axis] = isOther ? std::clamp(to[axis], -kMost, kMost) : exact[axis];
        }
        state.command([&](Edit& edit) { edit.pose() = turnedTo(edit.pose(), to); }, "turned");
        state.typedAngles = TypedAngles{state.document.edit.pose(), to};
    }
    if (ImGui::IsItemDeactivated()) {
        state.history.end();
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("rotation about the mesh origin: degrees about world x, then y, then z");
    }
}

/// A pair of buttons, less and more.
int lessOrMore(const char* less, const char* more, float width) {
    int way = 0;
    ImGui::PushButtonRepeat(true);
    if (ImGui::Button(less, {width, 0})) {
        way = -1;
    }
    ImGui::SameLine();
    if (ImGui::Button(more, {width, 0})) {
        way = 1;
    }
    ImGui::PopButtonRepeat();
    return way;
}

void drawNudges(State& state) {
    const float width = (ImGui::GetContentRegionAvail().x - 5 * ImGui::GetStyle().ItemSpacing.x) / 6;
    for (const auto& [axis, less, more] : {std::tuple(0, "R", "L"), std::tuple(1, "A", "P"), std::tuple(2, "I", "S")}) {
        const int way = lessOrMore(less, more, width);
        if (axis < 2) {
            ImGui::SameLine();
        }
        if (way != 0) {
            Vec3 mm{};
            mm[static_cast<std::size_t>(axis)] = way * state.stepMillimetres;
            move(state, mm, Axes::World);
        }
    }
    for (const auto& [axis, less, more] :
         {std::tuple(0, "-x", "+x"), std::tuple(1, "-y", "+y"), std::tuple(2, "-z", "+z")}) {
        const int way = lessOrMore(less, more, width);
        if (axis < 2) {
            ImGui::SameLine();
        }
        if (way != 0) {
            turn(state, static_cast<std::size_t>(axis), way * state.stepDegrees, Axes::Own);
        }
    }
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (const int way = lessOrMore("withdraw", "insert", half); way != 0) {
        move(state, {0, 0, -way * state.stepMillimetres}, Axes::Own);
    }
}

void drawSteps(State& state) {
    constexpr double kLeast = 1e-6;
    const float width = ImGui::GetFontSize() * 4;
    ImGui::SetNextItemWidth(width);
    constexpr double kMost = 1000;
    if (typeNumber("mm", state.stepMillimetres, "%.3g")) {
        state.stepMillimetres = std::clamp(state.stepMillimetres, kLeast, kMost);
    }
    sameLine(width + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("degrees per step").x);
    ImGui::SetNextItemWidth(width);
    if (typeNumber("degrees per step", state.stepDegrees, "%.3g")) {
        state.stepDegrees = std::clamp(state.stepDegrees, kLeast, 180.0);
    }
}

void drawDrill(State& state) {
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 4);
    constexpr double kLeast = 1e-3;
    constexpr double kMost = 1000;
    if (typeNumber("mm", state.drillRadius, "%.3g")) {
        state.drillRadius = std::clamp(state.drillRadius, kLeast, kMost);
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("radius of the holes; their voxels get the minimum value of the image");
    }
    sameLine(widthOfButton("drill at the tip"));
    if (ImGui::Button("drill at the tip")) {
        state.drill(originOf(state.document.edit.pose()));
    }
    sameLine(widthOfButton("at the cursor"));
    if (ImGui::Button("at the cursor")) {
        state.drill(state.cursor);
    }
}

void drawPoses(State& state) {
    const std::size_t count = state.document.poses.size();
    if (count == 0) {
        return;
    }
    int number = static_cast<int>(state.document.pose);
    if (ImGui::Button(state.playing ? "stop" : "play", {ImGui::GetFontSize() * 3, 0})) {
        state.playing = !state.playing;
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    const std::string format = "pose %d of " + std::to_string(count);
    if (slideNumber("##poses", number, 0, static_cast<int>(count) - 1, format.c_str())) {
        // The slider is held until its history ends.
        state.takePose(static_cast<std::size_t>(std::clamp(number, 0, static_cast<int>(count) - 1)), true);
    }
    if (ImGui::IsItemDeactivated()) {
        state.history.end();
    }
}

} // namespace

void drawInstrument(State& state) {
    heading("Instrument");
    drawMeshes(state);
    drawPlace(state);
    drawAngles(state);
    drawNudges(state);
    drawSteps(state);
    drawGizmoChoice(state);
    if (ImGui::Button("tip to the cursor")) {
        state.command([&](Edit& edit) { edit.pose() = placedAt(edit.pose(), state.cursor); });
    }
    sameLine(widthOfButton("add pose to list"));
    if (ImGui::Button("add pose to list")) {
        state.document.poses.push_back(state.document.edit.pose());
        state.document.pose = state.document.poses.size() - 1;
    }
    ImGui::PushID("drill"); // it has a 'mm' of its own
    drawDrill(state);
    ImGui::PopID();
    drawPoses(state);
}

} // namespace voxtact::view
