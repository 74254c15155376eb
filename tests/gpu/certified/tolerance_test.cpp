// SPDX-License-Identifier: MIT
// Poses that may be off, on the device: never against the host's cpu::MotionChecker::around(), where it is known what
// is reached, and what must follow from one tolerance for another.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/sides.h"
#include "cpu/scenes/margin_cases.h"
#include "few_kinds.h"
#include "support/floor.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

DetectorDesc off(const PoseTolerance& tolerance) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .poseTolerance = tolerance};
}

/// How often it is said.
struct Said {
    std::size_t yes = 0;
    std::size_t no = 0;
    std::size_t possible = 0;

    void add(const PairAnswer& answer) {
        EXPECT_FALSE(answer.hit && answer.possible);
        EXPECT_EQ(answer.count, answer.hit ? 1U : 0U);
        EXPECT_EQ(answer.exactness, Exactness::LowerBound);
        ++(answer.hit ? yes : answer.possible ? possible : no);
    }
};

std::ostream& operator<<(std::ostream& out, const Said& said) {
    return out << said.yes << " yes, " << said.no << " no, " << said.possible << " possible";
}

std::vector<PairAnswer> hostAnswers(const cpu::BatchItem& item, double threshold, const PoseTolerance& tolerance) {
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    return take(checker.around({{&item, 1}, {}, threshold}, tolerance)).pairs;
}

/// One for most tests: each angle has pipelines of its own.
constexpr PoseTolerance kOff{2, 12};

class ToleranceTest : public CertifiedTest {
  protected:
    std::vector<PairAnswer> ask(const Head& scene, const PoseTolerance& tolerance, std::uint32_t clusters = 2048) {
        return detect(off(tolerance), scene.batch(), static_cast<std::uint32_t>(scene.poses.size()), clusters).pairs;
    }
    /// One pair.
    PairAnswer ask(BlockingDetector& device, const oracle::OraclePair& pair, bool clusters) const {
        return askPair(device, context(), queue(), pair, clusters).pairs.at(0);
    }
};

/// Of a scalpel about a head, from hardly a turn to a half one. What the device leaves *possible* is hardly more.
TEST_F(ToleranceTest, SaysNothingAgainstTheHost) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint32_t kPoses = 60;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed, true, 1.6);
    const cpu::BatchItem at = scene.hostItem();
    for (const PoseTolerance& tolerance : {kOff, PoseTolerance{0.5, 0.01}, PoseTolerance{0, 12}, PoseTolerance{1, 180},
                                           PoseTolerance{2, 0}, PoseTolerance{1e-5, 0}, PoseTolerance{0, 0}}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(tolerance.distance) + " mm, " +
                     std::to_string(tolerance.angle) + " degrees");
        const std::vector<PairAnswer> host = hostAnswers(at, kDefaultThreshold, tolerance);
        const std::vector<PairAnswer> device = ask(scene, tolerance);
        ASSERT_EQ(device.size(), host.size());
        Said ofDevice;
        Said ofHost;
        for (std::uint32_t i = 0; i < kPoses; ++i) {
            SCOPED_TRACE("pose " + std::to_string(i));
            expectNoContradiction(device[i], host[i]);
            ofDevice.add(device[i]);
            ofHost.add(host[i]);
        }
        std::cout << "  " << tolerance.distance << " mm, " << tolerance.angle << " degrees: device " << ofDevice
                  << "; host " << ofHost << '\n';
        EXPECT_LE(ofDevice.possible, ofHost.possible + kPoses / 10);
    }
}

/// Random volumes, also with axes that are not at right angles, meshes and poses.
TEST_F(ToleranceTest, SaysNothingAgainstTheHostOnRandomCases) {
    const std::uint64_t seed = testSeed();
    BlockingDetector device = detector(off(kOff));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    Said said;
    Said ofHost;
    const auto make = [&](std::uint64_t number) { return makeMarginCase(seed, number, meter); };
    const std::uint64_t cases = forFewKinds(randomCases(4000, 160), seed, make, [&](MarginCase& c, auto number) {
        scaleTo(c, kOff.distance * std::exp2(static_cast<double>(1 + number % 5))); // a turn adds to the distance
        const oracle::OraclePair pair = c.scene.pair();
        const HostSide side(pair.volume, pair.transferFunction, pair.mesh);
        const PairAnswer host = hostAnswers(side.item({&pair.world_from_object, 1}), pair.threshold, kOff).at(0);
        const PairAnswer found = ask(device, pair, number % 2 == 0);
        expectNoContradiction(found, host);
        said.add(found);
        ofHost.add(host);
    });
    std::cout << "  " << cases << " cases: device " << said << "; host " << ofHost << '\n';
}

