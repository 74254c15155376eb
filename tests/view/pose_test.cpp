// SPDX-License-Identifier: MIT
#include "viewer/model/document/pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace voxtact::test {

using namespace voxtact::view;
using testing::DoubleNear;
using testing::ElementsAre;

namespace {

auto near(double x, double y, double z) {
    return ElementsAre(DoubleNear(x, 1e-12), DoubleNear(y, 1e-12), DoubleNear(z, 1e-12));
}

/// Own x is the world's y, own y the world's -x; twice as large; the tip at 10, 20, 30.
constexpr Mat4 kPose{0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1};

} // namespace

TEST(ViewPose, MovesAlongTheWorldsAxes) {
    EXPECT_THAT(originOf(moved(kPose, {1, 2, 3}, Axes::World)), near(11, 22, 33));
}

TEST(ViewPose, MovesAlongItsOwnAxesInMillimetresWhateverItsScale) {
    EXPECT_THAT(originOf(moved(kPose, {1, 2, 3}, Axes::Own)), near(8, 21, 33));
}

TEST(ViewPose, AMoveChangesNothingButThePlace) {
    Mat4 back = moved(kPose, {1, 2, 3}, Axes::Own);
    back = placedAt(back, {10, 20, 30});
    EXPECT_EQ(back, kPose);
}

TEST(ViewPose, IsPutNoFartherThanMayBe) {
    const double infinite = std::numeric_limits<double>::infinity();
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(originOf(placedAt(kPose, {infinite, -1e39, none})), (Vec3{kFarthestPlace, -kFarthestPlace, 30}));
    EXPECT_EQ(originOf(moved(kPose, {infinite, 0, 0}, Axes::World))[0], kFarthestPlace);
}

TEST(ViewPose, TurnsAboutTheWorldsAxisThroughTheTip) {
    const Mat4 turnedPose = turned(kPose, 2, 90, Axes::World);
    EXPECT_THAT(originOf(turnedPose), near(10, 20, 30));
    // Its own x was the world's y: a quarter turn about z, counter-clockwise from above, makes it -x.
    EXPECT_THAT(axisOf(turnedPose, 0), near(-1, 0, 0));
    EXPECT_THAT(axisOf(turnedPose, 2), near(0, 0, 1));
}

TEST(ViewPose, TurnsAboutItsOwnAxis) {
    // Its own x is the world's y: about it z goes to the world's x.
    const Mat4 turnedPose = turned(kPose, 0, 90, Axes::Own);
    EXPECT_THAT(axisOf(turnedPose, 0), near(0, 1, 0));
    EXPECT_THAT(axisOf(turnedPose, 2), near(1, 0, 0));
}

TEST(ViewPose, ATurnKeepsTheScale) {
    const Mat4 turnedPose = turned(kPose, 1, 33, Axes::Own);
    EXPECT_THAT(transformPoint(turnedPose, {0, 1, 0}), near(8, 20, 30));
}

TEST(ViewPose, FourQuarterTurnsAreNone) {
    Mat4 pose = kPose;
    for (int i = 0; i < 4; ++i) {
        pose = turned(pose, 0, 90, Axes::World);
    }
    for (std::size_t i = 0; i < pose.size(); ++i) {
        EXPECT_NEAR(pose[i], kPose[i], 1e-12);
    }
}

TEST(ViewPose, TellsItsAngles) {
    EXPECT_THAT(anglesOf(kPose), near(0, 0, 90));
    EXPECT_THAT(anglesOf(turned(identity(), 0, 25, Axes::World)), near(25, 0, 0));
    EXPECT_THAT(anglesOf(turned(identity(), 1, -40, Axes::World)), near(0, -40, 0));
}

TEST(ViewPose, IsTurnedToAnglesAboutXThenYThenZ) {
    Mat4 expected = identity();
    for (const auto& [axis, degrees] : {std::pair(0, 20.0), std::pair(1, -35.0), std::pair(2, 110.0)}) {
        expected = turned(expected, static_cast<std::size_t>(axis), degrees, Axes::World);
    }
    expected = placedAt(expected, {10, 20, 30});
    const Mat4 pose = turnedTo(turned(translation({10, 20, 30}), 1, 77, Axes::World), {20, -35, 110});
    for (std::size_t i = 0; i < pose.size(); ++i) {
        EXPECT_NEAR(pose[i], expected[i], 1e-12) << i;
    }
}

TEST(ViewPose, HasTheAnglesThatItWasTurnedToWhateverItsShape) {
    Mat4 mirrored = kPose;
    mirrored[2 * 4 + 2] = -2;
    Mat4 sheared = kPose;
    sheared[4] = 1;
    for (const Mat4& shape : {identity(), kPose, mirrored, sheared}) {
        const Mat4 pose = turnedTo(shape, {-120, 60, 15});
        EXPECT_THAT(anglesOf(pose), near(-120, 60, 15));
        EXPECT_EQ(originOf(pose), originOf(shape));
        // The same shape: back again it is what it was.
        const Mat4 back = turnedTo(pose, anglesOf(shape));
        for (std::size_t i = 0; i < back.size(); ++i) {
            EXPECT_NEAR(back[i], shape[i], 1e-12) << i;
        }
    }
}

TEST(ViewPose, OfAShapeWithoutRoomTheAnglesAreNumbersStill) {
    const Mat4 line{1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 1};
    const Mat4 other{0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 1, 2, 3, 1};
    EXPECT_THAT(anglesOf(line), near(0, 0, 0));
    EXPECT_THAT(anglesOf(other), near(0, 0, 90));
}

TEST(ViewPose, WhereXGoesAlongTheWorldsZTheAnglesMakeThePoseTheSame) {
    for (const double y : {90.0, -90.0}) {
        const Mat4 pose = turnedTo(identity(), {25, y, 40});
        const Vec3 angles = anglesOf(pose);
        EXPECT_THAT(angles, near(y > 0 ? -15 : 65, y, 0));
        const Mat4 again = turnedTo(identity(), angles);
        for (std::size_t i = 0; i < again.size(); ++i) {
            EXPECT_NEAR(again[i], pose[i], 1e-12) << i;
        }
    }
}

TEST(ViewPose, AnglesThatWereTypedAreThoseOfTheirPose) {
    const Mat4 pose = turnedTo(kPose, {10, 100, 350});
    const TypedAngles typed{pose, {10, 100, 350}};
    EXPECT_EQ(anglesOf(pose, typed), (Vec3{10, 100, 350}));
    EXPECT_THAT(anglesOf(pose, std::nullopt), near(-170, 80, 170));
    EXPECT_THAT(anglesOf(kPose, typed), near(0, 0, 90));
}

TEST(ViewPose, AnAngleThatIsNotFiniteStays) {
    const double infinite = std::numeric_limits<double>::infinity();
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(anglesOf(turnedTo(kPose, {infinite, 30, none})), near(0, 30, 90));
}

TEST(ViewPose, AnAxisWithoutLengthIsTheWorlds) {
    EXPECT_THAT(axisOf(Mat4{}, 1), near(0, 1, 0));
}

} // namespace voxtact::test
