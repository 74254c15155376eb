// SPDX-License-Identifier: MIT
// Clusters of meshes in the caller's own buffers, whose contents change.
#include "bend_fixture.h"

#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <numeric>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr VkBufferUsageFlags kVertices = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kIndices = VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

class WrappedBendTest : public BendFixture {
  protected:
    /// A buffer of indices, from byte `offset` on.
    template <class Index> VkBuffer indexBuffer(std::span<const std::uint32_t> indices, std::size_t offset) {
        std::vector<Index> out(offset / sizeof(Index), Index{0xabcd});
        out.insert(out.end(), indices.begin(), indices.end());
        out.resize(out.size() + 1); // those of 16 bits may end in the middle of a word
        return raw().makeBuffer(std::span<const Index>(out), kIndices).buffer;
    }
    /// Buffers of a shape, filled by `commands`.
    WrappedMesh buffersOf(VkCommandBuffer commands, const MeshData& shape, const Spacing& spacing) {
        WrappedMesh wrapped;
        wrapped.vertices = written(commands, shape.positions, spacing, kVertices);
        wrapped.vertexOffset = spacing.offset;
        wrapped.vertexStride = spacing.stride;
        wrapped.vertexCount = static_cast<std::uint32_t>(shape.positions.size() / 3);
        wrapped.triangleCount = static_cast<std::uint32_t>(shape.indices.size() / 3);
        wrapped.storage = true;
        wrapped.clusters = true;
        return wrapped;
    }
    /// Every corner has a vertex of its own.
    static MeshData loose(const MeshData& mesh) {
        MeshData out;
        for (const std::uint32_t index : mesh.indices) {
            const auto at = mesh.positions.begin() + 3 * static_cast<std::ptrdiff_t>(index);
            out.positions.insert(out.positions.end(), at, at + 3);
        }
        out.indices.resize(mesh.indices.size());
        std::iota(out.indices.begin(), out.indices.end(), 0U);
        return out;
    }
    /// A certified detection that counts its work.
    CertifiedCounters workOn(const Mesh& mesh) {
        BlockingDetector counting =
            detector({.method = CountingMethod::Compute, .projection = Projection::Certified, .counters = true});
        const BatchItem asked = item(mesh);
        return take(counting.detect({{&asked, 1}, {}, 0.5})).counters.value();
    }
};

TEST_F(WrappedBendTest, AnswersAreThoseOfAMeshMadeAfresh) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::vector<Way> ways = allWays();
    const std::size_t rounds = randomCases(60, 20);
    // Few rounds may all miss: it goes on until some touch.
    const auto goesOn = [&](std::size_t round) { return round < rounds || (hits_ <= rounds && round < 20 * rounds); };
    for (std::size_t round = 0; goesOn(round) && !HasFailure(); ++round) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", round " << round);
        poses_ = randomPoses(image_.grid, 2, 1, random);
        MeshData shape = randomMesh(random, image_.grid);
        if (chance(random, 0.15)) {
            shape.indices.resize(3);
        }
        const std::size_t kind = below(random, 3); // no indices, of 16 bits, of 32 bits
        if (kind == 0) {
            shape = loose(shape);
        }
        const Spacing spacing = randomSpacing(random);
        const VkCommandBuffer commands = raw().begin();
        WrappedMesh wrapped = buffersOf(commands, shape, spacing);
        if (kind == 1) {
            wrapped.indexOffset = 2 * below(random, 4);
            wrapped.indices = indexBuffer<std::uint16_t>(shape.indices, wrapped.indexOffset);
            wrapped.indexType = VK_INDEX_TYPE_UINT16;
        } else if (kind == 2) {
            wrapped.indexOffset = 4 * below(random, 4);
            wrapped.indices = indexBuffer<std::uint32_t>(shape.indices, wrapped.indexOffset);
        }
        const MeshData first = shape;
        if (chance(random, 0.5)) {
            wrapped.shape = first.view();
        }
        Mesh mesh = take(Mesh::wrap(context(), wrapped));
        take(mesh.cmdUpload(commands));
        std::vector<MeshData> shapes{shape};
        ASSERT_NO_FATAL_FAILURE(detect(commands, ways, mesh, 1));
        for (std::size_t step = 2; step <= 3; ++step) {
            shape.positions = bent(random, shape, bendSize(image_.grid));
            write(commands, wrapped.vertices, shape.positions, spacing);
            take(mesh.cmdRefit(commands));
            shapes.push_back(shape);
            ASSERT_NO_FATAL_FAILURE(detect(commands, ways, mesh, step));
        }
        raw().submitAndWait(commands);
        mesh.releaseStaging();
        for (std::size_t step = 1; step <= 3; ++step) {
            SCOPED_TRACE(testing::Message() << "step " << step << ", kind " << kind);
            ASSERT_NO_FATAL_FAILURE(expectFresh(ways, shapes[step - 1], step, true));
        }
        expectBoxes(mesh, shape);
    }
    EXPECT_GT(hits_, rounds) << "hardly anything touched";
}

