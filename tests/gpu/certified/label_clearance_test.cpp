// SPDX-License-Identifier: MIT
// How near each label is, on the device: where distances are known, and bounds that overlap those of the host's
// cpu::ClearanceMeter and of the oracle.
#include "certified/counted_fixture.h"
#include "certified/label_searches.h"
#include "certified/sides.h"
#include "core/base/infinity.h"
#include "cpu/scenes/margin_cases.h"
#include "cpu/scenes/random_labels.h"
#include "few_kinds.h"
#include "oracle/clearance_oracle.h"
#include "voxtact/cpu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

constexpr ControlPoint kBytesRamp[] = {{0, 0}, {255, 1}};

/// Voxels of 0.5 x 1 x 0.8 mm, the axes of the grid along those of the world.
Grid flatVoxels() {
    Grid grid;
    grid.size = {24, 20, 22};
    grid.spacing = {0.5, 1, 0.8};
    return grid;
}

/// A triangle that has its tip there, and is on one side of it along an axis.
MeshData tipAt(const Vec3& tip, std::size_t axis, double side) {
    Vec3 far = tip;
    far[axis] += side * 3;
    Vec3 other = far;
    far[(axis + 1) % 3] += 0.5;
    other[(axis + 2) % 3] += 0.5;
    MeshData mesh;
    addTriangle(mesh, tip, far, other);
    return mesh;
}

class LabelClearanceTest : public CertifiedTest {
  protected:
    /// The clearances of one pair to some labels.
    std::vector<LabelClearance> ask(BlockingDetector& device, const oracle::OraclePair& pair, const LabelData& labels,
                                    std::span<const std::int32_t> asked, bool clusters = true) const {
        const DeviceSide side(context(), queue(), pair.volume, pair.transferFunction, pair.mesh, clusters);
        const LabelMap map = take(LabelMap::upload(context(), queue(), labels));
        BatchItem item = side.item({&pair.world_from_object, 1});
        item.labels = &map;
        const BatchAnswer answer = take(device.detect({{&item, 1}, {}, pair.threshold, asked}));
        EXPECT_EQ(answer.clearances.size(), 1U);
        EXPECT_EQ(answer.labelClearances.size(), asked.size());
        const double tolerance = device.detector().desc().clearance->tolerance;
        for (std::size_t i = 0; i < answer.labelClearances.size(); ++i) {
            const LabelClearance& found = answer.labelClearances[i];
            EXPECT_EQ(found.label, asked[i]);
            EXPECT_EQ(found.end == ClearanceEnd::Closed,
                      found.bounds.lo == kInfinity || found.bounds.hi - found.bounds.lo <= tolerance);
            EXPECT_LE(found.bounds.lo, found.bounds.hi);
        }
        return answer.labelClearances;
    }
    /// Of a mesh in the world.
    std::vector<LabelClearance> ask(BlockingDetector& device, const VolumeData& image, const MeshData& mesh,
                                    const LabelData& labels, std::span<const std::int32_t> asked) const {
        return ask(device, {mesh.view(), image.view(), {kBytesRamp, {0, 255}, kDefaultTableSize}, {}, identity(), 0.5},
                   labels, asked);
    }
};

/// A single voxel of a label, in an image that is opaque all over, or, at any opacity, nowhere.
TEST_F(LabelClearanceTest, OfASingleVoxel) {
    const Grid grid = flatVoxels();
    const LabelData labels =
        mapOf(grid, [](auto x, auto y, auto z) { return x == 12 && y == 10 && z == 11 ? 7.0 : 0.0; });
    const std::array<std::int32_t, 3> asked{7, 0, 8};
    for (const bool anyOpacity : {false, true}) {
        const VolumeData image = makeBytes(grid, [&](auto...) { return anyOpacity ? 0.0 : 255.0; });
        BlockingDetector device = detector(toLabels({}, anyOpacity));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                for (const double distance : {0.05, 1.7, 20.0}) {
                    SCOPED_TRACE("axis " + std::to_string(axis) + ", " + std::to_string(side * distance));
                    Vec3 tip{6, 10, 8.8};
                    tip[axis] += side * (distance + grid.spacing[axis] / 2);
                    const std::vector<LabelClearance> found = ask(device, image, tipAt(tip, axis, side), labels, asked);
                    EXPECT_LE(found.at(0).bounds.lo, distance + 1e-6);
                    EXPECT_GE(found.at(0).bounds.hi, distance - 1e-6);
                    EXPECT_EQ(found.at(0).end, ClearanceEnd::Closed);
                    // The label around it is touched, or as far as the image's face.
                    const double face =
                        side > 0 ? (grid.size[axis] - 0.5) * grid.spacing[axis] : -0.5 * grid.spacing[axis];
                    const double around = std::max(0.0, side * (tip[axis] - face));
                    EXPECT_LE(found.at(1).bounds.lo, around * (1 + 1e-6));
                    EXPECT_GE(found.at(1).bounds.hi, around * (1 - 1e-6));
                    EXPECT_EQ(found.at(1).end, ClearanceEnd::Closed);
                    EXPECT_EQ(found.at(2).bounds.lo, kInfinity);
                    EXPECT_EQ(found.at(2).bounds.hi, kInfinity);
                    EXPECT_EQ(found.at(2).end, ClearanceEnd::Closed);
                }
            }
        }
    }
}

