// SPDX-License-Identifier: MIT
// Which boxes may have an opaque sample: never wrong where something touches, and not always yes.
#include "core/transfer/table_points.h"
#include "host/touch/cells/brick_occupancy.h"

#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

/// A small triangle in the box of texture space made larger by a tenth, and the box around it.
struct Probe {
    std::array<Vec3, 3> corners{};
    Box box{};
};

Probe randomProbe(std::mt19937_64& random) {
    Probe probe;
    Vec3 at{};
    for (double& coordinate : at) {
        coordinate = uniform(random, -0.1, 1.1);
    }
    const double size = std::pow(10, uniform(random, -3, -0.5));
    probe.box = {{1, 1, 1}, {0, 0, 0}};
    for (Vec3& corner : probe.corners) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner[axis] = at[axis] + size * uniform(random, -1, 1);
            probe.box.lo[axis] = std::clamp(std::min(probe.box.lo[axis], corner[axis]), 0.0, 1.0);
            probe.box.hi[axis] = std::clamp(std::max(probe.box.hi[axis], corner[axis]), 0.0, 1.0);
        }
    }
    return probe;
}

MeshData meshOf(const Probe& probe, const Mat4& world_from_texture) {
    MeshData mesh;
    for (const Vec3& corner : probe.corners) {
        for (const double coordinate : transformPoint(world_from_texture, corner)) {
            mesh.positions.push_back(static_cast<float>(coordinate));
        }
    }
    mesh.indices = {0, 1, 2};
    return mesh;
}

TEST(BrickOccupancyTest, WhatTouchesIsInABoxThatMayBeOpaque) {
    std::mt19937_64 random(testSeed());
    cpu::Detector detector = take(cpu::Detector::create({.threads = 1, .projection = Projection::Certified}));
    const Mat4 pose = identity();
    std::size_t hits = 0;
    std::size_t clear = 0;
    for (int i = 0; i < 60; ++i) {
        const RandomScene scene = makeRandomScene(random, 1);
        const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const cpu::TransferFunction function = take(cpu::TransferFunction::create(scene.transferFunction()));
        const cpu::BrickOccupancy occupancy(volume, function, scene.threshold);
        // Boxes are for what looks up the table, and the detector decides by control points.
        const std::vector<ControlPoint> points =
            pointsOf(take(sampleTable(scene.transferFunction())), tableDomain(scene.transferFunction()));
        const cpu::TransferFunction asTable = take(cpu::TransferFunction::create({points, scene.domain}));
        for (int j = 0; j < 30; ++j) {
            const Probe probe = randomProbe(random);
            const cpu::Mesh mesh = take(cpu::Mesh::create(meshOf(probe, worldFromTexture(scene.volume.grid)).view()));
            const cpu::BatchItem item{&mesh, &volume, &asTable, {&pose, 1}};
            const PairAnswer answer = take(detector.detect({{&item, 1}, scene.view, scene.threshold})).pairs.front();
            const bool may = occupancy.mayBeOpaque(probe.box);
            EXPECT_TRUE(may || !answer.hit) << "scene " << i << ", triangle " << j;
            hits += answer.hit ? 1 : 0;
            clear += may ? 0 : 1;
        }
    }
    EXPECT_GT(hits, 50U);
    EXPECT_GT(clear, 50U);
}

TEST(BrickOccupancyTest, ABallInTheMiddle) {
    const Grid grid = unitGrid(64);
    const VolumeData data = makeBytes(grid, [](auto x, auto y, auto z) {
        const auto from = [](auto i) { return (i + 0.5) / 64 - 0.5; };
        return from(x) * from(x) + from(y) * from(y) + from(z) * from(z) < 0.04 ? 255.0 : 0.0;
    });
    const cpu::Volume volume = take(cpu::Volume::create(data.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), {0, 255}, 256}));
    const cpu::BrickOccupancy occupancy(volume, function, 0.5);
    EXPECT_TRUE(occupancy.mayBeOpaque({{0, 0, 0}, {1, 1, 1}}));
    EXPECT_TRUE(occupancy.mayBeOpaque({{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}));
    EXPECT_FALSE(occupancy.mayBeOpaque({{0, 0, 0}, {1, 1, 0.1}}));
    EXPECT_FALSE(occupancy.mayBeOpaque({{0.9, 0.4, 0.4}, {1, 0.6, 0.6}}));
    // What a filter may be off by can make a difference.
    EXPECT_TRUE(cpu::BrickOccupancy(volume, function, 0.5, 200).mayBeOpaque({{0.9, 0.4, 0.4}, {1, 0.6, 0.6}}));
}

/// A box that ends a hundredth of a voxel beyond the last voxel of a brick: a sample there has as much of the next
/// voxel, and with a table this fine that is opaque. Each side of a box has to be taken outwards.
TEST(BrickOccupancyTest, ABoxThatEndsJustBeyondABrick) {
    constexpr std::uint32_t kSide = 24; // voxel 8 i - 1 is the last that brick i - 1 has, and the first of brick i
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {true, false}) {
            const VolumeData data = makeBytes(unitGrid(kSide), [&](auto x, auto y, auto z) {
                const std::uint32_t at = std::array{x, y, z}[axis];
                return (upper ? at > 7 : at < 15) ? 255.0 : 0.0;
            });
            const cpu::Volume volume = take(cpu::Volume::create(data.view()));
            const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), {0, 255}, 4096}));
            const cpu::BrickOccupancy occupancy(volume, function, 0.005);
            const auto slab = [&](double first, double last) { // voxels along the axis, and the whole of the others
                Box box{{0, 0, 0}, {1, 1, 1}};
                box.lo[axis] = (first + 0.5) / kSide;
                box.hi[axis] = (last + 0.5) / kSide;
                return box;
            };
            SCOPED_TRACE("axis " + std::to_string(axis) + (upper ? ", upper" : ", lower"));
            EXPECT_TRUE(occupancy.mayBeOpaque(upper ? slab(2, 7.012) : slab(14.988, 20)));
            // What filters with weights of 8 bits is off by up to a 256th of a voxel.
            EXPECT_TRUE(occupancy.mayBeOpaque(upper ? slab(2, 6.997) : slab(15.003, 20)));
            EXPECT_FALSE(occupancy.mayBeOpaque(upper ? slab(2, 6.9) : slab(15.1, 20)));
        }
    }
}

} // namespace
} // namespace voxtact::test
