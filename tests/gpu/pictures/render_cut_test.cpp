// SPDX-License-Identifier: MIT
// Clipping planes, the faces that they cut, light from the side, what is shut in, several meshes, and pictures in
// pieces: against the ray caster on the host, and where the pixels are known beforehand.
#include "own_image.h"
#include "render_scene.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Of a picture whose light changes within a step: 8-bit steps.
constexpr double kMostLit = 6;

class RenderCutTest : public RenderTest {
  protected:
    /// Through a point of the space before the world was turned.
    [[nodiscard]] ClipPlane planeThrough(const Vec3& straight, const Vec3& straightNormal) const {
        const Vec3 at = world(straight);
        const Vec3 end =
            world({straight[0] + straightNormal[0], straight[1] + straightNormal[1], straight[2] + straightNormal[2]});
        const Vec3 normal{end[0] - at[0], end[1] - at[1], end[2] - at[2]};
        return {normal, normal[0] * at[0] + normal[1] * at[1] + normal[2] * at[2]};
    }
    /// Opaque from its border on: every side of it is a cut.
    void placeOpaque() {
        scene_.function.opacity = {kAll, {0, 1}, 256};
        scene_.function.opacityUnit = 1;
    }
    /// A volume alone, from where look() was told last. Both outlive it.
    [[nodiscard]] Scene seen(const Volume& volume, const RenderTransferFunction& function) const {
        Scene scene;
        scene.volume = &volume;
        scene.transferFunction = &function;
        scene.clip_from_world = scene_.clip_from_world;
        return scene;
    }

    static constexpr ControlPoint kAll[] = {{0, 0.3}, {1, 0.6}};
};

TEST_F(RenderCutTest, AClippingPlaneCutsTheVolumeFromEverySide) {
    scene_.clipPlanes = {planeThrough({0.3, 0.2, -0.1}, {2, 1, -0.5})};
    for (const Vec3& side : kSides) {
        look(side, {0, 0, 0});
        expectSame(picture(0.25), kMean, kMost, 0.06);
    }
    // It does cut, and what is left from both sides of it is all.
    look(kSides[0], {0, 0, 0});
    const Picture cut = picture(0.25);
    scene_.clipPlanes.clear();
    EXPECT_NE(cut.rgba, picture(0.25).rgba);
}

TEST_F(RenderCutTest, SeveralPlanesLeaveWhatNoneTakesAway) {
    scene_.clipPlanes = {planeThrough({0.3, 0.2, -0.1}, {2, 1, -0.5}), planeThrough({0, 0.5, 0}, {0, 3, 1}),
                         planeThrough({0, 0, -2}, {0.1, 0, -1})};
    for (const Vec3& side : kSides) {
        look(side, {0, 0, 0});
        expectSame(picture(0.25), kMean, kMost, 0.06);
    }
}

TEST_F(RenderCutTest, BricksThatAreSkippedAreClippedToo) {
    scene_.clipPlanes = {planeThrough({0.3, 0.2, -0.1}, {2, 1, -0.5})};
    scene_.lighting.volume = true;
    look(kSides[0], {0, 0, 0});
    expectSame(picture(0.1, true), kMean, kMostLit, 0.06);
}

TEST_F(RenderCutTest, NothingIsLeftOfWhatIsAllAway) {
    scene_.clipPlanes = {planeThrough({-30, 0, 0}, {1, 0, 0})};
    look(kSides[0], {0, 0, 0});
    const Picture empty = picture(0.25);
    for (std::size_t i = 0; i < empty.rgba.size(); ++i) {
        constexpr std::uint8_t kBackground[] = {26, 77, 51, 255};
        EXPECT_NEAR(empty.rgba[i], kBackground[i % 4], 1);
    }
}

TEST_F(RenderCutTest, FacesAreShadedWithTheirPlane) {
    placeOpaque();
    scene_.lighting.volume = true;
    scene_.lighting.side = 0.4;
    // The border of the volume, whose axes are not those of the world.
    look({20, 12, 9}, {0, 0, 0});
    expectSame(picture(0.05), kMean, kMostLit, 0.06);
    scene_.clipPlanes = {planeThrough({0.3, 0.2, -0.1}, {2, 1, 0.5})};
    expectSame(picture(0.05), kMean, kMostLit, 0.06);
    // The gradient there is another matter.
    const ReferencePicture faces = reference();
    scene_.lighting.faces = false;
    EXPECT_GT(255 * compare(picture(0.1), faces).most, 30);
    expectSame(picture(0.05), kMean, kMostLit, 0.06);
}

