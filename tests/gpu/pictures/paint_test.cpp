// SPDX-License-Identifier: MIT
// What detection decides, painted on the mesh: pixel for pixel what the detector counts.
#include "gpu_fixture.h"
#include "own_image.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <optional>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr VkExtent2D kPaintExtent{150, 130};
constexpr Colour kMeshColour{0, 1, 0};
constexpr Colour kContactColour{1, 0, 0};
constexpr Colour kDiscardedColour{0, 0, 1};
constexpr double kPaintThreshold = 0.3;
constexpr std::size_t kPoses = 12;

std::uint8_t channel(const Picture& picture, std::size_t pixel, std::size_t index) {
    return picture.rgba[4 * pixel + index];
}

/// Pixels of which `is` is true of red, green and blue.
template <class Is> std::uint64_t pixelsThat(const Picture& picture, Is is) {
    std::uint64_t count = 0;
    for (std::size_t pixel = 0; pixel < picture.rgba.size() / 4; ++pixel) {
        count += is(channel(picture, pixel, 0), channel(picture, pixel, 1), channel(picture, pixel, 2)) ? 1U : 0U;
    }
    return count;
}

std::uint64_t pixelsOf(const Picture& picture, const Colour& colour) {
    return pixelsThat(picture, [&](int red, int green, int blue) {
        return red == std::lround(255 * colour[0]) && green == std::lround(255 * colour[1]) &&
               blue == std::lround(255 * colour[2]);
    });
}

/// Floats between 0 and 1 on a grid whose voxels are far from cubes.
VolumeData waves() {
    Grid grid;
    grid.size = {24, 12, 10};
    grid.spacing = {0.5, 1.2, 1.6};
    return makeVolume<float>(grid, ScalarType::Float32, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return 0.5 + 0.5 * std::sin(0.7 * x) * std::cos(1.1 * y) * std::sin(0.9 * z + 0.5);
    });
}

Vec3 middleOf(const Grid& grid) {
    return transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
}

double diagonalOf(const Grid& grid) {
    const Vec3 lo = transformPoint(worldFromTexture(grid), {0, 0, 0});
    const Vec3 hi = transformPoint(worldFromTexture(grid), {1, 1, 1});
    return std::hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
}

/// An eye in front of the volume, near enough that the near plane cuts into it.
Mat4 nearEye(const Grid& grid) {
    const Vec3 middle = middleOf(grid);
    const double size = diagonalOf(grid);
    const double nearPlane = 0.5 * size;
    const double farPlane = 2 * size;
    Mat4 eye_from_world = identity();
    eye_from_world[12] = -middle[0];
    eye_from_world[13] = -middle[1];
    eye_from_world[14] = 0.6 * size - middle[2];
    Mat4 clip_from_eye{};
    clip_from_eye[0] = clip_from_eye[5] = 1.2;
    clip_from_eye[10] = farPlane / (farPlane - nearPlane);
    clip_from_eye[11] = 1;
    clip_from_eye[14] = -nearPlane * clip_from_eye[10];
    return multiply(clip_from_eye, eye_from_world);
}

Mat4 reversed(const Mat4& clip_from_world) {
    return multiply({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1}, clip_from_world);
}

