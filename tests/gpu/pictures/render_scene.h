// SPDX-License-Identifier: MIT
#pragma once

#include "render_fixture.h"
#include "render_reference.h"
#include "support/scenes.h"

#include <cmath>
#include <optional>

/// A scene that the device and the ray caster on the host make the same picture of.
namespace voxtact::test {

inline constexpr std::uint32_t kWidth = 56;
inline constexpr std::uint32_t kHeight = 48;
inline constexpr VkExtent2D kExtent{kWidth, kHeight};
// Errors in 8-bit steps: rounding alone is up to 0.5, and 0.25 in the mean of arbitrary colours.
inline constexpr double kMean = 0.6;
inline constexpr double kMost = 2;
inline constexpr ControlPoint kOpacity[] = {{0, 0}, {0.3, 0}, {0.6, 0.08}, {1, 0.3}};
inline constexpr ColourPoint kColours[] = {{0, {0.2, 0.1, 0.9}}, {0.6, {0.9, 0.2, 0.1}}, {1, {0.9, 0.9, 0.4}}};

/// An eye at `from` that looks at `to`. Without `farPlane` it is at infinity.
inline Mat4 perspective(const Vec3& from, const Vec3& to, double nearPlane, std::optional<double> farPlane) {
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
inline Mat4 reversed(const Mat4& clip_from_world) {
    return multiply({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1}, clip_from_world);
}

/// A smooth blob of floats, 0..1, on a grid whose voxels are far from cubes.
inline VolumeData blob() {
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
        scene.clipped = scene_.clippedMesh;
        scene.clipPlanes = scene_.clipPlanes;
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

inline constexpr Vec3 kSides[] = {{25, 1, 2}, {-25, 2, 1}, {1, 26, -2}, {2, -26, 1}, {1, 2, 27}, {3, 1, -28}};

} // namespace voxtact::test
