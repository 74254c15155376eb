// SPDX-License-Identifier: MIT
// Pictures against a ray caster on the host.
#include "render_fixture.h"
#include "render_reference.h"
#include "support/scenes.h"
#include "voxtact/builtin.h"

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kWidth = 56;
constexpr std::uint32_t kHeight = 48;
constexpr VkExtent2D kExtent{kWidth, kHeight};
// Errors in 8-bit steps: rounding alone is up to 0.5, and 0.25 in the mean of arbitrary colours.
constexpr double kMean = 0.6;
constexpr double kMost = 2;
constexpr ControlPoint kOpacity[] = {{0, 0}, {0.3, 0}, {0.6, 0.08}, {1, 0.3}};
constexpr ColourPoint kColours[] = {{0, {0.2, 0.1, 0.9}}, {0.6, {0.9, 0.2, 0.1}}, {1, {0.9, 0.9, 0.4}}};

/// An eye at `from` that looks at `to`. Without `farPlane` it is at infinity.
Mat4 perspective(const Vec3& from, const Vec3& to, double nearPlane, std::optional<double> farPlane) {
    Vec3 forward{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double length = std::hypot(forward[0], forward[1], forward[2]);
    for (double& x : forward) {
        x /= length;
    }
    const double flat = std::hypot(forward[0], forward[1]);
    const Vec3 right{-forward[1] / flat, forward[0] / flat, 0};
    const Vec3 down{forward[1] * right[2] - forward[2] * right[1], forward[2] * right[0] - forward[0] * right[2],
                    forward[0] * right[1] - forward[1] * right[0]};
    Mat4 eye_from_world = identity();
    const Vec3 axes[] = {right, down, forward};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t c = 0; c < 3; ++c) {
            eye_from_world[4 * c + row] = axes[row][c];
        }
        eye_from_world[12 + row] = -(axes[row][0] * from[0] + axes[row][1] * from[1] + axes[row][2] * from[2]);
    }
    constexpr double kZoom = 1.6;
    Mat4 clip_from_eye{};
    clip_from_eye[0] = kZoom * kHeight / kWidth;
    clip_from_eye[5] = kZoom;
    clip_from_eye[10] = farPlane ? *farPlane / (*farPlane - nearPlane) : 1;
    clip_from_eye[11] = 1;
    clip_from_eye[14] = -nearPlane * clip_from_eye[10];
    return multiply(clip_from_eye, eye_from_world);
}

/// Depth 0 for depth 1.
Mat4 reversed(const Mat4& clip_from_world) {
    return multiply({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1}, clip_from_world);
}

/// A smooth blob of floats, 0..1, on a grid whose voxels are far from cubes.
VolumeData blob() {
    Grid grid;
    grid.size = {24, 12, 10};
    grid.spacing = {0.5, 1.2, 1.6};
    const auto at = [&](std::size_t axis, double i) { return (i + 0.5) / grid.size[axis] - 0.5; };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = -(grid.size[axis] - 1.0) / 2 * grid.spacing[axis];
    }
    return makeVolume<float>(grid, ScalarType::Float32, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const Vec3 p{at(0, x), at(1, y), at(2, z)};
        return std::clamp(1.1 - 2.2 * std::hypot(p[0] + 0.1, 1.2 * p[1], p[2]) + 0.1 * std::sin(9 * p[0]), 0.0, 1.0);
    });
}