/// A volume, a flat mesh that no pixel sees twice, and a scene of the two.
class PaintTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        blocking_.emplace(take(BlockingRenderer::create(context(), queue())));
        scene_.meshColour = kMeshColour;
        scene_.lighting.volume = scene_.lighting.mesh = false;
        scene_.paint.what = Paint::Contacts;
        scene_.paint.threshold = kPaintThreshold;
        scene_.paint.contactColour = kContactColour;
        scene_.paint.discardedColour = kDiscardedColour;
        scene_.paint.through = 1;
    }
    void TearDown() override {
        scene_ = {};
        normals_.reset();
        mesh_.reset();
        seen_.reset();
        decided_.reset();
        volume_.reset();
        blocking_.reset();
        GpuTest::TearDown();
    }

    [[nodiscard]] BlockingRenderer& blocking() { return *blocking_; }
    [[nodiscard]] const Renderer& renderer() const { return blocking_->renderer(); }

    /// The detector's table is a ramp over the domain; in the picture all of it has one opacity, none or a little.
    void place(const VolumeData& data, const ValueRange& domain, double opacity = 0) {
        volume_.emplace(upload(data));
        const ControlPoint ramp[] = {{domain.lo, 0}, {domain.hi, 1}};
        decided_.emplace(upload(ramp, domain));
        const ControlPoint even[] = {{domain.lo, opacity}};
        constexpr ColourPoint kWhite[] = {{0, {1, 1, 1}}};
        RenderTransferFunctionDesc desc;
        desc.opacity = {even, domain, 16};
        desc.colours = kWhite;
        desc.step = diagonalOf(data.grid) / 40;
        desc.opacityUnit = diagonalOf(data.grid) / 40;
        seen_.emplace(take(RenderTransferFunction::upload(renderer(), queue(), desc)));
        scene_.volume = &*volume_;
        scene_.transferFunction = &*seen_;
        scene_.paint.transferFunction = &*decided_;
        scene_.clip_from_world = framingCamera(data.grid, kPaintExtent.width, kPaintExtent.height);
    }
    void placeMesh(const MeshData& data) {
        mesh_.emplace(upload(data));
        normals_.emplace(take(MeshNormals::upload(renderer(), queue(), data.view())));
        scene_.mesh = &*mesh_;
    }
    /// A rectangle as large as the volume.
    void placeFlat() {
        const double half = diagonalOf(volume_->grid()) / 3;
        placeMesh(makeFlat(-half, half, -half, half, 0));
    }

    Picture picture() { return take(blocking().render(scene_, kPaintExtent)); }
    std::uint64_t survivors(double threshold = kPaintThreshold) {
        const BatchItem item{scene_.mesh, scene_.volume, scene_.paint.transferFunction, {&scene_.world_from_object, 1}};
        const View view{scene_.clip_from_world, kPaintExtent.width, kPaintExtent.height};
        return detectOne({.method = CountingMethod::Query}, item, view, threshold).count;
    }
    void expectWhatIsCounted(const VolumeData& data, const ValueRange& domain);

    Scene scene_;
    std::optional<MeshNormals> normals_;

  private:
    std::optional<BlockingRenderer> blocking_;
    std::optional<Volume> volume_;
    std::optional<TransferFunction> decided_;
    std::optional<RenderTransferFunction> seen_;
    std::optional<Mesh> mesh_;
};

void PaintTest::expectWhatIsCounted(const VolumeData& data, const ValueRange& domain) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    place(data, domain);
    placeFlat();
    const Mat4 cameras[] = {scene_.clip_from_world, nearEye(data.grid), reversed(nearEye(data.grid))};
    std::uint64_t all = 0;
    for (const Mat4& pose : randomPoses(data.grid, kPoses, 0.5, random)) {
        scene_.world_from_object = pose;
        scene_.clip_from_world = cameras[random() % std::size(cameras)];
        scene_.paint.what = Paint::Plain;
        const std::uint64_t covered = pixelsOf(picture(), kMeshColour);
        const std::uint64_t counted = survivors();
        scene_.paint.what = Paint::Contacts;
        const Picture contacts = picture();
        EXPECT_EQ(pixelsOf(contacts, kContactColour), counted) << seed;
        EXPECT_EQ(pixelsOf(contacts, kMeshColour), covered - counted) << seed;
        scene_.paint.what = Paint::Discarded;
        const Picture discarded = picture();
        EXPECT_EQ(pixelsOf(discarded, kDiscardedColour), covered - counted) << seed;
        EXPECT_EQ(pixelsThat(discarded, [](int r, int g, int b) { return r == g && g == b && r > 60; }), counted)
            << seed;
        all += counted;
    }
    EXPECT_GT(all, 500U) << seed;
}

TEST_F(PaintTest, BytesThatTheDetectorCounts) {
    expectWhatIsCounted(take(makeBuiltinVolume("head:48")), {0, 255});
}

TEST_F(PaintTest, FloatsThatTheDetectorCounts) {
    expectWhatIsCounted(waves(), {0, 1});
}

TEST_F(PaintTest, SmoothAndLitMeshesToo) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    place(head, {0, 255});
    placeFlat();
    scene_.normals = &*normals_;
    scene_.lighting.mesh = true;
    scene_.lighting.specular = 0;
    for (const Mat4& pose : randomPoses(head.grid, kPoses, 0.2, random)) {
        scene_.world_from_object = pose;
        EXPECT_EQ(pixelsThat(picture(), [](int red, int, int) { return red > 0; }), survivors()) << seed;
    }
}

