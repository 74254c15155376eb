// SPDX-License-Identifier: MIT
// Colours and views are data: none of this needs a device.
#include "support/special.h"
#include "voxtact/looks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxtact {
namespace {

using test::kInfinity;
using test::kNan;
using testing::HasSubstr;

constexpr const char* kSides[] = {"front", "back", "left", "right", "top", "bottom"};

/// Anisotropic, and turned about z.
Grid obliqueGrid() {
    const double c = std::cos(0.3);
    const double s = std::sin(0.3);
    Grid grid;
    grid.size = {20, 30, 8};
    grid.spacing = {1, 0.7, 4};
    grid.origin = {-30, 12, 100};
    grid.direction = {c, s, 0, -s, c, 0, 0, 0, 1};
    return grid;
}

/// The box around the volume in pixels from the picture's left upper corner, and in depth.
struct Seen {
    Vec3 lo{kInfinity, kInfinity, kInfinity};
    Vec3 hi{-kInfinity, -kInfinity, -kInfinity};
};
Seen seenOf(const Mat4& clip_from_world, const Grid& grid, double width, double height) {
    Seen seen;
    const Mat4 world_from_texture = worldFromTexture(grid);
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 corner{static_cast<double>(i & 1U), static_cast<double>(i >> 1U & 1U), static_cast<double>(i >> 2U)};
        const Vec3 clip = transformPoint(clip_from_world, transformPoint(world_from_texture, corner));
        const Vec3 pixel{(clip[0] + 1) / 2 * width, (clip[1] + 1) / 2 * height, clip[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            seen.lo[axis] = std::min(seen.lo[axis], pixel[axis]);
            seen.hi[axis] = std::max(seen.hi[axis], pixel[axis]);
        }
    }
    return seen;
}

TEST(LooksTest, EveryPresetIsALook) {
    ASSERT_FALSE(lookPresets().empty());
    for (const LookPreset& preset : lookPresets()) {
        EXPECT_EQ(findLookPreset(preset.name), &preset);
        const Result<Look> look = lookNamed(preset.name, {-50, 150});
        ASSERT_TRUE(look.ok()) << preset.name;
        ASSERT_GE(look->opacity.size(), 2U) << preset.name;
        const auto ascends = [](const auto& a, const auto& b) { return a.value < b.value; };
        EXPECT_TRUE(std::ranges::is_sorted(look->opacity, ascends)) << preset.name;
        EXPECT_TRUE(std::ranges::is_sorted(look->colours, ascends)) << preset.name;
        for (const ControlPoint& point : look->opacity) {
            EXPECT_TRUE(point.opacity >= 0 && point.opacity <= 1) << preset.name;
            EXPECT_TRUE(preset.hounsfield || (point.value >= -50 && point.value <= 150)) << preset.name;
        }
    }
}

TEST(LooksTest, FractionsGoByTheImagesValues) {
    const Look unit = *lookNamed("mr", {0, 1});
    const Look image = *lookNamed("mr", {100, 300});
    ASSERT_EQ(image.opacity.size(), unit.opacity.size());
    for (std::size_t i = 0; i < unit.opacity.size(); ++i) {
        EXPECT_DOUBLE_EQ(image.opacity[i].value, 100 + 200 * unit.opacity[i].value);
        EXPECT_EQ(image.opacity[i].opacity, unit.opacity[i].opacity);
    }
    EXPECT_EQ(lookNamed("ct-bone", {0, 1})->opacity[0].value, lookNamed("ct-bone", {kNan, 1})->opacity[0].value)
        << "Hounsfield units are what they are";
}

TEST(LooksTest, RefusesByName) {
    const Result<Look> unknown = lookNamed("mr-bone", {0, 1});
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(unknown.error().text, testing::AllOf(HasSubstr("\"mr-bone\""), HasSubstr("mr-brain")));
    EXPECT_EQ(findLookPreset("mr-bone"), nullptr);
    for (const ValueRange& values :
         {ValueRange{kNan, 1}, ValueRange{0, kNan}, ValueRange{0, kInfinity}, ValueRange{2, 1}}) {
        const Result<Look> look = lookNamed("mr", values);
        ASSERT_FALSE(look.ok()) << values.lo << " " << values.hi;
        EXPECT_THAT(look.error().text, HasSubstr("range"));
    }
}

TEST(ViewTest, EyesAreWhereTheyAreNamed) {
    // LPS: +x is the patient's left, +y the back, +z the head.
    const std::pair<const char*, Vec3> eyes[] = {{"front", {0, -1, 0}}, {"back", {0, 1, 0}}, {"left", {1, 0, 0}},
                                                 {"right", {-1, 0, 0}}, {"top", {0, 0, 1}},  {"bottom", {0, 0, -1}}};
    for (const auto& [name, expected] : eyes) {
        const Vec3 eye = towardsEye(*directionNamed(name));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(eye[axis], expected[axis], 1e-12) << name;
        }
    }
    EXPECT_FALSE(directionNamed("behind").has_value());
}