class RenderTest : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        const std::uint64_t seed = testSeed();
        std::mt19937_64 random(seed);
        world_from_straight_ = randomMotion(random);
        scene_.volume = &volume_;
        scene_.function.opacity = {kOpacity, {0, 1}, 256};
        scene_.function.colours = kColours;
        scene_.function.opacityUnit = 1;
        scene_.function.step = 0.02;
        scene_.background = {0.1, 0.3, 0.2};
        scene_.meshColour = {0.9, 0.8, 0.1};
        place(blob());
    }

    /// The volume, turned with its world.
    void place(const VolumeData& straight) { volume_ = moved(straight, world_from_straight_); }
    [[nodiscard]] Vec3 world(const Vec3& straight) const { return transformPoint(world_from_straight_, straight); }
    /// An eye in the space before the world was turned.
    void look(const Vec3& from, const Vec3& to, double nearPlane = 0.1, double farPlane = 60) {
        scene_.clip_from_world = perspective(world(from), world(to), nearPlane, farPlane);
    }

    /// The same scene by the device, a step of `step` mm.
    Picture picture(double step, bool bricks = false, bool jitter = false) {
        const Volume volume = take(Volume::upload(context(), queue(), volume_.view(), {.bricks = bricks}));
        RenderTransferFunctionDesc desc = scene_.function;
        desc.step = step;
        const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), desc));
        std::optional<RenderBricks> skipped;
        std::optional<Mesh> mesh;
        Scene scene;
        scene.volume = &volume;
        scene.transferFunction = &function;
        if (bricks) {
            scene.bricks = &skipped.emplace(take(RenderBricks::create(renderer(), volume)));
        }
        if (scene_.mesh != nullptr) {
            scene.mesh = &mesh.emplace(upload(*scene_.mesh));
        }
        scene.world_from_object = scene_.world_from_object;
        scene.meshColour = scene_.meshColour;
        scene.clip_from_world = scene_.clip_from_world;
        scene.background = scene_.background;
        scene.lighting = scene_.lighting;
        scene.jitter = jitter;
        return take(blocking().render(scene, kExtent));
    }
    [[nodiscard]] ReferencePicture reference() const { return castReference(scene_, kWidth, kHeight); }

    /// `mean` and `most`: what the errors may be, in 8-bit steps.
    void expectSame(const Picture& picture, double mean, double most, double edge = 2) {
        const PictureError error = compare(picture, reference(), edge);
        EXPECT_LE(255 * error.mean, mean);
        EXPECT_LE(255 * error.most, most);
    }

    ReferenceScene scene_;
    VolumeData volume_;

  private:
    Mat4 world_from_straight_{};
};

constexpr Vec3 kSides[] = {{25, 1, 2}, {-25, 2, 1}, {1, 26, -2}, {2, -26, 1}, {1, 2, 27}, {3, 1, -28}};

TEST_F(RenderTest, ObliqueVolumeFromEverySide) {
    for (const Vec3& side : kSides) {
        look(side, {0, 0, 0});
        expectSame(picture(0.25), kMean, kMost);
    }
}

TEST_F(RenderTest, OrthographicCamera) {
    scene_.clip_from_world = framingCamera(volume_.grid, kWidth, kHeight);
    expectSame(picture(0.25), kMean, kMost);
    expectSame(picture(0.25, false, true), kMean, kMost);
}

TEST_F(RenderTest, EyeInsideTheVolume) {
    for (const Vec3& to : kSides) {
        look({0.4, -0.3, 0.2}, to, 0.05);
        expectSame(picture(0.2), kMean, kMost);
    }
}

TEST_F(RenderTest, NearAndFarPlanesCutTheVolume) {
    look({25, 1, 2}, {0, 0, 0}, 24, 27);
    const Picture cut = picture(0.25);
    expectSame(cut, kMean, kMost);
    look({25, 1, 2}, {0, 0, 0});
    EXPECT_NE(cut.rgba, picture(0.25).rgba);
}

TEST_F(RenderTest, MeshInsideIsAtItsDepthFromEverySide) {
    const MeshData cube = makeCube(-1.6, 1.6);
    scene_.mesh = &cube;
    std::mt19937_64 random(testSeed());
    for (const Vec3& side : kSides) {
        look(side, {0, 0, 0});
        scene_.world_from_object = multiply(translation(world({0.7, -0.4, 0.9})), randomRotation(random));
        // Pixels on the cube's silhouette may be the cube's or not.
        expectSame(picture(0.25), kMean, kMost, 0.06);
        // The cube does show.
        const ReferencePicture with = reference();
        scene_.mesh = nullptr;
        EXPECT_GT(255 * compare(picture(0.25), with, 0.06).most, 20);
        scene_.mesh = &cube;
    }
}

