// SPDX-License-Identifier: MIT
#include "shown_panels.h"
#include "viewer/model/shown/chart_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <cmath>

namespace voxtact::test {

using namespace voxtact::view;
using testing::ElementsAre;

namespace {

constexpr ValueRange kWhole{-100, 300};

/// Where a value and an opacity are in the window.
std::array<double, 2> placeOf(const State& state, double value, double opacity) {
    const ChartAxis axis{state.chart.corner[0], state.chart.size[0], state.chartRange()};
    return {axis.at(value), state.chart.corner[1] + (1 - opacity) * state.chart.size[1]};
}

} // namespace

TEST(ViewChart, ValuesAndPointsOfTheWindowBelongTogether) {
    const ChartAxis axis{50, 200, kWhole};
    EXPECT_DOUBLE_EQ(axis.at(-100), 50);
    EXPECT_DOUBLE_EQ(axis.at(0), 100);
    EXPECT_DOUBLE_EQ(axis.at(300), 250);
    EXPECT_DOUBLE_EQ(axis.at(400), 300); // beyond its side
    EXPECT_DOUBLE_EQ(axis.valueAt(100), 0);
    EXPECT_DOUBLE_EQ(axis.valueAt(axis.at(12.5)), 12.5);
}

TEST(ViewChart, AZoomKeepsWhatIsUnderThePointer) {
    ValueRange shown = kWhole;
    for (int step = 0; step < 5; ++step) {
        const ChartAxis before{0, 100, shown};
        const double x = before.at(40);
        shown = zoomed(shown, kWhole, 0.8, 40);
        EXPECT_NEAR((ChartAxis{0, 100, shown}).at(40), x, 1e-9);
    }
    EXPECT_NEAR(shown.hi - shown.lo, 400 * std::pow(0.8, 5), 1e-9);
    // Back again: within the whole, and exactly it at last.
    for (int step = 0; step < 7; ++step) {
        shown = zoomed(shown, kWhole, 1.25, -20);
        EXPECT_GE(shown.lo, kWhole.lo);
        EXPECT_LE(shown.hi, kWhole.hi);
    }
    EXPECT_EQ(shown.lo, kWhole.lo);
    EXPECT_EQ(shown.hi, kWhole.hi);
    EXPECT_TRUE(isWhole(shown, kWhole));
}

TEST(ViewChart, AZoomHasAnEnd) {
    ValueRange shown = kWhole;
    for (int step = 0; step < 200; ++step) {
        shown = zoomed(shown, kWhole, 0.5, 300);
    }
    EXPECT_NEAR(shown.hi - shown.lo, 400 * 1e-5, 1e-9);
    EXPECT_LE(shown.hi, 300);
    EXPECT_FALSE(isWhole(shown, kWhole));
}

TEST(ViewChart, IsMovedWithinTheWhole) {
    const ValueRange shown{0, 100};
    const auto moved = [&](double by) {
        const ValueRange to = panned(shown, kWhole, by);
        return std::array{to.lo, to.hi};
    };
    EXPECT_THAT(moved(30), ElementsAre(30, 130));
    EXPECT_THAT(moved(-130), ElementsAre(-100, 0));
    EXPECT_THAT(moved(500), ElementsAre(200, 300));
}

TEST(ViewChart, TicksAreRoundValuesWithinIt) {
    EXPECT_THAT(axisTicks({-100, 300}, 4), ElementsAre(0, 200));
    EXPECT_THAT(axisTicks({-100, 300}, 5), ElementsAre(-100, 0, 100, 200, 300));
    EXPECT_THAT(axisTicks({0, 255}, 6), ElementsAre(0, 50, 100, 150, 200, 250));
    EXPECT_THAT(axisTicks({0.31, 0.36}, 3),
                ElementsAre(testing::DoubleEq(0.32), testing::DoubleEq(0.34), testing::DoubleEq(0.36)));
    EXPECT_LE(axisTicks({0.1, 7e5}, 1).size(), 1U);
}

TEST(ViewChart, TheWheelZoomsAndTheMiddleButtonMoves) {
    State state = smallState();
    ShownPanels panels(state);
    // A pointer is at whole points.
    const double x = std::floor(placeOf(state, 60, 0.5)[0]);
    const double value = ChartAxis{state.chart.corner[0], state.chart.size[0], state.chartRange()}.valueAt(x);
    panels.turnWheel(x, placeOf(state, 60, 0.5)[1], 3);
    const ValueRange near = state.chartRange();
    EXPECT_NEAR(near.hi - near.lo, 255 * 0.8 * 0.8 * 0.8, 1e-9);
    EXPECT_NEAR(placeOf(state, value, 0.5)[0], x, 1e-3);
    // What was under the pointer stays under it.
    const std::array<double, 2> from = placeOf(state, 80, 0.5);
    panels.drag(from[0], from[1], -40, 10, ImGuiMouseButton_Middle);
    EXPECT_NEAR(placeOf(state, 80, 0.5)[0], from[0] - 40, 1e-2);
    EXPECT_NEAR(state.chartRange().hi - state.chartRange().lo, near.hi - near.lo, 1e-9);
    EXPECT_THAT(state.document.edit.curve, testing::SizeIs(2)); // no point was added
    panels.turnWheel(from[0], from[1], -1);
    EXPECT_NEAR(state.chartRange().hi - state.chartRange().lo, (near.hi - near.lo) / 0.8, 1e-9);
    panels.turnWheel(from[0], from[1], -9);
    EXPECT_FALSE(state.zoomedRange);
}

TEST(ViewChart, PointsAreDraggedAndAddedWhereThePointerIsWhenItIsZoomed) {
    State state = smallState();
    ShownPanels panels(state);
    const std::array<double, 2> about = placeOf(state, 80, 0.5);
    panels.turnWheel(about[0], about[1], 12);
    ASSERT_LT(state.chartRange().hi - state.chartRange().lo, 20);
    const std::array<double, 2> from = placeOf(state, 80, 1);
    const std::array<double, 2> to = placeOf(state, 83.5, 0.75);
    panels.drag(from[0], from[1] + 3, to[0] - from[0], to[1] - from[1] - 3);
    ASSERT_THAT(state.document.edit.curve, testing::SizeIs(2));
    // As near as a pixel is, which is 0.05 there; and finer than the whole domain would be rounded to.
    EXPECT_NEAR(state.document.edit.curve[1].value, 83.5, 0.06);
    EXPECT_NEAR(state.document.edit.curve[1].opacity, 0.75, 0.02);
    const std::array<double, 2> other = placeOf(state, 78.25, 0.3);
    panels.click(other[0], other[1]);
    ASSERT_THAT(state.document.edit.curve, testing::SizeIs(3));
    EXPECT_NEAR(state.document.edit.curve[1].value, 78.25, 0.06);
    // One that is not shown is not taken at the side where the line leaves the chart.
    EXPECT_EQ(state.document.edit.curve[0].value, 40);
}

TEST(ViewChart, StaysWhereItIsWhateverIsChosenBelow) {
    for (const float scale : {1.0F, 2.0F}) {
        State state = smallState();
        ShownPanels panels(state, scale);
        const Point2 size = state.chart.size;
        const std::array<double, 2> at = placeOf(state, 80, 1);
        panels.click(at[0], at[1] + 4);
        panels.turnWheel(at[0], at[1] + 4, 1);
        panels.frame();
        ASSERT_TRUE(state.curvePoint);
        EXPECT_EQ(state.chart.size, size);
    }
}

TEST(ViewChart, WhatIsUnderThePointerIsSaidBesideIt) {
    for (const Extent& points : {kLeastWindow, Extent{1280, 800}}) {
        for (const float scale : {1.0F, 2.0F}) {
            State state = smallState();
            ShownPanels panels(state, scale, points);
            for (const double opacity : {0.05, 0.5, 0.95}) {
                const std::array<double, 2> at = placeOf(state, 20, opacity);
                panels.moveTo(at[0], at[1]);
                panels.frame();
                panels.frame(); // its size is known then
                const ImGuiWindow* said = ImGui::FindWindowByName("##Tooltip_00");
                ASSERT_TRUE(said != nullptr && said->WasActive);
                const ImVec2 corner{static_cast<float>(state.chart.corner[0]),
                                    static_cast<float>(state.chart.corner[1])};
                const ImVec2 size{static_cast<float>(state.chart.size[0]), static_cast<float>(state.chart.size[1])};
                EXPECT_FALSE(said->Rect().Overlaps({corner, {corner.x + size.x, corner.y + size.y}})) << points.width;
                EXPECT_TRUE(ImRect({0, 0}, ImGui::GetIO().DisplaySize).Contains(said->Rect())) << points.width;
            }
        }
    }
}

TEST(ViewChart, TheWheelScrollsNothingElse) {
    State state = smallState();
    ShownPanels panels(state);
    ImGui::GetIO().DisplaySize = {640, 480}; // too low for all panels
    panels.frame();
    panels.frame();
    const std::array<double, 2> at = placeOf(state, 60, 0.5);
    panels.turnWheel(at[0], at[1], 6);
    const ValueRange near = state.chartRange();
    const Point2 corner = state.chart.corner;
    panels.turnWheel(at[0], at[1], -1);
    panels.frame();
    EXPECT_EQ(state.chart.corner, corner);
    EXPECT_NEAR(state.chartRange().hi - state.chartRange().lo, (near.hi - near.lo) / 0.8, 1e-9);
}

TEST(ViewChart, AButtonShowsAllValuesAgain) {
    State state = smallState();
    ShownPanels panels(state);
    const std::array<double, 2> at = placeOf(state, 60, 0.5);
    panels.turnWheel(at[0], at[1], 5);
    panels.frame();
    ASSERT_TRUE(state.zoomedRange);
    // In the heading's line, which is above the chart: somewhere to the right of the heading.
    for (double x = state.chart.corner[0] + 110; state.zoomedRange && x < state.chart.corner[0] + 200; x += 10) {
        panels.click(x, state.chart.corner[1] - 16);
    }
    EXPECT_FALSE(state.zoomedRange);
}

} // namespace voxtact::test
