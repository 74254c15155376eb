// SPDX-License-Identifier: MIT
#include "viewer/model/shown/chart_axis.h"
#include "viewer/model/shown/histogram.h"
#include "viewer/panels/fields.h"
#include "viewer/panels/panels.h"

#include "voxtact/looks.h"

#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

namespace voxtact::view {

namespace {

/// Values to the right and opacities up, in a rectangle of the window.
struct Chart {
    ImVec2 corner;
    ImVec2 size;
    ValueRange domain;
    ChartAxis axis;

    /// Points outside of the domain are at its ends.
    [[nodiscard]] ImVec2 at(const ControlPoint& point) const {
        return {static_cast<float>(axis.at(std::clamp(point.value, domain.lo, domain.hi))),
                corner.y + static_cast<float>(1 - point.opacity) * size.y};
    }
    [[nodiscard]] ControlPoint under(const ImVec2& mouse) const {
        return {axis.valueAt(static_cast<double>(mouse.x)), 1 - static_cast<double>((mouse.y - corner.y) / size.y)};
    }
    [[nodiscard]] ImVec2 end() const { return {corner.x + size.x, corner.y + size.y}; }
};

Chart chartOf(const State& state, const ImVec2& corner, const ImVec2& size) {
    const ChartAxis axis{static_cast<double>(corner.x), static_cast<double>(size.x), state.chartRange()};
    return {corner, size, state.document.domain, axis};
}

/// Scaled to the highest visible bar.
void drawHistogram(const State& state, const Chart& chart, ImDrawList& list) {
    constexpr std::size_t kMost = 256;
    const Bars bars = barsOf(state.histogram, chart.axis.shown, kMost);
    const auto height = [&state](std::uint64_t count) {
        const auto number = static_cast<double>(count);
        return state.logHistogram ? std::log1p(number) : number;
    };
    double most = 1;
    for (const std::uint64_t count : bars.counts) {
        most = std::max(most, height(count));
    }
    const float bottom = chart.end().y;
    for (std::size_t bar = 0; bar < bars.counts.size(); ++bar) {
        const double value = bars.first + static_cast<double>(bar) * bars.width;
        const auto left = static_cast<float>(chart.axis.at(value));
        const auto right = static_cast<float>(chart.axis.at(value + bars.width));
        const auto top = static_cast<float>(height(bars.counts[bar]) / most) * chart.size.y;
        list.AddRectFilled({left, bottom - top}, {right, bottom}, ImGui::GetColorU32(ImGuiCol_FrameBgHovered));
    }
}

/// Some values below the chart.
void drawAxis(const Chart& chart, float height, ImDrawList& list) {
    const float size = height * 0.85F;
    const auto most = static_cast<std::size_t>(std::max(chart.size.x / (size * 5), 2.0F));
    const ImU32 colour = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    for (const double value : axisTicks(chart.axis.shown, most)) {
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", value);
        const auto x = static_cast<float>(chart.axis.at(value));
        const float width = ImGui::GetFont()->CalcTextSizeA(size, FLT_MAX, 0, text).x;
        const float left = std::clamp(x - width / 2, chart.corner.x, std::max(chart.end().x - width, chart.corner.x));
        list.AddLine({x, chart.end().y}, {x, chart.end().y + height * 0.2F}, colour, scaled(1));
        list.AddText(ImGui::GetFont(), size, {left, chart.end().y + height * 0.2F}, colour, text);
    }
}

/// Shades values whose opacity reaches the threshold, and draws the threshold line.
void drawThreshold(const State& state, const Chart& chart, ImDrawList& list) {
    const Edit& edit = state.document.edit;
    const float bottom = chart.corner.y + chart.size.y;
    for (const ValueRange& range : opaqueRanges(edit.curve, edit.threshold, chart.domain)) {
        const float left = chart.at({range.lo, 0}).x;
        const float right = chart.at({range.hi, 0}).x;
        list.AddRectFilled({left, chart.corner.y}, {right, bottom}, IM_COL32(242, 184, 89, 34));
    }
    const float y = chart.at({0, edit.threshold}).y;
    list.AddLine({chart.corner.x, y}, {chart.corner.x + chart.size.x, y}, IM_COL32(242, 184, 89, 200), scaled(1.5F));
}

void drawLine(const State& state, const Chart& chart, ImDrawList& list) {
    const Curve& curve = state.document.edit.curve;
    const ImU32 colour = ImGui::GetColorU32(ImGuiCol_SliderGrab);
    ImVec2 before = chart.at({chart.domain.lo, curve.front().opacity});
    for (const ControlPoint& point : curve) {
        const ImVec2 at = chart.at(point);
        list.AddLine(before, at, colour, scaled(2));
        before = at;
    }
    list.AddLine(before, chart.at({chart.domain.hi, curve.back().opacity}), colour, scaled(2));
}

void drawThresholdField(State& state) {
    double threshold = state.document.edit.threshold;
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("threshold_").x);
    if (slideNumber("threshold", threshold, 0, 1, "%.3f")) {
        constexpr double kSteps = 1000;
        state.command(
            [&](Edit& edit) { edit.threshold = std::clamp(std::round(threshold * kSteps) / kSteps, 0.0, 1.0); },
            "threshold");
    }
    if (ImGui::IsItemDeactivated()) {
        state.history.end();
    }
}

void drawPoints(const State& state, const Chart& chart, ImDrawList& list) {
    const Curve& curve = state.document.edit.curve;
    const ImU32 colour = ImGui::GetColorU32(ImGuiCol_SliderGrab);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const bool chosen = state.curvePoint == i;
        const ImVec2 at = chart.at(curve[i]);
        if (at.x < chart.corner.x || at.x > chart.end().x) {
            continue; // not shown
        }
        list.AddCircleFilled(at, scaled(chosen ? 6.5F : 5), chosen ? IM_COL32_WHITE : colour);
    }
}

