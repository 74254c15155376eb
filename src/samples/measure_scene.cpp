// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "voxtact/samples.h"

#include <cmath>

namespace voxtact {

namespace {

constexpr std::uint32_t kPoses = 32;
constexpr std::uint32_t kMeasuredSide = 256;

/// The tip on a spiral over the head, from `radius` mm off the world's origin, the handle pointing outwards.
Mat4 poseOnSpiral(std::uint32_t index) {
    constexpr double kGoldenAngle = 2.399963229728653;
    constexpr double kOutside = 95; // mm from the head's centre: off the skin
    constexpr double kInside = 35;
    const double part = (index + 0.5) / kPoses;
    const double z = 1 - 2 * part;
    const double ring = std::sqrt(1 - z * z);
    const double angle = kGoldenAngle * index;
    const Vec3 out{ring * std::cos(angle), ring * std::sin(angle), z};
    const Vec3 across{-std::sin(angle), std::cos(angle), 0};
    const Vec3 third{out[1] * across[2] - out[2] * across[1], out[2] * across[0] - out[0] * across[2],
                     out[0] * across[1] - out[1] * across[0]};
    // A step of 13 through the 32 radii, so that depth does not go with direction.
    const double radius = kInside + (kOutside - kInside) * (index * 13 % kPoses) / (kPoses - 1);
    Mat4 world_from_object = identity();
    for (std::size_t row = 0; row < 3; ++row) {
        world_from_object[row] = across[row];
        world_from_object[4 + row] = third[row];
        world_from_object[8 + row] = out[row];
        world_from_object[12 + row] = radius * out[row];
    }
    return world_from_object;
}

} // namespace

Result<MeasureScene> makeMeasureScene() {
    return guard([&]() -> Result<MeasureScene> {
        Result<VolumeData> volume = makeBuiltinVolume("head:64");
        VOXTACT_TRY(volume);
        Result<MeshData> mesh = makeScalpel();
        VOXTACT_TRY(mesh);
        MeasureScene scene;
        scene.volume = std::move(*volume);
        scene.mesh = std::move(*mesh);
        scene.points = {{0, 0}, {255, 1}};
        scene.domain = {0, 255};
        for (std::uint32_t i = 0; i < kPoses; ++i) {
            scene.world_from_object.push_back(poseOnSpiral(i));
        }
        scene.view = {framingCamera(scene.volume.grid, kMeasuredSide, kMeasuredSide), kMeasuredSide, kMeasuredSide};
        return scene;
    });
}

} // namespace voxtact
