// SPDX-License-Identifier: MIT
#include "view/panels/panels.h"

#include "voxtact/looks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::view {

namespace {

/// Values to the right and opacities up, in a rectangle of the window.
struct Chart {
    ImVec2 corner;
    ImVec2 size;
    ValueRange domain;

    [[nodiscard]] ImVec2 at(const ControlPoint& point) const {
        const double share = (point.value - domain.lo) / (domain.hi - domain.lo);
        return {corner.x + static_cast<float>(std::clamp(share, 0.0, 1.0)) * size.x,
                corner.y + static_cast<float>(1 - point.opacity) * size.y};
    }
    [[nodiscard]] ControlPoint under(const ImVec2& mouse) const {
        const double share = static_cast<double>((mouse.x - corner.x) / size.x);
        return {domain.lo + share * (domain.hi - domain.lo), 1 - static_cast<double>((mouse.y - corner.y) / size.y)};
    }
};

void drawHistogram(const State& state, const Chart& chart, ImDrawList& list) {
    const auto height = [&state](std::uint64_t count) {
        const auto number = static_cast<double>(count);
        return state.logHistogram ? std::log1p(number) : number;
    };
    double most = 1;
    for (const std::uint64_t count : state.histogram) {
        most = std::max(most, height(count));
    }
    const float width = chart.size.x / static_cast<float>(state.histogram.size());
    for (std::size_t bin = 0; bin < state.histogram.size(); ++bin) {
        const float x = chart.corner.x + static_cast<float>(bin) * width;
        const float bottom = chart.corner.y + chart.size.y;
        const auto top = static_cast<float>(height(state.histogram[bin]) / most) * chart.size.y;
        list.AddRectFilled({x, bottom - top}, {x + width, bottom}, ImGui::GetColorU32(ImGuiCol_FrameBgHovered));
    }
}

/// What of the values collides is shaded; the threshold is a line.
void drawThreshold(const State& state, const Chart& chart, ImDrawList& list) {
    const Edit& edit = state.document.edit;
    const float bottom = chart.corner.y + chart.size.y;
    for (const ValueRange& range : opaqueRanges(edit.curve, edit.threshold, chart.domain)) {
        const float left = chart.at({range.lo, 0}).x;
        const float right = chart.at({range.hi, 0}).x;
        list.AddRectFilled({left, chart.corner.y}, {right, bottom}, IM_COL32(242, 184, 89, 34));
    }
    const float y = chart.at({0, edit.threshold}).y;
    list.AddLine({chart.corner.x, y}, {chart.corner.x + chart.size.x, y}, IM_COL32(242, 184, 89, 200), 1.5F);
}

void drawLine(const State& state, const Chart& chart, ImDrawList& list) {
    const Curve& curve = state.document.edit.curve;
    const ImU32 colour = ImGui::GetColorU32(ImGuiCol_SliderGrab);
    ImVec2 before = chart.at({chart.domain.lo, curve.front().opacity});
    for (const ControlPoint& point : curve) {
        const ImVec2 at = chart.at(point);
        list.AddLine(before, at, colour, 2);
        before = at;
    }
    list.AddLine(before, chart.at({chart.domain.hi, curve.back().opacity}), colour, 2);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const bool chosen = state.curvePoint == i;
        list.AddCircleFilled(chart.at(curve[i]), chosen ? 6.5F : 5, chosen ? IM_COL32_WHITE : colour);
    }
}

std::optional<std::size_t> pointUnder(const Curve& curve, const Chart& chart, const ImVec2& mouse) {
    constexpr float kReach = 10;
    std::optional<std::size_t> nearest;
    float best = kReach * kReach;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const ImVec2 at = chart.at(curve[i]);
        const float distance = (at.x - mouse.x) * (at.x - mouse.x) + (at.y - mouse.y) * (at.y - mouse.y);
        if (distance <= best) {
            best = distance;
            nearest = i;
        }
    }
    return nearest;
}

