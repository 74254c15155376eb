// SPDX-License-Identifier: MIT
// The projection `certified` on the device: the same fragments as on the host, which the certified oracle judges.
#include "certified/sides.h"
#include "few_kinds.h"
#include "gpu_fixture.h"
#include "support/host_meters.h"
#include "vulkan/context_impl.h"

#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/denormal_scenes.h"
#include "cpu/scenes/spike_scene.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <iostream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr AnyDesc kDevice{.method = CountingMethod::Compute, .projection = Projection::Certified};

cpu::Detector hostDetector(bool stopAtFirst = false) {
    return take(cpu::Detector::create({.stopAtFirst = stopAtFirst, .projection = Projection::Certified}));
}

void expectSame(const PairAnswer& device, const PairAnswer& host, const std::string& which) {
    EXPECT_EQ(device.count, host.count) << which;
    EXPECT_EQ(device.hit, host.hit) << which;
    EXPECT_EQ(device.possible, host.possible) << which;
    EXPECT_EQ(device.exactness, host.exactness) << which;
    EXPECT_EQ(device.projection, Projection::Certified) << which;
}

class CertifiedProjectionTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        if (const char* control = missingFloatControl(context().impl().floatControls); control != nullptr) {
            GTEST_SKIP() << "the device does not report " << control;
        }
        ASSERT_TRUE(context().supports(CountingMethod::Compute, Projection::Certified));
    }
};

TEST_F(CertifiedProjectionTest, IsTheHostBitForBitOnRandomCases) {
    const std::uint64_t seed = testSeed();
    BlockingDetector device = detector(kDevice);
    cpu::Detector host = hostDetector();
    std::size_t hits = 0;
    std::size_t possible = 0;
    const auto make = [&](std::uint64_t number) { return makeCertifiedCase(seed, number); };
    const std::uint64_t cases = forFewKinds(randomCases(300, 28), seed, make, [&](const CertifiedCase& c, auto number) {
        const oracle::OraclePair pair = c.scene.pair();
        const PairAnswer onDevice = askPair(device, context(), queue(), pair, number % 2 == 0).pairs.at(0);
        const PairAnswer wanted =
            onHost(pair, [&](const cpu::Batch& batch) { return take(host.detect(batch)).pairs.at(0); });
        expectSame(onDevice, wanted, toString(c.kind));
        hits += wanted.hit ? 1U : 0U;
        possible += wanted.possible ? 1U : 0U;
    });
    std::cout << "  " << cases << " cases: " << hits << " hits, " << possible << " possible\n";
    EXPECT_GT(hits, cases / 20);
}

TEST_F(CertifiedProjectionTest, IsTheHostBitForBitOnAHead) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:60"));
    const MeshData scalpel = take(makeScalpel());
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunctionDesc table{points, {0, 255}, kDefaultTableSize};
    const std::vector<Mat4> poses = randomPoses(head.grid, 12, 1, random);
    for (const bool clusters : {false, true}) {
        const Sides sides(context(), queue(), head.view(), table, scalpel.view(), clusters);
        const BatchItem item = sides.item(poses);
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        for (const bool stopAtFirst : {false, true}) {
            AnyDesc desc = kDevice;
            desc.stopAtFirst = stopAtFirst;
            const BatchAnswer onDevice = take(detector(desc).detect({{&item, 1}, {}, kDefaultThreshold}));
            const BatchAnswer onHost = take(hostDetector(stopAtFirst).detect({{&hostItem, 1}, {}, kDefaultThreshold}));
            std::size_t hits = 0;
            for (std::size_t i = 0; i < poses.size(); ++i) {
                expectSame(onDevice.pairs[i], onHost.pairs[i],
                           "seed " + std::to_string(seed) + ", pose " + std::to_string(i));
                hits += onHost.pairs[i].hit ? 1U : 0U;
            }
            EXPECT_GT(hits, 0U) << seed;
        }
    }
}