TEST_F(PaintTest, SurvivorsAreGrayByTheirOpacity) {
    // The value rises along x from 0 to 1, and so does the opacity.
    place(makeVolume<float>(unitGrid(100, 2, 2), ScalarType::Float32,
                            [](std::uint32_t x, std::uint32_t, std::uint32_t) { return (x + 0.5) / 100; }),
          {0, 1});
    placeMesh(makeFlat(0, 1, 0, 1, 0.5));
    scene_.clip_from_world = flatView(0, 1, kPaintExtent.width, kPaintExtent.height).clip_from_world;
    scene_.paint.what = Paint::Discarded;
    const Picture decided = picture();
    constexpr double kDarkest = 0.25;
    for (std::size_t x = 2; x + 2 < kPaintExtent.width; ++x) {
        const double opacity = (static_cast<double>(x) + 0.5) / kPaintExtent.width;
        if (std::abs(opacity - kPaintThreshold) < 0.01) {
            continue;
        }
        const double gray = kDarkest + (1 - kDarkest) * (opacity - kPaintThreshold) / (1 - kPaintThreshold);
        const std::size_t pixel = kPaintExtent.width * (kPaintExtent.height / 2) + x;
        EXPECT_NEAR(channel(decided, pixel, 0), opacity > kPaintThreshold ? 255 * gray : 0, 2) << x;
        EXPECT_NEAR(channel(decided, pixel, 2), opacity > kPaintThreshold ? 255 * gray : 255, 2) << x;
    }
}

TEST_F(PaintTest, ThroughTheVolume) {
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    place(head, {0, 255}, 0.05);
    placeFlat();
    scene_.world_from_object = translation(middleOf(head.grid));
    scene_.paint.threshold = 0; // all in the volume survives
    scene_.paint.through = 0;
    const Picture behind = picture();
    scene_.paint.through = 0.5;
    const Picture half = picture();
    scene_.paint.through = 1;
    const Picture bare = picture();
    scene_.paint.what = Paint::Plain;
    const std::uint64_t counted = survivors(0);
    EXPECT_GT(counted, 500U);
    EXPECT_EQ(pixelsOf(bare, kContactColour), counted);
    EXPECT_EQ(pixelsOf(behind, kContactColour), 0U);
    for (std::size_t i = 0; i < half.rgba.size(); ++i) {
        EXPECT_NEAR(half.rgba[i], (behind.rgba[i] + bare.rgba[i]) / 2.0, 1);
    }
    // At its own depth: as a mesh that is not painted.
    scene_.meshColour = kContactColour;
    const Picture plain = picture();
    for (std::size_t pixel = 0; pixel < plain.rgba.size() / 4; ++pixel) {
        if (channel(bare, pixel, 0) == 255 && channel(bare, pixel, 1) == 0) {
            EXPECT_EQ(channel(plain, pixel, 1), channel(behind, pixel, 1));
        }
    }
}

TEST_F(PaintTest, WhatDoesNotTouchIsPlain) {
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    place(head, {0, 255}, 0.05);
    placeMesh(take(makeEllipsoid(500)));
    scene_.world_from_object = translation(middleOf(head.grid));
    scene_.lighting = {};
    scene_.paint.threshold = 1;
    for (const MeshNormals* normals : {static_cast<const MeshNormals*>(nullptr), &std::as_const(*normals_)}) {
        scene_.normals = normals;
        scene_.paint.what = Paint::Plain;
        const Picture plain = picture();
        scene_.paint.what = Paint::Contacts;
        EXPECT_EQ(picture().rgba, plain.rgba);
        const PaintedTriangles none = take(PaintedTriangles::upload(renderer(), queue(), 500, {}));
        scene_.paint.what = Paint::Triangles;
        scene_.paint.triangles = &none;
        EXPECT_EQ(picture().rgba, plain.rgba);
    }
}

/// A triangle in each of `side` x `side` cells of the unit square: its corners are three of the cell's.
MeshData loneTriangles(std::uint32_t side) {
    MeshData mesh;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1)}) {
                mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size() / 3));
                mesh.positions.push_back(static_cast<float>(x + static_cast<unsigned>(dx)) / static_cast<float>(side));
                mesh.positions.push_back(static_cast<float>(y + static_cast<unsigned>(dy)) / static_cast<float>(side));
                mesh.positions.push_back(0.5F);
            }
        }
    }
    return mesh;
}