TEST_F(RenderTest, MeshBeforeBehindAndBesideTheVolume) {
    const MeshData cube = makeCube(-1.6, 1.6);
    scene_.mesh = &cube;
    look({25, 1, 2}, {0, 0, 0});
    for (const Vec3& place : {Vec3{15, 1, 1}, Vec3{-12, 0, 0}, Vec3{0, 8, 0}}) {
        scene_.world_from_object = translation(world(place));
        expectSame(picture(0.25), kMean, kMost, 0.06);
    }
}

TEST_F(RenderTest, LitByTheGradient) {
    scene_.lighting.volume = true;
    look({20, 12, 9}, {0, 0, 0});
    expectSame(picture(0.1), kMean, kMost);
}

TEST_F(RenderTest, BytesAreFilteredAsFloatsAre) {
    VolumeData bytes = makeBytes(blob().grid, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return std::floor(127 + 120 * std::sin(0.3 * x) * std::cos(0.4 * y) * std::sin(0.5 * z + 1));
    });
    place(bytes);
    constexpr ControlPoint kBytes[] = {{60, 0}, {255, 0.3}};
    scene_.function.opacity = {kBytes, {0, 255}, 256};
    look({20, 12, 9}, {0, 0, 0});
    // Samplers may filter bytes with 8-bit weights and results.
    expectSame(picture(0.25), 2, 12);
}

TEST_F(RenderTest, ReversedDepthAndFarPlaneAtInfinity) {
    const MeshData cube = makeCube(-1.6, 1.6);
    scene_.mesh = &cube;
    scene_.world_from_object = translation(world({1, 0, 0}));
    const Vec3 from = world({20, 12, 9});
    const Vec3 to = world({0, 0, 0});
    scene_.clip_from_world = perspective(from, to, 0.1, 1e3);
    const ReferencePicture expected = reference();
    const Mat4 infinite = perspective(from, to, 0.1, std::nullopt);
    for (const Mat4& camera : {reversed(scene_.clip_from_world), infinite, reversed(infinite)}) {
        scene_.clip_from_world = camera;
        const PictureError error = compare(picture(0.25), expected, 0.06);
        EXPECT_LE(255 * error.mean, kMean);
        EXPECT_LE(255 * error.most, kMost);
    }
}

TEST_F(RenderTest, ThinShellNeedsPreIntegration) {
    // A shell of three entries: a step crosses it more often than a sample meets it.
    constexpr ControlPoint kShell[] = {{0.49, 0}, {0.495, 0.9}, {0.505, 0.9}, {0.51, 0}};
    scene_.function.opacity = {kShell, {0, 1}, 256};
    scene_.function.opacityUnit = 0.05;
    scene_.function.step = 0.002;
    look({9, 1, 2}, {0, 0, 0});
    const ReferencePicture exact = reference();
    constexpr double kStep = 0.6;
    const PictureError integrated = compare(picture(kStep), exact);
    scene_.function.step = kStep;
    const ReferencePicture sampled = reference();
    Picture plain{kWidth, kHeight, {}};
    for (const Colour& colour : sampled) {
        for (const double channel : colour) {
            plain.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0, 1.0))));
        }
        plain.rgba.push_back(255);
    }
    const PictureError banded = compare(plain, exact);
    EXPECT_LT(255 * integrated.mean, 4);
    EXPECT_GT(banded.mean, 5 * integrated.mean);
    EXPECT_GT(255 * banded.most, 60);
}

