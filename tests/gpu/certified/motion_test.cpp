// SPDX-License-Identifier: MIT
// Motions on the device: never against the host's cpu::MotionChecker, nor against what samples of the way say.
#include "certified/along.h"
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/sides.h"
#include "cpu/scenes/margin_cases.h"
#include "cpu/scenes/random_scene.h"
#include "few_kinds.h"
#include "support/floor.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <numbers>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

std::vector<SegmentMotion> hostMotions(const cpu::BatchItem& item, double threshold, const MotionSearch& search) {
    cpu::MotionChecker checker = take(cpu::MotionChecker::create(
        {.threads = 1, .interpolation = search.interpolation, .resolution = search.resolution}));
    return take(checker.check({{&item, 1}, {}, threshold})).segments;
}

/// How often it is said.
struct SaidOfWays {
    std::size_t free = 0;
    std::size_t touches = 0;
    std::size_t possible = 0;
    std::size_t undecided = 0;

    void add(const SegmentMotion& of) {
        EXPECT_EQ(of.possible, !of.touch && of.freeUntil < 1);
        ++(of.touch ? touches : of.possible ? possible : free);
        undecided += of.end == MotionEnd::Decided ? 0 : 1;
    }
};

std::ostream& operator<<(std::ostream& out, const SaidOfWays& said) {
    return out << said.free << " free, " << said.touches << " touch, " << said.possible << " possible, "
               << said.undecided << " not decided";
}

/// mm, at least: how far a point of a mesh goes between two poses.
double wayOf(const MeshFacts& mesh, const Mat4& from, const Mat4& to) {
    double longest = 0;
    for (unsigned i = 0; i < 8; ++i) {
        const Box& box = mesh.bounds;
        const Vec3 corner{(i & 1U) != 0 ? box.hi[0] : box.lo[0], (i & 2U) != 0 ? box.hi[1] : box.lo[1],
                          (i & 4U) != 0 ? box.hi[2] : box.lo[2]};
        const Vec3 a = transformPoint(from, corner);
        const Vec3 b = transformPoint(to, corner);
        longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
    }
    return longest;
}

/// What both prove is true at once.
void expectWaysAgree(const SegmentMotion& device, const SegmentMotion& host) {
    EXPECT_EQ(device.segment, host.segment);
    EXPECT_EQ(device.item, host.item);
    EXPECT_EQ(device.pose, host.pose);
    const auto expectOrder = [](const SegmentMotion& free, const SegmentMotion& touching) {
        if (touching.touch) {
            // What is free is so at its end, too; but of a way that begins with a touch nothing is.
            EXPECT_TRUE(free.freeUntil < touching.touch->at || free.freeUntil == 0)
                << free.freeUntil << ", and a touch at " << touching.touch->at;
        }
    };
    expectOrder(device, host);
    expectOrder(host, device);
    expectOrder(device, device);
}

Vec3 middleOf(const Box& box) {
    return {0.5 * (box.lo[0] + box.hi[0]), 0.5 * (box.lo[1] + box.hi[1]), 0.5 * (box.lo[2] + box.hi[2])};
}

/// Of a mesh, where it touches is the pose that is said, and what is free does not touch wherever one looks.
struct Witness {
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Conservative}));

    [[nodiscard]] PairAnswer at(cpu::BatchItem item, double threshold, const Mat4& pose) {
        item.world_from_object = {&pose, 1};
        return take(detector.detect({{&item, 1}, {}, threshold})).pairs.at(0);
    }

    /// `from` and `to`: the poses of the segment.
    void expect(const cpu::BatchItem& item, double threshold, const SegmentMotion& found, const MotionSearch& search,
                int samples) {
        const Mat4& from = item.world_from_object[found.pose];
        const Mat4& to = item.world_from_object[found.pose + 1];
        const Box& box = item.mesh->facts().bounds;
        const auto poseAt = [&](double t) {
            return take(poseBetween(from, to, t, search.interpolation, middleOf(box)));
        };
        if (found.touch) {
            EXPECT_EQ(found.touch->world_from_object, poseAt(found.touch->at));
            EXPECT_TRUE(at(item, threshold, found.touch->world_from_object).hit);
            EXPECT_LT(found.touch->triangle, item.mesh->facts().triangles);
        }
        for (int i = 0; i <= samples; ++i) {
            const double t = found.freeUntil * i / samples;
            EXPECT_FALSE(t > 0 && at(item, threshold, poseAt(t)).hit) << "at " << t;
        }
    }
};

