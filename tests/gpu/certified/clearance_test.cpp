// SPDX-License-Identifier: MIT
// How near, on the device: where distances are known, and bounds that overlap those of the host's cpu::ClearanceMeter.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/known_pairs.h"
#include "certified/sides.h"
#include "core/geometry/clusters.h"
#include "cpu/scenes/margin_cases.h"
#include "few_kinds.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <iostream>
#include <limits>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

DetectorDesc howNear(const ClearanceSearch& search = {}) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .clearance = search};
}

bool isTouch(const ClearanceBounds& bounds) {
    return bounds.lo == 0 && bounds.hi == 0;
}

/// Whether a number can be between both.
void expectOverlap(const ClearanceBounds& device, const ClearanceBounds& host) {
    EXPECT_LE(device.lo, device.hi);
    EXPECT_LE(device.lo, host.hi);
    EXPECT_LE(host.lo, device.hi);
    EXPECT_EQ(isTouch(device) && host.lo > 0, false);
}

class ClearanceTest : public CertifiedTest {
  protected:
    /// One pair, whose answer must not contradict itself.
    PairClearance ask(BlockingDetector& device, const oracle::OraclePair& pair, bool clusters) const {
        const BatchAnswer answer = askPair(device, context(), queue(), pair, clusters);
        EXPECT_EQ(answer.clearances.size(), 1U);
        const PairClearance found = answer.clearances.at(0);
        EXPECT_EQ(answer.pairs.at(0).hit, isTouch(found.bounds));
        if (answer.pairs.at(0).possible) {
            EXPECT_EQ(found.bounds.lo, 0);
        }
        const double tolerance = device.detector().desc().clearance->tolerance;
        EXPECT_EQ(found.end == ClearanceEnd::Closed,
                  found.bounds.lo == kInfinity || found.bounds.hi - found.bounds.lo <= tolerance);
        EXPECT_FALSE(found.closest.has_value());
        return found;
    }
    std::vector<PairClearance> hostClearances(const Head& scene,
                                              const cpu::ClearanceDesc& desc = {.threads = 1}) const {
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create(desc));
        const cpu::BatchItem item = scene.hostItem();
        return take(meter.measure({{&item, 1}, {}, kDefaultThreshold})).pairs;
    }
};

TEST_F(ClearanceTest, OfKnownDistances) {
    std::mt19937_64 random(testSeed());
    BlockingDetector device = detector(howNear());
    const std::vector<ScalarType> types = fewTypes();
    for (int round = 0; round < 48 && !HasFailure(); ++round) {
        KnownPlane known = makeKnownPlane(random, round, types);
        SCOPED_TRACE("round " + std::to_string(round));
        const double relative = known.slack / known.distance;
        for (const double distance : {0.3, 2.0, 7.0}) {
            scaleTo(known, distance);
            const PairClearance found = ask(device, pairOf(known), round % 2 == 0);
            EXPECT_LE(found.bounds.lo, distance * (1 + relative));
            EXPECT_GE(found.bounds.hi, distance * (1 - relative));
            // Grown to 7 mm, a thousandth of a voxel may be more than the tolerance.
            EXPECT_LE(found.bounds.hi - found.bounds.lo, std::max(kDefaultTolerance, 4 * distance * relative))
                << found.bounds.lo << " to " << found.bounds.hi << ", " << toString(found.end) << ", slack "
                << distance * relative << ", voxel " << known.volume.grid.spacing[0] << " "
                << known.volume.grid.spacing[1] << " " << known.volume.grid.spacing[2];
        }
    }
}

