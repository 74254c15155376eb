// SPDX-License-Identifier: MIT
// Pictures whose pixels are known beforehand.
#include "render_fixture.h"
#include "support/scenes.h"

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

constexpr VkExtent2D kSmallExtent{8, 8};
constexpr ColourPoint kBlack[] = {{0, {0, 0, 0}}};

/// A cube with a corner at the world's origin.
Grid cube(std::uint32_t voxels, double side) {
    Grid grid = unitGrid(voxels);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] *= side;
        grid.origin[axis] *= side;
    }
    return grid;
}

class RenderAnalyticTest : public PictureTest {
  protected:
    /// Looks along z at a cube with that side, black before white, without light and noise.
    [[nodiscard]] static Scene sceneOf(const Volume& volume, const RenderTransferFunction& function, double side) {
        Scene scene;
        scene.volume = &volume;
        scene.transferFunction = &function;
        scene.clip_from_world = flatView(0, side, kSmallExtent.width, kSmallExtent.height).clip_from_world;
        scene.background = {1, 1, 1};
        scene.lighting.volume = false;
        scene.jitter = false;
        return scene;
    }
    /// The red of a pixel in the middle.
    [[nodiscard]] static int red(const Picture& picture) {
        return picture.rgba[std::size_t{4} * (kSmallExtent.width * (kSmallExtent.height / 2) + kSmallExtent.width / 2)];
    }
};

TEST_F(RenderAnalyticTest, AUniformVolumeHalvesTheLightEveryMillimetre) {
    // Beer and Lambert: 2^-s of the light behind it comes through s mm, to the last step of each ray. A ray may end
    // early where 1 % is left, and not before: what is left after 6 mm is 1.6 %, 4 of 255 steps.
    constexpr ControlPoint kHalf[] = {{0, 0.5}, {255, 0.5}};
    const RenderTransferFunction function = take(RenderTransferFunction::upload(
        renderer(), queue(), {.opacity = {kHalf, {0, 255}, 16}, .colours = kBlack, .opacityUnit = 1, .step = 0.25}));
    for (const double side : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
        const Volume volume = upload(makeBytes(cube(4, side), [](auto...) { return 255.0; }));
        const Picture picture = take(blocking().render(sceneOf(volume, function, side), kSmallExtent));
        EXPECT_NEAR(red(picture), 255 * std::exp2(-side), 1) << side << " mm";
    }
}

TEST_F(RenderAnalyticTest, ABrickThatCanBeSeenIsNotSkipped) {
    // One entry of 16 is opaque, number 6, which is at scalar 6.5. Look-ups interpolate: scalars from 5.5 to 7.5 see
    // it, in a volume of one scalar that whole bricks are decided by.
    constexpr ControlPoint kSpike[] = {{6, 0}, {6.5, 1}, {7, 0}};
    constexpr double kSquare = 2;
    const RenderTransferFunction function = take(RenderTransferFunction::upload(
        renderer(), queue(), {.opacity = {kSpike, {0, 16}, 16}, .colours = kBlack, .opacityUnit = 0.1, .step = 0.25}));
    for (double scalar = 5.05; scalar < 8; scalar += 0.1) {
        const Volume volume = take(Volume::upload(
            context(), queue(),
            makeVolume<float>(cube(16, kSquare), ScalarType::Float32, [&](auto...) { return scalar; }).view(),
            {.bricks = true}));
        const RenderBricks bricks = take(RenderBricks::create(renderer(), volume));
        Scene scene = sceneOf(volume, function, kSquare);
        const Picture without = take(blocking().render(scene, kSmallExtent));
        scene.bricks = &bricks;
        const Picture with = take(blocking().render(scene, kSmallExtent));
        EXPECT_EQ(red(with), red(without)) << scalar;
        if (scalar > 5.6 && scalar < 7.4) {
            EXPECT_LT(red(with), 250) << scalar;
        } else if (scalar < 5.5 || scalar > 7.5) {
            EXPECT_EQ(red(with), 255) << scalar;
        }
    }
}

} // namespace
} // namespace voxtact::test
