// SPDX-License-Identifier: MIT
// Meshes whose vertices have colours of their own.
#include "gpu_fixture.h"
#include "raw_vulkan.h"
#include "support/scenes.h"
#include "voxtact/render.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kPaintedSide = 40;
constexpr VkExtent2D kPaintedExtent{kPaintedSide, kPaintedSide};

/// A rectangle that fills the picture, in a volume without opacity, seen straight on.
class PaintedVerticesTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        blocking_.emplace(take(BlockingRenderer::create(context(), queue())));
        flat_ = makeFlat(0, 1, 0, 1, 0.5);
        mesh_.emplace(upload(flat_));
        normals_.emplace(take(MeshNormals::upload(renderer(), queue(), flat_.view())));
        volume_.emplace(upload(makeBytes(unitGrid(4), [](auto...) { return 0.0; })));
        setOpacity(0);
        scene_.mesh = &*mesh_;
        scene_.volume = &*volume_;
        scene_.clip_from_world = flatView(0, 1, kPaintedSide, kPaintedSide).clip_from_world;
        scene_.lighting.volume = scene_.lighting.mesh = false;
        scene_.paint.what = Paint::Vertices;
    }
    void TearDown() override {
        scene_ = {};
        seen_.reset();
        volume_.reset();
        normals_.reset();
        mesh_.reset();
        blocking_.reset();
        GpuTest::TearDown();
    }

    [[nodiscard]] const Renderer& renderer() const { return blocking_->renderer(); }
    void setOpacity(double opacity) {
        const ControlPoint even[] = {{0, opacity}};
        constexpr ColourPoint kWhite[] = {{0, {1, 1, 1}}};
        RenderTransferFunctionDesc desc;
        desc.opacity = {even, {0, 255}, 16};
        desc.colours = kWhite;
        desc.step = 0.05;
        desc.opacityUnit = 0.02;
        seen_.emplace(take(RenderTransferFunction::upload(renderer(), queue(), desc)));
        scene_.transferFunction = &*seen_;
    }
    /// Linear over the rectangle, so that every mixture is known.
    static Colour colourAt(double x, double y) { return {x, 0.2 + 0.6 * y, 1 - 0.5 * x - 0.5 * y}; }
    [[nodiscard]] std::vector<Colour> colours() const {
        std::vector<Colour> out;
        for (std::size_t at = 0; at < flat_.positions.size(); at += 3) {
            out.push_back(colourAt(flat_.positions[at], flat_.positions[at + 1]));
        }
        return out;
    }
    /// Every pixel, within what 8 bits a channel and a half float round.
    void expectColours(const Picture& picture) {
        for (std::uint32_t y = 0; y < kPaintedSide; ++y) {
            for (std::uint32_t x = 0; x < kPaintedSide; ++x) {
                const Colour colour = colourAt((x + 0.5) / kPaintedSide, (y + 0.5) / kPaintedSide);
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    ASSERT_NEAR(picture.rgba[4 * std::size_t{kPaintedSide * y + x} + channel], 255 * colour[channel],
                                1.5)
                        << x << ", " << y << ", channel " << channel;
                }
            }
        }
    }
    [[nodiscard]] Picture picture() { return take(blocking_->render(scene_, kPaintedExtent)); }
    void refused(const char* text, const Scene& scene) {
        const Result<Picture> made = blocking_->render(scene, kPaintedExtent);
        ASSERT_FALSE(made.ok()) << text;
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(made.error().text, HasSubstr(text));
    }

    MeshData flat_;
    std::optional<BlockingRenderer> blocking_;
    std::optional<Mesh> mesh_;
    std::optional<MeshNormals> normals_;
    std::optional<Volume> volume_;
    std::optional<RenderTransferFunction> seen_;
    Scene scene_;
};

TEST_F(PaintedVerticesTest, AreMixedBetweenTheVertices) {
    const PaintedVertices painted = take(PaintedVertices::upload(renderer(), queue(), colours()));
    scene_.paint.vertices = &painted;
    for (const MeshNormals* normals : {static_cast<const MeshNormals*>(nullptr), &std::as_const(*normals_)}) {
        scene_.normals = normals;
        expectColours(picture());
    }
}

