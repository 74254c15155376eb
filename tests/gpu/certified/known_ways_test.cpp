// SPDX-License-Identifier: MIT
// Motions on the device of which it is known when a mesh touches.
#include "certified/along.h"
#include "certified/counted_fixture.h"
#include "certified/sides.h"
#include "support/floor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace voxtact::test {
namespace {

/// Ways of which it is known where they touch first: all by one detector, whose programs take long to make.
class KnownWays : public CertifiedTest {
  protected:
    /// Of one mesh above the floor.
    std::vector<SegmentMotion> overFloor(BlockingDetector& device, const MeshData& mesh, const std::vector<Mat4>& poses,
                                         bool clusters = true) const {
        return over(floorImage(), device, mesh, poses, clusters);
    }
    /// Of values from -10 to 10.
    std::vector<SegmentMotion> over(const VolumeData& image, BlockingDetector& device, const MeshData& mesh,
                                    const std::vector<Mat4>& poses, bool clusters) const {
        const DeviceSide side(context(), queue(), image.view(), {kFloorPoints, kFloorDomain, kFloorEntries},
                              mesh.view(), clusters);
        const BatchItem item = side.item(poses);
        const BatchAnswer answer = take(device.detect({{&item, 1}, {}, 0.5}));
        EXPECT_EQ(answer.pairs.size(), poses.size());
        for (const SegmentMotion& motion : answer.motions) {
            const PairAnswer& pair = answer.pairs.at(motion.pose);
            EXPECT_EQ(pair.hit, motion.touch.has_value());
            EXPECT_EQ(pair.possible, motion.possible);
        }
        EXPECT_FALSE(answer.pairs.back().hit || answer.pairs.back().possible);
        return answer.motions;
    }
    /// A tip straight down to the floor, from near and from far.
    void expectTip(BlockingDetector& device);
    /// A rod from the origin along x, turned about y: its far end comes down on a circle. The second way ends before.
    void expectTurningRod(BlockingDetector& device);
    /// Some voxels where the rod's end is at last: seen from the middle of the way, it is 3 mm beside the tangent.
    void expectEndOfATurn(BlockingDetector& device);
    /// A tip on a circle of 8 mm that meets a thin ridge: seen from the middle of the way, which is short, the ridge is
    /// half a mm beside the tangent.
    void expectTightTurn(BlockingDetector& device);
    /// Along a floor at a small distance, into a wall at the end of the way, and where only the last pose touches.
    void expectSlide(BlockingDetector& device);
    /// A turn that comes down to the floor, just so, and up again.
    void expectGraze(BlockingDetector& device);

