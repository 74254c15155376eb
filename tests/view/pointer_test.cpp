// SPDX-License-Identifier: MIT
#include "viewer/model/shown/pointer.h"

#include <gtest/gtest.h>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

constexpr double kReach = 6;

void click(Pointer& pointer, const Point2& at, double seconds) {
    pointer.moveTo(at);
    pointer.press(0, seconds, kReach);
    pointer.release(0);
}

} // namespace

TEST(ViewPointer, AFrameSeesAPressWhereItWas) {
    Pointer pointer;
    pointer.moveTo({10, 20});
    EXPECT_FALSE(pointer.next(0).at) << "wherever it is";
    pointer.moveTo({40, 50});
    pointer.press(0, 0.1, kReach);
    pointer.moveTo({90, 90});
    const Pointer::Seen seen = pointer.next(0.2);
    EXPECT_EQ(seen.at, (Point2{40, 50}));
    EXPECT_TRUE(seen.down[0]);
    EXPECT_EQ(seen.clicks[0], 1);
    EXPECT_FALSE(pointer.behind());
    EXPECT_FALSE(pointer.next(0.3).at);
    EXPECT_TRUE(pointer.next(0.4).down[0]) << "it is held";
}

TEST(ViewPointer, ADragOfOneFrameIsSeenStepByStep) {
    Pointer pointer;
    pointer.moveTo({10, 10});
    pointer.press(1, 0, kReach);
    pointer.moveTo({30, 10});
    pointer.release(1);
    pointer.moveTo({500, 500});
    const Pointer::Seen pressed = pointer.next(0);
    EXPECT_EQ(pressed.at, (Point2{10, 10}));
    EXPECT_TRUE(pressed.down[1]);
    const Pointer::Seen held = pointer.next(0);
    EXPECT_EQ(held.at, (Point2{30, 10}));
    EXPECT_TRUE(held.down[1]);
    EXPECT_EQ(held.clicks[1], 0);
    EXPECT_TRUE(pointer.behind());
    const Pointer::Seen released = pointer.next(0);
    EXPECT_EQ(released.at, (Point2{30, 10}));
    EXPECT_FALSE(released.down[1]);
    EXPECT_FALSE(pointer.behind());
}

TEST(ViewPointer, TheLastPartOfADragIsSeenBeforeItEnds) {
    Pointer pointer;
    pointer.press(0, 0, kReach);
    EXPECT_TRUE(pointer.next(0).down[0]);
    pointer.moveTo({0, 25});
    pointer.release(0);
    const Pointer::Seen held = pointer.next(1);
    EXPECT_EQ(held.at, (Point2{0, 25}));
    EXPECT_TRUE(held.down[0]);
    EXPECT_FALSE(pointer.next(2).down[0]);
}

TEST(ViewPointer, ADoubleClickIsOneHoweverSlowFramesAre) {
    Pointer pointer;
    click(pointer, {5, 5}, 3);
    click(pointer, {6, 5}, 3); // told of together, after a long frame
    EXPECT_EQ(pointer.next(3).clicks[0], 1);
    EXPECT_FALSE(pointer.next(3.5).down[0]);
    while (pointer.behind()) {
        if (const Pointer::Seen seen = pointer.next(4); seen.clicks[0] != 0) {
            EXPECT_EQ(seen.clicks[0], 2);
            EXPECT_EQ(seen.at, (Point2{6, 5}));
        }
    }
    // A frame that takes a second is between these two.
    click(pointer, {50, 50}, 10);
    static_cast<void>(pointer.next(10));
    static_cast<void>(pointer.next(10));
    click(pointer, {50, 50}, 11);
    EXPECT_EQ(pointer.next(11).clicks[0], 2);
}

TEST(ViewPointer, TwoClicksLaterOrElsewhereAreNoDoubleClick) {
    Pointer pointer;
    const auto clicks = [&pointer](const Point2& at, double seconds) {
        static_cast<void>(pointer.next(seconds - 0.01));
        click(pointer, at, seconds);
        const int seen = pointer.next(seconds).clicks[0];
        while (pointer.behind()) {
            static_cast<void>(pointer.next(seconds));
        }
        return seen;
    };
    EXPECT_EQ(clicks({5, 5}, 1), 1);
    EXPECT_EQ(clicks({5, 5}, 2), 1);
    EXPECT_EQ(clicks({5, 15}, 2.1), 1);
    EXPECT_EQ(clicks({5, 15}, 2.2), 2);
    pointer.press(7, 2.3, kReach); // what nothing here asks for
    EXPECT_FALSE(pointer.behind());
}

} // namespace voxtact::test