TEST_F(PaintTest, ChosenTriangles) {
    constexpr std::uint32_t kSide = 10;
    constexpr VkExtent2D kCells{8 * kSide, 8 * kSide};
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    place(makeBytes(unitGrid(4), [](auto...) { return 0.0; }), {0, 255});
    placeMesh(loneTriangles(kSide));
    scene_.clip_from_world = flatView(0, 1, kCells.width, kCells.height).clip_from_world;
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t triangle = 0; triangle < kSide * kSide; ++triangle) {
        if (random() % 3 == 0) {
            chosen.push_back(triangle);
        }
    }
    const PaintedTriangles painted = take(PaintedTriangles::upload(renderer(), queue(), kSide * kSide, chosen));
    scene_.paint = {.what = Paint::Triangles, .triangles = &painted, .contactColour = kContactColour};
    for (const MeshNormals* normals : {static_cast<const MeshNormals*>(nullptr), &std::as_const(*normals_)}) {
        scene_.normals = normals;
        const Picture seen = take(blocking().render(scene_, kCells));
        for (std::uint32_t triangle = 0; triangle < kSide * kSide; ++triangle) {
            const std::uint32_t x = 8 * (triangle % kSide) + 2;
            const std::uint32_t y = 8 * (triangle / kSide) + 2;
            const bool red = channel(seen, kCells.width * y + x, 0) == 255;
            EXPECT_EQ(red, std::ranges::find(chosen, triangle) != chosen.end()) << triangle << ", seed " << seed;
            EXPECT_EQ(channel(seen, kCells.width * y + x, 1), red ? 0 : 255) << triangle << ", seed " << seed;
        }
    }
}

TEST_F(PaintTest, TrianglesFromADetectorInTheSameCommandBuffer) {
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const MeshData ellipsoid = take(makeEllipsoid(2000));
    place(head, {0, 255});
    placeMesh(ellipsoid);
    // On the head's rim.
    scene_.world_from_object = translation(transformPoint(worldFromTexture(head.grid), {0.2, 0.5, 0.5}));
    const AnyDesc desc{.method = CountingMethod::Query, .outputs = {.triangles = true}};
    const Detector detector = take(Detector::create(context(), desc));
    Results results = take(Results::create(detector, {.room = {.triangles = scene_.mesh->triangles()}}));
    const PaintedTriangles painted = take(PaintedTriangles::wrap(renderer(), results.triangleMask()));
    const BatchItem item{scene_.mesh, scene_.volume, scene_.paint.transferFunction, {&scene_.world_from_object, 1}};
    const Batch batch{{&item, 1}, {scene_.clip_from_world, 400, 400}, kPaintThreshold};
    OwnImage image(gpu().device, kPaintExtent);
    RenderTargets targets = take(RenderTargets::create(renderer(), kPaintExtent));
    scene_.paint.what = Paint::Triangles;
    scene_.paint.triangles = &painted;
    const VkCommandBuffer commands = image.raw.begin();
    take(detector.cmdDetect(commands, batch, results));
    take(results.cmdReadBack(commands));
    take(renderer().cmdRender(commands, scene_, image.target(targets)));
    const std::uint8_t* pixels = image.cmdCopy(commands);
    image.raw.submitAndWait(commands);

    BatchAnswer answer;
    take(results.readOutputs(answer));
    std::vector<std::uint32_t> touched;
    for (const TouchedTriangle& triangle : answer.triangles) {
        touched.push_back(triangle.triangle);
    }
    EXPECT_GT(touched.size(), 10U);
    EXPECT_LT(touched.size(), std::size_t{scene_.mesh->triangles()});
    const PaintedTriangles again =
        take(PaintedTriangles::upload(renderer(), queue(), scene_.mesh->triangles(), touched));
    scene_.paint.triangles = &again;
    const Picture expected = picture();
    EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + image.bytes()), expected.rgba);
    EXPECT_GT(pixelsOf(expected, kContactColour), 10U);
    EXPECT_GT(pixelsOf(expected, kMeshColour), 10U);
}

class PaintRefusalTest : public PaintTest {
  protected:
    void SetUp() override {
        PaintTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure()) {
            place(waves(), {0, 1});
            placeFlat();
        }
    }
    template <class Change> void refused(const std::string& text, Change change) {
        Scene scene = scene_;
        change(scene);
        const Result<Picture> made = blocking().render(scene, kPaintExtent);
        ASSERT_FALSE(made.ok()) << text;
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(made.error().text, HasSubstr(text));
    }
};