/// Left: takes a point, or makes one. Right: removes one.
void takeMouse(State& state, const Chart& chart) {
    const ImGuiIO& io = ImGui::GetIO();
    const ControlPoint under = rounded(chart.under(io.MousePos), chart.domain);
    if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        state.history.end();
        state.curvePoint = pointUnder(state.document.edit.curve, chart, io.MousePos);
        if (!state.curvePoint) {
            state.command([&](Edit& edit) { state.curvePoint = addPoint(edit.curve, under); }, "curve");
        }
    } else if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && state.curvePoint &&
               (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        state.command([&](Edit& edit) { movePoint(edit.curve, *state.curvePoint, under, chart.domain); }, "curve");
    }
    if (ImGui::IsItemDeactivated()) {
        state.history.end();
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        if (const auto point = pointUnder(state.document.edit.curve, chart, io.MousePos)) {
            state.command([&](Edit& edit) { removePoint(edit.curve, *point); });
            state.curvePoint.reset();
        }
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("value %.6g, opacity %.3f\nleft: take or add a point; right: remove it", under.value,
                          std::clamp(under.opacity, 0.0, 1.0));
    }
}

/// The chosen point in numbers.
void drawChosen(State& state) {
    Curve& curve = state.document.edit.curve;
    if (!state.curvePoint || *state.curvePoint >= curve.size()) {
        state.curvePoint.reset();
        ImGui::TextColored(quietColour(), "click the curve for a point");
        return;
    }
    ControlPoint typed = curve[*state.curvePoint];
    const float width = ImGui::GetFontSize() * 4.5F;
    ImGui::SetNextItemWidth(width);
    bool changed = ImGui::InputDouble("value", &typed.value, 0, 0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(width);
    changed |= ImGui::InputDouble("opacity", &typed.opacity, 0, 0, "%.3g", ImGuiInputTextFlags_EnterReturnsTrue);
    if (changed && std::isfinite(typed.value) && std::isfinite(typed.opacity)) {
        state.command([&](Edit& edit) { movePoint(edit.curve, *state.curvePoint, typed, state.document.domain); });
    }
    ImGui::SameLine();
    if (ImGui::Button("remove")) {
        state.command([&](Edit& edit) { removePoint(edit.curve, *state.curvePoint); });
        state.curvePoint.reset();
    }
}

void drawPresets(State& state) {
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
    if (!ImGui::BeginCombo("##presets", "presets")) {
        return;
    }
    for (const LookPreset& preset : lookPresets()) {
        if (!ImGui::Selectable(preset.name)) {
            continue;
        }
        if (Result<Look> look = lookNamed(preset.name, state.values); look.ok()) {
            state.command([&](Edit& edit) {
                edit.curve = look->opacity;
                edit.colours = look->colours;
            });
            state.curvePoint.reset();
        } else {
            state.complain(look.error().text);
        }
    }
    ImGui::EndCombo();
}

} // namespace

void drawCurve(State& state) {
    heading("Transfer function");
    ImGui::SameLine(ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 9.5F);
    drawPresets(state);
    ImGui::SameLine();
    ImGui::Checkbox("log", &state.logHistogram);
    Chart chart{ImGui::GetCursorScreenPos(),
                {ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 7.5F},
                state.document.domain};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::InvisibleButton("curve", chart.size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    takeMouse(state, chart);
    list.AddRectFilled(chart.corner, {chart.corner.x + chart.size.x, chart.corner.y + chart.size.y},
                       ImGui::GetColorU32(ImGuiCol_FrameBg), 4);
    drawHistogram(state, chart, list);
    drawThreshold(state, chart, list);
    drawLine(state, chart, list);
    drawChosen(state);
    const double least = 0;
    const double most = 1;
    double threshold = state.document.edit.threshold;
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("threshold_").x);
    if (ImGui::SliderScalar("threshold", ImGuiDataType_Double, &threshold, &least, &most, "%.3f")) {
        constexpr double kSteps = 1000;
        state.command(
            [&](Edit& edit) { edit.threshold = std::clamp(std::round(threshold * kSteps) / kSteps, 0.0, 1.0); },
            "threshold");
    }
    if (ImGui::IsItemDeactivated()) {
        state.history.end();
    }
}

} // namespace voxtact::view