/// Without clusters all would be examined; with a shape, what is near each other is together.
TEST_F(WrappedBendTest, WhatCannotTouchIsSkipped) {
    MeshData shape = take(makeEllipsoid(4000));
    for (double& coordinate : shape.positions) {
        coordinate *= 0.3F;
    }
    // Triangles in an order that says nothing of where they are.
    std::mt19937_64 random(11);
    for (std::size_t i = shape.indices.size() / 3 - 1; i > 0; --i) {
        const std::size_t other = below(random, i + 1);
        std::swap_ranges(shape.indices.begin() + static_cast<std::ptrdiff_t>(3 * i),
                         shape.indices.begin() + static_cast<std::ptrdiff_t>(3 * i + 3),
                         shape.indices.begin() + static_cast<std::ptrdiff_t>(3 * other));
    }
    // A small part of it is in the volume.
    const Box box = take(checkMesh(shape.view())).bounds;
    const Vec3 corner = transformPoint(worldFromTexture(image_.grid), {1, 0.5, 0.5});
    poses_ = {translation({corner[0] - 0.8 * box.lo[0], corner[1], corner[2]})};
    const Mesh fresh = take(Mesh::upload(context(), queue(), shape.view(), {.clusters = true}));
    const std::uint64_t few = workOn(fresh).runsKept;
    EXPECT_GT(few, 0U);
    for (const bool shaped : {false, true}) {
        const VkCommandBuffer commands = raw().begin();
        WrappedMesh wrapped = buffersOf(commands, shape, {});
        wrapped.indices = indexBuffer<std::uint32_t>(shape.indices, 0);
        if (shaped) {
            wrapped.shape = shape.view();
        }
        Mesh mesh = take(Mesh::wrap(context(), wrapped));
        take(mesh.cmdUpload(commands));
        raw().submitAndWait(commands);
        const std::uint64_t kept = workOn(mesh).runsKept;
        EXPECT_TRUE(shaped ? kept == few : kept > 2 * few) << kept << ", " << few;
        // Out of reach, nothing is kept in any order.
        MeshData away = shape;
        for (double& coordinate : away.positions) {
            coordinate += 200;
        }
        const VkCommandBuffer more = raw().begin();
        write(more, wrapped.vertices, away.positions, {});
        take(mesh.cmdRefit(more));
        raw().submitAndWait(more);
        EXPECT_EQ(workOn(mesh).clustersKept, 0U);
        wrapped.clusters = false;
        const Mesh without = take(Mesh::wrap(context(), wrapped));
        EXPECT_GT(workOn(without).runsKept, 4 * few);
    }
}