class MotionTest : public CertifiedTest {
  protected:
    void expectRefusals(const Detector& device);
};

/// A scalpel about a head, some millimetres and degrees from pose to pose.
TEST_F(MotionTest, SaysNothingAgainstTheHost) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    constexpr std::size_t kPoses = 9;
    std::mt19937_64 random(seed);
    Witness witness;
    const MotionSearch search;
    const Detector device = take(Detector::create(context(), along(search)));
    for (const double far : {3.0, 30.0}) {
        Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed, true, 1.6);
        for (std::size_t i = 1; i < kPoses; i += 2) { // back and forth
            const Mat4 axes = randomRotation(random);
            const Mat4 turn = multiply(axes, multiply(turned(0, uniform(random, 0, 8) * kDegree), take(inverse(axes))));
            scene.poses[i] = multiply(translation({far * axes[0], far * axes[1], far * axes[2]}),
                                      multiply(scene.poses[i - 1], turn));
        }
        scene.item.world_from_object = scene.poses;
        const std::vector<SegmentMotion> host = hostMotions(scene.hostItem(), kDefaultThreshold, search);
        const std::vector<SegmentMotion> found = detect(device, scene.batch(), kPoses, 2048).motions;
        ASSERT_EQ(found.size(), kPoses - 1);
        SaidOfWays ofDevice;
        SaidOfWays ofHost;
        double widest = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            SCOPED_TRACE("segment " + std::to_string(i));
            expectWaysAgree(found[i], host[i]);
            witness.expect(scene.hostItem(), kDefaultThreshold, found[i], search, 20);
            ofDevice.add(found[i]);
            ofHost.add(host[i]);
            // As near to each other as single precision lets them be, where double precision brings them together.
            if (found[i].touch && host[i].end == MotionEnd::Decided) {
                const double way = wayOf(scene.hostMesh.facts(), scene.poses[i], scene.poses[i + 1]);
                widest = std::max(widest, (found[i].touch->at - found[i].freeUntil) * way);
            }
        }
        EXPECT_LE(widest, 0.05 * scene.head.grid.spacing[0] + search.resolution);
        std::cout << "  " << far << " mm: device " << ofDevice << "; host " << ofHost << "; at most " << widest
                  << " mm from free to touch, voxels of " << scene.head.grid.spacing[0] << '\n';
        EXPECT_LE(ofDevice.possible, ofHost.possible + 1);
    }
}

/// Random volumes, also with axes that are not at right angles, meshes and ways.
TEST_F(MotionTest, SaysNothingAgainstTheHostOnRandomCases) {
    const std::uint64_t seed = testSeed();
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    Witness witness;
    SaidOfWays said;
    SaidOfWays ofHost;
    std::mt19937_64 random(seed);
    const MotionSearch search{0.01, Interpolation::Slerp};
    BlockingDetector device = detector(along(search));
    const auto make = [&](std::uint64_t number) { return makeMarginCase(seed, number, meter); };
    const std::uint64_t cases = forFewKinds(randomCases(4000, 400), seed, make, [&](MarginCase& c, auto number) {
        scaleTo(c, std::exp2(uniform(random, -2, 4)));
        const oracle::OraclePair pair = c.scene.pair();
        const Mat4 axes = randomRotation(random);
        const double angle = chance(random, 0.3) ? 0 : uniform(random, 0, 1.5);
        const Mat4 turn = multiply(axes, multiply(turned(0, angle), take(inverse(axes))));
        const double by = chance(random, 0.2) ? 0 : c.margin * std::exp2(uniform(random, -1, 3));
        const Sides sides(context(), queue(), pair.volume, pair.transferFunction, pair.mesh, number % 3 != 0);
        const Box& box = sides.host.mesh.facts().bounds;
        const Vec3 at = transformPoint(pair.world_from_object, middleOf(box));
        const Mat4 turnedThere = multiply(translation(at), multiply(turn, translation({-at[0], -at[1], -at[2]})));
        const std::array poses{pair.world_from_object, multiply(translation({by * axes[0], by * axes[1], by * axes[2]}),
                                                                multiply(turnedThere, pair.world_from_object))};
        const SegmentMotion host = hostMotions(sides.hostItem(poses), pair.threshold, search).at(0);
        const BatchItem item = sides.item(poses);
        const SegmentMotion found = take(device.detect({{&item, 1}, {}, pair.threshold})).motions.at(0);
        expectWaysAgree(found, host);
        witness.expect(sides.hostItem(poses), pair.threshold, found, search, 10);
        said.add(found);
        ofHost.add(host);
    });
    std::cout << "  " << cases << " cases: device " << said << "; host " << ofHost << '\n';
}