std::optional<std::size_t> pointUnder(const Curve& curve, const Chart& chart, const ImVec2& mouse) {
    const float reach = scaled(10);
    std::optional<std::size_t> nearest;
    float best = reach * reach;
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

/// The wheel zooms about the pointer; a drag with the middle button moves.
void takeZoom(State& state, const Chart& chart) {
    const ImGuiIO& io = ImGui::GetIO();
    ValueRange shown = chart.axis.shown;
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        constexpr double kFactor = 0.8;
        shown = zoomed(shown, chart.domain, std::pow(kFactor, static_cast<double>(io.MouseWheel)),
                       chart.axis.valueAt(static_cast<double>(io.MousePos.x)));
    }
    if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
        const double right = static_cast<double>(draggedBy().x);
        shown = panned(shown, chart.domain, -right * (shown.hi - shown.lo) / chart.axis.width);
    }
    state.zoomedRange = isWhole(shown, chart.domain) ? std::nullopt : std::optional(shown);
}

/// Left: takes a point, or makes one. Right: removes one.
void takeMouse(State& state, const Chart& chart) {
    const ImGuiIO& io = ImGui::GetIO();
    const ControlPoint under = rounded(chart.under(io.MousePos), chart.axis.shown);
    if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        state.history.end();
        state.curvePoint = pointUnder(state.document.edit.curve, chart, io.MousePos);
        if (!state.curvePoint) {
            state.command([&](Edit& edit) { state.curvePoint = addPoint(edit.curve, under); }, "curve");
        }
    } else if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && state.curvePoint &&
               (draggedBy().x != 0 || draggedBy().y != 0)) {
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
        // Beside the chart, on which the hand works: over the picture.
        const float line = ImGui::GetFontSize();
        const float low = io.DisplaySize.y - 8 * line; // of a column that is scrolled
        const float y = std::clamp(chart.corner.y, std::min(2 * line, low), low);
        ImGui::SetNextWindowPos({chart.corner.x - line, y}, ImGuiCond_Always, {1, 0});
        ImGui::SetTooltip("value %.6g, opacity %.3f\nleft: take or add a point\nright: remove it\nwheel: zoom\n"
                          "middle: move",
                          under.value, std::clamp(under.opacity, 0.0, 1.0));
    }
}

