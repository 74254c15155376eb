// SPDX-License-Identifier: MIT
#include "shown_panels.h"
#include "viewer/model/shown/chart_axis.h"
#include "viewer/panels/onto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

/// How thick the bar of millimetres is in a picture, with the rim that smooths it, which is as wide on any display.
float thicknessOfBar(const State& state) {
    const ImVec2 size{800, 600};
    const Onto onto{clipFromWorld(state.camera, {800, 600}, 1), {0, 0}, size};
    ImDrawList list(ImGui::GetDrawListSharedData());
    list._ResetForNewFrame();
    list.PushTextureID(ImGui::GetIO().Fonts->TexID);
    list.PushClipRect({0, 0}, size);
    State still = smallState(); // no answer, no poses
    still.camera = state.camera;
    drawMarks(still, onto, list);
    // The lowest of what is drawn: its number stands above it.
    float lowest = 0;
    for (const ImDrawVert& vertex : list.VtxBuffer) {
        lowest = std::max(lowest, vertex.pos.y);
    }
    float upper = lowest;
    for (const ImDrawVert& vertex : list.VtxBuffer) {
        upper = vertex.pos.y > lowest - scaled(5) ? std::min(upper, vertex.pos.y) : upper;
    }
    return lowest - upper;
}

/// How far beside a point of the curve a click takes it, in pixels.
int reachOfCurve(float scale) {
    int reach = 0;
    for (int beside = 1; beside < 40; ++beside) {
        State state = smallState();
        ShownPanels panels(state, scale);
        const ChartAxis axis{state.chart.corner[0], state.chart.size[0], state.chartRange()};
        panels.click(axis.at(80) + beside, state.chart.corner[1] + 1);
        reach = state.document.edit.curve.size() == 2 ? beside : reach;
    }
    return reach;
}

/// How far from the arrow of x, whose middle it is beside, the pointer takes it, in pixels.
int reachOfHandles(float scale) {
    State state = smallState();
    state.camera.direction = {0, 0};
    state.camera.target = {};
    ShownPanels panels(state, scale);
    const double x = state.picture.corner[0] + state.picture.size[0] / 2;
    const double y = state.picture.corner[1] + state.picture.size[1] / 2;
    // From the front, x goes to the right; beyond the square, and within the ring.
    const double along = 0.65 * 75 * static_cast<double>(scale);
    int reach = 0;
    for (int above = 0; above < 30; ++above) {
        panels.moveTo(x + along, y - above);
        reach = state.gizmoHandle == Handle{HandleKind::Arrow, 0} ? above : reach;
    }
    return reach;
}

} // namespace

TEST(ViewDisplayScale, LinesAreTwiceAsThickWherePointsAreTwiceAsLarge) {
    std::array<float, 2> thickness{};
    for (const std::size_t scale : {1U, 2U}) {
        State state = smallState();
        const ShownPanels panels(state, static_cast<float>(scale));
        EXPECT_FLOAT_EQ(scaled(3), 3 * static_cast<float>(scale));
        thickness[scale - 1] = thicknessOfBar(state);
    }
    EXPECT_NEAR(thickness[1] - thickness[0], 2, 0.1); // 2 points
}

TEST(ViewDisplayScale, PointsAndHandlesAreTakenFromTwiceAsFar) {
    EXPECT_NEAR(reachOfCurve(1), 10, 1);
    EXPECT_NEAR(reachOfCurve(2), 20, 1);
    EXPECT_NEAR(reachOfHandles(1), 6, 1);
    EXPECT_NEAR(reachOfHandles(2), 12, 1);
}

TEST(ViewDisplayScale, TheThemeIsThatOfTheState) {
    State state = smallState();
    ShownPanels panels(state);
    const auto bright = [] { return ImGui::GetStyle().Colors[ImGuiCol_WindowBg].x > 0.5F; };
    EXPECT_FALSE(bright());
    state.theme = Theme::Light;
    panels.frame();
    EXPECT_TRUE(bright());
    // Of another scene that was loaded: what its session says.
    Document document = state.saved();
    EXPECT_EQ(document.shown->theme, Theme::Light);
    Given given = state.giveBack();
    given.document.shown->theme = Theme::Dark;
    state = State(std::move(given));
    panels.frame();
    EXPECT_FALSE(bright());
}

} // namespace voxtact::test