TEST_F(CertifiedProjectionTest, ATriangleWithCertainAndOpenCellsCountsOnce) {
    // Opaque on the left; on the right the threshold itself, which nothing decides.
    constexpr double kThreshold = 100.0 / 255;
    const VolumeData halves = makeBytes(unitGrid(10), [](std::uint32_t x, auto, auto) { return x < 5 ? 255 : 100; });
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const std::array positions{0.1, 0.1, 0.47, 0.9, 0.1, 0.47, 0.1, 0.9, 0.47};
    const std::array<std::uint32_t, 3> indices{0, 1, 2};
    const std::vector<Mat4> poses{identity()};
    for (const bool clusters : {false, true}) {
        const Sides sides(context(), queue(), halves.view(), {points, {0, 255}, kDefaultTableSize},
                          {positions, indices}, clusters);
        const BatchItem item = sides.item(poses);
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        const BatchAnswer onDevice = take(detector(kDevice).detect({{&item, 1}, {}, kThreshold}));
        const BatchAnswer onHost = take(hostDetector().detect({{&hostItem, 1}, {}, kThreshold}));
        EXPECT_GT(onHost.pairs[0].count, 5U);
        EXPECT_EQ(onHost.pairs[0].exactness, Exactness::LowerBound) << "no cell is open, which this is about";
        expectSame(onDevice.pairs[0], onHost.pairs[0], clusters ? "clusters" : "no clusters");
    }
}

void expectSameOutputs(const BatchAnswer& device, const BatchAnswer& host) {
    ASSERT_EQ(device.triangles.size(), host.triangles.size());
    for (std::size_t i = 0; i < host.triangles.size(); ++i) {
        EXPECT_EQ(device.triangles[i].triangle, host.triangles[i].triangle);
        EXPECT_EQ(device.triangles[i].count, host.triangles[i].count);
    }
    ASSERT_EQ(device.contacts.size(), host.contacts.size());
    EXPECT_EQ(device.contactsFound, host.contactsFound);
    for (std::size_t i = 0; i < host.contacts.size(); ++i) {
        EXPECT_EQ(device.contacts[i].triangle, host.contacts[i].triangle);
        EXPECT_EQ(device.contacts[i].position, host.contacts[i].position);
        EXPECT_EQ(device.contacts[i].value, host.contacts[i].value);
        EXPECT_EQ(device.contacts[i].opacity, host.contacts[i].opacity);
        EXPECT_NEAR(device.contacts[i].depth, host.contacts[i].depth, 1e-3);
    }
    ASSERT_EQ(device.bounds.size(), host.bounds.size());
    for (std::size_t i = 0; i < host.bounds.size(); ++i) {
        ASSERT_EQ(device.bounds[i].has_value(), host.bounds[i].has_value());
        if (host.bounds[i]) {
            EXPECT_EQ(device.bounds[i]->lo, host.bounds[i]->lo);
            EXPECT_EQ(device.bounds[i]->hi, host.bounds[i]->hi);
        }
    }
}

TEST_F(CertifiedProjectionTest, OutputsAreTheHosts) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    const MeshData scalpel = take(makeScalpel());
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const Sides sides(context(), queue(), head.view(), {points, {0, 255}, kDefaultTableSize}, scalpel.view(), true);
    const std::vector<Mat4> poses = randomPoses(head.grid, 16, 1, random);
    const BatchItem item = sides.item(poses);
    const cpu::BatchItem hostItem = sides.hostItem(poses);
    constexpr Outputs kOutputs{.triangles = true, .contacts = true, .bounds = true};
    AnyDesc desc = kDevice;
    desc.outputs = kOutputs;
    const BatchAnswer onDevice = take(detector(desc).detect({{&item, 1}, {}, kDefaultThreshold}));
    const BatchAnswer onHost =
        take(take(cpu::Detector::create({.projection = Projection::Certified, .outputs = kOutputs}))
                 .detect({{&hostItem, 1}, {}, kDefaultThreshold}));
    ASSERT_FALSE(onHost.contacts.empty()) << seed;
    expectSameOutputs(onDevice, onHost);
    std::uint64_t counted = 0;
    for (const PairAnswer& pair : onHost.pairs) {
        counted += pair.count;
    }
    EXPECT_EQ(onHost.contactsFound, counted);
    for (const Contact& contact : onHost.contacts) {
        EXPECT_GE(contact.opacity, static_cast<double>(static_cast<float>(kDefaultThreshold))) << seed;
    }
}

