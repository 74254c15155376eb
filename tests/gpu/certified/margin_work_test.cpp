// SPDX-License-Identifier: MIT
// What the passes with a margin do, and that it is no more than the host expects, for runs of triangles that are near
// each other and for such that are not.
#include "certified/counted_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "detect/certified/certified_rounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

DetectorDesc counted(double margin) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .counters = true,
            .margin = margin};
}

class MarginWorkTest : public CertifiedTest {};

/// In a volume of one value whose opacity is below the threshold by less than a computed opacity may be off, every cell
/// may be opaque and none is: no look ends the work.
struct Undecided {
    VolumeData image = makeBytes(unitGrid(40), [](auto...) { return 100.0; });
    std::array<ControlPoint, 2> points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    double threshold = 100.0 / 255 + 2e-7;

    /// Triangles with sides of up to `side` of the volume's, `spread` about its middle.
    static MeshData mesh(std::mt19937_64& random, std::uint32_t triangles, double side, double spread) {
        MeshData out;
        for (std::uint32_t triangle = 0; triangle < triangles; ++triangle) {
            const Vec3 about{uniform(random, -spread, spread), uniform(random, -spread, spread),
                             uniform(random, -spread, spread)};
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                for (const double middle : about) {
                    out.positions.push_back(static_cast<float>(0.5 + middle + side * uniform(random, -0.5, 0.5)));
                }
                out.indices.push_back(3 * triangle + corner);
            }
        }
        return out;
    }
};

TEST_F(MarginWorkTest, IsWithinWhatTheHostExpects) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const Undecided scene;
    const Volume volume = take(Volume::upload(context(), queue(), scene.image.view(), {.bricks = true}));
    const TransferFunction function = upload(scene.points, {0, 255});
    const double voxel = volume.grid().spacing[0];
    double fullest = 0;
    for (int turn = 0; turn < 4; ++turn) {
        SCOPED_TRACE("turn " + std::to_string(turn) + ", seed " + std::to_string(seed));
        const std::uint32_t triangles = 1 + static_cast<std::uint32_t>(random() % 20);
        const double side = std::exp2(uniform(random, -7, -3));
        const MeshData data = Undecided::mesh(random, triangles, side, turn % 2 == 0 ? 0.02 : 0.4);
        const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = turn < 2}));
        const Mat4 pose = identity();
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        const double margin = voxel * uniform(random, 0.1, 1.6);
        const Answered roomy = detect(counted(margin), {{&item, 1}, {}, scene.threshold}, 1, 2048);
        const Answered narrow = detect(counted(margin), {{&item, 1}, {}, scene.threshold}, 1, 16);
        EXPECT_TRUE(roomy.pairs.at(0).possible);
        EXPECT_TRUE(narrow.pairs.at(0).possible);
        EXPECT_EQ(roomy.counters.left, 0U);
        const double expected = meshLooks(item, margin).of(0, 1);
        const double looks = static_cast<double>(roomy.counters.bricksSeen + roomy.counters.cellsSeen);
        EXPECT_LE(looks, expected);
        EXPECT_LE(static_cast<double>(narrow.counters.bricksLeft + narrow.counters.cellsLeft), expected);
        fullest = std::max(fullest, looks / expected);
    }
    std::cout << "  at most " << fullest << " of it\n";
    EXPECT_GT(fullest, 0.0005);
}

/// A voxel is opaque in a volume where nothing can be decided, and of the triangles of a run one is near enough: the
/// queues are full of what is undecided, in bricks and of triangles that come before, and what is left of a brick is
/// decided for each triangle.
TEST_F(MarginWorkTest, WhatHasNoRoomIsDecidedForEachTriangle) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const Undecided scene;
    const VolumeData image =
        makeBytes(unitGrid(40), [](auto x, auto y, auto z) { return x == 28 && y == 20 && z == 20 ? 255.0 : 100.0; });
    const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
    const TransferFunction function = upload(scene.points, {0, 255});
    constexpr double kVoxels = 3;
    for (const std::uint32_t which : {13U, 15U}) {
        SCOPED_TRACE("triangle " + std::to_string(which) + ", seed " + std::to_string(seed));
        MeshData data;
        for (std::uint32_t triangle = 0; triangle < 16; ++triangle) {
            // What is above 100 is less than a voxel from the middle of the bright one.
            const double x = 27 - kVoxels + (triangle == which ? 0.2 : uniform(random, -2, -1));
            const Vec3 at = transformPoint(worldFromIndex(volume.grid()), {x, uniform(random, 19.8, 20.2), 20});
            addTriangle(data, at, at, at);
        }
        const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = false}));
        const Mat4 pose = identity();
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        const double margin = kVoxels * volume.grid().spacing[0];
        const Answered found = detect(counted(margin), {{&item, 1}, {}, scene.threshold}, 1, 16);
        EXPECT_TRUE(found.pairs.at(0).hit);
        EXPECT_GT(found.counters.left, 0U);
        EXPECT_EQ(found.counters.mostParts, found.counters.largeParts);
        EXPECT_LT(found.counters.largeParts, 16U); // the run looks at bricks together
    }
}

/// The same mesh, its triangles in an order in which those of a run are far from each other: the answers are the same,
/// and more of its bricks are listed, each for one triangle.
TEST_F(MarginWorkTest, OfScatteredRuns) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const TransferFunction function = upload(points, {0, 255});
    MeshData data = take(makeBuiltinMesh("scalpel:1500"));
    const Mesh ordered = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i < data.indices.size(); i += 3) {
        triangles.push_back({data.indices[i], data.indices[i + 1], data.indices[i + 2]});
    }
    std::ranges::shuffle(triangles, random);
    data.indices.clear();
    for (const std::array<std::uint32_t, 3>& triangle : triangles) {
        data.indices.insert(data.indices.end(), triangle.begin(), triangle.end());
    }
    const Mesh scattered = take(Mesh::upload(context(), queue(), data.view(), {.clusters = false}));
    constexpr std::uint32_t kPoses = 16;
    const std::vector<Mat4> poses = randomPoses(head.grid, kPoses, 1.1, random);
    const BatchItem first{&ordered, &volume, &function, poses};
    const BatchItem second{&scattered, &volume, &function, poses};
    for (const double margin : {1.0, 6.0}) {
        SCOPED_TRACE("margin " + std::to_string(margin) + ", seed " + std::to_string(seed));
        const Answered wanted = detect(counted(margin), {{&first, 1}, {}, kDefaultThreshold}, kPoses, 2048);
        const Answered found = detect(counted(margin), {{&second, 1}, {}, kDefaultThreshold}, kPoses, 2048);
        for (std::uint32_t i = 0; i < kPoses; ++i) {
            EXPECT_FALSE(wanted.pairs[i].possible);
            EXPECT_FALSE(found.pairs[i].possible);
            EXPECT_EQ(found.pairs[i].hit, wanted.pairs[i].hit) << "pair " << i;
        }
        EXPECT_GT(found.counters.largeParts, wanted.counters.largeParts);
    }
}

} // namespace
} // namespace voxtact::test