TEST_F(RenderCutTest, AnEyeInMatterSeesTheCutOfItsNearPlane) {
    placeOpaque();
    scene_.lighting.volume = true;
    look({0.4, -0.3, 0.2}, {20, 1, 2}, 0.05);
    expectSame(picture(0.1), kMean, kMost);
}

TEST_F(RenderCutTest, ACutThroughNoiseIsAsEvenAsItsPlane) {
    // Voxels of nothing but noise, all opaque: the cut faces the eye, and its light is that of the plane.
    Grid grid = unitGrid(24);
    std::mt19937_64 random(testSeed());
    std::uniform_real_distribution<double> noise(100, 200);
    const VolumeData data = makeBytes(grid, [&](auto...) { return std::floor(noise(random)); });
    const Volume volume = upload(data);
    constexpr ControlPoint kOpaque[] = {{0, 1}, {255, 1}};
    constexpr ColourPoint kGray[] = {{0, {0.5, 0.5, 0.5}}};
    const RenderTransferFunction function = take(RenderTransferFunction::upload(
        renderer(), queue(),
        {.opacity = {kOpaque, {0, 255}, 16}, .colours = kGray, .opacityUnit = 0.001, .step = 0.01}));
    const ClipPlane plane{{0, 0, -4}, -2}; // z < 0.5 is away; its length scales its offset
    Scene scene;
    scene.volume = &volume;
    scene.transferFunction = &function;
    scene.clip_from_world = flatView(0, 1, kWidth, kHeight).clip_from_world;
    scene.lighting = {.ambient = 0.3, .diffuse = 0.5, .specular = 1, .shininess = 2};
    const auto redRange = [&] {
        const Picture picture = take(blocking().render(scene, kExtent));
        int least = 255;
        int most = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
            least = std::min<int>(least, picture.rgba[i]);
            most = std::max<int>(most, picture.rgba[i]);
        }
        return std::pair(least, most);
    };
    for (const bool clipped : {true, false}) {
        scene.clipPlanes = clipped ? std::span(&plane, 1) : std::span<const ClipPlane>();
        scene.lighting.faces = true;
        // 0.5 (0.3 + 0.5), without gloss.
        const auto [least, most] = redRange();
        EXPECT_NEAR(least, 0.4 * 255, 2);
        EXPECT_NEAR(most, 0.4 * 255, 2);
        scene.lighting.faces = false;
        EXPECT_GT(redRange().second - redRange().first, 60);
    }
}

TEST_F(RenderCutTest, TheRimOfACutIsNoLine) {
    // Denser from left to right and from both faces inwards; at the faces visible in the right half alone. The slope
    // along y turns the surfaces within away from the eye.
    const Grid grid = unitGrid(24);
    const VolumeData data =
        makeVolume<float>(grid, ScalarType::Float32, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const double inwards = 12 - std::abs(z - 11.5);
            return 0.3 + 0.01 * (x - 11.5) + 0.05 * inwards + 0.05 * std::abs(y - 11.5);
        });
    const Volume volume = upload(data);
    constexpr ControlPoint kRamp[] = {{0, 0}, {0.42, 0}, {1, 0.9}};
    constexpr ColourPoint kGray[] = {{0, {1, 1, 1}}};
    const RenderTransferFunction function = take(RenderTransferFunction::upload(
        renderer(), queue(),
        {.opacity = {kRamp, {0, 1}, 256}, .colours = kGray, .opacityUnit = 1.0 / 24, .step = 0.002}));
    Scene scene;
    scene.volume = &volume;
    scene.transferFunction = &function;
    scene.clip_from_world = flatView(0, 1, kWidth, kHeight).clip_from_world;
    scene.lighting = {.ambient = 0, .diffuse = 1, .specular = 0};
    const Picture picture = take(blocking().render(scene, kExtent));
    const std::size_t row = std::size_t{4} * kWidth * (kHeight / 3);
    int jump = 0;
    for (std::size_t x = 4; x + 1 < kWidth - 4; ++x) {
        const std::size_t at = row + 4 * x;
        jump = std::max(jump, std::abs(picture.rgba[at + 4] - picture.rgba[at]));
    }
    EXPECT_LE(jump, 6);
}