TEST_F(ClearanceTest, IsNeverBesideTheHostsOnRandomCases) {
    const std::uint64_t seed = testSeed();
    BlockingDetector device = detector(howNear());
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    std::map<ClearanceEnd, std::size_t> ends;
    std::size_t apart = 0;
    const auto make = [&](std::uint64_t number) { return makeClearanceCase(seed, number); };
    const std::uint64_t cases = forFewKinds(randomCases(300, 12), seed, make, [&](const CertifiedCase& c, auto) {
        const oracle::OraclePair pair = c.scene.pair();
        const PairClearance host =
            onHost(pair, [&](const cpu::Batch& batch) { return take(meter.measure(batch)).pairs.at(0); });
        for (const bool clusters : {false, true}) {
            const PairClearance found = ask(device, pair, clusters);
            expectOverlap(found.bounds, host.bounds);
            if (host.bounds.lo == kInfinity && found.bounds.lo < kInfinity) { // a float may not see it
                EXPECT_EQ(found.end, ClearanceEnd::Rounding);
                EXPECT_EQ(found.bounds.hi, kInfinity);
            }
            ++ends[found.end];
            apart += found.end == ClearanceEnd::Closed && found.bounds.lo > 0 && found.bounds.hi < kInfinity ? 1U : 0U;
        }
    });
    std::cout << "  " << cases << " cases twice:";
    for (const auto& [end, count] : ends) {
        std::cout << " " << count << " " << toString(end);
    }
    std::cout << "; " << apart << " apart\n";
    EXPECT_GT(apart, cases / 10);
    EXPECT_EQ(ends[ClearanceEnd::Budget], 0U);
}

TEST_F(ClearanceTest, OfASingleVoxel) {
    BlockingDetector device = detector(howNear());
    const OneVoxel one;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            for (const double distance : {0.05, 3.0, 50.0}) {
                const MeshData mesh = one.meshAt(axis, side, distance);
                SCOPED_TRACE("axis " + std::to_string(axis) + ", " + std::to_string(side * distance));
                const PairClearance found = ask(device, pairOf(one, mesh), axis == 1);
                EXPECT_EQ(found.end, ClearanceEnd::Closed);
                EXPECT_LE(found.bounds.lo, distance + 0.002); // an entry of the table is a part of a voxel
                EXPECT_GE(found.bounds.hi, distance - 0.002);
            }
        }
    }
}

/// All in one run, so that they are looked at together: whichever of them is nearest counts.
TEST_F(ClearanceTest, OfTheNearestOfARun) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    BlockingDetector device = detector(howNear());
    const OneVoxel one;
    for (std::size_t round = 0; round < 12 && !HasFailure(); ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        const std::size_t axis = round % 3;
        const double side = round % 2 == 0 ? 1 : -1;
        const double distance = uniform(random, 0.3, 4);
        const std::size_t nearest = random() % kRunTriangles;
        MeshData mesh;
        for (std::size_t i = 0; i < kRunTriangles; ++i) {
            const MeshData alone = one.meshAt(axis, side, i == nearest ? distance : distance + uniform(random, 1, 4));
            const auto corner = [&](std::size_t c) {
                const float* at = &alone.positions[3 * std::size_t{alone.indices[c]}];
                return Vec3{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
            };
            addTriangle(mesh, corner(0), corner(1), corner(2));
        }
        const PairClearance found = ask(device, pairOf(one, mesh), true);
        EXPECT_EQ(found.end, ClearanceEnd::Closed);
        EXPECT_LE(found.bounds.lo, distance + 0.002);
        EXPECT_GE(found.bounds.hi, distance - 0.002);
    }
}

