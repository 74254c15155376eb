// SPDX-License-Identifier: MIT
// What the search for clearances may look at: a lane that goes down to the nearest bricks has a bound, and what it did
// not come to may be near.
#include "certified/counted_fixture.h"
#include "voxtact/cpu.h"

#include <iostream>

namespace voxtact::test {
namespace {

/// A slab of 48 x 48 bricks beside which all of them are as near, and none is certain to have anything: a voxel of each
/// is opaque but for a rounding.
class ClearanceWorkTest : public CertifiedTest {
  protected:
    static constexpr double kAlmost = 128;
    /// Above the opacity of that voxel by less than the device tells apart.
    static constexpr double kThreshold = kAlmost / 255 + 1.5e-7;

    VolumeData slab() const {
        VolumeData image = makeBytes(unitGrid(380, 380, 7), [](auto x, auto y, auto z) {
            return x % 8 == 3 && y % 8 == 3 && z == 6 ? kAlmost : 0.0;
        });
        image.grid.spacing = {1, 1, 1};
        image.grid.origin = {};
        return image;
    }
};

TEST_F(ClearanceWorkTest, ALaneLooksAtSoManyNodesAndNoMore) {
    constexpr std::uint64_t kMostNodes = 4096; // shaders/certified_clearance_near.glsl
    std::mt19937_64 random(testSeed());
    // The almost opaque voxels are 7.5 mm from the mesh, farther than the search looks; their bricks are 1.5 mm away.
    const MeshData flat = makeFlat(0, 379, 0, 379, -2.5);
    constexpr double kMaximum = 6;
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const Mesh mesh = take(Mesh::upload(context(), queue(), flat.view(), {.clusters = true}));
    const TransferFunction function = upload(points, {0, 255});
    DetectorDesc desc{.method = CountingMethod::Compute, .projection = Projection::Conservative, .stopAtFirst = true};
    desc.clearance = ClearanceSearch{.maximum = kMaximum};
    desc.counters = true;
    const Detector device = take(Detector::create(context(), desc));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1, .maximum = kMaximum}));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(flat.view()));
    const cpu::TransferFunction hostFunction =
        take(cpu::TransferFunction::create({points, {0, 255}, kDefaultTableSize}));
    const Mat4 pose = identity();
    VolumeData image = slab();
    for (const bool something : {false, true}) {
        SCOPED_TRACE(something ? "with an opaque voxel" : "without");
        if (something) { // anywhere, 3 mm from the mesh
            image.voxels[random() % 380 + 380 * (random() % 380) + std::size_t{380} * 380] = std::byte{255};
        }
        const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        const Answered found = detect(device, {{&item, 1}, {}, kThreshold}, 1, 4096);
        const cpu::Volume hostVolume = take(cpu::Volume::create(image.view()));
        const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, {&pose, 1}};
        const PairClearance host = take(meter.measure({{&hostItem, 1}, {}, kThreshold})).pairs.at(0);
        const PairClearance& pair = found.clearances.at(0);
        // A triangle of so many voxels may leave bounds of single precision a little apart.
        EXPECT_TRUE(something ? pair.end == ClearanceEnd::Closed || pair.end == ClearanceEnd::Rounding
                              : pair.end == ClearanceEnd::Beyond)
            << toString(pair.end);
        EXPECT_LE(pair.bounds.lo, host.bounds.hi);
        EXPECT_LE(host.bounds.lo, pair.bounds.hi);
        std::cout << "  " << pair.bounds.lo << " to " << pair.bounds.hi << ", " << found.counters.mostLooks
                  << " looks at once\n";
        // The step that looks at boxes only: a cluster, which is content with any brick, and its run, which is not.
        // With an opaque voxel it depends on where that is.
        EXPECT_TRUE(something || found.counters.mostLooks > kMostNodes - 8);
        EXPECT_LE(found.counters.mostLooks, kMostNodes + 200);
        EXPECT_EQ(found.counters.left, 0U);
    }
}

} // namespace
} // namespace voxtact::test