TEST_F(RenderCutTest, LightFromTheSide) {
    scene_.lighting.volume = true;
    scene_.lighting.diffuse = 0.4;
    scene_.lighting.side = 0.6;
    for (const Vec3& from : {Vec3{-3, 2, 2}, Vec3{1, 0, 0.2}, Vec3{0, -5, 1}}) {
        scene_.lighting.sideFrom = from;
        look({20, 12, 9}, {0, 0, 0});
        expectSame(picture(0.1), kMean, kMost);
        scene_.clip_from_world = framingCamera(volume_.grid, kWidth, kHeight);
        expectSame(picture(0.1), kMean, kMost);
    }
}

TEST_F(RenderCutTest, LightFromTheSideWithReversedDepth) {
    scene_.lighting.volume = true;
    scene_.lighting.side = 0.6;
    look({20, 12, 9}, {0, 0, 0});
    const ReferencePicture expected = reference();
    const Mat4 infinite = perspective(world({20, 12, 9}), world({0, 0, 0}), 0.1, std::nullopt);
    for (const Mat4& camera : {reversed(scene_.clip_from_world), infinite, reversed(infinite)}) {
        scene_.clip_from_world = camera;
        const PictureError error = compare(picture(0.1), expected, 0.06);
        EXPECT_LE(255 * error.mean, kMean);
        EXPECT_LE(255 * error.most, kMost);
    }
}

TEST_F(RenderCutTest, WhatIsShutInIsDarker) {
    scene_.lighting.volume = true;
    look({20, 12, 9}, {0, 0, 0});
    const Picture open = picture(0.1);
    scene_.lighting.occlusion = 1;
    scene_.lighting.reach = 3;
    expectSame(picture(0.1), kMean, kMost);
    scene_.clipPlanes = {planeThrough({0.3, 0.2, -0.1}, {2, 1, 0.5})};
    expectSame(picture(0.1), kMean, kMostLit, 0.06);
    scene_.clipPlanes.clear();
    const Picture shut = picture(0.1);
    std::size_t darker = 0;
    for (std::size_t i = 0; i < open.rgba.size(); ++i) {
        EXPECT_LE(shut.rgba[i], open.rgba[i] + 1);
        darker += shut.rgba[i] + 5 < open.rgba[i] ? 1U : 0U;
    }
    EXPECT_GT(darker, 30U);
}

TEST_F(RenderCutTest, AMeshIsClippedWhereItIsAskedFor) {
    const MeshData cube = makeCube(-1.6, 1.6);
    scene_.mesh = &cube;
    scene_.world_from_object = translation(world({0.7, -0.4, 0.9}));
    scene_.clipPlanes = {planeThrough({0.9, 0.2, -0.1}, {2, 1, -0.5})};
    for (const bool clipped : {false, true}) {
        scene_.clippedMesh = clipped;
        for (const Vec3& side : kSides) {
            look(side, {0, 0, 0});
            expectSame(picture(0.25), kMean, kMost, 0.06);
        }
    }
}

/// The triangles of a mesh, elsewhere.
void append(MeshData& all, const MeshData& mesh, const Vec3& by) {
    const auto first = static_cast<std::uint32_t>(all.positions.size() / 3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        all.positions.push_back(static_cast<float>(mesh.positions[i] + by[i % 3]));
    }
    for (const std::uint32_t index : mesh.indices) {
        all.indices.push_back(first + index);
    }
}