TEST_F(PaintRefusalTest, Paints) {
    take(blocking().render(scene_, kPaintExtent));
    const Context other = take(Context::create(gpu().device.contextDesc()));
    const Renderer otherRenderer = take(Renderer::create(other));
    const ControlPoint ramp[] = {{0, 0}, {1, 1}};
    const TransferFunction foreign = take(TransferFunction::upload(other, queue(), {ramp, {0, 1}}));
    const PaintedTriangles foreignTriangles = take(PaintedTriangles::upload(otherRenderer, queue(), 2, {}));
    const std::array<std::uint32_t, 1> first{0};
    const PaintedTriangles few = take(PaintedTriangles::upload(renderer(), queue(), 32, first));
    const Mesh many = upload(take(makeEllipsoid(200)));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused("without a mesh", [](Scene& s) { s.mesh = nullptr; });
    refused("no transfer function", [](Scene& s) { s.paint.transferFunction = nullptr; });
    refused("transfer function of another Context", [&](Scene& s) { s.paint.transferFunction = &foreign; });
    refused("the threshold nan", [&](Scene& s) { s.paint.threshold = nan; });
    refused("the threshold 1.5", [](Scene& s) { s.paint.threshold = 1.5; });
    refused("seen through the volume nan", [&](Scene& s) { s.paint.through = nan; });
    refused("seen through the volume -0.1", [](Scene& s) { s.paint.through = -0.1; });
    refused("the colour of contacts", [](Scene& s) { s.paint.contactColour[1] = 2; });
    refused("the colour of discarded", [&](Scene& s) { s.paint.discardedColour[2] = nan; });
    refused("no triangles to paint", [](Scene& s) { s.paint.what = Paint::Triangles; });
    refused("triangles of another Context", [&](Scene& s) {
        s.paint.what = Paint::Triangles;
        s.paint.triangles = &foreignTriangles;
    });
    refused("bits for 32 triangles, the mesh has " + std::to_string(many.triangles()), [&](Scene& s) {
        s.paint.what = Paint::Triangles;
        s.paint.triangles = &few;
        s.mesh = &many;
    });
}

TEST_F(PaintRefusalTest, TrianglesThatCannotBe) {
    const std::array<std::uint32_t, 2> beyond{3, 7};
    const auto text = [](const Result<PaintedTriangles>& made) { return made.ok() ? "" : made.error().text; };
    EXPECT_THAT(text(PaintedTriangles::create(renderer(), 7, beyond)),
                HasSubstr("triangle 7 is to be painted, the mesh has 7"));
    EXPECT_THAT(text(PaintedTriangles::create(renderer(), 0, {})), HasSubstr("without triangles"));
    EXPECT_THAT(text(PaintedTriangles::wrap(renderer(), {})), HasSubstr("null buffer"));
    const Detector detector = take(Detector::raster(context(), {.outputs = {.triangles = true}}));
    const Results results = take(Results::create(detector, {.room = {.triangles = 1000}}));
    BufferRange mask = results.triangleMask();
    mask.offset += 4;
    EXPECT_THAT(text(PaintedTriangles::wrap(renderer(), mask)), HasSubstr("no multiple of 256"));
    mask.size = 3;
    EXPECT_THAT(text(PaintedTriangles::wrap(renderer(), mask)), HasSubstr("fewer bytes"));
    PaintedTriangles wrapped = take(PaintedTriangles::wrap(renderer(), results.triangleMask()));
    RawVulkan raw(gpu().device);
    const VkCommandBuffer commands = raw.begin();
    EXPECT_EQ(wrapped.cmdUpload(commands).error().code, ErrorCode::NotReady);
    raw.submitAndWait(commands);
}

TEST_F(PaintRefusalTest, WithoutGeometryShader) {
    const auto devices = take(gpu().instance.devices());
    const auto chosen = take(device::chooseDevice(devices, {}));
    const auto adjust = [](FeatureRequest& request) { request.features2.features.geometryShader = VK_FALSE; };
    const device::VulkanDevice device =
        take(device::VulkanDevice::create(gpu().instance, chosen, {.adjustFeatures = adjust}));
    const Context context = take(Context::create(device.contextDesc()));
    const Renderer renderer = take(Renderer::create(context));
    const Result<PaintedTriangles> painted = PaintedTriangles::create(renderer, 7, {});
    ASSERT_FALSE(painted.ok());
    EXPECT_EQ(painted.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(painted.error().text, HasSubstr("geometryShader"));
}

} // namespace
} // namespace voxtact::test
