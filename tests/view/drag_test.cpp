// SPDX-License-Identifier: MIT
#include "shown_panels.h"

#include <gtest/gtest.h>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

/// A place of the picture where there is neither a handle nor the cube.
Point2 freePlace(const State& state) {
    return {state.picture.corner[0] + 40, state.picture.corner[1] + state.picture.size[1] - 40};
}

/// The middle of the first slice, which lies below the picture.
Point2 slicePlace(const State& state) {
    return {state.picture.corner[0] + 80, state.picture.corner[1] + state.picture.size[1] + 80};
}

} // namespace

TEST(ViewDrag, AClickDoesNotTurnThePictureByTheWayToIt) {
    State state = smallState();
    ShownPanels panels(state);
    const Camera before = state.camera;
    const Point2 at = freePlace(state);
    for (const int button : {ImGuiMouseButton_Left, ImGuiMouseButton_Right, ImGuiMouseButton_Middle}) {
        panels.moveTo(at[0] + 90, at[1] - 90);
        panels.pressAt(at[0], at[1], button);
        panels.frame();
        panels.release(button);
        EXPECT_EQ(state.camera.direction.azimuth, before.direction.azimuth) << button;
        EXPECT_EQ(state.camera.direction.elevation, before.direction.elevation) << button;
        EXPECT_EQ(state.camera.target, before.target) << button;
    }
    // From there on it is a drag.
    panels.pressAt(at[0], at[1]);
    panels.moveTo(at[0] + 30, at[1]);
    EXPECT_NE(state.camera.direction.azimuth, before.direction.azimuth);
    panels.release();
}

TEST(ViewDrag, ADoubleClickFromFarAwayEnlargesThePictureAndDoesNotTurnIt) {
    State state = smallState();
    ShownPanels panels(state);
    const double azimuth = state.camera.direction.azimuth;
    const Point2 at = freePlace(state);
    panels.moveTo(at[0] + 200, at[1] - 100);
    panels.pressAt(at[0], at[1]);
    panels.release();
    panels.press();
    panels.release();
    EXPECT_EQ(state.maximised, Maximised::Picture);
    EXPECT_EQ(state.camera.direction.azimuth, azimuth);
}

TEST(ViewDrag, TheRightButtonInASliceChangesNothingByTheWayToIt) {
    State state = smallState();
    ShownPanels panels(state);
    const ValueRange before = state.window;
    const Point2 at = slicePlace(state);
    panels.moveTo(at[0] + 60, at[1] - 200);
    panels.pressAt(at[0], at[1], ImGuiMouseButton_Right);
    panels.frame();
    EXPECT_EQ(state.window.lo, before.lo);
    EXPECT_EQ(state.window.hi, before.hi);
    panels.moveTo(at[0] + 20, at[1]);
    EXPECT_LT(state.window.hi - state.window.lo, before.hi - before.lo);
    panels.release(ImGuiMouseButton_Right);
}

TEST(ViewDrag, TheChartIsNotMovedByTheWayToIt) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at{state.chart.corner[0] + state.chart.size[0] / 2, state.chart.corner[1] + state.chart.size[1] / 2};
    panels.turnWheel(at[0], at[1], 3);
    const ValueRange before = state.chartRange();
    panels.moveTo(at[0] - 60, at[1]);
    panels.pressAt(at[0], at[1], ImGuiMouseButton_Middle);
    panels.frame();
    EXPECT_EQ(state.chartRange().lo, before.lo);
    panels.release(ImGuiMouseButton_Middle);
}

} // namespace voxtact::test
