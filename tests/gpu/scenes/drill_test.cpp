// SPDX-License-Identifier: MIT
// Drilling: the matter that an instrument touches is taken away ball by ball until the hit is gone, on the device, on
// the host and in plain data that the oracles look at.
#include "certified/counted_fixture.h"
#include "gpu_fixture.h"

#include "oracle/certified_oracle.h"
#include "raw_vulkan.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <iostream>

namespace voxtact::test {
namespace {

constexpr double kAir = 0;
constexpr std::size_t kMostSteps = 200;

/// The ball's rule in its own words: a voxel whose centre is within the radius.
void drill(VolumeData& data, const Ball& ball) {
    const Mat4 world_from_index = worldFromIndex(data.grid);
    std::size_t voxel = 0;
    for (std::uint32_t z = 0; z < data.grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < data.grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < data.grid.size[0]; ++x, ++voxel) {
                const Vec3 at = transformPoint(
                    world_from_index, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
                const double dx = at[0] - ball.centre[0];
                const double dy = at[1] - ball.centre[1];
                const double dz = at[2] - ball.centre[2];
                if (dx * dx + dy * dy + dz * dz <= ball.radius * ball.radius) {
                    data.voxels[voxel] = std::byte{0};
                }
            }
        }
    }
}

class DrillTest : public CertifiedTest {
  protected:
    void drillOnDevice(Volume& volume, const std::vector<Ball>& balls) const {
        RawVulkan raw(gpu().device);
        const VkCommandBuffer commands = raw.begin();
        for (const Ball& ball : balls) {
            take(volume.cmdSet(commands, ball, kAir));
        }
        raw.submitAndWait(commands);
    }
};

/// A ball around one or two contacts. A radius beyond the diagonal of a cell has all corners of the cell.
std::vector<Ball> around(const std::vector<Contact>& contacts, double radius) {
    std::vector<Ball> balls;
    const std::size_t step = contacts.size() / 2 + 1;
    for (std::size_t i = 0; i < contacts.size(); i += step) {
        balls.push_back({contacts[i].position, radius});
    }
    return balls;
}

TEST_F(DrillTest, TheHitIsGoneWhenTheOracleSaysSo) {
    VolumeData data = take(makeBuiltinVolume("head:64"));
    const MeshData scalpel = take(makeScalpel());
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunctionDesc table{points, {0, 255}, kDefaultTableSize};
    const Vec3 centre = transformPoint(worldFromTexture(data.grid), {0.5, 0.5, 0.5});
    const Mat4 pose = translation(centre);
    const View view{framingCamera(data.grid, 256, 256), 256, 256};

    Volume volume = take(Volume::upload(context(), queue(), data.view(), {.bricks = true, .editable = true}));
    const Mesh mesh = take(Mesh::upload(context(), queue(), scalpel.view(), {.clusters = true}));
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), table));
    cpu::Volume hostVolume = take(cpu::Volume::create(data.view()));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(scalpel.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
    const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
    const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, {&pose, 1}};

    BlockingDetector device = detector({.method = CountingMethod::Compute, .projection = Projection::Certified});
    BlockingDetector samples = detector({.method = CountingMethod::Atomic, .filter = Filter::Exact});
    cpu::Detector host =
        take(cpu::Detector::create({.projection = Projection::Certified, .outputs = {.contacts = true}}));

    std::size_t steps = 0;
    for (bool touching = true; touching; ++steps) {
        ASSERT_LT(steps, kMostSteps);
        const PairAnswer onDevice = take(device.detect({{&item, 1}, {}, kDefaultThreshold})).pairs.at(0);
        const BatchAnswer onHost = take(host.detect({{&hostItem, 1}, {}, kDefaultThreshold}));
        const PairAnswer seen = take(samples.detect({{&item, 1}, view, kDefaultThreshold})).pairs.at(0);
        const oracle::OraclePair pair{scalpel.view(), data.view(), table, view, pose, kDefaultThreshold};
        const oracle::Certainty oracle = take(oracle::certifiedOracle(pair)).certainty;

        EXPECT_EQ(onDevice.count, onHost.pairs[0].count) << steps;
        EXPECT_EQ(onDevice.possible, onHost.pairs[0].possible) << steps;
        if (oracle != oracle::Certainty::Undecided && !onDevice.possible) {
            EXPECT_EQ(onDevice.hit, oracle == oracle::Certainty::Certain) << steps;
        }
        // Samples see less than bounds, never more.
        EXPECT_TRUE(!seen.hit || onDevice.hit || onDevice.possible) << steps;
        EXPECT_EQ(onHost.contacts.size(), onHost.contactsFound);
        std::cout << "  step " << steps << ": " << onDevice.count << " fragments certain, " << seen.count
                  << " sampled\n";
        touching = onDevice.hit;
        if (touching) {
            const std::vector<Ball> balls = around(onHost.contacts, 1.75 * data.grid.spacing[0]);
            drillOnDevice(volume, balls);
            for (const Ball& ball : balls) {
                take(hostVolume.set(ball, kAir));
                drill(data, ball);
            }
        }
    }
    EXPECT_GT(steps, 3U) << "the scene touches too little to be drilled";
}

} // namespace
} // namespace voxtact::test