/// The border between two labels is halfway between two voxels, where it is opaque: between x = 9 and 10, 4.75 mm.
TEST_F(LabelClearanceTest, TheBorderOfALabelIsAStep) {
    const Grid grid = flatVoxels();
    const LabelData labels = mapOf(grid, [](auto x, auto, auto) { return x < 10 ? 1.0 : 2.0; });
    const std::array<std::int32_t, 2> asked{1, 2};
    const VolumeData all = makeBytes(grid, [](auto...) { return 255.0; });
    // Opaque are the places from x = 8.5 to 9.65, of which both labels have some.
    const VolumeData sheet = makeBytes(grid, [](auto x, auto, auto) { return x == 9 ? 255.0 : x == 10 ? 60.0 : 0.0; });
    // Above all of the image: nothing is touched.
    const MeshData above = tipAt({4, 9.5, 19.8}, 2, 1);
    BlockingDetector device = detector(toLabels());
    for (const VolumeData* image : {&all, &sheet}) {
        const bool thin = image == &sheet;
        SCOPED_TRACE(thin);
        const std::vector<LabelClearance> found = ask(device, *image, above, labels, asked);
        const double up = 19.8 - 21.5 * 0.8; // to the uppermost face
        // Of the sheet label 1 begins at 4.25 mm, and label 2 where it does everywhere, at 4.75.
        const double first = thin ? std::hypot(up, 0.25) : up;
        const double second = std::hypot(up, 0.75);
        EXPECT_LE(found.at(0).bounds.lo, first + 0.002);
        EXPECT_GE(found.at(0).bounds.hi, first - 0.002);
        EXPECT_LE(found.at(1).bounds.lo, second + 0.002);
        EXPECT_GE(found.at(1).bounds.hi, second - 0.002);
        EXPECT_LE(found.at(0).bounds.hi - found.at(0).bounds.lo, kDefaultTolerance);
    }
}

/// A triangle through the border: both labels are touched, the third one is not.
TEST_F(LabelClearanceTest, WhatIsTouchedIsAtZero) {
    const Grid grid = flatVoxels();
    const LabelData labels = mapOf(grid, [](auto x, auto, auto) { return x < 10 ? 1.0 : x < 20 ? 2.0 : 3.0; });
    const std::array<std::int32_t, 4> asked{3, 2, 1, 2};
    MeshData mesh;
    addTriangle(mesh, {3.1, 5.2, 6.1}, {6.3, 5.4, 6.7}, {4.4, 6.1, 6.2});
    for (const bool anyOpacity : {false, true}) {
        const VolumeData image = makeBytes(grid, [&](auto...) { return anyOpacity ? 0.0 : 255.0; });
        BlockingDetector device = detector(toLabels({}, anyOpacity));
        const std::vector<LabelClearance> found = ask(device, image, mesh, labels, asked);
        const double away = 19.5 * 0.5 - 6.3;
        EXPECT_LE(found.at(0).bounds.lo, away + 1e-6);
        EXPECT_GE(found.at(0).bounds.hi, away - 1e-6);
        for (const std::size_t i : {1U, 2U, 3U}) {
            EXPECT_EQ(found.at(i).bounds.lo, 0) << i;
            EXPECT_LE(found.at(i).bounds.hi, 0.001) << i;
            EXPECT_EQ(found.at(i).end, ClearanceEnd::Closed) << i;
        }
    }
}

