// SPDX-License-Identifier: MIT
#include "viewer/model/shown/camera.h"
#include "viewer/model/shown/pace.h"
#include "viewer/model/shown/slice.h"

#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

constexpr Extent kExtent{640, 480};
constexpr double kDepth = 500;

Camera camera() {
    return {{10, -20, 30}, {35, 20}, 80};
}

/// The pixel of a world point.
std::array<double, 2> pixelOf(const Camera& camera, const Vec3& world) {
    const Vec3 clip = transformPoint(clipFromWorld(camera, kExtent, kDepth), world);
    return {(clip[0] + 1) / 2 * kExtent.width, (clip[1] + 1) / 2 * kExtent.height};
}

Grid grid() {
    Grid out;
    out.size = {40, 50, 60};
    out.spacing = {2, 1, 1.5};
    out.origin = {-30, 5, 12};
    return out;
}

} // namespace

TEST(ViewCamera, TheTargetIsInTheMiddleAtHalfDepth) {
    const Vec3 clip = transformPoint(clipFromWorld(camera(), kExtent, kDepth), camera().target);
    EXPECT_NEAR(clip[0], 0, 1e-12);
    EXPECT_NEAR(clip[1], 0, 1e-12);
    EXPECT_NEAR(clip[2], 0.5, 1e-12);
}

TEST(ViewCamera, APixelIsAsLongInBothDirections) {
    Camera front = camera();
    front.direction = {0, 0}; // before the face: the patient's left is to the right
    const double mm = millimetresOfPixel(front, kExtent);
    const auto middle = pixelOf(front, front.target);
    const auto left = pixelOf(front, {front.target[0] + 10 * mm, front.target[1], front.target[2]});
    const auto up = pixelOf(front, {front.target[0], front.target[1], front.target[2] + 10 * mm});
    EXPECT_NEAR(left[0] - middle[0], 10, 1e-9);
    EXPECT_NEAR(up[1] - middle[1], -10, 1e-9);
}

TEST(ViewCamera, APanKeepsWhatIsUnderThePointer) {
    Camera moved = camera();
    const Vec3 point{17, 3, -8};
    const auto before = pixelOf(moved, point);
    pan(moved, 25, -13, kExtent);
    const auto after = pixelOf(moved, point);
    EXPECT_NEAR(after[0] - before[0], 25, 1e-9);
    EXPECT_NEAR(after[1] - before[1], -13, 1e-9);
}

TEST(ViewCamera, AZoomKeepsWhatIsUnderThePointer) {
    Camera zoomed = camera();
    const Vec3 point{17, 3, -8};
    const auto before = pixelOf(zoomed, point);
    zoom(zoomed, 0.5, before[0], before[1], kExtent);
    const auto after = pixelOf(zoomed, point);
    EXPECT_NEAR(after[0], before[0], 1e-9);
    EXPECT_NEAR(after[1], before[1], 1e-9);
    EXPECT_DOUBLE_EQ(zoomed.halfHeight, 40);
}

TEST(ViewCamera, ATurnStopsAboveAndBelow) {
    Camera turned = camera();
    orbit(turned, 0, 1e6, kExtent);
    EXPECT_EQ(turned.direction.elevation, 90);
    orbit(turned, 480, -1e6, kExtent);
    EXPECT_EQ(turned.direction.elevation, -90);
    EXPECT_NEAR(turned.direction.azimuth, 35 - 180, 1e-9);
}

TEST(ViewCamera, BarsAreOneTwoOrFive) {
    EXPECT_DOUBLE_EQ(barLength(73), 50);
    EXPECT_DOUBLE_EQ(barLength(49), 20);
    EXPECT_DOUBLE_EQ(barLength(1.5), 1);
    EXPECT_DOUBLE_EQ(barLength(0), 0);
}

TEST(ViewPace, PicturesFitTheBudget) {
    Pace pace(50);
    pace.tookCoarse(100000, 200);
    const Extent small = pace.coarse({1000, 500});
    EXPECT_LE(small.width * small.height * 200.0 / 100000, 50);
    EXPECT_GE(small.width, 1000U / 12);
    EXPECT_NEAR(static_cast<double>(small.width) / small.height, 2, 0.1);
    // A fast device is believed when it was fast some times.
    for (int i = 0; i < 20; ++i) {
        pace.tookCoarse(100000, 0.1);
    }
    EXPECT_EQ(pace.coarse({1000, 500}).width, 1000U);
}

TEST(ViewPace, ThereIsAlwaysARow) {
    Pace pace(10);
    pace.tookFine(1, 1e9);
    EXPECT_EQ(pace.rows({1000, 500}), 1U);
    for (int i = 0; i < 60; ++i) {
        pace.tookFine(1e9, 0);
    }
    EXPECT_EQ(pace.rows({1000, 500}), 500U);
}

