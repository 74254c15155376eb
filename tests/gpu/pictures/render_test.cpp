// SPDX-License-Identifier: MIT
// Pictures against a ray caster on the host.
#include "render_scene.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <cmath>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

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
    constexpr ControlPoint kFunction[] = {{60, 0}, {255, 0.3}};
    scene_.function.opacity = {kFunction, {0, 255}, 256};
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
    constexpr ControlPoint kFunction[] = {{20, 0}, {255, 0.5}};
    scene_.function.opacity = {kFunction, {0, 255}, 256};
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
    refused(with([](Scene& s) { s.lighting.specular = 1e38; }), "outside [0, 1e+06]");
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
    refusedFunction(with([](auto& d) { d.opacityUnit = 1e-40; }), "single precision");
    refusedFunction(with([](auto& d) { d.opacity.tableSize = 1025; }), "1024");
    refusedFunction(with([](auto& d) { d.opacity.tableSize = 1; }), "at least 2");
    refusedFunction(with([](auto& d) { d.opacity.points = {}; }), "no control points");
    refusedFunction(with([&](auto& d) { d.colours = kBright; }), "outside [0, 1]");
    refusedFunction(with([&](auto& d) { d.colours = kDescending; }), "colours");
    const Volume volume = upload(volume_);
    EXPECT_THAT(RenderBricks::create(renderer(), volume).error().text, HasSubstr("no bricks"));
    EXPECT_THAT(MeshNormals::create(renderer(), {}).error().text, HasSubstr("no triangle"));
    for (const VkFormat format : {VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT, VK_FORMAT_R8_UINT, VK_FORMAT_R8G8B8A8_SINT,
                                  VK_FORMAT_R32_UINT, VK_FORMAT_A2B10G10R10_UINT_PACK32}) {
        const Result<Renderer> none = Renderer::create(context(), {format});
        ASSERT_FALSE(none.ok()) << format;
        EXPECT_EQ(none.error().code, ErrorCode::Unsupported);
    }
    for (const VkFormat format :
         {VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
        EXPECT_TRUE(Renderer::create(context(), {format}).ok()) << format;
    }
}

} // namespace
} // namespace voxtact::test
