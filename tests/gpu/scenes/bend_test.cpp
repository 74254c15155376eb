// SPDX-License-Identifier: MIT
// Meshes whose vertices come elsewhere between the commands of a command buffer.
#include "bend_fixture.h"

#include "cpu/scenes/random_scene.h"
#include "device/scene/scene_impl.h"
#include "exact/shared.h"
#include "support/scenes.h"
#include "voxtact/samples.h"
#include "voxtact_shaders/edit_comp.h"
#include "vulkan/barriers.h"
#include "vulkan/pipeline.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr VkBufferUsageFlags kCopied = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

class MeshBendTest : public BendFixture {
  protected:
    [[nodiscard]] Mesh editable(const MeshData& data, bool clusters, std::uint32_t stride = 12) const {
        return take(Mesh::upload(context(), queue(), data.view(),
                                 {.clusters = clusters, .editable = true, .vertexStride = stride}));
    }
    void expectFacts(const Mesh& mesh, const MeshData& shape) {
        const std::optional<MeshFacts> facts = mesh.facts();
        const MeshFacts expected = take(checkMesh(shape.view()));
        ASSERT_TRUE(facts.has_value());
        EXPECT_EQ(facts->degenerate, expected.degenerate);
        EXPECT_EQ(facts->bounds.lo, expected.bounds.lo);
        EXPECT_EQ(facts->bounds.hi, expected.bounds.hi);
    }
};

TEST_F(MeshBendTest, AnswersAreThoseOfAMeshMadeAfresh) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::vector<Way> ways = allWays();
    const std::size_t rounds = randomCases(60, 20);
    // Few rounds may all miss: it goes on until some touch.
    const auto goesOn = [&](std::size_t round) { return round < rounds || (hits_ <= rounds && round < 20 * rounds); };
    for (std::size_t round = 0; goesOn(round) && !HasFailure(); ++round) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", round " << round);
        poses_ = randomPoses(image_.grid, 2, 1, random);
        view_ =
            chance(random, 0.5) ? randomView(random, image_.grid) : View{framingCamera(image_.grid, 48, 40), 48, 40};
        MeshData shape = randomMesh(random, image_.grid);
        if (chance(random, 0.15)) {
            shape.indices.resize(3); // a mesh of one triangle
        }
        const bool clusters = chance(random, 0.75);
        const Spacing spacing = randomSpacing(random);
        Mesh mesh = editable(shape, clusters, spacing.stride);
        std::vector<MeshData> shapes;
        const VkCommandBuffer commands = raw().begin();
        for (std::size_t step = 1; step <= 3; ++step) {
            const bool changes = step > 1 || chance(random, 0.5);
            if (changes) {
                shape.positions = bent(random, shape, bendSize(image_.grid));
            }
            if (changes && chance(random, 0.5)) {
                take(mesh.cmdUpdate(commands, shape.positions));
                expectFacts(mesh, shape);
            } else if (changes) {
                const VkBuffer source = written(commands, shape.positions, spacing, kCopied);
                take(mesh.cmdCopy(commands, source, spacing.offset));
                EXPECT_FALSE(mesh.facts().has_value());
            }
            shapes.push_back(shape);
            ASSERT_NO_FATAL_FAILURE(detect(commands, ways, mesh, step));
        }
        raw().submitAndWait(commands);
        for (std::size_t step = 1; step <= 3; ++step) {
            SCOPED_TRACE(testing::Message() << "step " << step);
            ASSERT_NO_FATAL_FAILURE(expectFresh(ways, shapes[step - 1], step, chance(random, 0.5)));
        }
        if (clusters) {
            expectBoxes(mesh, shape);
        }
    }
    EXPECT_GT(hits_, rounds) << "hardly anything touched";
    EXPECT_GT(whole_, 4 * cut_);
}

