// SPDX-License-Identifier: MIT
#include "viewer/model/shown/gizmo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

constexpr Extent kWindow{400, 200};

/// At (10, 0, 0), with arrows of 10 mm along the world's axes.
Gizmo gizmo() {
    return gizmoOf(translation({10, 0, 0}), {}, GizmoAxes::World, 10);
}

/// From above, through a place of the plane z = 0.
Ray down(double x, double y) {
    return {{x, y, 100}, {0, 0, -1}};
}

void expectNear(const Mat4& found, const Mat4& expected) {
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
    }
}

} // namespace

TEST(ViewGizmo, ARayGoesThroughWhatIsInItsPixel) {
    const Camera camera{{1, 2, 3}, {30, -20}, 50};
    const Ray ray = rayThrough(camera, kWindow, 300, 20);
    for (const double far : {0.0, 70.0}) {
        Vec3 point = ray.origin;
        for (std::size_t i = 0; i < 3; ++i) {
            point[i] += far * ray.direction[i];
        }
        const Vec3 clip = transformPoint(clipFromWorld(camera, kWindow, 1000), point);
        EXPECT_NEAR(clip[0], 0.5, 1e-12);
        EXPECT_NEAR(clip[1], -0.8, 1e-12);
        EXPECT_NEAR(clip[2], 0.5 + far / 2000, 1e-12); // farther into the picture
    }
}

TEST(ViewGizmo, ARayTakesTheHandleThatItPasses) {
    EXPECT_EQ(handleAt(gizmo(), down(15, 0.3), 0.5), (Handle{HandleKind::Arrow, 0}));
    EXPECT_EQ(handleAt(gizmo(), down(10.3, 9), 0.5), (Handle{HandleKind::Arrow, 1}));
    EXPECT_EQ(handleAt(gizmo(), down(14, 4), 0.5), (Handle{HandleKind::Square, 2}));
    const double ring = kRingRadius * 10 / std::sqrt(2.0);
    EXPECT_EQ(handleAt(gizmo(), down(10 + ring, ring), 0.5), (Handle{HandleKind::Ring, 2}));
    EXPECT_EQ(handleAt(gizmo(), down(10 - ring, ring + 0.4), 0.5), (Handle{HandleKind::Ring, 2}));
    EXPECT_EQ(handleAt(gizmo(), down(10 - ring, ring + 1), 0.5), Handle{});
    EXPECT_EQ(handleAt(gizmo(), down(21, 0), 0.5), Handle{});
    // The origin itself belongs to no arrow, and one that points at the eye cannot be dragged.
    EXPECT_EQ(handleAt(gizmo(), down(10, 0), 0.5), Handle{});
}

TEST(ViewGizmo, AnArrowMovesAlongItsAxisAlone) {
    const Mat4 pose = translation({10, 0, 0});
    expectNear(dragged(pose, gizmo(), {HandleKind::Arrow, 0}, down(15, 0), down(18.25, 7), {}),
               translation({13.25, 0, 0}));
    // By a slanting ray: what of the axis was under the first is under the second.
    const double s = std::sqrt(0.5);
    expectNear(
        dragged(pose, gizmo(), {HandleKind::Arrow, 0}, {{15, -50, 50}, {0, s, -s}}, {{12, -50, 50}, {0, s, -s}}, {}),
        translation({7, 0, 0}));
    expectNear(dragged(pose, gizmo(), {HandleKind::Arrow, 0}, down(15, 0), down(18.25, 7), {2, 0}),
               translation({14, 0, 0}));
    // Towards the eye: it stays.
    expectNear(dragged(pose, gizmo(), {HandleKind::Arrow, 2}, down(15, 0), down(18, 7), {}), pose);
}

TEST(ViewGizmo, ASquareMovesInItsPlane) {
    const Mat4 pose = translation({10, 0, 0});
    const Handle square{HandleKind::Square, 2};
    expectNear(dragged(pose, gizmo(), square, down(14, 4), down(11.25, 6.5), {}), translation({7.25, 2.5, 0}));
    expectNear(dragged(pose, gizmo(), square, down(14, 4), down(11.25, 6.4), {1, 0}), translation({7, 2, 0}));
    expectNear(dragged(pose, gizmo(), {HandleKind::Square, 0}, down(14, 4), down(11, 6), {}), pose);
}

TEST(ViewGizmo, ARingTurnsAboutItsAxisAndKeepsTheOrigin) {
    const Mat4 pose = translation({10, 0, 0});
    const Handle ring{HandleKind::Ring, 2};
    expectNear(dragged(pose, gizmo(), ring, down(18, 0), down(10, 3), {}),
               turned(pose, 2, 90, Axes::World));               // how far out it is let go does not matter
    const Ray nearly = down(10 + std::cos(0.7), std::sin(0.7)); // 40.1 degrees
    expectNear(dragged(pose, gizmo(), ring, down(18, 0), nearly, {0, 15}), turned(pose, 2, 45, Axes::World));
    expectNear(dragged(pose, gizmo(), {HandleKind::Ring, 1}, down(18, 0), nearly, {}), pose);
}

TEST(ViewGizmo, AxesAreTheWorldsTheViewsOrItsOwn) {
    const Mat4 pose = turned(translation({1, 2, 3}), 2, 90, Axes::World);
    const Camera camera{{}, {40, 10}, 50};
    EXPECT_EQ(gizmoOf(pose, camera, GizmoAxes::World, 1).axes[0], (Vec3{1, 0, 0}));
    const Gizmo own = gizmoOf(pose, camera, GizmoAxes::Own, 1);
    EXPECT_NEAR(own.axes[0][1], 1, 1e-12);
    EXPECT_NEAR(own.axes[1][0], -1, 1e-12);
    EXPECT_EQ(own.at, (Vec3{1, 2, 3}));
    EXPECT_EQ(gizmoOf(pose, camera, GizmoAxes::View, 1).axes[2], rayThrough(camera, kWindow, 0, 0).direction);
    EXPECT_EQ(nextOf(GizmoAxes::World), GizmoAxes::View);
    EXPECT_EQ(nextOf(GizmoAxes::View), GizmoAxes::Own);
    EXPECT_EQ(nextOf(GizmoAxes::Own), GizmoAxes::World);
}

} // namespace voxtact::test
