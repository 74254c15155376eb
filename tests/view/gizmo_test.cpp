// SPDX-License-Identifier: MIT
#include "view/model/gizmo.h"
#include "view/model/pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

constexpr Vec3 kCentre{10, 20, 30};

/// 10 mm large, along the world's axes.
Gizmo gizmo() {
    return gizmoOf(translation(kCentre), false, 10 / kGizmoPixels);
}

/// From the front: the eye looks along +y.
Ray front(double x, double z) {
    return {{x, -500, z}, {0, 1, 0}};
}

/// From above: the eye looks along -z.
Ray above(double x, double y) {
    return {{x, y, 500}, {0, 0, -1}};
}

void expectNear(const Vec3& a, const Vec3& b, double within = 1e-9) {
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(a[i], b[i], within) << i;
    }
}

} // namespace

TEST(ViewGizmo, HasAsManyPixelsWhateverTheZoom) {
    EXPECT_DOUBLE_EQ(gizmoOf(identity(), false, 0.5).size, kGizmoPixels / 2);
    expectNear(gizmo().centre, kCentre);
    expectNear(tipOf(gizmo(), 2), {10, 20, 40});
    for (const Vec3& corner : ringOf(gizmo(), 0)) {
        EXPECT_NEAR(corner[0], 10, 1e-9);
        EXPECT_NEAR(std::hypot(corner[1] - 20, corner[2] - 30), 10, 1e-9);
    }
}

TEST(ViewGizmo, ItsOwnAxesTurnWithTheObject) {
    const Mat4 pose = turned(translation(kCentre), 2, 90, Axes::World);
    expectNear(gizmoOf(pose, true, 1).axes[0], {0, 1, 0});
    expectNear(gizmoOf(pose, false, 1).axes[0], {1, 0, 0});
}

TEST(ViewGizmo, TheHandleUnderTheRayIsTaken) {
    EXPECT_EQ(partUnder(gizmo(), front(17, 30.4), 0.5), (GizmoPart{Handle::Arrow, 0}));
    EXPECT_EQ(partUnder(gizmo(), front(10.3, 36), 0.5), (GizmoPart{Handle::Arrow, 2}));
    EXPECT_EQ(partUnder(gizmo(), front(10 + 7.1, 30 + 7.1), 0.5), (GizmoPart{Handle::Ring, 1}));
    EXPECT_EQ(partUnder(gizmo(), above(10 - 7.1, 20 + 7.1), 0.5), (GizmoPart{Handle::Ring, 2}));
    EXPECT_EQ(partUnder(gizmo(), front(10, 30), 0.5), std::nullopt) << "all arrows begin there";
    EXPECT_EQ(partUnder(gizmo(), front(14, 35), 0.5), std::nullopt);
    EXPECT_EQ(partUnder(gizmo(), front(17, 31), 0.5), std::nullopt);
    EXPECT_EQ(partUnder(gizmo(), front(17, 31), 1.5), (GizmoPart{Handle::Arrow, 0}));
}

TEST(ViewGizmo, WhatIsSeenFromItsEndOrSideIsNotTaken) {
    EXPECT_FALSE(isUsable(gizmo(), {Handle::Arrow, 1}, front(0, 0)));
    EXPECT_TRUE(isUsable(gizmo(), {Handle::Arrow, 0}, front(0, 0)));
    EXPECT_TRUE(isUsable(gizmo(), {Handle::Ring, 1}, front(0, 0)));
    EXPECT_FALSE(isUsable(gizmo(), {Handle::Ring, 0}, front(0, 0)));
    // Left of the centre there is no arrow, and the rings there are seen from their sides.
    EXPECT_EQ(partUnder(gizmo(), front(4, 30), 0.5), std::nullopt);
}

TEST(ViewGizmo, AnArrowMovesAlongItsAxisAlone) {
    const GizmoDrag drag{gizmo(), {Handle::Arrow, 0}, translation(kCentre), front(15, 30)};
    expectNear(originOf(dragged(drag, front(22, 33))), {17, 20, 30});
    EXPECT_EQ(dragged(drag, drag.from), drag.pose);
}

TEST(ViewGizmo, ARingTurnsByTheAngleRoundTheTip) {
    const GizmoDrag drag{gizmo(), {Handle::Ring, 2}, translation(kCentre), above(20, 20)};
    const Mat4 quarter = dragged(drag, above(10, 55)); // however far out
    expectNear(axisOf(quarter, 0), {0, 1, 0});
    expectNear(axisOf(quarter, 2), {0, 0, 1});
    expectNear(originOf(quarter), kCentre);
    expectNear(axisOf(dragged(drag, above(10, -15)), 0), {0, -1, 0});
}

TEST(ViewGizmo, ARayThroughAPixelIsWhatThePictureShowsThere) {
    const std::uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const Extent extent{640, 480};
    for (int i = 0; i < 200; ++i) {
        const Camera camera{{50 * any(random), 50 * any(random), 50 * any(random)},
                            {180 * any(random), 90 * any(random)},
                            100 + 90 * any(random)};
        const Point2 pixel{320 + 320 * any(random), 240 + 240 * any(random)};
        const Ray ray = rayThrough(camera, extent, pixel);
        const Mat4 clip = clipFromWorld(camera, extent, 1000);
        const double far = 100 * any(random);
        Vec3 on{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            on[axis] = ray.origin[axis] + far * ray.direction[axis];
        }
        const Vec3 seen = transformPoint(clip, on);
        EXPECT_NEAR((seen[0] + 1) / 2 * extent.width, pixel[0], 1e-6);
        EXPECT_NEAR((seen[1] + 1) / 2 * extent.height, pixel[1], 1e-6);
        const double deeper = transformPoint(clip, ray.origin)[2] - seen[2];
        EXPECT_EQ(far > 0, deeper < 0) << "away from the eye is deeper";
    }
}

TEST(ViewGizmo, DraggingKeepsTheHandleUnderTheMouse) {
    const std::uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const Extent extent{640, 480};
    for (int i = 0; i < 200; ++i) {
        const Camera camera{kCentre, {180 * any(random), 90 * any(random)}, 60};
        const auto axis = static_cast<std::size_t>(i % 3);
        const Ray from = rayThrough(camera, extent, {320, 240});
        if (!isUsable(gizmo(), {Handle::Arrow, axis}, from)) {
            continue;
        }
        const GizmoDrag drag{gizmo(), {Handle::Arrow, axis}, translation(kCentre), from};
        // To where a point of the axis is seen.
        const double mm = 30 * any(random);
        Vec3 to = kCentre;
        to[axis] += mm;
        const Vec3 clip = transformPoint(clipFromWorld(camera, extent, 1000), to);
        const Ray there =
            rayThrough(camera, extent, {(clip[0] + 1) / 2 * extent.width, (clip[1] + 1) / 2 * extent.height});
        expectNear(originOf(dragged(drag, there)), to, 1e-6);
    }
}

} // namespace voxtact::test