TEST(ViewTest, FramesTheVolumeWithSquarePixels) {
    constexpr std::uint32_t kWidth = 320;
    constexpr std::uint32_t kHeight = 200;
    const Grid grid = obliqueGrid();
    for (const char* side : kSides) {
        const Mat4 clip_from_world = viewFrom(*directionNamed(side), grid, std::nullopt, kWidth, kHeight);
        const Seen seen = seenOf(clip_from_world, grid, kWidth, kHeight);
        EXPECT_GE(seen.lo[0], 0) << side;
        EXPECT_LE(seen.hi[0], kWidth) << side;
        EXPECT_GE(seen.lo[1], 0) << side;
        EXPECT_LE(seen.hi[1], kHeight) << side;
        EXPECT_GT(seen.lo[2], 0) << side;
        EXPECT_LT(seen.hi[2], 1) << side;
        EXPECT_NEAR(seen.lo[0] + seen.hi[0], kWidth, 1e-6) << side << ": it is in the middle";
        EXPECT_NEAR(seen.lo[1] + seen.hi[1], kHeight, 1e-6) << side;
        EXPECT_GT(std::max((seen.hi[0] - seen.lo[0]) / kWidth, (seen.hi[1] - seen.lo[1]) / kHeight), 0.95) << side;
        const auto lengthOfRow = [&](std::size_t row) {
            return std::hypot(clip_from_world[row], clip_from_world[4 + row], clip_from_world[8 + row]);
        };
        EXPECT_NEAR(lengthOfRow(0) * kWidth, lengthOfRow(1) * kHeight, 1e-9) << side << ": pixels are square";
    }
}

TEST(ViewTest, KeepsToItsPartOfThePicture) {
    const Grid grid = obliqueGrid();
    const ViewFrame frame{100, 20, 300, 180};
    for (const char* side : kSides) {
        const Seen seen = seenOf(viewFrom(*directionNamed(side), grid, std::nullopt, 320, 200, frame), grid, 320, 200);
        EXPECT_GE(seen.lo[0], frame.left) << side;
        EXPECT_LE(seen.hi[0], frame.right) << side;
        EXPECT_GE(seen.lo[1], frame.top) << side;
        EXPECT_LE(seen.hi[1], frame.bottom) << side;
    }
}

TEST(ViewTest, PlanesAreBeyondWhatElseIsThere) {
    const Grid grid = obliqueGrid();
    const Box also{{-500, -400, -300}, {400, 500, 600}};
    for (const char* side : kSides) {
        const Mat4 clip_from_world = viewFrom(*directionNamed(side), grid, also, 320, 200);
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 corner{(i & 1U) != 0 ? also.hi[0] : also.lo[0], (i & 2U) != 0 ? also.hi[1] : also.lo[1],
                              (i & 4U) != 0 ? also.hi[2] : also.lo[2]};
            const double depth = transformPoint(clip_from_world, corner)[2];
            EXPECT_TRUE(depth > 0 && depth < 1) << side << " " << depth;
        }
        const Seen alone = seenOf(viewFrom(*directionNamed(side), grid, std::nullopt, 320, 200), grid, 320, 200);
        const Seen seen = seenOf(clip_from_world, grid, 320, 200);
        EXPECT_NEAR(seen.lo[0], alone.lo[0], 1e-6) << side << ": only the depth is another";
    }
}

} // namespace
} // namespace voxtact
