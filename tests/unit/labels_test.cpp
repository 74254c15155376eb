// SPDX-License-Identifier: MIT
// Label maps: which labels there are, and which one a point has.
#include "core/volume/label_lookup.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

LabelData made(const VolumeData& volume) {
    return std::move(makeLabels(volume.view())).value();
}

std::int32_t labelOf(const LabelData& labels, const Vec3& world) {
    return labels.values.at(labelAt(labels, world));
}

TEST(Labels, AreNumberedInOrder) {
    const LabelData labels =
        made(makeVolume<std::int16_t>(unitGrid(4, 1, 1), ScalarType::Int16, [](auto x, auto, auto) {
            return std::array{7, -3, 7, -32768}[x];
        }));
    EXPECT_THAT(labels.values, ElementsAre(-32768, -3, 0, 7)) << "0 is among them even where no voxel has it";
    EXPECT_THAT(labels.indices, ElementsAre(3, 1, 3, 0));
    EXPECT_EQ(labelOf(labels, {0.3, 0.5, 0.5}), -3);
    EXPECT_EQ(labelOf(labels, {1.3, 0.5, 0.5}), 0);
}

TEST(Labels, EveryTypeWillDo) {
    const Grid grid = unitGrid(2, 1, 1);
    const auto value = [](auto x, auto, auto) { return x == 0 ? 0.0 : 200.0; };
    EXPECT_THAT(made(makeBytes(grid, value)).values, ElementsAre(0, 200));
    EXPECT_THAT(made(makeVolume<std::uint16_t>(grid, ScalarType::UInt16, value)).values, ElementsAre(0, 200));
    EXPECT_THAT(made(makeVolume<std::int16_t>(grid, ScalarType::Int16, value)).values, ElementsAre(0, 200));
    EXPECT_THAT(made(makeVolume<float>(grid, ScalarType::Float32, value)).values, ElementsAre(0, 200));
    const auto ends = [](auto x, auto, auto) { return x == 0 ? -16777216.0 : 16777216.0; };
    const LabelData widest = made(makeVolume<float>(grid, ScalarType::Float32, ends));
    EXPECT_THAT(widest.values, ElementsAre(-16777216, 0, 16777216));
    EXPECT_THAT(widest.indices, ElementsAre(0, 2));
}

TEST(Labels, AsManyAsSixteenBitsCanNumber) {
    const auto each = [](auto x, auto y, auto) { return static_cast<double>(x + 256 * y); };
    const LabelData all = made(makeVolume<std::uint16_t>(unitGrid(256, 256, 1), ScalarType::UInt16, each));
    ASSERT_EQ(all.values.size(), 65536U);
    EXPECT_EQ(all.values.back(), 65535);
    EXPECT_EQ(all.indices.back(), 65535);
    const auto positive = [&](auto x, auto y, auto z) { return each(x, y, z) + 1; };
    const VolumeData many = makeVolume<float>(unitGrid(256, 256, 1), ScalarType::Float32, positive);
    const Result<LabelData> refused = makeLabels(many.view());
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(refused.error().text, HasSubstr("65537 different labels"));
}

TEST(Labels, BadMapsAreRefused) {
    const auto text = [](double bad) {
        const VolumeData map = makeVolume<float>(unitGrid(2, 3, 4), ScalarType::Float32,
                                                 [&](auto x, auto y, auto z) { return x + y + z == 6 ? bad : 1; });
        return makeLabels(map.view()).error().text;
    };
    EXPECT_THAT(text(2.5), HasSubstr("voxel (1, 2, 3) of the label map is 2.5"));
    EXPECT_THAT(text(16777218), HasSubstr("16777218, a label is a whole number"));
    EXPECT_THAT(text(-1e30), HasSubstr("a label is a whole number"));
    EXPECT_THAT(text(std::numeric_limits<double>::quiet_NaN()), HasSubstr("NaN"));
    VolumeData short1 = makeBytes(unitGrid(2), [](auto...) { return 1.0; });
    short1.voxels.pop_back();
    EXPECT_THAT(makeLabels(short1.view()).error().text, HasSubstr("7 bytes"));
}

TEST(Labels, HalfWayIsTheUpperVoxelAndTheFacesBelongToTheMap) {
    const LabelData labels = made(makeBytes(unitGrid(4, 2, 1), [](auto x, auto y, auto) { return 1.0 + x + 10 * y; }));
    EXPECT_EQ(labelOf(labels, {0, 0, 0}), 1);
    EXPECT_EQ(labelOf(labels, {0.25, 0, 0}), 2);
    EXPECT_EQ(labelOf(labels, {std::nextafter(0.25, 0), 0, 0}), 1);
    EXPECT_EQ(labelOf(labels, {0.5, 0.5, 0.5}), 13);
    EXPECT_EQ(labelOf(labels, {1, 1, 1}), 14);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double outside : {-1e-9, 1 + 1e-9, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
            Vec3 at{0.5, 0.5, 0.5};
            at[axis] = outside;
            EXPECT_EQ(labelOf(labels, at), 0) << axis << ' ' << outside;
        }
    }
}

TEST(Labels, AreLookedUpAtTheNearestVoxelOfAnObliqueGrid) {
    std::mt19937_64 random(testSeed());
    std::size_t inside = 0;
    for (int round = 0; round < 50; ++round) {
        Grid grid;
        const Mat4 turn = randomRotation(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            grid.size[axis] = static_cast<std::uint32_t>(uniform(random, 1, 9));
            grid.spacing[axis] = uniform(random, 0.2, 4);
            grid.origin[axis] = uniform(random, -50, 50);
            for (std::size_t row = 0; row < 3; ++row) {
                grid.direction[3 * axis + row] = turn[4 * axis + row];
            }
        }
        const auto key = static_cast<std::uint32_t>(random() % 1000);
        const auto value = [&](auto x, auto y, auto z) { return (key + 31 * x + 7 * y + 3 * z) % 17 - 8.0; };
        const VolumeData map = makeVolume<std::int16_t>(grid, ScalarType::Int16, value);
        const LabelData labels = made(map);
        const LabelLookup lookup(labels);
        const Mat4 index_from_world = inverse(worldFromIndex(grid)).value();
        for (int i = 0; i < 200; ++i) {
            const Vec3 world =
                transformPoint(worldFromTexture(grid),
                               {uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2)});
            const Vec3 index = transformPoint(index_from_world, world);
            const Vec3 nearest{std::round(index[0]), std::round(index[1]), std::round(index[2])};
            bool within = true;
            bool decided = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                within = within && nearest[axis] >= 0 && nearest[axis] < grid.size[axis];
                decided = decided && std::abs(std::abs(index[axis] - nearest[axis]) - 0.5) > 1e-9;
            }
            if (!decided) {
                continue;
            }
            const std::int32_t expected = within
                                              ? static_cast<std::int32_t>(value(static_cast<std::uint32_t>(nearest[0]),
                                                                                static_cast<std::uint32_t>(nearest[1]),
                                                                                static_cast<std::uint32_t>(nearest[2])))
                                              : 0;
            ASSERT_EQ(labelOf(labels, world), expected);
            ASSERT_EQ(labels.values.at(lookup.at(world)), expected);
            inside += within ? 1U : 0U;
        }
    }
    EXPECT_GT(inside, 1000U);
}

} // namespace
} // namespace voxtact::test
