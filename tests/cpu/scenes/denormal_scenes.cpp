// SPDX-License-Identifier: MIT
#include "cpu/scenes/denormal_scenes.h"

#include "support/scenes.h"

namespace voxtact::test {

namespace {

/// Voxel space is world space; a triangle across the volume.
template <class Scalar> OracleScene block(ScalarType type, const VoxelFunction& value) {
    Grid grid;
    grid.size = {8, 8, 8};
    OracleScene scene;
    scene.volume = makeVolume<Scalar>(grid, type, value);
    addTriangle(scene.mesh, {1, 2, 2}, {5, 2, 3}, {3, 5, 5});
    return scene;
}

/// A flushed voxel would be at the first entry, which is transparent.
CertifiedCase tinyVoxels() {
    OracleScene scene = block<float>(ScalarType::Float32, [](auto...) { return 9e-39; });
    scene.points = {{2e-39, 0}, {5e-39, 1}};
    scene.domain = {0, 1e-36};
    return withTable(std::move(scene));
}

/// A flushed scale would put every voxel at the first entry, which is transparent.
CertifiedCase hugeDomain() {
    OracleScene scene = block<float>(ScalarType::Float32, [](auto...) { return 3.4e38; });
    scene.points = {{1e38, 0}, {3e38, 1}};
    scene.domain = {-2.5e38, 6e40};
    return withTable(std::move(scene));
}

CertifiedCase tinyThreshold() {
    OracleScene scene = block<std::uint8_t>(ScalarType::UInt8, [](auto...) { return 200; });
    scene.points = {{0, 0}, {100, 1}};
    scene.threshold = 1e-39;
    return withTable(std::move(scene));
}

} // namespace

CertifiedCase scaledTriangle(double scale) {
    // Zero is in the transparent half.
    OracleScene scene = block<std::uint8_t>(ScalarType::UInt8, [](auto x, auto, auto) { return x < 2 ? 0 : 200; });
    scene.points = {{0, 0}, {100, 1}};
    scene.mesh = {};
    addTriangle(scene.mesh, {3 / scale, 2, 2}, {3 / scale, 2, 3}, {3 / scale, 5, 5});
    scene.world_from_object[0] = scale;
    return withTable(std::move(scene));
}

std::vector<DenormalScene> denormalScenes() {
    return {{"voxels", tinyVoxels(), false},
            {"vertices", scaledTriangle(0x1p127), false},
            {"scale", hugeDomain(), true},
            {"threshold", tinyThreshold(), true}};
}

} // namespace voxtact::test