    static MeshData makeTip() {
        MeshData tip;
        addTriangle(tip, {0, 0, 0}, {0.3, 0, 5}, {0, 0.3, 5});
        return tip;
    }
};

TEST_F(KnownWays, AreFreeUntilTheyTouch) {
    BlockingDetector device = detector(along());
    expectTip(device);
    expectTurningRod(device);
    expectEndOfATurn(device);
    expectTightTurn(device);
    expectSlide(device);
    expectGraze(device);
}

void KnownWays::expectTip(BlockingDetector& device) {
    for (const double height : {0.5, 9.0, 300.0}) {
        SCOPED_TRACE(std::to_string(height));
        const double down = height + std::min(0.7 * height + 1, 5.0);
        const std::vector<SegmentMotion> found =
            overFloor(device, makeTip(),
                      {translation({1, 2, height}), translation({1, 2, height - down}), translation({1, 2, -2}),
                       translation({1, 2, 40}), translation({1, 2, 0.01 * height + 0.01})},
                      height != 9);
        ASSERT_EQ(found.size(), 4U);
        ASSERT_TRUE(found[0].touch);
        const double wanted = height / down;
        EXPECT_LE(found[0].freeUntil, wanted);
        EXPECT_GE(found[0].touch->at, wanted);
        EXPECT_LE(found[0].touch->at - found[0].freeUntil, kDefaultMotionResolution / down + 1e-9);
        EXPECT_EQ(found[0].end, MotionEnd::Decided);
        EXPECT_NEAR(found[0].touch->position[0], 1, 0.02);
        EXPECT_NEAR(found[0].touch->position[1], 2, 0.02);
        EXPECT_NEAR(found[0].touch->position[2], 0, 0.02);
        // It begins with a touch; and the last one ends just before.
        ASSERT_TRUE(found[1].touch && found[2].touch);
        EXPECT_EQ(found[1].touch->at, 0);
        EXPECT_EQ(found[2].touch->at, 0);
        EXPECT_EQ(found[2].freeUntil, 0);
        EXPECT_EQ(found[3].freeUntil, 1);
        EXPECT_EQ(found[3].end, MotionEnd::Decided);
    }
}

void KnownWays::expectTurningRod(BlockingDetector& device) {
    constexpr double kLength = 14;
    MeshData rod;
    addTriangle(rod, {0, 0, 0}, {kLength, 0, 0}, {kLength, 0.1, 0});
    for (const double height : {2.0, 7.0, 13.5}) {
        SCOPED_TRACE(std::to_string(height));
        const double reaches = std::asin(height / kLength);
        const auto at = [&](double angle) { return multiply(translation({-3, 1, height}), turned(1, angle)); };
        const std::vector<SegmentMotion> found =
            overFloor(device, rod, {at(-1), at(reaches + 0.3), at(-1.2), at(reaches - 0.005)});
        ASSERT_EQ(found.size(), 3U);
        ASSERT_TRUE(found[0].touch);
        const double wanted = (reaches + 1) / (reaches + 1.3);
        EXPECT_LE(found[0].freeUntil, wanted);
        EXPECT_GE(found[0].touch->at, wanted);
        EXPECT_EQ(found[0].end, MotionEnd::Decided);
        EXPECT_LE((found[0].touch->at - found[0].freeUntil) * (reaches + 1.3) * kLength, 0.02);
        EXPECT_FALSE(found[2].touch || found[2].possible);
    }
}

void KnownWays::expectEndOfATurn(BlockingDetector& device) {
    constexpr double kAngle = 1.2;
    Grid grid;
    grid.size = {41, 5, 41};
    grid.spacing = {0.5, 0.5, 0.5};
    grid.origin = {0, -1, -20};
    const std::array<double, 2> end{15 * std::cos(kAngle), -15 * std::sin(kAngle)};
    const VolumeData image = makeVolume<float>(grid, ScalarType::Float32, [&](auto x, auto y, auto z) {
        return y >= 1 && y <= 3 && std::abs(0.5 * x - end[0]) <= 0.6 && std::abs(0.5 * z - 20 - end[1]) <= 0.6 ? 10.0
                                                                                                               : -10.0;
    });
    MeshData tip;
    addTriangle(tip, {14.9, 0, 0}, {15, 0, 0}, {15, 0.01, 0});
    const std::vector<SegmentMotion> found = over(image, device, tip, {identity(), turned(1, kAngle)}, true);
    ASSERT_TRUE(found.at(0).touch);
    EXPECT_GT(found[0].freeUntil, 0.9);
    EXPECT_LT(found[0].touch->at, 1);
}

void KnownWays::expectTightTurn(BlockingDetector& device) {
    constexpr double kAngle = 0.45;
    Grid grid;
    grid.size = {33, 5, 20};
    grid.origin = {-16, -2, -4};
    const VolumeData image = makeVolume<float>(grid, ScalarType::Float32, [](auto x, auto, auto z) {
        return x == 13 && z <= 11 ? 10.0 : -10.0; // up to z = 7.5 mm at x = -3 mm
    });
    MeshData tip;
    addTriangle(tip, {0, 0, 8}, {0.01, 0, 8}, {0, 0.01, 8});
    const std::vector<SegmentMotion> found = over(image, device, tip, {turned(1, -kAngle), turned(1, kAngle)}, true);
    // Opaque where what the interpolant has of the ridge along x, times what it has along z, is more than a half.
    constexpr auto kOpaque = [](double angle) {
        return (1 - std::abs(8 * std::sin(angle) + 3)) * (1 - std::abs(8 * std::cos(angle) - 7)) > 0.5;
    };
    double first = -kAngle;
    while (!kOpaque(first)) {
        first += 1e-6;
    }
    const double wanted = (first + kAngle) / (2 * kAngle);
    ASSERT_TRUE(found.at(0).touch);
    EXPECT_GT(wanted, 0.02);
    EXPECT_LE(found[0].freeUntil, wanted);
    EXPECT_GT(found[0].freeUntil, wanted - 0.01);
    EXPECT_NEAR(found[0].touch->at, wanted, 0.01);
}

void KnownWays::expectSlide(BlockingDetector& device) {
    MeshData plate;
    addTriangle(plate, {0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    constexpr double kNear = 0.02;
    const std::vector<SegmentMotion> found = overFloor(
        device, plate, {translation({-15, -15, kNear}), translation({12, 12, kNear}), translation({0, 0, 0})});
    EXPECT_EQ(found.at(0).freeUntil, 1);
    EXPECT_EQ(found.at(0).end, MotionEnd::Decided);
    EXPECT_GT(found.at(1).freeUntil, 0.5);
    const std::vector<SegmentMotion> last =
        overFloor(device, makeTip(), {translation({0, 0, 4}), translation({0, 0, -8e-4})});
    ASSERT_TRUE(last.at(0).touch);
    EXPECT_EQ(last[0].touch->at, 1);
    EXPECT_EQ(last[0].touch->world_from_object, translation({0, 0, -8e-4}));
}

void KnownWays::expectGraze(BlockingDetector& device) {
    const Mat4 pivot = translation({0, 0, 10});
    const Mat4 arm = translation({0, 0, -10});
    const auto at = [&](double angle) { return multiply(pivot, multiply(turned(1, angle), arm)); };
    const std::vector<SegmentMotion> found = overFloor(device, makeTip(), {at(-0.5), at(0.6)});
    EXPECT_LE(found.at(0).freeUntil, 0.5 / 1.1);
    EXPECT_GT(found.at(0).freeUntil, 0.4);
    EXPECT_TRUE(found[0].possible || found[0].touch);
}

/// A search takes as many steps as the ways of its item need, whatever comes before.
TEST_F(KnownWays, HaveStepsOfTheirOwn) {
    const DeviceSide side(context(), queue(), floorImage().view(), {kFloorPoints, kFloorDomain, kFloorEntries},
                          makeTip().view(), true);
    const Mat4 still[] = {translation({0, 0, 10}), translation({0, 0, 10})};
    const auto turnedAt = [](double angle) {
        return multiply(translation({0, 0, 10}), multiply(turned(1, angle), translation({0, 0, -10})));
    };
    const Mat4 grazing[] = {turnedAt(-0.5), turnedAt(0.6)};
    const BatchItem items[] = {side.item(still), side.item(grazing)};
    BlockingDetector device = detector(along());
    const BatchAnswer answer = take(device.detect({items, {}, 0.5}));
    ASSERT_EQ(answer.motions.size(), 2U);
    EXPECT_EQ(answer.motions[0].freeUntil, 1);
    EXPECT_GT(answer.motions[1].freeUntil, 0.4);
    EXPECT_NE(answer.motions[1].end, MotionEnd::Budget);
}

} // namespace
} // namespace voxtact::test
