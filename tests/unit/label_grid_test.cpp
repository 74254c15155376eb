// SPDX-License-Identifier: MIT
// Label maps on the grid of a volume, or on a part of it.
#include "core/volume/label_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Oblique: index x along (0.6, 0.8, 0), y along (-0.8, 0.6, 0).
Grid volumeGrid() {
    return {{7, 6, 5}, {0.5, 0.75, 2}, {-31.5, 12.25, 1001}, {0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1}};
}

/// The part of the volume's grid from a voxel on, which need not be whole.
Grid partFrom(const Vec3& first, const std::array<std::uint32_t, 3>& size) {
    Grid grid = volumeGrid();
    grid.origin = transformPoint(worldFromIndex(grid), first);
    grid.size = size;
    return grid;
}

/// Labels -3, 0 and 8, one after the other.
LabelData labelsOf(const Grid& grid) {
    std::vector<std::int32_t> labels;
    for (std::size_t i = 0; i < voxelCount(grid); ++i) {
        labels.push_back(std::array{-3, 0, 8}[i % 3]);
    }
    return std::move(makeLabels(grid, labels)).value();
}

TEST(LabelGrid, APartIsSurroundedByZero) {
    const LabelData part = labelsOf(partFrom({2, 1, 3}, {4, 3, 2}));
    const Result<LabelData> whole = labelsOnGrid(part, volumeGrid(), "labels");
    ASSERT_TRUE(whole.ok()) << whole.error().text;
    EXPECT_TRUE(checkLabelGrid(whole->grid, volumeGrid(), "labels").ok());
    EXPECT_EQ(whole->values, part.values);
    ASSERT_EQ(whole->indices.size(), voxelCount(volumeGrid()));
    const Mat4 world_from_index = worldFromIndex(volumeGrid());
    for (std::size_t i = 0; i < whole->indices.size(); ++i) {
        const Vec3 world = transformPoint(world_from_index, {static_cast<double>(i % 7), static_cast<double>(i / 7 % 6),
                                                             static_cast<double>(i / 42)});
        EXPECT_EQ(whole->indices[i], labelAt(part, world)) << i;
    }
}

TEST(LabelGrid, RoundedNumbersOfAHeaderAreLetPass) {
    Grid grid = partFrom({2.0008, 1, 2.9993}, {4, 3, 2});
    EXPECT_TRUE(labelsOnGrid(labelsOf(grid), volumeGrid(), "labels").ok());
    grid = partFrom({0, 0.0009, 0}, {7, 6, 5});
    EXPECT_TRUE(labelsOnGrid(labelsOf(grid), volumeGrid(), "labels").ok());
    EXPECT_FALSE(checkLabelGrid(grid, volumeGrid(), "labels").ok());
}

TEST(LabelGrid, RefusalsSayWhatDiffers) {
    const auto refusal = [](const Grid& grid) {
        const Result<LabelData> whole = labelsOnGrid(labelsOf(grid), volumeGrid(), "labels");
        return whole.ok() ? std::string("accepted") : whole.error().text;
    };
    const std::string begin = "labels: the label map is not on the grid of the volume: ";
    EXPECT_EQ(refusal(partFrom({2.25, 1, 3}, {4, 3, 2})),
              begin + "its 4 x 3 x 2 voxels begin at voxel 2.25, 1, 3 of the volume's 7 x 6 x 5, not at a whole one; "
                      "resample it to that");
    EXPECT_THAT(refusal(partFrom({4, 1, 3}, {4, 3, 2})), HasSubstr("begin at voxel 4, 1, 3 of the volume's 7 x 6 x 5, "
                                                                   "and reach beyond them"));
    EXPECT_THAT(refusal(partFrom({-1, 0, 0}, {4, 3, 2})), HasSubstr("voxel -1, 0, 0 of the volume's 7 x 6 x 5, and"));
    Grid grid = partFrom({2, 1, 3}, {4, 3, 2});
    grid.spacing[2] = 1;
    EXPECT_THAT(refusal(grid), HasSubstr("its spacing is 0.5, 0.75, 1 mm, that of the volume 0.5, 0.75, 2 mm"));
    grid = partFrom({2, 1, 3}, {4, 3, 2});
    grid.direction = {0.6, 0.8, 0, 0.8, -0.6, 0, 0, 0, 1};
    EXPECT_THAT(refusal(grid), HasSubstr("its axis y runs along another direction"));
    // Of the same size elsewhere.
    EXPECT_THAT(refusal(partFrom({0, 0, 1}, {7, 6, 5})), HasSubstr("begin at voxel 0, 0, 1 of the volume's"));
    EXPECT_THAT(checkLabelGrid(partFrom({2, 1, 3}, {4, 3, 2}), volumeGrid(), "labels").error().text,
                HasSubstr("its 4 x 3 x 2 voxels begin at voxel 2, 1, 3 of the volume's 7 x 6 x 5; resample"));
}

} // namespace
} // namespace voxtact::test