/// What is proven does not depend on how much there is room for, on clusters, or on what else is in the batch.
TEST_F(MotionTest, IsOneAnswerHoweverItIsFound) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    constexpr std::uint32_t kPoses = 6;
    DetectorDesc desc = along();
    desc.counters = true;
    const Detector device = take(Detector::create(context(), desc));
    std::vector<std::vector<SegmentMotion>> found;
    for (const bool clusters : {true, false}) {
        Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed, clusters, 1.4);
        for (std::uint32_t i = 1; i < kPoses; ++i) {
            scene.poses[i] = multiply(translation({i % 2 == 0 ? 5.0 : -5.0, 3, 1.0 * i}), scene.poses[i - 1]);
        }
        scene.item.world_from_object = scene.poses;
        for (const std::uint32_t room : {16U, 48U, 16384U}) { // one segment a round, or some, or all of them
            found.push_back(detect(device, scene.batch(), kPoses, room).motions);
        }
        // Between items that stay where they are, which take few steps.
        const std::vector<Mat4> still(kPoses, translation({0, 0, 400}));
        BatchItem resting = scene.item;
        resting.world_from_object = still;
        const std::array items{resting, scene.item, resting};
        Answered three = detect(device, {items, {}, kDefaultThreshold}, 3 * kPoses, 2048);
        ASSERT_EQ(three.motions.size(), 3 * (kPoses - 1));
        EXPECT_GT(three.counters.rounds, 0U);
        found.emplace_back(three.motions.begin() + kPoses - 1, three.motions.begin() + 2 * (kPoses - 1));
        for (SegmentMotion& motion : found.back()) {
            EXPECT_EQ(motion.item, 1U);
            motion.item = 0;
            motion.segment -= kPoses - 1;
        }
    }
    for (const std::vector<SegmentMotion>& other : found) {
        ASSERT_EQ(other.size(), found[0].size());
        for (std::size_t i = 0; i < other.size(); ++i) {
            expectWaysAgree(other[i], found[0][i]);
            EXPECT_NE(other[i].end, MotionEnd::Budget) << "segment " << i;
        }
    }
}

TEST_F(MotionTest, RefusesWhatHasNoAnswer) {
    const auto refusal = [&](const DetectorDesc& desc) {
        const Result<Detector> made = Detector::create(context(), desc);
        EXPECT_FALSE(made.ok());
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        return made.ok() ? std::string() : made.error().text;
    };
    for (const double resolution : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THAT(refusal(along({resolution, {}})), HasSubstr("mm is not a number from 1e-06 mm on"));
    }
    DetectorDesc desc = along();
    desc.stopAtFirst = false;
    EXPECT_THAT(refusal(desc), HasSubstr("it needs a detector that stops at the first survivor"));
    desc = along();
    desc.outputs.triangles = true;
    EXPECT_THAT(refusal(desc), HasSubstr("without outputs"));
    desc = along();
    desc.margin = 1;
    EXPECT_THAT(refusal(desc), HasSubstr("a motion and a margin are two questions"));
    desc = along();
    desc.clearance = ClearanceSearch{};
    EXPECT_THAT(refusal(desc), HasSubstr("a motion and a clearance are two questions"));
    EXPECT_THAT(refusal({.method = CountingMethod::Compute, .motion = MotionSearch{}}),
                HasSubstr("a motion is for the projection conservative, not for view"));
}