TEST_F(RenderCutTest, ManyMeshesAreEachAtTheirPose) {
    // More than one group of them: 5 x 5 x 5 cubes, and one of its own.
    const MeshData cube = makeCube(-0.4, 0.4);
    const MeshData large = makeCube(-0.9, 0.9);
    const Volume volume = upload(volume_);
    const RenderTransferFunction function =
        take(RenderTransferFunction::upload(renderer(), queue(),
                                            {.opacity = scene_.function.opacity,
                                             .colours = scene_.function.colours,
                                             .opacityUnit = scene_.function.opacityUnit,
                                             .step = 0.25}));
    const Mesh small = upload(cube);
    const Mesh own = upload(large);
    std::vector<SceneMesh> others;
    MeshData all;
    append(all, large, world({0, 0, 0}));
    for (int i = 0; i < 125; ++i) {
        const std::array number{i % 5, i / 5 % 5, i / 25};
        const Vec3 at = world({-5.0 + 2.5 * number[0], -5.0 + 2.5 * number[1], -5.0 + 2.5 * number[2]});
        SceneMesh other;
        other.mesh = &small;
        other.world_from_object = translation(at);
        other.meshColour = scene_.meshColour;
        others.push_back(other);
        append(all, cube, at);
    }
    look({25, 9, 5}, {0, 0, 0});
    Scene scene;
    scene.volume = &volume;
    scene.transferFunction = &function;
    scene.mesh = &own;
    scene.world_from_object = translation(world({0, 0, 0}));
    scene.meshColour = scene_.meshColour;
    scene.others = others;
    scene.clip_from_world = scene_.clip_from_world;
    scene.background = scene_.background;
    scene.lighting = scene_.lighting;
    scene.jitter = false;
    scene_.mesh = &all;
    expectSame(take(blocking().render(scene, kExtent)), kMean, kMost, 0.06);
    // Colours are each mesh's own: of all the rest gray, the last, nearest to the eye, is red.
    for (SceneMesh& other : others) {
        other.meshColour = {0.5, 0.5, 0.5};
    }
    const auto reds = [&] {
        const Picture picture = take(blocking().render(scene, kExtent));
        std::size_t count = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
            count += picture.rgba[i] > 200 && picture.rgba[i + 1] < 20 ? 1U : 0U;
        }
        return count;
    };
    EXPECT_EQ(reds(), 0U);
    others.back().meshColour = {1, 0, 0};
    EXPECT_GT(reds(), 0U);
}

TEST_F(RenderCutTest, APictureInPiecesIsTheSame) {
    const MeshData cube = makeCube(-1.6, 1.6);
    const Mesh mesh = upload(cube);
    const Volume volume = upload(volume_);
    const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), scene_.function));
    look({20, 12, 9}, {0, 0, 0});
    Scene scene = seen(volume, function);
    scene.mesh = &mesh;
    scene.world_from_object = translation(world({0.7, -0.4, 0.9}));
    constexpr VkExtent2D kTall{70, 131};
    const Picture whole = take(blocking().render(scene, kTall));
    std::vector<std::uint32_t> done;
    const Picture bands = take(blocking().render(scene, kTall, [&](std::uint32_t rows, std::uint32_t all) {
        EXPECT_EQ(all, kTall.height);
        EXPECT_TRUE(done.empty() || rows > done.back());
        done.push_back(rows);
        return true;
    }));
    EXPECT_EQ(bands.rgba, whole.rgba);
    ASSERT_GT(done.size(), 1U);
    EXPECT_EQ(done.back(), kTall.height);
    // What is outside of an area is left as it was.
    OwnImage image(gpu().device, kTall);
    RenderTargets targets = take(RenderTargets::create(renderer(), kTall));
    Target target = image.target(targets);
    Scene blank = scene;
    blank.mesh = nullptr;
    blank.background = {1, 1, 1};
    const VkCommandBuffer commands = image.raw.begin();
    take(renderer().cmdRender(commands, blank, target));
    static_cast<void>(image.cmdCopy(commands)); // also waits for what was drawn
    target.area = {{11, 40}, {33, 57}};
    take(renderer().cmdRender(commands, scene, target));
    const std::uint8_t* pixels = image.cmdCopy(commands);
    image.raw.submitAndWait(commands);
    const Picture white = take(blocking().render(blank, kTall));
    for (std::uint32_t y = 0; y < kTall.height; ++y) {
        for (std::uint32_t x = 0; x < kTall.width; ++x) {
            const bool inside = x >= 11 && x < 44 && y >= 40 && y < 97;
            const std::size_t at = std::size_t{4} * (kTall.width * y + x);
            ASSERT_EQ(pixels[at], (inside ? whole : white).rgba[at]) << x << ", " << y;
        }
    }
}

