// SPDX-License-Identifier: MIT
#include "shown_panels.h"

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

} // namespace

TEST(ViewFields, AnAngleIsDraggedAndUndoneAsAWhole) {
    State state = smallState();
    ShownPanels panels(state);
    const Point2 at = placeOfHint(state, panels, "degrees about x, then y, then z");
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
    const Point2 at = placeOfHint(state, panels, "degrees about x, then y, then z");
    const double toTheNext = state.chart.size[0] / 3; // the field of y
    panels.drag(at[0] + toTheNext, at[1], 230, 0);
    const Vec3 angles = anglesOf(state.document.edit.pose(), state.typedAngles);
    EXPECT_EQ(angles[0], 0);
    EXPECT_GT(angles[1], 95);
    EXPECT_EQ(angles[2], 0);
}

} // namespace voxtact::test
