// SPDX-License-Identifier: MIT
// Small functions on values: what the C++ interface answers.
#include "both_interfaces.h"
#include "support/scenes.h"
#include "voxtact/voxtact_vulkan.h"

#include <gmock/gmock.h>

#include <cstring>

namespace voxtact::test {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

Grid obliqueGrid() {
    Grid grid;
    grid.size = {9, 7, 5};
    grid.spacing = {0.5, 0.75, 2};
    grid.origin = {-10, 20, 3};
    grid.direction = {0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1};
    return grid;
}

TEST(CValues, MatricesAndPoints) {
    std::mt19937_64 random(11);
    const Mat4 a = randomMotion(random);
    const Mat4 b = randomMotion(random);
    Mat4 out{};
    need(vxt_multiply(a.data(), b.data(), out.data()));
    EXPECT_THAT(out, ElementsAreArray(multiply(a, b)));
    out = b;
    need(vxt_multiply(a.data(), out.data(), out.data()));
    EXPECT_THAT(out, ElementsAreArray(multiply(a, b))) << "into one of the two";
    Vec3 point{1, 2, 3};
    const Vec3 expected = transformPoint(a, point);
    need(vxt_transform_point(a.data(), point.data(), point.data()));
    EXPECT_THAT(point, ElementsAreArray(expected));
    const Grid grid = obliqueGrid();
    const Mat4 camera = framingCamera(grid, 64, 32);
    need(vxt_side_view(camera.data(), out.data()));
    EXPECT_THAT(out, ElementsAreArray(sideView(camera)));
    const vxt_grid given = cGrid(grid);
    need(vxt_texture_from_world(&given, out.data()));
    EXPECT_THAT(out, ElementsAreArray(take(textureFromWorld(grid))));
}

TEST(CValues, Checks) {
    vxt_grid grid = cGrid(obliqueGrid());
    EXPECT_EQ(vxt_check_grid(&grid), VXT_OK);
    grid.spacing[1] = 0;
    EXPECT_EQ(vxt_check_grid(&grid), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("spacing"));
    Mat4 pose = identity();
    EXPECT_EQ(vxt_check_affine(pose.data()), VXT_OK);
    pose[3] = 1;
    EXPECT_EQ(vxt_check_affine(pose.data()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_scalar_type_name(VXT_SCALAR_UINT16), toString(ScalarType::UInt16));
    EXPECT_STREQ(vxt_scalar_type_name(static_cast<vxt_scalar_type>(9)), "unknown");
    for (const Projection projection : projections()) {
        EXPECT_EQ(vxt_projection_uses_view(static_cast<vxt_projection>(projection)) != 0, usesView(projection));
    }
    for (const CountingMethod method : countingMethods()) {
        EXPECT_EQ(vxt_method_exactness(static_cast<vxt_method>(method)), static_cast<vxt_exactness>(exactness(method)));
    }
}

TEST(CValues, ABallsVoxels) {
    const Grid grid = obliqueGrid();
    const vxt_grid given = cGrid(grid);
    const Vec3 centre = transformPoint(worldFromIndex(grid), {4, 3, 2});
    vxt_voxel_box box{};
    need(vxt_ball_voxels(&given, centre.data(), 0.9, &box));
    const VoxelBox expected = take(voxelBounds(Ball{centre, 0.9}, grid));
    EXPECT_THAT(box.first, ElementsAreArray(expected.first));
    EXPECT_THAT(box.size, ElementsAreArray(expected.size));
    EXPECT_GT(box.size[0], 1U);
    EXPECT_EQ(vxt_ball_voxels(&given, centre.data(), -1, &box), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CValues, ATable) {
    const std::vector<ControlPoint> points{{10, 0}, {20, 1}};
    const std::vector<vxt_control_point> given = cPoints(points);
    const vxt_transfer_function_desc desc = cFunction(given, {0, 40}, 32);
    std::vector<float> table(33, -1);
    need(vxt_sample_table(&desc, table.data(), table.size()));
    const std::vector<float> expected = take(sampleTable({points, {0, 40}, 32}));
    EXPECT_THAT(std::span(table).first(32), ElementsAreArray(expected));
    EXPECT_EQ(table[32], -1);
    EXPECT_EQ(vxt_sample_table(&desc, table.data(), 31), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("room for 31 entries, there are 32"));
}

TEST(CValues, WhatIsOpaque) {
    // Entries 132 apart, which pass over a peak.
    const std::vector<ControlPoint> points{{150, 0}, {160, 1}, {170, 0}, {2000, 0}, {20000, 1}};
    const std::vector<vxt_control_point> given = cPoints(points);
    const ValueRange all{-1000, 32767};
    const vxt_transfer_function_desc desc = cFunction(given, all, 256);
    const OpacityFacts expected = take(checkOpacity({points, all, 256}, all, 0.1));
    EXPECT_GT(expected.moved, 100);
    const vxt_range data{all.lo, all.hi};
    vxt_opacity_facts facts{};
    need(vxt_check_opacity(&desc, &data, 0.1, &facts));
    EXPECT_EQ(facts.moved, expected.moved);
    EXPECT_EQ(facts.reaches, 1U);
    EXPECT_EQ(facts.any, 1U);
    const vxt_range below{-1000, -500};
    need(vxt_check_opacity(&desc, &below, 0.1, &facts));
    EXPECT_EQ(facts.reaches, 1U);
    EXPECT_EQ(facts.any, 0U);
    EXPECT_EQ(vxt_check_opacity(&desc, &data, 2, &facts), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CValues, GridsOfLabelsAndVolumes) {
    const Grid grid = obliqueGrid();
    const VolumeData image = makeBytes(grid, [](auto x, auto, auto) { return static_cast<double>(x); });
    const vxt_volume_view view = cVolume(image);
    const auto labels = made(vxt_labels_destroy, vxt_labels_create, &view);
    const auto volume = made(vxt_host_volume_destroy, vxt_host_volume_create, &view);
    const vxt_grid expected = cGrid(grid);
    vxt_grid found{};
    need(vxt_labels_grid(labels.get(), &found));
    EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0);
    found = {};
    need(vxt_host_volume_grid(volume.get(), &found));
    EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0);
}

TEST(CValues, LabelsOnAPartOfAGrid) {
    Grid whole;
    whole.size = {6, 7, 8};
    Grid part;
    part.size = {3, 3, 3};
    part.origin = {1, 2, 3};
    const VolumeData image = makeBytes(part, [](auto x, auto y, auto z) { return 1.0 + x + 3 * y + 9 * z; });
    const vxt_volume_view view = cVolume(image);
    const auto labels = made(vxt_labels_destroy, vxt_labels_create, &view);
    vxt_grid given = cGrid(whole);
    const auto onGrid = made(vxt_labels_destroy, vxt_labels_on_grid, labels.get(), &given);
    vxt_grid found{};
    need(vxt_labels_grid(onGrid.get(), &found));
    EXPECT_EQ(std::memcmp(&found, &given, sizeof found), 0);
    int inside = 0;
    for (int voxel = 0; voxel < 6 * 7 * 8; ++voxel) {
        const double centre[] = {double(voxel % 6), double(voxel / 6 % 7), double(voxel / 42)};
        std::int32_t expected = -1;
        std::int32_t label = -2;
        need(vxt_labels_at(labels.get(), centre, &expected));
        need(vxt_labels_at(onGrid.get(), centre, &label));
        EXPECT_EQ(label, expected) << voxel;
        inside += label > 0 ? 1 : 0;
    }
    EXPECT_EQ(inside, 27);
    given.origin[0] += 0.5;
    vxt_labels* none = nullptr;
    EXPECT_EQ(vxt_labels_on_grid(labels.get(), &given, &none), VXT_ERROR_UNSUPPORTED);
    EXPECT_EQ(none, nullptr);
}

TEST(CValues, AnAnswerOfTheDevice) {
    // By the method compute in the projection certified: many survivors; then none, and fragments undecided.
    constexpr std::uint32_t kHow = 4U | 3U << 8U;
    for (const PairResult& packed :
         {PairResult{5, 1, 7, 2, 3, kHow}, PairResult{0, 0, 7, 2, 3, kHow | 1U << 16U | VOXTACT_HOW_UNDECIDED_BIT}}) {
        const PairAnswer expected = unpack(packed);
        vxt_device_pair given{};
        static_assert(sizeof given == sizeof packed);
        std::memcpy(&given, &packed, sizeof given);
        vxt_pair pair{};
        need(vxt_unpack(&given, &pair));
        EXPECT_EQ(pair.count, packed.countLow == 0 ? 0 : (std::uint64_t{1} << 32U) + 5);
        EXPECT_EQ(pair.pair, 7U);
        EXPECT_EQ(pair.item, 2U);
        EXPECT_EQ(pair.pose, 3U);
        EXPECT_EQ(pair.method, VXT_METHOD_COMPUTE);
        EXPECT_EQ(pair.projection, VXT_PROJECTION_CERTIFIED);
        EXPECT_EQ(pair.exactness, packed.countLow == 0 ? VXT_EXACTNESS_LOWER_BOUND : VXT_EXACTNESS_EXACT);
        EXPECT_EQ(pair.hit != 0, packed.countLow != 0);
        EXPECT_EQ(pair.possible != 0, expected.possible);
    }
}

} // namespace
} // namespace voxtact::test