/// A rod from the object's origin, so many degrees above the level: turned by `angle` towards the floor and then moved,
/// its end comes down by as much as is known. One that points at the floor gains nothing by a turn.
TEST_F(ToleranceTest, OfARodAboveAFloor) {
    constexpr double kLength = 14;
    const VolumeData image = floorImage();
    BlockingDetector device = detector(off(kOff));
    for (const double above : {-90.0, -85.0, -40.0, 0.0, 30.0, 60.0, 90.0}) {
        const double degree = std::numbers::pi / 180;
        const auto lowest = [&](double angle) { return kLength * std::sin(std::max(angle, -90.0) * degree); };
        // The origin is a point of the rod, too.
        const double reach = std::max(-lowest(above - kOff.angle), 0.0) + kOff.distance;
        MeshData rod;
        const Vec3 end{kLength * std::cos(above * degree), 0, kLength * std::sin(above * degree)};
        addTriangle(rod, {0, 0, 0}, end, {end[0], end[1] + 0.1, end[2]});
        for (const double more : {-0.5, -0.02, 0.02, 0.5}) {
            SCOPED_TRACE(std::to_string(above) + " degrees, " + std::to_string(more) + " mm farther than it reaches");
            const PairAnswer found = ask(device,
                                         {rod.view(),
                                          image.view(),
                                          {kFloorPoints, kFloorDomain, kFloorEntries},
                                          {},
                                          translation({1, 2, reach + more}),
                                          0.5},
                                         more < 0);
            EXPECT_EQ(found.hit, more < 0);
            EXPECT_FALSE(found.possible);
        }
    }
}

/// No answer that is sure depends on how much there is room for, on whether the mesh has clusters, or on where its
/// poses are; and what a smaller tolerance reaches, a larger one does.
TEST_F(ToleranceTest, IsOneAnswerHoweverItIsFound) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    constexpr std::uint32_t kPoses = 12;
    for (const bool clusters : {true, false}) {
        Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed, clusters, 1.5);
        std::vector<float> floats;
        for (Mat4& pose : scene.poses) {
            for (double& element : pose) {
                floats.push_back(static_cast<float>(element));
                element = static_cast<double>(floats.back());
            }
        }
        DetectorDesc desc = off(kOff);
        desc.counters = true;
        const Answered one = detect(desc, scene.batch(), kPoses, 16384);
        const Answered many = detect(desc, scene.batch(), kPoses, 16);
        EXPECT_EQ(one.counters.left, 0U);
        desc.poseTolerance->distance = 9;
        const std::vector<PairAnswer> less = ask(scene, {0, 0});
        const Answered farther = detect(desc, scene.batch(), kPoses, 16384);
        const Answered fartherOfMany = detect(desc, scene.batch(), kPoses, 16);
        desc.poseTolerance = kOff;
        const RawVulkan::HostBuffer buffer =
            raw().makeBuffer(std::span<const float>(floats), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        const PoseBuffer poses =
            take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer, .stride = 64, .count = kPoses}));
        desc.devicePoses = true;
        scene.item.world_from_object = {};
        scene.item.poses = &poses;
        const Answered there = detect(desc, scene.batch(), kPoses, 2048);
        for (std::uint32_t i = 0; i < kPoses; ++i) {
            SCOPED_TRACE("pose " + std::to_string(i));
            expectNoContradiction(many.pairs[i], one.pairs[i]);
            expectNoContradiction(there.pairs[i], one.pairs[i]);
            EXPECT_FALSE(less[i].hit && !one.pairs[i].hit);
            EXPECT_FALSE(one.pairs[i].hit && !farther.pairs[i].hit);
            expectNoContradiction(fartherOfMany.pairs[i], farther.pairs[i]);
        }
    }
}