/// Found by crossing it, and by no look at the witness's position.
TEST_F(CertifiedProjectionTest, TheWitnessOfASpikeIsTheHosts) {
    constexpr Outputs kOutputs{.triangles = true, .contacts = true, .bounds = true};
    AnyDesc desc = kDevice;
    desc.outputs = kOutputs;
    BlockingDetector device = detector(desc);
    cpu::Detector host = take(cpu::Detector::create({.projection = Projection::Certified, .outputs = kOutputs}));
    for (const bool falling : {false, true}) {
        const SpikeScene spike = spikeScene(ScalarType::UInt8, falling, 0); // as head:48 a kind of image
        const oracle::OraclePair pair = spike.scene.pair();
        const Sides sides(context(), queue(), pair.volume, pair.transferFunction, pair.mesh, true);
        const std::span poses(&pair.world_from_object, 1);
        const BatchItem item = sides.item(poses);
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        const BatchAnswer onDevice = take(device.detect({{&item, 1}, {}, pair.threshold}));
        const BatchAnswer onHost = take(host.detect({{&hostItem, 1}, {}, pair.threshold}));
        ASSERT_FALSE(onHost.contacts.empty());
        expectSameOutputs(onDevice, onHost);
        for (const Contact& contact : onDevice.contacts) {
            EXPECT_GE(contact.opacity, pair.threshold - 1e-7);
            EXPECT_NEAR(contact.value, spike.value, 1e-3);
        }
    }
}

/// About a voxel that is far from all others the device is as sure as the host.
TEST_F(CertifiedProjectionTest, OutliersAreTheHosts) {
    const std::uint64_t seed = testSeed();
    BlockingDetector device = detector(kDevice);
    cpu::Detector host = hostDetector();
    std::size_t hits = 0;
    for (std::uint64_t number = 0; number < randomCases(60, 8); ++number) {
        for (const double outlier : {1e5, -1e20, -3.4e38}) {
            for (const bool near : {false, true}) {
                const CertifiedCase c = outlierCase(seed + number, outlier, near);
                const oracle::OraclePair pair = c.scene.pair();
                const Sides sides(context(), queue(), pair.volume, pair.transferFunction, pair.mesh, true);
                const std::span poses(&pair.world_from_object, 1);
                const BatchItem item = sides.item(poses);
                const cpu::BatchItem hostItem = sides.hostItem(poses);
                const PairAnswer onHost = take(host.detect({{&hostItem, 1}, {}, pair.threshold})).pairs[0];
                expectSame(take(device.detect({{&item, 1}, {}, pair.threshold})).pairs[0], onHost,
                           "VOXTACT_TEST_SEED=" + std::to_string(seed) + ", case " + std::to_string(number));
                hits += onHost.hit && !near ? 1U : 0U;
            }
        }
    }
    EXPECT_GT(hits, 5U);
}

/// All four touch; a device that takes denormals for zero may not know.
TEST_F(CertifiedProjectionTest, WhatDependsOnDenormalsIsPossible) {
    BlockingDetector device = detector(kDevice);
    cpu::Detector host = hostDetector();
    for (const DenormalScene& denormal : denormalScenes()) {
        const oracle::OraclePair pair = denormal.scene.scene.pair();
        const Sides sides(context(), queue(), pair.volume, pair.transferFunction, pair.mesh, true);
        const std::span poses(&pair.world_from_object, 1);
        const BatchItem item = sides.item(poses);
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        const BatchAnswer onDevice = take(device.detect({{&item, 1}, {}, pair.threshold}));
        const BatchAnswer onHost = take(host.detect({{&hostItem, 1}, {}, pair.threshold}));
        expectSame(onDevice.pairs[0], onHost.pairs[0], denormal.name);
        EXPECT_EQ(onDevice.pairs[0].possible, !denormal.decided) << denormal.name;
    }
}

/// Triangles that single precision cannot decide: in faces of the domain,
/// with an edge or a corner in one, and of so many voxels that single precision decides no cell of them.
MeshData openTriangles(const Grid& grid, std::uint32_t copies) {
    const double near = grid.origin[0] - grid.spacing[0] / 2;
    const double far = near + grid.size[0] * grid.spacing[0];
    const auto in = [&](double x0, double x1, double x2) {
        return std::array<Vec3, 3>{Vec3{x0, grid.origin[1], grid.origin[2]},
                                   Vec3{x1, grid.origin[1] + 2, grid.origin[2]},
                                   Vec3{x2, grid.origin[1], grid.origin[2] + 2}};
    };
    const auto huge = [&](double side) {
        const Vec3 at = {grid.origin[0] + 1, grid.origin[1] + 1, grid.origin[2] + 1};
        return std::array<Vec3, 3>{Vec3{at[0] + side, at[1] - side, at[2]}, Vec3{at[0], at[1] + side, at[2] - side},
                                   Vec3{at[0] - side, at[1], at[2] + side}};
    };
    MeshData mesh;
    for (std::uint32_t copy = 0; copy < copies; ++copy) {
        for (const std::array<Vec3, 3>& triangle :
             {in(near, near, near), in(far, far, far), in(near - 2, near, near), in(near - 2, near - 1, near),
              in(near - 2, near - 1, near - 0.125), huge(1e5), huge(1e7)}) {
            for (const Vec3& corner : triangle) {
                mesh.indices.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
                for (const double coordinate : corner) {
                    mesh.positions.push_back(static_cast<float>(coordinate));
                }
            }
        }
    }
    return mesh;
}