/// The words that stay on the device say the same; and where there is no way, none is said to be there. Of a batch are
/// refused: no room, poses on the device, and poses that no rigid motion joins.
TEST_F(MotionTest, LeavesItsResultsOnTheDevice) {
    MeshData tip;
    addTriangle(tip, {0, 0, 0}, {0.3, 0, 5}, {0, 0.3, 5});
    const VolumeData image = floorImage();
    const DeviceSide side(context(), queue(), image.view(), {kFloorPoints, kFloorDomain, kFloorEntries}, tip.view(),
                          true);
    const std::vector<Mat4> poses{translation({1, 2, 4}), translation({1, 2, -4})};
    const std::array items{side.item(poses), side.item({poses.data(), 1}), side.item({})};
    DetectorDesc desc = along();
    desc.devicePoses = true;
    const Detector device = take(Detector::create(context(), desc));
    Results results = take(Results::create(context(), {.maxPairs = 5, .motions = true}));
    const BufferRange range = results.motions();
    ASSERT_EQ(range.size, 5 * sizeof(MotionResult));
    EXPECT_EQ(range.offset % 256, 0U);
    const VkCommandBuffer commands = raw().begin();
    take(device.cmdDetect(commands, {items, {}, 0.5}, results));
    take(results.cmdReadBack(commands));
    raw().submitAndWait(commands);
    const std::vector<SegmentMotion> read = take(results.readMotions());
    ASSERT_EQ(read.size(), 1U);
    const std::vector<std::byte> bytes = raw().readBuffer(range.buffer, range.offset + range.size);
    std::array<MotionResult, 3> found{};
    std::memcpy(found.data(), bytes.data() + range.offset, sizeof found);
    ASSERT_TRUE(read[0].touch);
    EXPECT_EQ(static_cast<double>(found[0].freeUntil), read[0].freeUntil);
    EXPECT_EQ(static_cast<double>(found[0].touchAt), read[0].touch->at);
    EXPECT_EQ(found[0].end, VOXTACT_MOTION_DECIDED);
    for (const std::size_t last : {1U, 2U}) {
        EXPECT_EQ(found[last].freeUntil, 1.0F);
        EXPECT_TRUE(std::isinf(found[last].touchAt));
    }
    expectRefusals(device);
}

void MotionTest::expectRefusals(const Detector& device) {
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), 3, 1);
    Results without = take(Results::create(context(), {.maxPairs = 3}));
    Results with = take(Results::create(context(), {.maxPairs = 3, .motions = true}));
    const VkCommandBuffer commands = raw().begin();
    const auto refusal = [&](Results& results) {
        const Result<void> recorded = device.cmdDetect(commands, scene.batch(), results);
        EXPECT_FALSE(recorded.ok());
        return recorded.ok() ? std::string() : recorded.error().text;
    };
    EXPECT_THAT(refusal(without), HasSubstr("ResultsDesc::motions is false"));
    EXPECT_EQ(without.motions().buffer, VK_NULL_HANDLE);
    scene.poses[2][0] *= 2;
    EXPECT_THAT(refusal(with), HasSubstr("batch item 0, poses 1 and 2: the motion from one to the other is not rigid"));
    EXPECT_FALSE(with.readMotions().ok());
    const std::vector<float> floats(48, 1);
    const RawVulkan::HostBuffer buffer =
        raw().makeBuffer(std::span<const float>(floats), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const PoseBuffer poses = take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer, .stride = 64, .count = 3}));
    scene.item.world_from_object = {};
    scene.item.poses = &poses;
    EXPECT_THAT(refusal(with), HasSubstr("not between those of a PoseBuffer"));
    raw().submitAndWait(commands);
}

} // namespace
} // namespace voxtact::test