TEST_F(MeshBendTest, BoxesAreTheHostsForAllKindsOfFloats) {
    constexpr float kDenormal = std::numeric_limits<float>::denorm_min();
    constexpr float kLargest = std::numeric_limits<float>::max();
    constexpr float kOdd[] = {0, -0.0F, kDenormal, -kDenormal, -3 * kDenormal, kLargest, -kLargest, 1, -1, 1e-30F};
    std::mt19937_64 random(testSeed());
    for (const std::uint32_t triangles : {1U, 15U, 17U, 64U, 65U, 1000U}) {
        MeshData shape;
        for (std::uint32_t corner = 0; corner < 3 * triangles; ++corner) {
            for (int axis = 0; axis < 3; ++axis) {
                shape.positions.push_back(static_cast<float>(uniform(random, -1, 1)));
            }
            shape.indices.push_back(corner);
        }
        Mesh mesh = editable(shape, true, 16);
        // Numbers that differ (0 kinds), so that each run has a part in the box of its cluster, and odd ones.
        for (const std::size_t kinds : {std::size_t{0}, std::size_t{1}, std::size_t{5}, std::size(kOdd)}) {
            const double middle = uniform(random, -1, 1);
            for (double& coordinate : shape.positions) {
                coordinate = static_cast<double>(kinds > 0 ? kOdd[below(random, kinds)]
                                                           : static_cast<float>(middle + uniform(random, -0.5, 0.5)));
            }
            const VkCommandBuffer commands = raw().begin();
            take(mesh.cmdUpdate(commands, shape.positions));
            raw().submitAndWait(commands);
            expectBoxes(mesh, shape);
        }
    }
}

/// Vertices that need several vkCmdUpdateBuffer, and more clusters than a device has work groups in a row.
TEST_F(MeshBendTest, AMeshOfFiftyThousandVertices) {
    std::vector<Way> ways;
    ways.push_back({take(Detector::certified(context(), {.outputs = {.bounds = true}})), {}});
    MeshData shape = take(makeEllipsoid(99996));
    EXPECT_EQ(take(checkMesh(shape.view())).vertices, 50000U);
    for (double& coordinate : shape.positions) {
        coordinate *= 0.2F;
    }
    poses_ = {translation(transformPoint(worldFromTexture(image_.grid), {0.5, 0.5, 0.5}))};
    Mesh mesh = editable(shape, true);
    std::uint32_t& mostGroups = context().impl().limits.maxComputeWorkGroupCount[0];
    const std::uint32_t before = mostGroups;
    std::mt19937_64 random(testSeed());
    for (const std::uint32_t groups : {before, 100U}) {
        shape.positions = bent(random, shape, 4);
        const VkCommandBuffer commands = raw().begin();
        mostGroups = groups;
        const Result<void> updated = mesh.cmdUpdate(commands, shape.positions);
        mostGroups = before;
        take(updated);
        detect(commands, ways, mesh, 1);
        raw().submitAndWait(commands);
        expectBoxes(mesh, shape);
        expectFresh(ways, shape, 1, true);
    }
    EXPECT_EQ(hits_, 2U);
}

TEST_F(MeshBendTest, WithTwoFramesInFlight) {
    constexpr std::uint64_t kFrames = 8;
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    const MeshData ellipsoid = [] {
        MeshData data = take(makeEllipsoid(2000));
        for (double& coordinate : data.positions) {
            coordinate *= 0.2F;
        }
        return data;
    }();
    poses_ = {translation(transformPoint(worldFromTexture(image_.grid), {0.6, 0.5, 0.4}))};
    const Detector certified = take(Detector::certified(context()));
    BlockingDetector judge = take(BlockingDetector::create(context(), certified.desc(), queue()));
    ResultRing ring = take(ResultRing::create(certified, 2, {.maxPairs = 1}));
    Mesh mesh = editable(ellipsoid, true);
    std::vector<VkFence> fences;
    std::vector<MeshData> shapes;
    std::vector<std::uint64_t> counts;
    const auto read = [&](std::uint64_t frame) {
        raw().wait(fences[frame]);
        counts.push_back(unpack(take(ring.read(frame))[0]).count);
    };
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        if (frame >= 2) {
            read(frame - 2);
        }
        shapes.push_back(ellipsoid);
        shapes.back().positions = bent(random, ellipsoid, 6);
        const VkCommandBuffer commands = raw().begin();
        take(mesh.cmdUpdate(commands, shapes.back().positions));
        const BatchItem asked = item(mesh);
        Results* slot = take(ring.begin(frame));
        take(certified.cmdDetect(commands, {{&asked, 1}, {}, 0.5}, *slot));
        take(slot->cmdReadBack(commands));
        fences.push_back(raw().makeFence());
        raw().submit(commands, fences.back());
    }
    read(kFrames - 2);
    read(kFrames - 1);
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        const Mesh fresh = upload(shapes[frame]);
        const BatchItem asked = item(fresh);
        EXPECT_EQ(counts[frame], take(judge.detect({{&asked, 1}, {}, 0.5})).pairs[0].count) << frame;
    }
}