TEST_F(ClearanceTest, OfAToolAndAHead) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint32_t kPoses = 24;
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:1500")), kPoses, seed);
    for (std::size_t i = 0; i < kPoses; i += 4) { // some of them far away
        scene.poses[i] = multiply(translation({80, 4.0 * static_cast<double>(i), 0}), scene.poses[i]);
    }
    const std::vector<PairClearance> host = hostClearances(scene);
    DetectorDesc desc = howNear({.tolerance = 0.02});
    desc.counters = true;
    const Detector device = take(Detector::create(context(), desc));
    const Answered found = detect(device, scene.batch(), kPoses, 2048);
    std::size_t apart = 0;
    for (std::size_t i = 0; i < kPoses; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", pair " + std::to_string(i));
        const PairClearance& pair = found.clearances.at(i);
        expectOverlap(pair.bounds, host[i].bounds);
        EXPECT_EQ(pair.pair, i);
        EXPECT_EQ(pair.pose, i);
        EXPECT_EQ(pair.end, ClearanceEnd::Closed) << pair.bounds.lo << " to " << pair.bounds.hi;
        EXPECT_LE(pair.bounds.hi - pair.bounds.lo, 0.02);
        EXPECT_EQ(found.pairs[i].hit, isTouch(pair.bounds));
        apart += pair.bounds.lo > 0 ? 1U : 0U;
    }
    EXPECT_GT(apart, kPoses / 4);
    // With next to no room much is left to the last pass, and may be too much: the bounds are true all the same.
    constexpr std::uint32_t kFew = 5;
    scene.item.world_from_object = std::span(scene.poses).first(kFew);
    const Answered narrow = detect(device, scene.batch(), kFew, 16);
    for (std::size_t i = 0; i < kFew; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", pair " + std::to_string(i) + ", narrow");
        expectOverlap(narrow.clearances.at(i).bounds, host[i].bounds);
        EXPECT_TRUE(narrow.clearances[i].end == ClearanceEnd::Closed ||
                    narrow.clearances[i].end == ClearanceEnd::Budget);
    }
    EXPECT_GT(narrow.counters.left, 0U);
}

TEST_F(ClearanceTest, IsMeasuredBesideACount) {
    constexpr std::uint32_t kPoses = 8;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    DetectorDesc desc = howNear();
    desc.stopAtFirst = false;
    const Answered found = detect(desc, scene.batch(), kPoses, 2048);
    desc.clearance.reset();
    const Answered counted = detect(desc, scene.batch(), kPoses, 2048);
    const std::vector<PairClearance> host = hostClearances(scene);
    for (std::size_t i = 0; i < kPoses; ++i) {
        EXPECT_EQ(found.pairs[i].count, counted.pairs[i].count);
        EXPECT_EQ(found.pairs[i].possible, counted.pairs[i].possible);
        expectOverlap(found.clearances.at(i).bounds, host[i].bounds);
    }
}

TEST_F(ClearanceTest, BeyondTheMaximumNothingIsMeasured) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint32_t kPoses = 24;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed);
    const std::vector<PairClearance> all = hostClearances(scene);
    for (const double maximum : {0.3, 4.0, 30.0}) {
        const Answered found = detect(howNear({.maximum = maximum}), scene.batch(), kPoses, 2048);
        for (std::size_t i = 0; i < kPoses; ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", pair " + std::to_string(i) + ", maximum " +
                         std::to_string(maximum));
            const PairClearance& pair = found.clearances.at(i);
            if (pair.end == ClearanceEnd::Beyond) {
                EXPECT_EQ(pair.bounds.lo, maximum);
                EXPECT_EQ(pair.bounds.hi, kInfinity);
                EXPECT_GE(all[i].bounds.hi, maximum);
            } else {
                EXPECT_LE(all[i].bounds.lo, maximum * (1 + 1e-4));
                expectOverlap(pair.bounds, all[i].bounds);
            }
        }
    }
}

TEST_F(ClearanceTest, WhereNothingIsOpaque) {
    const VolumeData image = makeBytes(unitGrid(20), [](auto...) { return 100.0; });
    const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
    const TransferFunction function = upload(std::array{ControlPoint{0, 0}, ControlPoint{255, 1}}, {0, 255});
    const MeshData flat = makeFlat(0.2, 0.8, 0.2, 0.8, 0.5);
    const Detector anywhere = take(Detector::create(context(), howNear({.maximum = kInfinity})));
    const Detector near = take(Detector::create(context(), howNear({.maximum = 3})));
    for (const bool clusters : {true, false}) {
        const Mesh mesh = take(Mesh::upload(context(), queue(), flat.view(), {.clusters = clusters}));
        const std::array poses{identity(), translation({5, 0, 0})};
        const BatchItem item{&mesh, &volume, &function, poses};
        for (const PairClearance& pair : detect(anywhere, {{&item, 1}, {}, 0.5}, 2, 2048).clearances) {
            EXPECT_EQ(pair.bounds.lo, kInfinity);
            EXPECT_EQ(pair.bounds.hi, kInfinity);
            EXPECT_EQ(pair.end, ClearanceEnd::Closed);
        }
        // As the host says it.
        for (const PairClearance& pair : detect(near, {{&item, 1}, {}, 0.5}, 2, 2048).clearances) {
            EXPECT_EQ(pair.bounds.lo, 3);
            EXPECT_EQ(pair.end, ClearanceEnd::Beyond);
        }
    }
}