TEST_F(RenderCutTest, APictureIsCancelled) {
    const Volume volume = upload(volume_);
    const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), scene_.function));
    look({20, 12, 9}, {0, 0, 0});
    const Scene scene = seen(volume, function);
    constexpr VkExtent2D kTall{70, 131};
    const Picture whole = take(blocking().render(scene, kTall));
    for (const bool atTheEnd : {false, true}) {
        std::uint32_t last = 0;
        const Result<Picture> cancelled = blocking().render(scene, kTall, [&](std::uint32_t rows, std::uint32_t all) {
            last = rows;
            return atTheEnd && rows < all;
        });
        ASSERT_FALSE(cancelled.ok());
        EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
        EXPECT_EQ(last == kTall.height, atTheEnd) << "no band follows";
        EXPECT_EQ(take(blocking().render(scene, kTall)).rgba, whole.rgba) << "the next picture";
    }
}

TEST_F(RenderCutTest, Refusals) {
    const Volume volume = upload(volume_);
    const RenderTransferFunction function = take(RenderTransferFunction::upload(renderer(), queue(), scene_.function));
    look({25, 1, 2}, {0, 0, 0});
    const Scene good = seen(volume, function);
    const auto refused = [&](const auto& change, const char* text) {
        Scene scene = good;
        change(scene);
        const Result<Picture> made = blocking().render(scene, kExtent);
        ASSERT_FALSE(made.ok()) << text;
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(made.error().text, HasSubstr(text));
    };
    const std::vector<ClipPlane> planes(kMaxClipPlanes + 1, {{1, 0, 0}, 0});
    const ClipPlane none{{0, 0, 0}, 1};
    const ClipPlane endless{{1, 0, 0}, std::nan("")};
    const SceneMesh noMesh{};
    const Mesh mesh = upload(makeCube(0, 1));
    SceneMesh flat;
    flat.mesh = &mesh;
    flat.world_from_object[0] = 0;
    SceneMesh painted;
    painted.mesh = &mesh;
    painted.paint.what = Paint::Contacts;
    refused([&](Scene& s) { s.clipPlanes = planes; }, "the scene has 7 clip planes, the most is 6");
    refused([&](Scene& s) { s.clipPlanes = {&none, 1}; }, "clip plane 0 is no plane");
    refused([&](Scene& s) { s.clipPlanes = {&endless, 1}; }, "clip plane 0 is no plane");
    refused([&](Scene& s) { s.others = {&noMesh, 1}; }, "Scene::others[0]: there is no mesh");
    refused([&](Scene& s) { s.others = {&flat, 1}; }, "Scene::others[0]: the mesh's pose");
    refused([&](Scene& s) { s.others = {&painted, 1}; }, "Scene::others[0]: Scene::paint has no transfer function");
    refused([&](Scene& s) { s.lighting.occlusion = 1.5; }, "occlusion 1.5");
    refused(
        [&](Scene& s) {
            s.lighting.occlusion = 1;
            s.lighting.reach = 0;
        },
        "reach is 0, not above 0");
    refused(
        [&](Scene& s) {
            s.lighting.side = 1;
            s.lighting.sideFrom = {0, 0, 0};
        },
        "no direction");
    refused([&](Scene& s) { s.lighting.side = -1; }, "lighting");
    OwnImage image(gpu().device, kExtent);
    RenderTargets targets = take(RenderTargets::create(renderer(), kExtent));
    Target target = image.target(targets);
    const VkCommandBuffer commands = image.raw.begin();
    for (const VkRect2D& area : {VkRect2D{{0, 0}, {0, 5}}, VkRect2D{{-1, 0}, {5, 5}}, VkRect2D{{1, 0}, kExtent},
                                 VkRect2D{{0, 40}, {5, 9}}, VkRect2D{{2, 0}, {~0U, 5}}}) {
        target.area = area;
        EXPECT_THAT(renderer().cmdRender(commands, good, target).error().text, HasSubstr("Target::area"));
    }
    image.raw.submitAndWait(commands);
}

} // namespace
} // namespace voxtact::test