TEST_F(RenderTest, SkippedBricksAreNotMissed) {
    // Mostly empty, of many bricks.
    Grid grid = unitGrid(70, 33, 41);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] *= 12;
        grid.origin[axis] = grid.origin[axis] * 12 - 6;
    }
    place(makeBytes(grid, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (x / 9 + y / 7 + z / 11) % 5 == 0 && x % 9 > 3 ? 200.0 : 10.0;
    }));
    constexpr ControlPoint kBytes[] = {{20, 0}, {255, 0.5}};
    scene_.function.opacity = {kBytes, {0, 255}, 256};
    for (const Vec3& side : kSides) {
        look(side, {0, 0, 0});
        const Picture all = picture(0.1, false, true);
        const Picture skipped = picture(0.1, true, true);
        // Distances are added in another order.
        std::size_t differing = 0;
        for (std::size_t i = 0; i < all.rgba.size(); ++i) {
            const int off = std::abs(all.rgba[i] - skipped.rgba[i]);
            EXPECT_LE(off, 2);
            differing += off > 0 ? 1U : 0U;
        }
        EXPECT_LT(differing, all.rgba.size() / 10);
    }
}

TEST_F(RenderTest, JitterIsTheSameEveryTime) {
    look({25, 1, 2}, {0, 0, 0});
    const Picture first = picture(1, false, true);
    EXPECT_EQ(first.rgba, picture(1, false, true).rgba);
    EXPECT_NE(first.rgba, picture(1).rgba);
}

TEST_F(RenderTest, NothingOpaqueIsTheBackground) {
    constexpr ControlPoint kNothing[] = {{0, 0}};
    scene_.function.opacity = {kNothing, {0, 1}, 256};
    look({25, 1, 2}, {0, 0, 0});
    const Picture empty = picture(0.25);
    for (std::size_t i = 0; i < empty.rgba.size(); ++i) {
        constexpr std::uint8_t kBackground[] = {26, 77, 51, 255};
        EXPECT_NEAR(empty.rgba[i], kBackground[i % 4], 1);
    }
}

/// The largest step of red between neighbours in a row where a white mesh faces the eye.
int largestStep(const Picture& picture) {
    constexpr int kFacing = 190;
    int most = 0;
    for (std::size_t i = 4; i < picture.rgba.size(); i += 4) {
        if (i / 4 % picture.width != 0 && picture.rgba[i] > kFacing && picture.rgba[i - 4] > kFacing) {
            most = std::max(most, std::abs(picture.rgba[i] - picture.rgba[i - 4]));
        }
    }
    return most;
}

TEST_F(RenderTest, NormalsMakeAMeshSmooth) {
    const MeshData ellipsoid = take(makeBuiltinMesh("ellipsoid:500"));
    const Mesh mesh = upload(ellipsoid);
    const MeshNormals normals = take(MeshNormals::upload(renderer(), queue(), ellipsoid.view()));
    const Volume volume = upload(volume_);
    constexpr ControlPoint kNothing[] = {{0, 0}};
    scene_.function.opacity = {kNothing, {0, 1}, 256};
    const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), scene_.function));
    const Box box = take(checkMesh(ellipsoid.view())).bounds;
    const double size = std::hypot(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
    look({1.5 * size, 0.2 * size, 0.1 * size}, {0, 0, 0}, 0.1 * size, 4 * size);
    Scene scene;
    scene.volume = &volume;
    scene.transferFunction = &function;
    scene.mesh = &mesh;
    scene.world_from_object = translation(world({0, 0, 0}));
    scene.meshColour = {1, 1, 1};
    scene.background = {0, 0, 1};
    scene.lighting.specular = 0;
    scene.clip_from_world = scene_.clip_from_world;
    const int flat = largestStep(take(blocking().render(scene, {8 * kWidth, 8 * kHeight})));
    scene.normals = &normals;
    const int smooth = largestStep(take(blocking().render(scene, {8 * kWidth, 8 * kHeight})));
    EXPECT_GT(smooth, 0);
    EXPECT_GT(flat, 2 * smooth);
}

class RenderRefusalTest : public RenderTest {
  protected:
    void refused(const Scene& scene, const char* text, VkExtent2D extent = kExtent) {
        const Result<Picture> picture = blocking().render(scene, extent);
        ASSERT_FALSE(picture.ok()) << text;
        EXPECT_THAT(picture.error().text, HasSubstr(text));
    }
    void refusedFunction(const RenderTransferFunctionDesc& desc, const char* text) {
        const Result<RenderTransferFunction> made = RenderTransferFunction::create(renderer(), desc);
        ASSERT_FALSE(made.ok()) << text;
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(made.error().text, HasSubstr(text));
    }
};