/// In a grid whose axes are turned, beside a corner of a label's box, as on the host: from the corner in a direction
/// that all of the box is on the other side of.
TEST_F(LabelClearanceTest, OfABoxInATurnedGrid) {
    Grid grid;
    grid.size = {12, 10, 9};
    grid.spacing = {0.7, 1.3, 2.5};
    const double c = std::cos(0.4);
    const double s = std::sin(0.4);
    grid.direction = {c, s, 0, -s, c, 0, 0, 0, 1};
    const LabelData labels = mapOf(grid, [](auto x, auto y, auto z) {
        return x >= 3 && x <= 5 && y >= 4 && y <= 6 && z >= 2 && z <= 3 ? 1.0 : 0.0;
    });
    const Vec3 corner = transformPoint(worldFromIndex(grid), {5.5, 6.5, 3.5});
    // Outward along all three axes of the grid, by 7 mm.
    const Vec3 axes[] = {{grid.direction[0], grid.direction[1], grid.direction[2]},
                         {grid.direction[3], grid.direction[4], grid.direction[5]},
                         {grid.direction[6], grid.direction[7], grid.direction[8]}};
    Vec3 out{};
    for (const Vec3& axis : axes) {
        for (std::size_t i = 0; i < 3; ++i) {
            out[i] += axis[i] / std::sqrt(3.0);
        }
    }
    const auto along = [&](double mm, double sideways) {
        return Vec3{corner[0] + mm * out[0], corner[1] + mm * out[1], corner[2] + mm * out[2] + sideways};
    };
    MeshData mesh;
    addTriangle(mesh, along(7, 0), along(9, 0.3), along(9, 0));
    const std::array<std::int32_t, 1> asked{1};
    for (const bool anyOpacity : {false, true}) {
        const VolumeData image = makeBytes(grid, [&](auto...) { return anyOpacity ? 0.0 : 255.0; });
        BlockingDetector device = detector(toLabels({}, anyOpacity));
        const LabelClearance found = ask(device, image, mesh, labels, asked).at(0);
        EXPECT_LE(found.bounds.lo, 7 + 1e-5);
        EXPECT_GE(found.bounds.hi, 7 - 1e-5);
        EXPECT_EQ(found.end, ClearanceEnd::Closed);
    }
}

TEST_F(LabelClearanceTest, IsNeverBesideTheHostsOrTheTruthOnRandomCases) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const std::array<std::int32_t, 5> asked{2, 0, 3, 1, 77};
    FewKindsOfImage few(randomCases(96, 8));
    BlockingDetector devices[] = {detector(toLabels()), detector(toLabels({}, true))};
    cpu::ClearanceMeter meters[] = {take(cpu::ClearanceMeter::create({.threads = 1})),
                                    take(cpu::ClearanceMeter::create({.threads = 1, .labelsAtAnyOpacity = true}))};
    std::map<ClearanceEnd, std::size_t> ends;
    std::size_t apart = 0;
    std::size_t wide = 0;
    std::uint64_t cases = 0;
    for (std::uint64_t number = 0; !few.isDone() && !HasFailure(); ++number) {
        const CertifiedCase c = makeClearanceCase(seed, number);
        const LabelData labels = randomLabels(random, c.scene.volume.grid);
        if (!few.take(c.scene.volume.view(), c.scene.tableSize)) {
            continue;
        }
        ++cases;
        const oracle::OraclePair pair = c.scene.pair();
        const HostSide side(pair.volume, pair.transferFunction, pair.mesh);
        cpu::BatchItem item = side.item({&pair.world_from_object, 1});
        item.labels = &labels;
        for (const bool anyOpacity : {false, true}) {
            const std::vector<LabelClearance> host =
                take(meters[anyOpacity ? 1 : 0].measureLabels({{&item, 1}, {}, pair.threshold}, asked)).labels;
            const std::vector<LabelClearance> found =
                ask(devices[anyOpacity ? 1 : 0], pair, labels, asked, number % 3 != 0);
            for (std::size_t i = 0; i < asked.size(); ++i) {
                SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(number) + ", label " +
                             std::to_string(asked[i]) + (anyOpacity ? " at any opacity" : ""));
                expectBothCanBe(found.at(i).bounds, host.at(i).bounds);
                if (!anyOpacity) {
                    const oracle::OracleClearance truth =
                        take(oracle::labelClearanceOracle(pair, labels, asked[i], 1.0 / 32));
                    EXPECT_LE(found[i].bounds.lo, truth.hi * (1 + 1e-12));
                    EXPECT_GE(found[i].bounds.hi, truth.lo * (1 - 1e-12));
                }
                ++ends[found[i].end];
                const bool measured = found[i].bounds.lo > 0 && found[i].bounds.hi < kInfinity;
                apart += found[i].end == ClearanceEnd::Closed && measured ? 1 : 0;
                wide += host[i].end == ClearanceEnd::Closed && found[i].end != ClearanceEnd::Closed ? 1 : 0;
            }
        }
    }
    std::cout << "  " << cases << " cases:";
    for (const auto& [end, count] : ends) {
        std::cout << " " << count << " " << toString(end);
    }
    std::cout << "; " << apart << " apart, " << wide << " wider than the host's tolerance\n";
    EXPECT_GT(apart, cases);
    EXPECT_LT(wide, cases * 5); // of ten
}

} // namespace
} // namespace voxtact::test