/// What was known of a mesh of small triangles says nothing of large ones: one loop over all their pixels would be
/// longer than llvmpipe's may be.
TEST_F(MeshBendTest, SmallTrianglesMayBecomeLarge) {
    const Volume volume = upload(makeBytes(unitGrid(8), [](auto...) { return 255.0; }));
    const Mat4 pose = identity();
    constexpr std::uint32_t kSide = 2560;
    BlockingDetector counting = detector({.method = CountingMethod::Compute});
    const MeshData small = makeFlat(0, 0.01, 0, 0.01, 0.5);
    const MeshData large = makeFlat(0, 1, 0, 1, 0.5);
    for (const bool copied : {false, true}) {
        Mesh mesh = editable(small, false);
        const BatchItem asked{&mesh, &volume, &*function_, {&pose, 1}};
        const VkCommandBuffer commands = raw().begin();
        if (copied) {
            take(mesh.cmdCopy(commands, written(commands, large.positions, {}, kCopied), 0));
        } else {
            take(mesh.cmdUpdate(commands, large.positions));
        }
        raw().submitAndWait(commands);
        const BatchAnswer answer = take(counting.detect({{&asked, 1}, flatView(0, 1, kSide, kSide), 0.5}));
        EXPECT_EQ(answer.pairs[0].count, std::uint64_t{kSide} * kSide) << copied;
    }
}

