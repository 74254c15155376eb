// SPDX-License-Identifier: MIT
// The closest points, where the opaque part is a sheet that no rounded value hits.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace voxtact::test {
namespace {

/// Opaque is one entry of the table alone, and of that its very value: a plane across x.
TEST(WitnessPoints, OfASheetWithoutThicknessAreAsFarApartAsTheBoundsSay) {
    constexpr double kOpaque = 40.5;
    constexpr double kRise = 16; // for each voxel along x
    Grid grid;
    grid.size = {8, 8, 8};
    const VolumeData image = makeBytes(grid, [](auto x, auto, auto) { return kRise * static_cast<double>(x); });
    const cpu::Volume volume = take(cpu::Volume::create(image.view()));
    const std::array points{ControlPoint{kOpaque - 1, 0}, ControlPoint{kOpaque, 1}, ControlPoint{kOpaque + 1, 0}};
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({points, {0, 256}, 256}));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 200; ++round) {
        // The first corner is the closest.
        const double x = uniform(random, 4, 7);
        MeshData data;
        addTriangle(data, {x, uniform(random, 1, 6), uniform(random, 1, 6)}, {x + 1, 0, 3}, {x + 2, 6, 5});
        const double truth = static_cast<double>(data.positions[0]) - kOpaque / kRise;
        const cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
        const Mat4 pose = identity();
        const cpu::BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        const PairDistance says = take(meter.measure({{&item, 1}, {}, 1})).pairs.at(0);
        EXPECT_EQ(says.end, StopReason::Closed);
        EXPECT_LE(says.bounds.lower, truth + 1e-12);
        EXPECT_GE(says.bounds.upper, truth - 1e-12);
        ASSERT_TRUE(says.closest);
        const Vec3& onMesh = says.closest->mesh;
        const Vec3& inVolume = says.closest->volume;
        const double apart = std::hypot(onMesh[0] - inVolume[0], onMesh[1] - inVolume[1], onMesh[2] - inVolume[2]);
        EXPECT_NEAR(apart, says.bounds.upper, 1e-11);
        EXPECT_NEAR(inVolume[0], kOpaque / kRise, 1e-6);
    }
}

} // namespace
} // namespace voxtact::test
