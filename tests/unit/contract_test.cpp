// SPDX-License-Identifier: MIT
// What host and device refuse by one check: numbers that are none of an enumeration's, and values that no voxel holds.

// The assertion of live() is what is tested, in release builds too.
#ifdef NDEBUG
#undef NDEBUG
#endif
#include "core/base/live.h"

#include "core/base/enum_check.h"
#include "core/volume/voxel_value.h"

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <limits>

namespace voxtact {
namespace {

using testing::HasSubstr;

TEST(EnumTest, NumbersOfNothingAreNamed) {
    EXPECT_TRUE(checkFilter(Filter::Exact).ok());
    EXPECT_TRUE(checkBoundary(Boundary::Clamp).ok());
    EXPECT_TRUE(checkProjection(Projection::Certified).ok());
    EXPECT_TRUE(checkScalarType(ScalarType::Float32).ok());
    EXPECT_EQ(checkFilter(static_cast<Filter>(99)).error().text, "there is no filter number 99");
    EXPECT_EQ(checkBoundary(static_cast<Boundary>(99)).error().text, "there is no boundary number 99");
    EXPECT_EQ(checkProjection(static_cast<Projection>(4)).error().text, "there is no projection number 4");
    EXPECT_EQ(checkScalarType(static_cast<ScalarType>(77)).error().text, "there is no scalar type number 77");
    EXPECT_STREQ(toString(static_cast<ScalarType>(77)), "unknown");
    EXPECT_STREQ(toString(static_cast<Filter>(99)), "unknown");
    EXPECT_STREQ(toString(static_cast<Boundary>(99)), "unknown");
    EXPECT_STREQ(toString(static_cast<Exactness>(99)), "unknown");
}

TEST(EnumTest, AVolumeOfAnUnknownTypeIsRefused) {
    const std::byte voxels[4] = {};
    Grid grid;
    grid.size = {1, 1, 1};
    EXPECT_THAT(checkVolume({grid, static_cast<ScalarType>(77), voxels}).error().text,
                HasSubstr("scalar type number 77"));
}

TEST(VoxelValueTest, FloatsAreRoundedAndIntegersAreNot) {
    for (const double value : {0.1, -0.1, 1.0 / 3, 16777217.0, 3.4028234663852886e38, 1e-45, 0.0}) {
        const Result<VoxelBytes> voxel = voxelOf(ScalarType::Float32, value);
        ASSERT_TRUE(voxel.ok()) << value;
        EXPECT_EQ(valueOf(ScalarType::Float32, *voxel), static_cast<double>(static_cast<float>(value)));
    }
    EXPECT_FALSE(voxelOf(ScalarType::Float32, 3.41e38).ok());
    EXPECT_FALSE(voxelOf(ScalarType::UInt8, 0.5).ok());
    EXPECT_FALSE(voxelOf(ScalarType::UInt16, 65536).ok());
    EXPECT_EQ(valueOf(ScalarType::UInt8, *voxelOf(ScalarType::UInt8, 255)), 255);
    EXPECT_EQ(valueOf(ScalarType::Int16, *voxelOf(ScalarType::Int16, -32768)), -32768);
    EXPECT_EQ(valueOf(ScalarType::UInt16, *voxelOf(ScalarType::UInt16, 65535)), 65535);
    for (const ScalarType type : {ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32}) {
        EXPECT_FALSE(voxelOf(type, std::numeric_limits<double>::quiet_NaN()).ok());
        EXPECT_FALSE(voxelOf(type, std::numeric_limits<double>::infinity()).ok());
    }
}

TEST(VoxelValueTest, TheRangeOfVoxelsOfAnyAlignment) {
    std::array<std::byte, 1 + 3 * sizeof(std::int16_t)> bytes{};
    const std::int16_t voxels[] = {5, -7, 3};
    std::memcpy(bytes.data() + 1, voxels, sizeof voxels);
    const Result<ValueRange> range =
        checkVoxels(ScalarType::Int16, {{}, {3, 1, 1}}, std::span<const std::byte>(bytes).subspan(1));
    ASSERT_TRUE(range.ok());
    EXPECT_EQ(range->lo, -7);
    EXPECT_EQ(range->hi, 5);
    EXPECT_TRUE(checkVoxels(ScalarType::Int16, {}, {}).ok());
}

struct Something {
    int value = 3;
};

TEST(LiveDeathTest, AMovedFromObjectSaysSo) {
    const auto impl = std::make_unique<Something>();
    EXPECT_EQ(live(impl).value, 3);
    const std::unique_ptr<Something> nothing;
    EXPECT_DEATH(static_cast<void>(live(nothing)), "was moved from is used");
}

} // namespace
} // namespace voxtact