/// What is opaque is there, however far away the mesh is.
TEST_F(ClearanceTest, FarAwayIsNotNowhere) {
    const VolumeData image = makeBytes(unitGrid(20), [](auto...) { return 200.0; });
    const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
    const TransferFunction function = upload(std::array{ControlPoint{0, 0}, ControlPoint{255, 1}}, {0, 255});
    const MeshData flat = makeFlat(0.2, 0.8, 0.2, 0.8, 0.5);
    const Detector anywhere = take(Detector::create(context(), howNear({.maximum = kInfinity})));
    const Detector near = take(Detector::create(context(), howNear({.maximum = 3})));
    // A voxel is 1/20 mm: from 2^22 voxels to far beyond 2^24.
    const std::array places{1e3, 2.2e5, 4e5, 8.3e5, 8.5e5, 1e6, 1e9, 1e15};
    std::vector<Mat4> poses;
    for (const double place : places) {
        poses.push_back(translation({0, place, 0}));
    }
    for (const bool clusters : {true, false}) {
        const Mesh mesh = take(Mesh::upload(context(), queue(), flat.view(), {.clusters = clusters}));
        const BatchItem item{&mesh, &volume, &function, poses};
        const Answered found = detect(anywhere, {{&item, 1}, {}, 0.5}, places.size(), 2048);
        const Answered within = detect(near, {{&item, 1}, {}, 0.5}, places.size(), 2048);
        for (std::size_t i = 0; i < places.size(); ++i) {
            SCOPED_TRACE(std::to_string(places[i]) + (clusters ? " with clusters" : ""));
            EXPECT_LE(found.clearances[i].bounds.lo, places[i]);
            EXPECT_GE(found.clearances[i].bounds.hi, places[i] - 1);
            EXPECT_NE(found.clearances[i].end, ClearanceEnd::Closed);
            EXPECT_EQ(within.clearances[i].bounds.lo, 3);
            EXPECT_EQ(within.clearances[i].end, ClearanceEnd::Beyond);
        }
    }
}

/// A batch of several items, each with a volume and a transfer function of its own.
TEST_F(ClearanceTest, OfSeveralItems) {
    std::vector<Answered> alone;
    constexpr std::uint32_t kPoses = 6;
    const std::uint64_t seed = testSeed();
    const Head first(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed);
    Head second(context(), queue(), take(makeBuiltinMesh("ellipsoid:200")), kPoses, seed + 1);
    const TransferFunction bone = upload(std::array{ControlPoint{150, 0}, ControlPoint{200, 1}}, {0, 255});
    second.item.transferFunction = &bone;
    const BatchItem items[] = {first.item, second.item, first.item};
    const Detector device = take(Detector::create(context(), howNear()));
    const Answered together = detect(device, {items, {}, kDefaultThreshold}, 3 * kPoses, 2048);
    for (std::size_t i = 0; i < std::size(items); ++i) {
        const Answered one = detect(device, {{&items[i], 1}, {}, kDefaultThreshold}, kPoses, 2048);
        for (std::size_t pose = 0; pose < kPoses; ++pose) {
            const PairClearance& pair = together.clearances.at(i * kPoses + pose);
            EXPECT_EQ(pair.item, i);
            EXPECT_EQ(pair.pose, pose);
            expectOverlap(pair.bounds, one.clearances.at(pose).bounds);
        }
    }
}