/// The chosen point in numbers.
void drawChosen(State& state) {
    Curve& curve = state.document.edit.curve;
    if (!state.curvePoint || *state.curvePoint >= curve.size()) {
        state.curvePoint.reset();
        ImGui::AlignTextToFramePadding(); // as high as the fields
        ImGui::TextColored(quietColour(), "click the curve to add a point");
        return;
    }
    ControlPoint typed = curve[*state.curvePoint];
    const float width = ImGui::GetFontSize() * 4.5F;
    ImGui::SetNextItemWidth(width);
    bool changed = typeNumber("value", typed.value, "%.6g");
    sameLine(width + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("opacity").x);
    ImGui::SetNextItemWidth(width);
    changed |= typeNumber("opacity", typed.opacity, "%.3g");
    if (changed && std::isfinite(typed.value) && std::isfinite(typed.opacity)) {
        state.command([&](Edit& edit) { movePoint(edit.curve, *state.curvePoint, typed, state.document.domain); });
    }
    sameLine(widthOfButton("remove"));
    if (ImGui::Button("remove")) {
        state.command([&](Edit& edit) { removePoint(edit.curve, *state.curvePoint); });
        state.curvePoint.reset();
    }
}

float widthOfPresets() {
    return ImGui::GetFontSize() * 6;
}

void drawPresets(State& state) {
    ImGui::SetNextItemWidth(widthOfPresets());
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

/// With the chart's readings at the right.
void drawHeading(State& state) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const bool zoomed = state.zoomedRange.has_value();
    const float width =
        (zoomed ? widthOfButton("all values") + gap : 0) + widthOfPresets() + gap + widthOfCheckbox("log");
    const float left = ImGui::GetContentRegionMax().x - width;
    heading(fitting({"Transfer function", "Function", ""}, left - ImGui::GetCursorPosX() - gap).c_str());
    ImGui::SameLine(left);
    if (zoomed) {
        if (ImGui::Button("all values")) {
            state.zoomedRange.reset();
        }
        ImGui::SameLine();
    }
    drawPresets(state);
    ImGui::SameLine();
    ImGui::Checkbox("log", &state.logHistogram);
}

float heightOfChart() {
    return ImGui::GetFontSize() * 6.5F;
}

void drawChart(State& state) {
    const float axis = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, heightOfChart()};
    state.chart.corner = {static_cast<double>(corner.x), static_cast<double>(corner.y)};
    state.chart.size = {static_cast<double>(size.x), static_cast<double>(size.y)};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::InvisibleButton("curve", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ImGui::SetItemUsingMouseWheel(); // else a window that is low scrolls the panels
    takeZoom(state, chartOf(state, corner, size));
    const Chart chart = chartOf(state, corner, size);
    takeMouse(state, chart);
    ImGui::Dummy({size.x, axis - ImGui::GetStyle().ItemSpacing.y});
    list.AddRectFilled(chart.corner, chart.end(), ImGui::GetColorU32(ImGuiCol_FrameBg), scaled(4));
    list.PushClipRect(chart.corner, chart.end(), true);
    drawHistogram(state, chart, list);
    drawThreshold(state, chart, list);
    drawLine(state, chart, list);
    list.PopClipRect();
    drawPoints(state, chart, list); // whole at the edges, too
    drawAxis(chart, axis, list);
}

} // namespace

void drawCurve(State& state) {
    drawHeading(state);
    const ImVec2 chart = ImGui::GetCursorPos();
    // The fields below first: typed values belong to the chosen point until the mouse chooses another.
    ImGui::SetCursorPosY(chart.y + heightOfChart() + ImGui::GetFontSize() + ImGui::GetStyle().ItemSpacing.y);
    drawChosen(state);
    drawThresholdField(state);
    ImGui::SetCursorPos(chart);
    drawChart(state);
}

} // namespace voxtact::view