/// The last copies have more large triangles than the queue of them holds.
TEST_F(CertifiedProjectionTest, WhatIsOpenIsDecidedAgainAsOnTheHost) {
    Grid grid;
    grid.size = {5, 6, 7};
    grid.spacing = {0.75, 1, 3};
    grid.origin = {0.5, -8, 1024};
    const VolumeData image = makeBytes(grid, [](auto x, auto...) { return x < 3 ? 255 : 100; });
    const std::vector<Mat4> poses{identity(), translation({0, 0, 1e4}), translation({0.25, 0, 0})};
    for (const std::uint32_t copies : {1U, 40U}) {
        const MeshData mesh = openTriangles(grid, copies);
        const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
        const Sides sides(context(), queue(), image.view(), {points, {0, 255}, kDefaultTableSize}, mesh.view(), true);
        const BatchItem item = sides.item(poses);
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        constexpr Outputs kOutputs{.triangles = true, .contacts = true, .bounds = true};
        for (const bool stopAtFirst : {false, true}) {
            AnyDesc desc = kDevice;
            desc.stopAtFirst = stopAtFirst;
            desc.outputs = stopAtFirst ? Outputs{} : kOutputs;
            cpu::Detector host = take(cpu::Detector::create(
                {.stopAtFirst = stopAtFirst, .projection = Projection::Certified, .outputs = desc.outputs}));
            const BatchAnswer onDevice = take(detector(desc).detect({{&item, 1}, {}, 0.5}));
            const BatchAnswer onHost = take(host.detect({{&hostItem, 1}, {}, 0.5}));
            for (std::size_t i = 0; i < poses.size(); ++i) {
                expectSame(onDevice.pairs[i], onHost.pairs[i],
                           std::to_string(copies) + " copies, pose " + std::to_string(i));
            }
            EXPECT_TRUE(onDevice.pairs[0].hit);
            if (!stopAtFirst) {
                expectSameOutputs(onDevice, onHost);
                std::uint64_t ofHuge = 0; // which only the last pass can have found
                for (const TouchedTriangle& triangle : onDevice.triangles) {
                    ofHuge += triangle.pair == 0 && triangle.triangle % 7 >= 5 ? triangle.count : 0;
                }
                EXPECT_GT(ofHuge, std::uint64_t{copies});
            }
        }
    }
}

/// Some 100,000 cells per triangle: more loops than llvmpipe runs in one invocation (docs/facts.md).
TEST_F(CertifiedProjectionTest, APlateThroughALargeVolumeIsTheHosts) {
    const VolumeData sphere = take(makeBuiltinVolume("sphere:250"));
    MeshData plate;
    plate.positions = {-120, -120, 3.3F, 120, -120, 3.7F, 120, 120, 3.9F, -120, 120, 3.5F};
    plate.indices = {0, 1, 2, 0, 2, 3};
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const Sides sides(context(), queue(), sphere.view(), {points, {0, 255}, kDefaultTableSize}, plate.view(), true);
    const Mat4 pose = identity();
    const BatchItem item = sides.item({&pose, 1});
    const cpu::BatchItem hostItem = sides.hostItem({&pose, 1});
    const BatchAnswer onDevice = take(detector(kDevice).detect({{&item, 1}, {}, 0.05}));
    const BatchAnswer onHost = take(hostDetector().detect({{&hostItem, 1}, {}, 0.05}));
    expectSame(onDevice.pairs[0], onHost.pairs[0], "a plate");
    EXPECT_GT(onHost.pairs[0].count, 30000U);
}

/// The first to prove a touch ends the work on a pair: a vertex while boxes are examined, or a fragment later.
TEST_F(CertifiedProjectionTest, YesAndNoAreTheHostsOnManyPoses) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:60"));
    const MeshData scalpel = take(makeScalpel());
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const Sides sides(context(), queue(), head.view(), {points, {0, 255}, kDefaultTableSize}, scalpel.view(), true);
    const std::vector<Mat4> poses = randomPoses(head.grid, 400, 1, random);
    const BatchItem item = sides.item(poses);
    const cpu::BatchItem hostItem = sides.hostItem(poses);
    AnyDesc desc = kDevice;
    desc.stopAtFirst = true;
    const BatchAnswer onDevice = take(detector(desc).detect({{&item, 1}, {}, kDefaultThreshold}));
    const BatchAnswer onHost = take(hostDetector(true).detect({{&hostItem, 1}, {}, kDefaultThreshold}));
    std::size_t hits = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        expectSame(onDevice.pairs[i], onHost.pairs[i], "seed " + std::to_string(seed) + ", pose " + std::to_string(i));
        hits += onHost.pairs[i].hit ? 1U : 0U;
    }
    EXPECT_GT(hits, poses.size() / 10) << seed;
    EXPECT_LT(hits, poses.size() - poses.size() / 10) << seed;
}