TEST_F(PaintedVerticesTest, OfABufferOfTheCallers) {
    std::vector<std::uint32_t> words(64); // an offset before them
    for (const Colour& colour : colours()) {
        std::uint32_t word = 0xff000000U;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            word |= static_cast<std::uint32_t>(std::lround(255 * colour[channel])) << 8 * channel;
        }
        words.push_back(word);
    }
    RawVulkan raw(gpu().device);
    const RawVulkan::HostBuffer buffer =
        raw.makeBuffer(std::span<const std::uint32_t>(words), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const BufferRange range{buffer.buffer, 256, 4 * words.size() - 256};
    PaintedVertices painted = take(PaintedVertices::wrap(renderer(), range));
    scene_.paint.vertices = &painted;
    expectColours(picture());
    const VkCommandBuffer commands = raw.begin();
    EXPECT_EQ(painted.cmdUpload(commands).error().code, ErrorCode::NotReady);
    raw.submitAndWait(commands);
    // Nothing was copied: what the buffer holds at the picture is what it shows.
    std::memset(buffer.mapped, 0, 4 * words.size());
    const Picture black = picture();
    EXPECT_EQ(black.rgba[0] + black.rgba[1] + black.rgba[2], 0);
}

TEST_F(PaintedVerticesTest, AreSeenThroughTheVolumeAsFarAsIsSaid) {
    setOpacity(0.999);
    const PaintedVertices painted = take(PaintedVertices::upload(renderer(), queue(), colours()));
    scene_.paint.vertices = &painted;
    const Picture hidden = picture();
    EXPECT_GT(hidden.rgba[0], 250); // white tissue at x = 0, where the paint has no red
    scene_.paint.through = 1;
    expectColours(picture());
}

TEST_F(PaintedVerticesTest, RefusesWhatDoesNotFit) {
    const PaintedVertices painted = take(PaintedVertices::upload(renderer(), queue(), colours()));
    scene_.paint.vertices = &painted;
    (void)picture();
    Scene scene = scene_;
    scene.paint.vertices = nullptr;
    refused("no colours of vertices", scene);
    const Context other = take(Context::create(gpu().device.contextDesc()));
    const Renderer otherRenderer = take(Renderer::create(other));
    const PaintedVertices foreign = take(PaintedVertices::upload(otherRenderer, queue(), colours()));
    scene.paint.vertices = &foreign;
    refused("of another Context", scene);
    const PaintedVertices few = take(PaintedVertices::upload(renderer(), queue(), std::vector<Colour>(3)));
    scene.paint.vertices = &few;
    refused("colours for 3 vertices, the mesh has 4", scene);
    RawVulkan raw(gpu().device);
    const WrappedMesh loose{.vertices = raw.makeBuffer(72, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT).buffer,
                            .vertexCount = 7, // one that is not drawn
                            .triangleCount = 2};
    const Mesh wrapped = take(Mesh::wrap(context(), loose));
    scene.paint.vertices = &painted;
    scene.mesh = &wrapped;
    refused("colours for 4 vertices, the mesh has 6", scene);
    const MeshNormals normals = take(MeshNormals::upload(renderer(), queue(), makeFlat(0, 1, 0, 1, 0.5).view()));
    scene.paint.what = Paint::Plain;
    scene.normals = &normals;
    refused("Scene::normals has 4 vertices, the wrapped mesh has 6", scene);
    scene = scene_;
    const PaintedVertices recordedNowhere = take(PaintedVertices::create(renderer(), colours()));
    scene.paint.vertices = &recordedNowhere;
    const Result<Picture> made = blocking_->render(scene, kPaintedExtent);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().code, ErrorCode::NotReady);
    scene = scene_;
    scene.paint.what = static_cast<Paint>(5);
    refused("no paint number 5", scene);
}

TEST_F(PaintedVerticesTest, RefusesColoursThatAreNone) {
    const auto text = [](const Result<PaintedVertices>& made) { return made.ok() ? "" : made.error().text; };
    EXPECT_THAT(text(PaintedVertices::create(renderer(), {})), HasSubstr("no colours of vertices"));
    const Colour wrong[] = {{0, 0, 0}, {0, 1.5, 0}};
    EXPECT_THAT(text(PaintedVertices::create(renderer(), wrong)), HasSubstr("a vertex's colour"));
    const Colour nan[] = {{std::numeric_limits<double>::quiet_NaN(), 0, 0}};
    EXPECT_THAT(text(PaintedVertices::create(renderer(), nan)), HasSubstr("a vertex's colour"));
    EXPECT_THAT(text(PaintedVertices::wrap(renderer(), {})), HasSubstr("null buffer"));
}

} // namespace
} // namespace voxtact::test
