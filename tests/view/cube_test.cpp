// SPDX-License-Identifier: MIT
#include "shown_panels.h"
#include "viewer/model/shown/view_cube.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

Camera lookingFrom(double azimuth, double elevation) {
    Camera camera;
    camera.direction = {azimuth, elevation};
    return camera;
}

/// Middles of the sides that the camera sees, in points of the window.
std::map<std::string, std::array<double, 2>> middles(const ViewCube& cube, const Camera& camera) {
    std::map<std::string, std::array<double, 2>> out;
    for (const SeenSide& side : seenSides(camera)) {
        out[kPatientSides[side.side].letter] = {cube.middle[0] + cube.half * side.middle[0],
                                                cube.middle[1] + cube.half * side.middle[1]};
    }
    return out;
}

std::string letterAt(const ViewCube& cube, const Camera& camera, const std::array<double, 2>& at) {
    const std::optional<std::size_t> side = sideAt(cube, camera, at);
    return side ? kPatientSides[*side].letter : "";
}

} // namespace

TEST(ViewCube, FromASideOneFaceIsSeenAndItsLetterStandsUpright) {
    for (const PatientSide& side : kPatientSides) {
        Camera camera;
        camera.direction = directionNamed(side.view).value();
        const std::vector<SeenSide> seen = seenSides(camera);
        ASSERT_EQ(seen.size(), 1U) << side.letter;
        EXPECT_STREQ(kPatientSides[seen[0].side].letter, side.letter);
        EXPECT_NEAR(seen[0].facing, 1, 1e-12);
        EXPECT_NEAR(seen[0].up[1], -1, 1e-12) << side.letter; // down is positive
        EXPECT_NEAR(seen[0].right[0], 1, 1e-12) << side.letter;
    }
}

TEST(ViewCube, TurnsWithTheCamera) {
    // From the front, from a little to the patient's left and above: his left is on the picture's right.
    const Camera camera = lookingFrom(30, 20);
    const ViewCube cube{{500, 100}, 20};
    const auto at = middles(cube, camera);
    ASSERT_EQ(at.size(), 3U);
    // Of the azimuth a to the right, sin(a); above, the sine of the elevation of what is turned to the eye.
    const double right = std::sin(30 * std::numbers::pi / 180);
    const double below = std::cos(30 * std::numbers::pi / 180) * std::sin(20 * std::numbers::pi / 180);
    EXPECT_NEAR(at.at("A")[0], 500 - 20 * right, 1e-9);
    EXPECT_NEAR(at.at("A")[1], 100 + 20 * below, 1e-9);
    EXPECT_GT(at.at("L")[0], 500);
    EXPECT_LT(at.at("S")[1], 100);
}

TEST(ViewCube, APointOfTheWindowIsOnOneOfItsSidesOrBeside) {
    const Camera camera = lookingFrom(30, 20);
    const ViewCube cube{{500, 100}, 20};
    for (const auto& [letter, at] : middles(cube, camera)) {
        EXPECT_EQ(letterAt(cube, camera, at), letter);
    }
    EXPECT_EQ(letterAt(cube, camera, {500, 100 - 20 * 1.8}), "");
    EXPECT_EQ(letterAt(cube, camera, {500 + 20 * 1.8, 100}), "");
    // From the front it is a square.
    EXPECT_EQ(letterAt(cube, lookingFrom(0, 0), {519, 119}), "A");
    EXPECT_EQ(letterAt(cube, lookingFrom(0, 0), {521, 100}), "");
}

TEST(ViewCube, IsInTheCornerOfAPictureThatHasRoom) {
    const auto cube = cubeIn({100, 50}, {800, 500}, 15);
    ASSERT_TRUE(cube);
    const double reach = cube->half * kCubeReach;
    EXPECT_LT(cube->middle[0] + reach, 900);
    EXPECT_GT(cube->middle[0] + reach, 880);
    EXPECT_GT(cube->middle[1] - reach, 50);
    EXPECT_FALSE(cubeIn({100, 50}, {800, 100}, 15));
}

TEST(ViewCube, AClickLooksAtASideAndADragTurns) {
    for (const float scale : {1.0F, 2.0F}) {
        State state = smallState();
        ShownPanels panels(state, scale);
        ASSERT_TRUE(state.cube);
        state.camera.direction = {30, 20};
        panels.frame();
        const auto at = middles(*state.cube, state.camera).at("S");
        const double height = state.camera.halfHeight;
        panels.moveTo(at[0], at[1]);
        ASSERT_TRUE(state.cubeSide);
        EXPECT_STREQ(kPatientSides[*state.cubeSide].letter, "S");
        panels.click(at[0], at[1]);
        EXPECT_EQ(state.camera.direction.elevation, 90);
        EXPECT_EQ(state.camera.halfHeight, height);
        EXPECT_EQ(state.maximised, Maximised::None);
        // From it, half the picture's height is a quarter of a turn.
        state.camera.direction = {0, 0};
        panels.drag(state.cube->middle[0], state.cube->middle[1], state.picture.size[1] / 2, 0);
        EXPECT_NEAR(state.camera.direction.azimuth, -90, 1);
        EXPECT_FALSE(state.cubePressed);
    }
}

TEST(ViewCube, TwoClicksOnItAreNoDoubleClickOfThePicture) {
    State state = smallState();
    ShownPanels panels(state);
    panels.click(state.cube->middle[0], state.cube->middle[1]);
    panels.click(state.cube->middle[0], state.cube->middle[1]);
    EXPECT_EQ(state.maximised, Maximised::None);
    const double x = state.picture.corner[0] + 40;
    const double y = state.picture.corner[1] + state.picture.size[1] - 40;
    panels.click(x, y);
    panels.click(x, y);
    EXPECT_EQ(state.maximised, Maximised::Picture);
}

TEST(ViewCube, IsAsLargeAsTheDisplaysPoints) {
    double half = 0;
    for (const float scale : {1.0F, 2.0F}) {
        State state = smallState();
        const ShownPanels panels(state, scale);
        ASSERT_TRUE(state.cube);
        EXPECT_NEAR(state.cube->half, scale == 1 ? state.cube->half : 2 * half, 0.5);
        half = state.cube->half;
        EXPECT_LT(state.cube->middle[0], state.picture.corner[0] + state.picture.size[0]);
    }
    EXPECT_GT(half, 30);
}

} // namespace voxtact::test
