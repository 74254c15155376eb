// SPDX-License-Identifier: MIT
#include "shown_panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <optional>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

/// Where something in the column says that when the pointer is over it: the first of a line.
Point2 placeOfHint(const State& state, ShownPanels& panels, const std::string& hint) {
    for (Point2 at{state.chart.corner[0] + 30, state.chart.corner[1]}; at[1] < 800; at[1] += 8) {
        panels.moveTo(at[0], at[1]);
        if (panels.shownText().find(hint) != std::string::npos) {
            return at;
        }
    }
    ADD_FAILURE() << "nothing says: " << hint;
    return {};
}

Point2 placeOfTip(const State& state, ShownPanels& panels) {
    return placeOfHint(state, panels, "position of the mesh origin");
}

double tipX(const State& state) {
    return originOf(state.document.edit.pose())[0];
}

/// Where nothing is, beside a heading.
void clickBeside(const State& state, ShownPanels& panels) {
    panels.click(state.chart.corner[0] + 120, 40);
}

} // namespace

TEST(ViewFields, AnAngleIsDraggedAndUndoneAsAWhole) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfHint(state, panels, "degrees about world x, then y, then z");
    panels.drag(at[0], at[1], 60, 0);
    const Vec3 angles = anglesOf(state.document.edit.pose());
    EXPECT_GT(angles[0], 10);
    EXPECT_NEAR(angles[1], 0, 1e-12);
    EXPECT_NEAR(angles[2], 0, 1e-12);
    state.undo();
    EXPECT_EQ(state.document.edit.pose(), identity());
}

TEST(ViewFields, AnAngleIsDraggedThroughAQuarterTurn) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfHint(state, panels, "degrees about world x, then y, then z");
    const double toTheNext = state.chart.size[0] / 3; // the field of y
    panels.drag(at[0] + toTheNext, at[1], 230, 0);
    const Vec3 angles = anglesOf(state.document.edit.pose(), state.typedAngles);
    EXPECT_EQ(angles[0], 0);
    EXPECT_GT(angles[1], 95);
    EXPECT_EQ(angles[2], 0);
}

TEST(ViewFields, WhatIsTypedIsTakenByEnterAsAWhole) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfTip(state, panels);
    panels.writeAt(at[0], at[1]);
    panels.type("12.5");
    EXPECT_EQ(tipX(state), 0);
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(tipX(state), 12.5);
    state.undo();
    EXPECT_EQ(state.document.edit.pose(), identity());
    EXPECT_FALSE(state.history.canUndo());
}

TEST(ViewFields, WhatIsTypedIsTakenWhenTheFieldIsLeft) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfTip(state, panels);
    panels.writeAt(at[0], at[1]);
    panels.type("-7");
    EXPECT_EQ(tipX(state), 0);
    clickBeside(state, panels);
    EXPECT_EQ(tipX(state), -7);
    // By Tab it is left for the next one.
    panels.writeAt(at[0], at[1]);
    panels.type("3.25");
    panels.tap(GLFW_KEY_TAB);
    panels.frame();
    EXPECT_EQ(tipX(state), 3.25);
    panels.type("8");
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(originOf(state.document.edit.pose()), (Vec3{3.25, 8, 0}));
    state.undo();
    state.undo();
    EXPECT_EQ(tipX(state), -7);
}

/// Dear ImGui gives it the keyboard before the field that had it is drawn.
TEST(ViewFields, WhatIsTypedIsTakenWhenAnEarlierFieldIsWrittenIn) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfTip(state, panels);
    const double toTheNext = state.chart.size[0] / 3;
    panels.writeAt(at[0] + toTheNext, at[1]);
    panels.type("5.5");
    panels.writeAt(at[0], at[1]);
    EXPECT_EQ(originOf(state.document.edit.pose()), (Vec3{0, 5.5, 0}));
    panels.type("4");
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(originOf(state.document.edit.pose()), (Vec3{4, 5.5, 0}));
}

TEST(ViewFields, WhatWasWipedAwayIsNotTaken) {
    State state = smallState();
    state.document.edit.pose() = translation({3, 0, 0});
    ShownPanels panels(state);
    const Point2 at = placeOfTip(state, panels);
    for (const std::string& text : {std::string("12"), std::string("-5")}) {
        panels.writeAt(at[0], at[1]);
        panels.type(text);
        panels.tap(GLFW_KEY_BACKSPACE);
        if (text == "12") {
            panels.tap(GLFW_KEY_BACKSPACE);
        }
        panels.tap(GLFW_KEY_ENTER);
        panels.frame();
        EXPECT_EQ(tipX(state), 3) << text;
    }
    EXPECT_FALSE(state.history.canUndo());
}

TEST(ViewFields, AnAngleThatIsNoNumberIsNotTaken) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfHint(state, panels, "degrees about world x, then y, then z");
    panels.writeAt(at[0], at[1]);
    panels.type("1e999");
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(anglesOf(state.document.edit.pose(), state.typedAngles), (Vec3{0, 0, 0}));
    EXPECT_EQ(state.document.edit.pose(), identity());
}