/// More rounds than queues have headers, and what touches is in the first and in the last of them.
TEST_F(CertifiedProjectionTest, ManyRoundsAreOneBatch) {
    const VolumeData head = take(makeBuiltinVolume("head:30"));
    const MeshData body = take(makeEllipsoid(12800)); // 200 clusters
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const Sides sides(context(), queue(), head.view(), {points, {0, 255}, kDefaultTableSize}, body.view(), true);
    std::vector<Mat4> poses(1400, translation({1e4, 0, 0})); // 20 of them a round
    poses.front() = poses[700] = poses.back() = identity();
    const BatchItem item = sides.item(poses);
    const Mat4 touching = identity();
    const cpu::BatchItem hostItem = sides.hostItem({&touching, 1});
    const BatchAnswer onDevice = take(detector(kDevice).detect({{&item, 1}, {}, kDefaultThreshold}));
    const BatchAnswer onHost = take(hostDetector().detect({{&hostItem, 1}, {}, kDefaultThreshold}));
    EXPECT_GT(onHost.pairs[0].count, 0U);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const bool touches = i == 0 || i == 700 || i + 1 == poses.size();
        ASSERT_EQ(onDevice.pairs[i].count, touches ? onHost.pairs[0].count : 0U) << "pose " << i;
    }
}

/// What one batch leaves in the buffers is not the next one's answer: the same Results hold pairs that are undecided,
/// then pairs far outside, then both.
TEST_F(CertifiedProjectionTest, FarPosesAreNoneWhateverTheBuffersHeld) {
    const VolumeData head = take(makeBuiltinVolume("head:30"));
    const MeshData scalpel = take(makeBuiltinMesh("scalpel:500"));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const Sides sides(context(), queue(), head.view(), {points, {0, 255}, kDefaultTableSize}, scalpel.view(), true);
    Mat4 nowhere = identity(); // beyond floats: no vertex is anywhere
    nowhere[0] = 1e300;
    const Mat4 far = translation({1e4, -2e4, 500});
    BlockingDetector device = detector(kDevice);
    const auto ask = [&](const std::vector<Mat4>& poses) {
        const BatchItem item = sides.item(poses);
        return take(device.detect({{&item, 1}, {}, kDefaultThreshold})).pairs;
    };
    for (int round = 0; round < 3; ++round) {
        for (const PairAnswer& pair : ask(std::vector<Mat4>(8, nowhere))) {
            EXPECT_TRUE(pair.possible);
        }
        for (const PairAnswer& pair : ask(std::vector<Mat4>(40, far))) {
            EXPECT_TRUE(!pair.hit && !pair.possible && pair.count == 0 && pair.exactness == Exactness::Exact);
        }
        const std::vector<PairAnswer> both = ask({nowhere, far, identity(), far, nowhere});
        EXPECT_TRUE(both[0].possible && both[2].hit && both[4].possible);
        EXPECT_TRUE(!both[1].possible && !both[1].hit && !both[3].possible && !both[3].hit);
    }
}

TEST_F(CertifiedProjectionTest, RefusesWhatItCannotAnswer) {
    EXPECT_EQ(Detector::raster(context(), {.projection = Projection::Certified}).error().text,
              "RasterDesc::projection is certified; make a certified detector with Detector::certified()");
    EXPECT_THAT(Detector::certified(context(), {.resolution = 2}).error().text, HasSubstr("resolution 2"));

    const VolumeData image = take(makeBuiltinVolume("sphere:18"));
    const MeshData triangles = take(makeEllipsoid(100));
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const Volume volume = upload(image);
    const Mesh mesh = upload(triangles);
    const TransferFunction function = upload(points, {0, 255});
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
    EXPECT_THAT(detector(kDevice).detect({{&item, 1}, {}, 0.5}).error().text, HasSubstr("bricks"));
}

} // namespace
} // namespace voxtact::test