/// Poses on the device, one of which is none.
TEST_F(ClearanceTest, OfPosesOnTheDevice) {
    constexpr std::uint32_t kPoses = 10;
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    PosesOnDevice poses(raw(), context(), scene.poses);
    const std::vector<PairClearance> host = hostClearances(scene);
    poses.spoil(3);
    DetectorDesc desc = howNear();
    desc.devicePoses = true;
    scene.item.world_from_object = {};
    scene.item.poses = &poses.buffer();
    const Answered found = detect(desc, scene.batch(), kPoses, 2048);
    for (std::size_t i = 0; i < kPoses; ++i) {
        const PairClearance& pair = found.clearances.at(i);
        if (i == 3) {
            EXPECT_EQ(pair.bounds.lo, 0);
            EXPECT_EQ(pair.bounds.hi, kInfinity);
            EXPECT_EQ(pair.end, ClearanceEnd::Rounding);
        } else {
            expectOverlap(pair.bounds, host[i].bounds);
            // Single precision may leave them a little farther apart than was asked for.
            EXPECT_TRUE(pair.end == ClearanceEnd::Closed || pair.end == ClearanceEnd::Rounding);
            EXPECT_LT(pair.bounds.hi - pair.bounds.lo, 2 * desc.clearance->tolerance);
        }
    }
}

/// Triangles through all of a volume that is opaque in a single voxel of each brick, and room for next to nothing.
TEST_F(ClearanceTest, WhatIsTooMuchEndsTheSearch) {
    const VolumeData image = makeBytes(unitGrid(96), [](auto x, auto y, auto z) {
        return x % 8 == 4 && y % 8 == 4 && z > 80 && z % 8 == 4 ? 255.0 : 0.0;
    });
    const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
    const TransferFunction function = upload(std::array{ControlPoint{0, 0}, ControlPoint{255, 1}}, {0, 255});
    MeshData mesh;
    for (int i = 0; i < 64; ++i) {
        const double z = 0.3 + 0.001 * i;
        addTriangle(mesh, {-2, -2, z}, {3, -2, z}, {-2, 3, z});
    }
    const Mesh onDevice = take(Mesh::upload(context(), queue(), mesh.view(), {.clusters = true}));
    const Mat4 pose = identity();
    const BatchItem item{&onDevice, &volume, &function, {&pose, 1}};
    const Detector device = take(Detector::create(context(), howNear({.tolerance = 1e-5})));
    const PairClearance narrow = detect(device, {{&item, 1}, {}, 0.5}, 1, 16).clearances.at(0);
    const PairClearance roomy = detect(device, {{&item, 1}, {}, 0.5}, 1, 16384).clearances.at(0);
    // The uppermost triangle is at 0.363; the first opaque voxel's centre at 84.5 / 96, and half of it is opaque.
    const double distance = 84.0 / 96 - 0.363;
    for (const PairClearance& pair : {narrow, roomy}) {
        EXPECT_LE(pair.bounds.lo, distance + 1e-4);
        EXPECT_GE(pair.bounds.hi, distance - 1e-4);
    }
    std::cout << "  " << toString(narrow.end) << ": " << narrow.bounds.lo << " to " << narrow.bounds.hi << "; "
              << toString(roomy.end) << ": " << roomy.bounds.lo << " to " << roomy.bounds.hi << "\n";
    EXPECT_EQ(narrow.end, ClearanceEnd::Budget);
}