TEST_F(RenderRefusalTest, Scenes) {
    const Volume volume = upload(volume_);
    const Volume other = take(Volume::upload(context(), queue(), volume_.view(), {.bricks = true}));
    const RenderBricks bricks = take(RenderBricks::create(renderer(), other));
    RenderTransferFunctionDesc desc = scene_.function;
    const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), desc));
    desc.step = 1e-6;
    const RenderTransferFunction fine = take(RenderTransferFunction::upload(renderer(), queue(), desc));
    const MeshData cube = makeCube(0, 1);
    const Mesh mesh = upload(cube);
    const MeshNormals normals = take(MeshNormals::upload(renderer(), queue(), makeFlat(0, 1, 0, 1, 0).view()));
    look({25, 1, 2}, {0, 0, 0});
    Scene good;
    good.volume = &volume;
    good.transferFunction = &function;
    good.clip_from_world = scene_.clip_from_world;
    take(blocking().render(good, kExtent));
    const auto with = [&](const auto& change) {
        Scene scene = good;
        change(scene);
        return scene;
    };
    refused(with([](Scene& s) { s.volume = nullptr; }), "null");
    refused(with([](Scene& s) { s.transferFunction = nullptr; }), "null");
    refused(with([](Scene& s) { s.clip_from_world = {}; }), "clip_from_world");
    refused(with([](Scene& s) { s.clip_from_world[0] = std::nan(""); }), "clip_from_world");
    refused(with([](Scene& s) { s.background[1] = 1.5; }), "background");
    refused(with([](Scene& s) { s.meshColour[0] = std::nan(""); }), "mesh's colour");
    refused(with([](Scene& s) { s.lighting.shininess = -1; }), "lighting");
    refused(with([&](Scene& s) { s.bricks = &bricks; }), "Scene::bricks");
    refused(with([&](Scene& s) { s.normals = &normals; }), "without a mesh");
    refused(with([&](Scene& s) { s.transferFunction = &fine; }), "65536 samples");
    refused(with([&](Scene& s) {
                s.mesh = &mesh;
                s.normals = &normals;
            }),
            "not of Scene::mesh");
    refused(with([&](Scene& s) {
                s.mesh = &mesh;
                s.world_from_object[0] = s.world_from_object[5] = 0;
            }),
            "pose");
    refused(good, "at least one pixel", {0, 5});
    refused(good, "limit", {1U << 20U, 5});
}

TEST_F(RenderRefusalTest, Objects) {
    const auto with = [&](const auto& change) {
        RenderTransferFunctionDesc desc = scene_.function;
        change(desc);
        return desc;
    };
    constexpr ColourPoint kBright[] = {{0, {0, 2, 0}}};
    constexpr ColourPoint kDescending[] = {{1, {0, 0, 0}}, {0, {0, 0, 0}}};
    refusedFunction(with([](auto& d) { d.step = 0; }), "the step");
    refusedFunction(with([](auto& d) { d.opacityUnit = -1; }), "opacity unit");
    refusedFunction(with([](auto& d) { d.opacity.tableSize = 1025; }), "1024");
    refusedFunction(with([](auto& d) { d.opacity.tableSize = 1; }), "at least 2");
    refusedFunction(with([](auto& d) { d.opacity.points = {}; }), "no control points");
    refusedFunction(with([&](auto& d) { d.colours = kBright; }), "outside [0, 1]");
    refusedFunction(with([&](auto& d) { d.colours = kDescending; }), "colours");
    const Volume volume = upload(volume_);
    EXPECT_THAT(RenderBricks::create(renderer(), volume).error().text, HasSubstr("no bricks"));
    EXPECT_THAT(MeshNormals::create(renderer(), {}).error().text, HasSubstr("no triangle"));
    const Result<Renderer> none = Renderer::create(context(), {VK_FORMAT_UNDEFINED});
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().code, ErrorCode::Unsupported);
}

} // namespace
} // namespace voxtact::test