/// A shader of the caller's: the pass that edits volumes, which gives every third word one value.
class CallersShader {
  public:
    CallersShader(const Context& context, VkBuffer vertices, std::uint32_t count, VkBuffer rows)
        : context_(context.impl()), count_(count) {
        const VkDescriptorPoolSize buffers{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
        pipeline_ = take(computePipeline(context_, spirv::edit_comp, {}, context_.editLayout.get(), "a caller's"));
        set_ = take(makeDescriptorSet(context_, context_.setLayouts[VOXTACT_SET_PAIRS], {&buffers, 1}, "a caller's"));
        writeBuffer(context_, set_.set, VOXTACT_BINDING_EDIT_ROWS, rows);
        writeBuffer(context_, set_.set, VOXTACT_BINDING_EDIT_TEXELS, vertices);
    }
    /// Moves all vertices to that z.
    void flatten(VkCommandBuffer commands, float z) const {
        const DeviceFunctions& vk = context_.vk;
        const VkPipelineLayout layout = context_.editLayout.get();
        const shader::EditConstants constants{3, count_, 4, std::bit_cast<std::uint32_t>(z)};
        vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set_.set, 0, nullptr);
        vk.CmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
        vk.CmdDispatch(commands, (3 * count_ + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
    }

  private:
    ContextImpl& context_;
    std::uint32_t count_;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    DescriptorSet set_;
};

TEST_F(MeshBendTest, FromABufferThatAShaderHasWritten) {
    // The half above z = 0.5 is opaque.
    const VolumeData half = makeBytes(unitGrid(8), [](auto, auto, std::uint32_t z) { return z >= 4 ? 255.0 : 0.0; });
    const Volume volume = take(Volume::upload(context(), queue(), half.view(), {.bricks = true, .editable = true}));
    const MeshData flat = makeFlat(0.1, 0.9, 0.1, 0.9, 0.1);
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    const VkBuffer vertices = raw().makeBuffer(std::span<const float>(floatsOf(flat.positions)), kUsage).buffer;
    constexpr std::uint32_t kRow[] = {2, 3, 2, 3, 2, 3, 2, 3};
    const VkBuffer rows =
        raw().makeBuffer(std::span<const std::uint32_t>(kRow), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT).buffer;
    const CallersShader shader(context(), vertices, 4, rows);
    WrappedMesh wrapped;
    wrapped.vertices = vertices;
    wrapped.vertexCount = 4;
    wrapped.indices =
        raw()
            .makeBuffer(std::span<const std::uint32_t>(flat.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT | kUsage)
            .buffer;
    wrapped.triangleCount = 2;
    wrapped.storage = wrapped.clusters = true;
    Mesh theirs = take(Mesh::wrap(context(), wrapped));
    Mesh ours = editable(flat, true);
    const Detector certified = take(Detector::certified(context()));
    const Detector query = take(Detector::raster(context(), {.method = CountingMethod::Query}));
    const Mat4 pose = identity();
    const BatchItem items[] = {{&ours, &volume, &*function_, {&pose, 1}}, {&theirs, &volume, &*function_, {&pose, 1}}};
    std::deque<Results> results;
    const VkCommandBuffer commands = raw().begin();
    take(theirs.cmdUpload(commands));
    for (const float z : {0.9F, 0.2F, 0.7F}) {
        shader.flatten(commands, z);
        take(ours.cmdCopy(commands, vertices, 0));
        take(theirs.cmdRefit(commands));
        for (const Detector* each : {&certified, &query}) {
            results.push_back(take(Results::create(*each, {.maxPairs = 2})));
            take(each->cmdDetect(commands, {items, flatView(0, 1, 20, 20), 0.5}, results.back()));
            take(results.back().cmdReadBack(commands));
        }
        // The next dispatch of the caller's writes what these read: that is the caller's to wait for.
        barrier(context().impl(), commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    }
    raw().submitAndWait(commands);
    for (std::size_t i = 0; i < results.size(); ++i) {
        for (const PairResult& pair : take(results[i].read())) {
            EXPECT_EQ(unpack(pair).hit, i / 2 != 1) << i;
        }
    }
    EXPECT_EQ(unpack(take(results[1].read())[0]).count, 16U * 16U);
}

/// Vertices that are no numbers are the caller's mistake; what they do not belong to is answered nevertheless.
TEST_F(MeshBendTest, NumbersThatAreNoneSpoilTheirTrianglesAlone) {
    constexpr float kOdd[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(), std::bit_cast<float>(0xffc00001U)};
    MeshData shape;
    std::mt19937_64 random(testSeed());
    for (std::uint32_t corner = 0; corner < 3 * 300; ++corner) {
        for (const double extent : {18.0, 19.5, 12.0}) {
            const double middle = extent * ((corner / 3) % 10 + 0.5) / 10;
            shape.positions.push_back(static_cast<float>(middle + uniform(random, -1, 1)));
        }
        shape.indices.push_back(corner);
    }
    std::vector<Way> ways = allWays();
    const Mesh fresh = take(Mesh::upload(context(), queue(), shape.view(), {.clusters = true}));
    Mesh mesh = editable(shape, true);
    std::vector<double> spoilt = shape.positions;
    std::vector<bool> spoilsTriangle(300);
    for (int i = 0; i < 12; ++i) {
        const std::size_t at = below(random, spoilt.size());
        spoilt[at] = kOdd[below(random, std::size(kOdd))];
        spoilsTriangle[at / 9] = true;
    }
    const VkCommandBuffer commands = raw().begin();
    detect(commands, ways, fresh, 1);
    take(mesh.cmdCopy(commands, written(commands, spoilt, {}, kCopied), 0));
    detect(commands, ways, mesh, 2);
    raw().submitAndWait(commands);
    for (Way& way : ways) {
        const auto touched = [&](std::size_t which) {
            std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
            for (const TouchedTriangle& triangle : answerOf(way, which).triangles) {
                if (!spoilsTriangle[triangle.triangle]) {
                    out.emplace_back(triangle.triangle, triangle.count);
                }
            }
            return out;
        };
        EXPECT_EQ(touched(2), touched(1)) << toString(way.detector.impl().desc.projection);
        EXPECT_TRUE(way.detector.impl().desc.stopAtFirst || touched(1).size() > 5U);
    }
}

TEST_F(MeshBendTest, AnUploadBringsBackTheShapeOfItsCreation) {
    const MeshData shape = take(makeEllipsoid(500));
    MeshData other = shape;
    for (double& coordinate : other.positions) {
        coordinate = 2 * coordinate + 1;
    }
    Mesh mesh = take(Mesh::create(context(), shape.view(), {.clusters = true, .editable = true}));
    const VkCommandBuffer commands = raw().begin();
    take(mesh.cmdUpload(commands));
    take(mesh.cmdUpdate(commands, other.positions));
    expectFacts(mesh, other);
    take(mesh.cmdUpload(commands));
    expectFacts(mesh, shape);
    raw().submitAndWait(commands);
    expectBoxes(mesh, shape);
    EXPECT_FALSE(mesh.impl().known.squaresBefore.empty());
    EXPECT_EQ(mesh.impl().known.squaresBefore, mesh.impl().made.squaresBefore);
}

TEST_F(MeshBendTest, WhatIsRefusedLeavesItAsItWas) {
    const auto text = [](const Result<void>& result) { return result.ok() ? "" : result.error().text; };
    const MeshData shape = makeCube(0.2, 0.8);
    Mesh mesh = take(Mesh::create(context(), shape.view(), {.clusters = true, .editable = true}));
    const VkCommandBuffer commands = raw().begin();
    EXPECT_THAT(text(mesh.cmdUpdate(commands, shape.positions)), HasSubstr("the mesh was never uploaded"));
    EXPECT_THAT(text(mesh.cmdCopy(commands, mesh.impl().vertices, 0)), HasSubstr("the mesh was never uploaded"));
    take(mesh.cmdUpload(commands));
    std::vector<double> positions = shape.positions;
    positions[0] = 7;
    EXPECT_THAT(text(mesh.cmdUpdate(VK_NULL_HANDLE, positions)), HasSubstr("command buffer"));
    positions[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(text(mesh.cmdUpdate(commands, positions)),
                HasSubstr("vertex 2 of the mesh has a coordinate that is NaN"));
    positions.pop_back();
    EXPECT_THAT(text(mesh.cmdUpdate(commands, positions)), HasSubstr("71 coordinates, the mesh has 24 vertices"));
    EXPECT_THAT(text(mesh.cmdUpdate(commands, {})), HasSubstr("0 coordinates"));
    EXPECT_THAT(text(mesh.cmdCopy(commands, VK_NULL_HANDLE, 0)), HasSubstr("the buffer to copy vertices from is null"));
    EXPECT_THAT(text(mesh.cmdCopy(commands, mesh.impl().vertices, 6)), HasSubstr("6 of the vertices to copy is not"));
    EXPECT_THAT(text(mesh.cmdRefit(commands)), HasSubstr("the mesh is not wrapped"));
    Mesh fixed = take(Mesh::create(context(), shape.view(), {.clusters = true}));
    EXPECT_THAT(text(fixed.cmdUpdate(commands, shape.positions)), HasSubstr("made without MeshOptions::editable"));
    EXPECT_THAT(text(fixed.cmdCopy(commands, mesh.impl().vertices, 0)), HasSubstr("MeshOptions::editable"));
    raw().submitAndWait(commands);
    expectFacts(mesh, shape);
    expectBoxes(mesh, shape);
    for (const std::uint32_t stride : {0U, 8U, 14U}) {
        EXPECT_THAT(Mesh::create(context(), shape.view(), {.vertexStride = stride}).error().text,
                    HasSubstr("MeshOptions::vertexStride must be at least 12"));
    }
}

} // namespace
} // namespace voxtact::test
