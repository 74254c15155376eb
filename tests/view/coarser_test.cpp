// SPDX-License-Identifier: MIT
#include "viewer/model/files/coarser.h"

#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace voxtact::test {

using namespace voxtact::view;
using testing::ElementsAre;

namespace {

VolumeData row(std::initializer_list<int> values) {
    VolumeData out;
    out.type = ScalarType::Int16;
    out.grid.size = {static_cast<std::uint32_t>(values.size()), 1, 1};
    out.grid.spacing = {2, 3, 4};
    out.grid.origin = {10, 20, 30};
    for (const int value : values) {
        const auto voxel = static_cast<std::int16_t>(value);
        const auto* const bytes = reinterpret_cast<const std::byte*>(&voxel);
        out.voxels.insert(out.voxels.end(), bytes, bytes + sizeof voxel);
    }
    return out;
}

std::vector<std::int16_t> valuesOf(const VolumeData& volume) {
    std::vector<std::int16_t> out(volume.voxels.size() / sizeof(std::int16_t));
    std::memcpy(out.data(), volume.voxels.data(), volume.voxels.size());
    return out;
}

} // namespace

TEST(ViewCoarser, AVoxelIsTheMeanOfItsBlockAndTheLastBlockOfWhatIsLeft) {
    const VolumeData out = coarser(row({-100, -300, 7, 10, 50}), 2).value();
    EXPECT_THAT(valuesOf(out), ElementsAre(-200, 8, 50)); // 8.5 is rounded to the even one
    EXPECT_THAT(out.grid.size, ElementsAre(3, 1, 1));     // axes of one voxel stay
    EXPECT_THAT(out.grid.spacing, ElementsAre(4, 3, 4));
    EXPECT_THAT(out.grid.origin, ElementsAre(11, 20, 30));
}

TEST(ViewCoarser, LiesWhereTheVolumeLies) {
    VolumeData head = makeBuiltinVolume("head:32").value();
    // Turned about z by a right angle, so that an axis of the index is not one of the world.
    head.grid.direction = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    const VolumeData out = coarser(head, 4).value();
    ASSERT_THAT(out.grid.size, ElementsAre(8, 8, 8));
    const Mat4 before = worldFromTexture(head.grid);
    const Mat4 after = worldFromTexture(out.grid);
    for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 1}, Vec3{1, 1, 1}}) {
        const Vec3 is = transformPoint(after, corner);
        const Vec3 was = transformPoint(before, corner);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(is[axis], was[axis], 1e-9);
        }
    }
    EXPECT_TRUE(checkVolume(out.view()).ok());
}

TEST(ViewCoarser, TellsHowFarItIsAndEnds) {
    const VolumeData head = makeBuiltinVolume("head:16").value();
    std::vector<double> shares;
    ASSERT_TRUE(coarser(head, 2, [&](double share) {
                    shares.push_back(share);
                    return true;
                }).ok());
    EXPECT_EQ(shares.size(), 8U);
    EXPECT_EQ(shares.back(), 1);
    const auto ended = coarser(head, 2, [](double) { return false; });
    ASSERT_FALSE(ended.ok());
    EXPECT_EQ(ended.error().code, ErrorCode::Cancelled);
    EXPECT_FALSE(coarser(head, 1).ok());
}

} // namespace voxtact::test