TEST(ViewSlice, ItsPointsAreInItsPlaneAndComeBack) {
    const Vec3 cursor{3, 21, 44};
    for (const SliceKind& kind : kSlices) {
        const SlicePlace place = slicePlace(kind, grid(), cursor, {300, 200});
        const Vec3 world = worldAt(place, {0.3, 0.6});
        EXPECT_DOUBLE_EQ(world[kind.axis], cursor[kind.axis]) << kind.name;
        const Point2 back = pictureAt(place, world);
        EXPECT_NEAR(back[0], 0.3, 1e-9) << kind.name;
        EXPECT_NEAR(back[1], 0.6, 1e-9) << kind.name;
    }
}

TEST(ViewSlice, LettersAreWhereThePatientsSidesAre) {
    const std::array<std::pair<const char*, Vec3>, 6> sides{{{"L", {1, 0, 0}},
                                                             {"R", {-1, 0, 0}},
                                                             {"P", {0, 1, 0}},
                                                             {"A", {0, -1, 0}},
                                                             {"S", {0, 0, 1}},
                                                             {"I", {0, 0, -1}}}};
    const Vec3 cursor{3, 21, 44};
    for (const SliceKind& kind : kSlices) {
        const SlicePlace place = slicePlace(kind, grid(), cursor, {300, 300});
        const Point2 middle = pictureAt(place, cursor);
        for (const auto& [letter, way] : sides) {
            const Point2 at = pictureAt(place, {cursor[0] + way[0], cursor[1] + way[1], cursor[2] + way[2]});
            const auto is = [&](const char* edge) { return std::string(edge) == letter; };
            EXPECT_EQ(is(kind.right), at[0] > middle[0] + 1e-6) << kind.name << letter;
            EXPECT_EQ(is(kind.left), at[0] < middle[0] - 1e-6) << kind.name << letter;
            EXPECT_EQ(is(kind.bottom), at[1] > middle[1] + 1e-6) << kind.name << letter;
            EXPECT_EQ(is(kind.top), at[1] < middle[1] - 1e-6) << kind.name << letter;
        }
    }
}

TEST(ViewSlice, TheOutlineOfAnEllipsoidIsAnEllipse) {
    const auto mesh = makeEllipsoid(2000);
    ASSERT_TRUE(mesh.ok());
    const SlicePlace place = slicePlace(kSlices[0], grid(), {0, 0, 40}, {300, 300});
    const auto pieces = outline(mesh->view(), translation({5, 25, 40}), 2, 40, place);
    ASSERT_GT(pieces.size(), 20U);
    for (const OutlinePiece& piece : pieces) {
        const Vec3 world = worldAt(place, piece.from);
        const double x = (world[0] - 5) / 20;
        const double y = (world[1] - 25) / 30;
        EXPECT_NEAR(std::hypot(x, y), 1, 0.02); // half axes 20 and 30
    }
    EXPECT_TRUE(outline(mesh->view(), translation({5, 25, 90}), 2, 40, place).empty());
}

TEST(ViewSlice, SmallVoxelsHaveMoreDecimals) {
    Grid grid;
    const auto text = [&grid](double voxel, double mm) {
        grid.spacing = {1, voxel, 1};
        return mmText(grid, 1, mm);
    };
    EXPECT_EQ(text(1, 12.34), "12.3");
    EXPECT_EQ(text(0.1, 12.34), "12.3");
    EXPECT_EQ(text(0.05, 12.34), "12.34");
    EXPECT_EQ(text(0.001, -0.0052), "-0.005");
    EXPECT_EQ(text(1, -0.04), "0.0") << "zero has no sign";
    EXPECT_EQ(decimalsOn(grid, 2), 2);
}

TEST(ViewPace, OnlyWhatWasDrawnIsSampled) {
    const Extent texture{900, 400};
    for (const Extent& picture : {Extent{1, 1}, Extent{75, 33}, Extent{451, 199}, texture}) {
        const SampledPart part = sampledPart(picture, texture);
        // A linear sample reads the texels whose middles lie round it.
        const auto last = [](float at, float size) { return std::ceil(at * size - 0.5F - 1e-3F); };
        for (const float share : {0.25F, 0.99F, 1.0F}) {
            const float x = std::min(share * part.used[0], part.most[0]);
            const float y = std::min(share * part.used[1], part.most[1]);
            EXPECT_LT(last(x, 900), static_cast<float>(picture.width) - 0.01F) << picture.width << ' ' << share;
            EXPECT_LT(last(y, 400), static_cast<float>(picture.height) - 0.01F) << picture.height << ' ' << share;
        }
        EXPECT_NEAR(part.used[0] * 900, picture.width, 1e-3) << "it is as large as it was drawn";
    }
}

} // namespace voxtact::test