/// In a volume whose opacity is below the threshold by less than a computed opacity may be off, every cell may be
/// opaque and none is, but one: a triangle gets there by a turn about the world's origin, whatever has no room before.
TEST_F(ToleranceTest, WhatHasNoRoomIsDecidedLater) {
    Grid grid;
    grid.size = {40, 40, 40};
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const TransferFunction function = upload(points, {0, 255});
    const Mat4 pose = identity();
    const Vec3 bright{28, 20, 20};
    MeshData data;
    for (int i = 0; i < 16; ++i) {
        // Turned back by up to 10 degrees about z.
        const double by = (2 + i / 2) * std::numbers::pi / 180;
        const Vec3 at{bright[0] * std::cos(by) + bright[1] * std::sin(by),
                      bright[1] * std::cos(by) - bright[0] * std::sin(by), bright[2]};
        addTriangle(data, at, at, at);
    }
    const Mesh mesh = take(Mesh::upload(context(), queue(), data.view(), {.clusters = true}));
    DetectorDesc desc = off(kOff);
    desc.counters = true;
    const Detector detector = take(Detector::create(context(), desc));
    for (const double value : {255.0, 100.0}) {
        const VolumeData image = makeBytes(grid, [&](auto x, auto y, auto z) {
            return x == bright[0] && y == bright[1] && z == bright[2] ? value : 100.0;
        });
        const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        for (const std::uint32_t clusters : {16U, 16384U}) {
            SCOPED_TRACE(std::to_string(value) + ", room " + std::to_string(clusters));
            const Answered found = detect(detector, {{&item, 1}, {}, 100.0 / 255 + 2e-7}, 1, clusters);
            EXPECT_EQ(found.pairs.at(0).hit, value > 100);
            EXPECT_EQ(found.pairs.at(0).possible, value == 100);
            EXPECT_TRUE(clusters > 16 || value > 100 || found.counters.left > 0);
        }
    }
}

/// Where the object's origin is so far away that single precision does not say where a turn brings its mesh, or the
/// mesh itself is not known to a voxel's part, it is *possible*, and what is far from everything is still far.
TEST_F(ToleranceTest, OfAnOriginFarAway) {
    const VolumeData image = floorImage();
    BlockingDetector device = detector(off(kOff));
    for (const double origin : {100.0, 1e4, 1e9}) {
        SCOPED_TRACE("origin at " + std::to_string(origin));
        MeshData mesh;
        addTriangle(mesh, {origin, 0, 0}, {origin, 1, 0}, {origin, 0, 1});
        const auto at = [&](double height) {
            return ask(device,
                       {mesh.view(),
                        image.view(),
                        {kFloorPoints, kFloorDomain, kFloorEntries},
                        {},
                        translation({1 - origin, 2, height}),
                        0.5},
                       true);
        };
        EXPECT_TRUE(at(-3).hit || (origin > 1e6 && at(-3).possible));
        const PairAnswer near = at(kOff.distance + 1); // a turn brings it there
        EXPECT_TRUE(near.hit || near.possible);
        const double farther = origin > 1e6 ? 100 * origin : origin;
        const PairAnswer far = at(farther);
        EXPECT_FALSE(far.hit || far.possible);
    }
}

TEST_F(ToleranceTest, RefusesWhatHasNoAnswer) {
    const auto refusal = [&](const DetectorDesc& desc) {
        const Result<Detector> made = Detector::create(context(), desc);
        EXPECT_FALSE(made.ok());
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        return made.ok() ? std::string() : made.error().text;
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double distance : {-1.0, kNan, std::numeric_limits<double>::infinity()}) {
        EXPECT_THAT(refusal(off({distance, 1})), HasSubstr("of the tolerance is not a number from 0 on"));
    }
    EXPECT_THAT(refusal(off({1000001, 1})), HasSubstr("above 1e+06 mm, the most on a device"));
    for (const double angle : {-1.0, kNan, 181.0}) {
        EXPECT_THAT(refusal(off({1, angle})), HasSubstr("outside of 0 to 180"));
    }
    DetectorDesc desc = off(kOff);
    desc.stopAtFirst = false;
    EXPECT_THAT(refusal(desc), HasSubstr("it needs a detector that stops at the first survivor"));
    desc = off(kOff);
    desc.outputs.triangles = true;
    EXPECT_THAT(refusal(desc), HasSubstr("by yes or no, without outputs"));
    desc = off(kOff);
    desc.margin = 1;
    EXPECT_THAT(refusal(desc), HasSubstr("leave out the margin"));
    desc = off(kOff);
    desc.clearance = ClearanceSearch{};
    EXPECT_THAT(refusal(desc), HasSubstr("they need a detector each"));
    EXPECT_THAT(refusal({.method = CountingMethod::Compute, .poseTolerance = kOff}),
                HasSubstr("a pose tolerance is for the projection conservative, not for view"));
}

} // namespace
} // namespace voxtact::test
