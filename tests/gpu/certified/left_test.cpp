// SPDX-License-Identifier: MIT
// What the queues had no room for, where there is very much of it: each work group of the last pass finds its own, and
// what would be too much is said to be undecided.
#include "certified/counted_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "support/host_meters.h"
#include "voxtact/cpu.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace voxtact::test {
namespace {

constexpr AnyDesc kCount{.method = CountingMethod::Compute, .projection = Projection::Certified, .counters = true};

class LeftTest : public CertifiedTest {
  protected:
    static std::vector<PairAnswer> onHost(const MeshData& mesh, const VolumeData& image,
                                          const TransferFunctionDesc& table, std::span<const Mat4> poses,
                                          double threshold) {
        const cpu::Volume volume = take(cpu::Volume::create(image.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(table));
        const cpu::Mesh shape = take(cpu::Mesh::create(mesh.view()));
        const cpu::BatchItem item{&shape, &volume, &function, poses};
        return take(take(cpu::Detector::create({.projection = Projection::Certified}))
                        .detect({{&item, 1}, {}, threshold}))
            .pairs;
    }
};

/// More entries than the work groups have lanes times lanes: more than one block of them is a lane's. Small triangles,
/// large ones, and large ones that have parts. Then, in a round of its own, some of the pairs again: it finds nothing
/// of the round before.
TEST_F(LeftTest, OfMoreEntriesThanALaneHasABlockOf) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(1); // how much is left depends on the mesh
    const VolumeData noise =
        makeBytes(unitGrid(33), [&](auto...) { return random() % 4 == 0 ? static_cast<double>(random() % 256) : 0.0; });
    const std::array points{ControlPoint{0, 0}, ControlPoint{120, 0}, ControlPoint{130, 1}, ControlPoint{255, 1}};
    const TransferFunctionDesc table{points, {0, 255}, kDefaultTableSize};
    MeshData data;
    for (std::uint32_t triangle = 0; triangle < 64; ++triangle) {
        const double side = triangle % 8 == 0 ? 0.25 : 0.04; // of the volume's
        std::array<Vec3, 3> at{};
        const Vec3 about{uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1)};
        for (Vec3& corner : at) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                corner[axis] = about[axis] + side * uniform(random, -1, 1);
            }
        }
        addTriangle(data, at[0], at[1], at[2]);
    }
    constexpr std::uint32_t kPairs = 4096;
    random.seed(seed);
    std::vector<Mat4> poses;
    for (std::uint32_t i = 0; i < kPairs; ++i) { // every seventh is beside the volume
        poses.push_back(
            translation({uniform(random, 0, 1) + (i % 7 == 0 ? 3 : 0), uniform(random, 0, 1), uniform(random, 0, 1)}));
    }
    const Volume volume = take(Volume::upload(context(), queue(), noise.view(), {.bricks = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
    const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
    constexpr std::uint32_t kAgain = 2048;
    const std::array items{BatchItem{&mesh, &volume, &function, poses},
                           BatchItem{&mesh, &volume, &function, std::span(poses).first(kAgain)}};
    const Answered found = detect(kCount, {items, {}, 0.5}, kPairs + kAgain, 16384);
    EXPECT_EQ(found.counters.rounds, 2U);
    EXPECT_GT(found.counters.peakLeft, 4096U);
    EXPECT_GT(found.counters.left - found.counters.peakLeft, 2U * 64U); // blocks
    std::vector<PairAnswer> host = onHost(data, noise, table, poses, 0.5);
    host.insert(host.end(), host.begin(), host.begin() + kAgain);
    for (std::uint32_t i = 0; i < kPairs + kAgain; ++i) {
        ASSERT_EQ(found.pairs[i].count, host[i].count) << "pair " << i << ", seed " << seed;
        ASSERT_EQ(found.pairs[i].exactness, host[i].exactness) << "pair " << i << ", seed " << seed;
    }
}

/// 256 triangles that go through all of a volume and touch nothing, of a mesh whose vertices the host does not know: it
/// cannot cut what they ask for. The device looks at as much as a round may have, and does not say no.
TEST_F(LeftTest, WhatIsTooMuchOfAnUnknownMeshIsUndecided) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    constexpr std::uint32_t kTriangles = 256;
    std::vector<float> corners;
    for (std::uint32_t triangle = 0; triangle < kTriangles; ++triangle) {
        for (const Vec3& about : {Vec3{0.1, 0.1, 0.1}, Vec3{0.9, 0.9, 0.1}, Vec3{0.1, 0.9, 0.9}}) {
            for (const double coordinate : about) {
                corners.push_back(static_cast<float>(coordinate + uniform(random, -0.02, 0.02)));
            }
        }
    }
    WrappedMesh wrapped;
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    wrapped.vertices = raw().makeBuffer(std::span<const float>(corners), kUsage).buffer;
    wrapped.vertexCount = 3 * kTriangles;
    wrapped.triangleCount = kTriangles;
    wrapped.storage = true;
    const Mesh unknown = take(Mesh::wrap(context(), wrapped));
    const VolumeData image =
        makeBytes(unitGrid(127), [](auto x, auto y, auto z) { return x == 126 && y == 0 && z == 126 ? 255.0 : 0.0; });
    const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mat4 pose = identity();
    const BatchItem item{&unknown, &volume, &function, {&pose, 1}};
    const Answered found = detect(kCount, {{&item, 1}, {}, 0.5}, 1, 16);
    EXPECT_EQ(found.pairs.at(0).count, 0U);
    EXPECT_TRUE(found.pairs.at(0).possible) << "seed " << seed;
    // 4,096 work groups for each of the 16 clusters, with 8 bricks each.
    EXPECT_LE(found.counters.bricksLeft, 16U * 4096U * 8U);
    EXPECT_GT(found.counters.bricksLeft, 16U * 4096U * 8U / 2);
}

} // namespace
} // namespace voxtact::test