TEST_F(ClearanceTest, IsOnTheDeviceForTheNextPass) {
    constexpr std::uint32_t kPoses = 5;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    const Detector device = take(Detector::create(context(), howNear()));
    Results results = take(Results::create(context(), {.maxPairs = kPoses, .clearances = true}));
    EXPECT_EQ(results.readClearances().error().code, ErrorCode::NotReady);
    const BufferRange range = results.clearances();
    EXPECT_EQ(range.size, kPoses * sizeof(ClearanceResult));
    EXPECT_EQ(range.offset % 256, 0U);
    const RawVulkan::HostBuffer copy = raw().makeBuffer(range.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = raw().begin();
    take(device.cmdDetect(commands, scene.batch(), results));
    take(results.cmdReadBack(commands));
    const VkBufferCopy region{range.offset, 0, range.size};
    raw().vk().vkCmdCopyBuffer(commands, range.buffer, copy.buffer, 1, &region);
    raw().submitAndWait(commands);
    const std::vector<PairClearance> host = take(results.readClearances());
    for (std::uint32_t i = 0; i < kPoses; ++i) {
        ClearanceResult found{};
        std::memcpy(&found, static_cast<const std::byte*>(copy.mapped) + i * sizeof found, sizeof found);
        EXPECT_EQ(static_cast<double>(found.lo), host.at(i).bounds.lo);
        EXPECT_EQ(static_cast<double>(found.hi), host.at(i).bounds.hi);
        EXPECT_EQ(found.end, static_cast<std::uint32_t>(host.at(i).end));
        EXPECT_EQ(found.reserved, 0U);
    }
}

TEST_F(ClearanceTest, IsReadOutOfARing) {
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), 1, testSeed());
    DetectorDesc desc = howNear({.maximum = 30});
    desc.counters = true;
    const Detector device = take(Detector::create(context(), desc));
    ResultRing ring = take(ResultRing::create(context(), 2, {.maxPairs = 1, .clearances = true}));
    EXPECT_EQ(ring.results(0).error().code, ErrorCode::NotReady);
    for (const std::uint64_t frame : {0U, 1U, 2U}) {
        Results* results = take(ring.begin(frame));
        const VkCommandBuffer commands = raw().begin();
        take(device.cmdDetect(commands, scene.batch(), *results));
        take(results->cmdReadBack(commands));
        raw().submitAndWait(commands);
        EXPECT_EQ(take(ring.results(frame)), results);
        EXPECT_EQ(take(take(ring.results(frame))->readClearances()).size(), 1U);
        EXPECT_GT(take(take(ring.results(frame))->counters()).clusters, 0U);
    }
    EXPECT_EQ(ring.results(0).error().code, ErrorCode::NotReady) << "frame 2 has its slot";
    EXPECT_EQ(ring.results(3).error().code, ErrorCode::NotReady);
}

TEST_F(ClearanceTest, RefusesWhatHasNoAnswer) {
    const auto refusal = [&](const DetectorDesc& desc) {
        const Result<Detector> made = Detector::create(context(), desc);
        EXPECT_FALSE(made.ok());
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        return made.ok() ? std::string() : made.error().text;
    };
    for (const double tolerance : {0.0, -1.0, 1e-7, std::numeric_limits<double>::quiet_NaN(), kInfinity}) {
        EXPECT_THAT(refusal(howNear({.tolerance = tolerance})), HasSubstr("is not a number from 1e-06 mm on"));
    }
    for (const double maximum : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THAT(refusal(howNear({.maximum = maximum})), HasSubstr("mm is not above 0"));
    }
    DetectorDesc outputs = howNear();
    outputs.stopAtFirst = false;
    outputs.outputs.triangles = true;
    EXPECT_THAT(refusal(outputs), HasSubstr("clearances are measured without outputs"));
    DetectorDesc margin = howNear();
    margin.margin = 1;
    EXPECT_THAT(refusal(margin), HasSubstr("a clearance and a margin are two questions"));
    EXPECT_THAT(refusal({.method = CountingMethod::Compute, .clearance = ClearanceSearch{}}),
                HasSubstr("a clearance is for the projection conservative, not for view"));
    EXPECT_THAT(refusal({.clearance = ClearanceSearch{}}), HasSubstr("a clearance is for the projection conservative"));

    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), 1, 1);
    const Detector device = take(Detector::create(context(), howNear()));
    Results results = take(Results::create(context(), {.maxPairs = 1}));
    EXPECT_EQ(results.clearances().buffer, VK_NULL_HANDLE);
    const VkCommandBuffer commands = raw().begin();
    const Result<void> recorded = device.cmdDetect(commands, scene.batch(), results);
    raw().submitAndWait(commands);
    ASSERT_FALSE(recorded.ok());
    EXPECT_THAT(recorded.error().text, HasSubstr("no room for clearances: ResultsDesc::clearances is false"));
}

} // namespace
} // namespace voxtact::test