TEST_F(WrappedBendTest, IndicesMayChangeToo) {
    std::vector<Way> ways = allWays();
    MeshData shape = makeCube(2, 9);
    const VkCommandBuffer commands = raw().begin();
    WrappedMesh wrapped = buffersOf(commands, shape, {});
    const std::size_t bytes = shape.indices.size() * sizeof(std::uint32_t);
    const RawVulkan::HostBuffer indices = raw().makeBuffer(bytes, kIndices);
    std::memcpy(indices.mapped, shape.indices.data(), bytes);
    wrapped.indices = indices.buffer;
    Mesh mesh = take(Mesh::wrap(context(), wrapped));
    take(mesh.cmdUpload(commands));
    raw().submitAndWait(commands);
    for (std::size_t i = 0; i < shape.indices.size(); ++i) {
        shape.indices[i] = shape.indices[i] == 0 ? 5 : shape.indices[i];
    }
    std::memcpy(indices.mapped, shape.indices.data(), bytes);
    const VkCommandBuffer more = raw().begin();
    take(mesh.cmdRefit(more));
    ASSERT_NO_FATAL_FAILURE(detect(more, ways, mesh, 1));
    raw().submitAndWait(more);
    expectFresh(ways, shape, 1, true);
    expectBoxes(mesh, shape);
    EXPECT_GT(hits_, 0U);
}

TEST_F(WrappedBendTest, WhatIsRefused) {
    const auto text = [](const auto& result) { return result.ok() ? "" : result.error().text; };
    const MeshData shape = makeCube(0.2, 0.8);
    const MeshData other = makeFlat(0, 1, 0, 1, 0.5);
    const VkCommandBuffer commands = raw().begin();
    WrappedMesh wrapped = buffersOf(commands, shape, {});
    wrapped.indices = indexBuffer<std::uint32_t>(shape.indices, 0);
    wrapped.shape = other.view();
    EXPECT_THAT(text(Mesh::wrap(context(), wrapped)),
                HasSubstr("WrappedMesh::shape has 2 triangles, triangleCount is 12"));
    MeshData broken = shape;
    broken.indices.back() = 99;
    wrapped.shape = broken.view();
    EXPECT_THAT(text(Mesh::wrap(context(), wrapped)), HasSubstr("99"));
    wrapped.shape = {};
    wrapped.storage = false;
    EXPECT_THAT(text(Mesh::wrap(context(), wrapped)), HasSubstr("WrappedMesh::clusters needs"));
    wrapped.storage = true;
    VkPhysicalDeviceLimits& limits = context().impl().limits;
    const std::uint32_t before = limits.maxStorageBufferRange;
    for (const std::uint32_t most : {200U, 250U}) { // less than the clusters need; than the vertices
        limits.maxStorageBufferRange = most;
        const Result<Mesh> refused = Mesh::wrap(context(), wrapped);
        limits.maxStorageBufferRange = before;
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
        EXPECT_THAT(refused.error().text, HasSubstr("maxStorageBufferRange is " + std::to_string(most)));
    }
    wrapped.clusters = false;
    Mesh without = take(Mesh::wrap(context(), wrapped));
    EXPECT_THAT(text(without.cmdRefit(commands)), HasSubstr("wrapped without WrappedMesh::clusters"));
    EXPECT_THAT(text(without.cmdUpdate(commands, shape.positions)), HasSubstr("its vertices are the caller's"));
    EXPECT_THAT(text(without.cmdUpload(commands)), HasSubstr("it is wrapped"));
    wrapped.clusters = true;
    Mesh mesh = take(Mesh::wrap(context(), wrapped));
    EXPECT_THAT(text(mesh.cmdRefit(commands)), HasSubstr("the mesh was never uploaded"));
    const Detector query = take(Detector::raster(context(), {.method = CountingMethod::Query}));
    Results results = take(Results::create(query, {.maxPairs = 1}));
    const BatchItem asked = item(mesh);
    EXPECT_THAT(text(query.cmdDetect(commands, {{&asked, 1}, view_, 0.5}, results)),
                HasSubstr("the mesh was never uploaded"));
    take(mesh.cmdUpload(commands));
    EXPECT_THAT(text(mesh.cmdRefit(VK_NULL_HANDLE)), HasSubstr("command buffer"));
    EXPECT_FALSE(mesh.facts().has_value());
    raw().submitAndWait(commands);
}

} // namespace
} // namespace voxtact::test
