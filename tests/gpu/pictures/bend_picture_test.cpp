// SPDX-License-Identifier: MIT
// Pictures of meshes that bend.
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/render.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <cmath>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class BendPictureTest : public RawGpuTest {
  protected:
    static MeshData ball() {
        MeshData data = take(makeEllipsoid(1000));
        for (double& coordinate : data.positions) {
            coordinate = coordinate * 0.02 + 0.5;
        }
        return data;
    }
    /// A volume in which nothing is seen, and so the mesh alone.
    struct Nothing {
        Nothing(const BendPictureTest& test, const Renderer& renderer)
            : volume(test.upload(makeBytes(unitGrid(4), [](auto...) { return 0.0; }))),
              function(take(RenderTransferFunction::upload(renderer, test.queue(),
                                                           {.opacity = {std::span(&kClear, 1), {0, 255}, 16}}))) {}
        [[nodiscard]] Scene scene() const {
            Scene scene;
            scene.volume = &volume;
            scene.transferFunction = &function;
            scene.clip_from_world = flatView(0, 1, 60, 60).clip_from_world;
            return scene;
        }
        static constexpr ControlPoint kClear{0, 0};
        Volume volume;
        RenderTransferFunction function;
    };
    static MeshData wavy(MeshData data) {
        for (std::size_t at = 0; at < data.positions.size(); at += 3) {
            data.positions[at] += 0.15 * std::sin(9 * data.positions[at + 1]);
        }
        return data;
    }
};

TEST_F(BendPictureTest, AreThoseOfAMeshMadeAfresh) {
    BlockingRenderer renderer = take(BlockingRenderer::create(context(), queue()));
    const Nothing nothing(*this, renderer.renderer());
    const MeshData before = ball();
    const MeshData after = wavy(before);
    Scene scene = nothing.scene();
    const auto pictureOf = [&](const Mesh& mesh, const MeshNormals* normals) {
        scene.mesh = &mesh;
        scene.normals = normals;
        return take(renderer.render(scene, {60, 60})).rgba;
    };
    for (const bool smooth : {false, true}) {
        Mesh mesh = take(Mesh::upload(context(), queue(), before.view(), {.editable = true, .vertexStride = 20}));
        MeshNormals normals = take(MeshNormals::upload(renderer.renderer(), queue(), before.view()));
        const std::vector<std::uint8_t> old = pictureOf(mesh, smooth ? &normals : nullptr);
        const VkCommandBuffer commands = raw().begin();
        take(mesh.cmdUpdate(commands, after.positions));
        take(normals.cmdUpdate(commands, after.view()));
        raw().submitAndWait(commands);
        const Mesh fresh = take(Mesh::upload(context(), queue(), after.view()));
        const MeshNormals freshNormals = take(MeshNormals::upload(renderer.renderer(), queue(), after.view()));
        const std::vector<std::uint8_t> expected = pictureOf(fresh, smooth ? &freshNormals : nullptr);
        EXPECT_EQ(pictureOf(mesh, smooth ? &normals : nullptr), expected);
        EXPECT_NE(expected, old);
    }
}

TEST_F(BendPictureTest, WhatIsOfAnotherMeshIsRefusedAfterACopyToo) {
    BlockingRenderer renderer = take(BlockingRenderer::create(context(), queue()));
    const Nothing nothing(*this, renderer.renderer());
    const MeshData data = ball();
    Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.editable = true}));
    const VkBuffer same =
        raw().makeBuffer(std::span<const float>(floatsOf(data.positions)), VK_BUFFER_USAGE_TRANSFER_SRC_BIT).buffer;
    MeshNormals normals = take(MeshNormals::upload(renderer.renderer(), queue(), makeCube(0, 1).view()));
    const PaintedVertices painted =
        take(PaintedVertices::upload(renderer.renderer(), queue(), std::vector<Colour>(8, Colour{1, 0, 0})));
    const VkCommandBuffer commands = raw().begin();
    take(mesh.cmdCopy(commands, same, 0));
    raw().submitAndWait(commands);
    EXPECT_FALSE(mesh.facts().has_value());
    Scene scene = nothing.scene();
    scene.mesh = &mesh;
    scene.normals = &normals;
    EXPECT_THAT(renderer.render(scene, {60, 60}).error().text, HasSubstr("Scene::normals is not of Scene::mesh"));
    scene.normals = nullptr;
    scene.paint = {.what = Paint::Vertices, .vertices = &painted};
    EXPECT_THAT(renderer.render(scene, {60, 60}).error().text, HasSubstr("colours for 8 vertices, the mesh has"));
}

TEST_F(BendPictureTest, NormalsOfAnotherMeshAreRefused) {
    const auto text = [](const Result<void>& result) { return result.ok() ? "" : result.error().text; };
    BlockingRenderer renderer = take(BlockingRenderer::create(context(), queue()));
    const MeshData data = ball();
    MeshNormals normals = take(MeshNormals::create(renderer.renderer(), data.view()));
    const VkCommandBuffer commands = raw().begin();
    EXPECT_THAT(text(normals.cmdUpdate(commands, data.view())), HasSubstr("the normals were never uploaded"));
    take(normals.cmdUpload(commands));
    EXPECT_THAT(text(normals.cmdUpdate(commands, makeCube(0, 1).view())),
                HasSubstr("the mesh has 24 vertices, the normals are of"));
    EXPECT_THAT(text(normals.cmdUpdate(commands, {})), HasSubstr("no triangle"));
    EXPECT_THAT(text(normals.cmdUpdate(VK_NULL_HANDLE, data.view())), HasSubstr("command buffer"));
    raw().submitAndWait(commands);
}

} // namespace
} // namespace voxtact::test