TEST(ViewFields, EscapeAndAFieldThatNothingIsWrittenInChangeNothing) {
    State state = smallState();
    state.document.edit.pose() = translation({1.23456789, 0, 0});
    ShownPanels panels(state);
    const Mat4 before = state.document.edit.pose();
    const Point2 at = placeOfTip(state, panels);
    panels.writeAt(at[0], at[1]);
    panels.type("99");
    panels.tap(GLFW_KEY_ESCAPE);
    panels.frame();
    EXPECT_EQ(state.document.edit.pose(), before);
    panels.writeAt(at[0], at[1]);
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(state.document.edit.pose(), before);
    panels.writeAt(at[0], at[1]);
    clickBeside(state, panels);
    EXPECT_EQ(state.document.edit.pose(), before);
    EXPECT_FALSE(state.history.canUndo());
    // Not what stood there before, either.
    panels.writeAt(at[0], at[1]);
    state.document.edit.pose() = translation({5, 0, 0});
    panels.frame();
    clickBeside(state, panels);
    EXPECT_EQ(tipX(state), 5);
}

TEST(ViewFields, WhatIsTypedMayBeWhatStoodThere) {
    State state = smallState();
    state.document.edit.pose() = translation({61.3, 0, 0});
    ShownPanels panels(state);
    const Point2 at = placeOfTip(state, panels);
    panels.writeAt(at[0], at[1]);
    panels.type("7");
    panels.tap(GLFW_KEY_ENTER);
    ASSERT_EQ(tipX(state), 7);
    state.undo();
    for (const std::string& text : {std::string("61.3"), std::string("61.30")}) {
        panels.writeAt(at[0], at[1]);
        panels.type(text);
        panels.tap(GLFW_KEY_ENTER);
        EXPECT_EQ(tipX(state), 61.3) << text;
        panels.writeAt(at[0], at[1]);
        panels.type(text);
        clickBeside(state, panels);
        EXPECT_EQ(tipX(state), 61.3) << text;
    }
    EXPECT_FALSE(state.history.canUndo());
}

TEST(ViewFields, AnAngleIsTyped) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfHint(state, panels, "degrees about world x, then y, then z");
    panels.writeAt(at[0], at[1]);
    panels.type("200");
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_NEAR(anglesOf(state.document.edit.pose())[0], -160, 1e-9);
    EXPECT_EQ(anglesOf(state.document.edit.pose(), state.typedAngles), (Vec3{200, 0, 0}));
    state.undo();
    EXPECT_EQ(state.document.edit.pose(), identity());
}

TEST(ViewFields, AStepIsTakenWhenItIsWhole) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfHint(state, panels, "radius of the holes");
    panels.writeAt(at[0], at[1]);
    panels.type("12.5");
    EXPECT_EQ(state.drillRadius, 5);
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(state.drillRadius, 12.5);
    panels.writeAt(at[0], at[1]);
    panels.type("0");
    clickBeside(state, panels);
    EXPECT_EQ(state.drillRadius, 1e-3); // no hole is smaller
}

TEST(ViewFields, APointThatIsTypedIsTheOneThatWasChosenThen) {
    State state = smallState();
    state.curvePoint = 0;
    ShownPanels panels(state);
    const double below = state.chart.corner[1] + state.chart.size[1] + 30;
    panels.writeAt(state.chart.corner[0] + 20, below);
    panels.type("55");
    EXPECT_EQ(state.document.edit.curve[0].value, 40);
    // The other point, which is at 80 of 0 to 255.
    panels.click(state.chart.corner[0] + state.chart.size[0] * 80 / 255, state.chart.corner[1] + 3);
    EXPECT_EQ(state.curvePoint, 1U);
    ASSERT_EQ(state.document.edit.curve.size(), 2U);
    EXPECT_EQ(state.document.edit.curve[0].value, 55);
    EXPECT_EQ(state.document.edit.curve[1].value, 80);
}

TEST(ViewFields, AThresholdIsTypedOrSlid) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at{state.chart.corner[0] + 100, state.chart.corner[1] + state.chart.size[1] + 56};
    panels.writeAt(at[0], at[1]);
    panels.type(".25");
    EXPECT_EQ(state.document.edit.threshold, kDefaultThreshold);
    panels.tap(GLFW_KEY_ENTER);
    EXPECT_EQ(state.document.edit.threshold, 0.25);
    panels.moveTo(at[0], at[1]);
    panels.press();
    panels.moveTo(at[0] + 50, at[1]);
    EXPECT_GT(state.document.edit.threshold, 0.3); // while it is held
    panels.release();
    state.undo();
    EXPECT_EQ(state.document.edit.threshold, 0.25);
}

} // namespace voxtact::test
