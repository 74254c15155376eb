// SPDX-License-Identifier: MIT
// How near each label is, on the device: where distances are known, and bounds that overlap those of the host's
// cpu::ClearanceMeter and of the oracle.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/sides.h"
#include "core/base/infinity.h"
#include "cpu/scenes/margin_cases.h"
#include "cpu/scenes/random_labels.h"
#include "few_kinds.h"
#include "gpu/context_impl.h"
#include "oracle/clearance_oracle.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

DetectorDesc toLabels(const ClearanceSearch& search = {}, bool anyOpacity = false) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .clearance = search,
            .labelClearances = true,
            .labelsAtAnyOpacity = anyOpacity};
}

/// Whether a number can be between both.
void expectBothCanBe(const ClearanceBounds& device, const ClearanceBounds& host) {
    EXPECT_LE(device.lo, device.hi);
    EXPECT_LE(device.lo, host.hi);
    EXPECT_LE(host.lo, device.hi);
}

/// A label map of numbers that `labelOf` says by voxel.
template <class LabelOf> LabelData mapOf(const Grid& grid, const LabelOf& labelOf) {
    return take(makeLabels(makeBytes(grid, labelOf).view()));
}

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
    grid.size = {12, 10, 8};
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
    constexpr std::uint64_t kTypes = 4;
    const std::uint64_t ofEach = randomCases(24, 2);
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const std::array<std::int32_t, 5> asked{2, 0, 3, 1, 77};
    FewKindsOfImage few(ofEach);
    BlockingDetector devices[] = {detector(toLabels()), detector(toLabels({}, true))};
    cpu::ClearanceMeter meters[] = {take(cpu::ClearanceMeter::create({.threads = 1})),
                                    take(cpu::ClearanceMeter::create({.threads = 1, .labelsAtAnyOpacity = true}))};
    std::map<ClearanceEnd, std::size_t> ends;
    std::size_t apart = 0;
    std::size_t wide = 0;
    std::uint64_t cases = 0;
    for (std::uint64_t number = 0; cases < kTypes * ofEach && !HasFailure(); ++number) {
        const CertifiedCase c = makeClearanceCase(seed, number);
        const LabelData labels = randomLabels(random, c.scene.volume.grid);
        if (!few.take(c.scene.volume.view())) {
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

/// Head, scalpel and a map of blocks: what is asked together, and what each call says of itself.
struct LabelledHead : Head {
    LabelData labels;
    LabelMap map;

    LabelledHead(const Context& context, const QueueAccess& queue, std::size_t count, std::uint64_t seed,
                 LabelData given)
        : Head(context, queue, take(makeBuiltinMesh("scalpel:300")), count, seed), labels(std::move(given)),
          map(take(LabelMap::upload(context, queue, labels))) {
        item.labels = &map;
    }
    [[nodiscard]] Batch batch(std::span<const std::int32_t> asked) const {
        return {{&item, 1}, {}, kDefaultThreshold, asked};
    }
    [[nodiscard]] std::vector<LabelClearance> onHost(std::span<const std::int32_t> asked,
                                                     const cpu::ClearanceDesc& desc = {.threads = 1}) const {
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create(desc));
        cpu::BatchItem of = hostItem();
        of.labels = &labels;
        return take(meter.measureLabels({{&of, 1}, {}, kDefaultThreshold}, asked)).labels;
    }
};

/// Blocks of 8 voxels, numbered one after the other.
LabelData blocks(const Grid& grid) {
    return mapOf(grid, [](auto x, auto y, auto z) { return static_cast<double>(x / 8 + 6 * (y / 8) + 36 * (z / 8)); });
}

Grid headGrid() {
    return take(makeBuiltinVolume("head:48")).grid;
}

/// More labels than a node has bits, so that numbers share some: all of them are still told apart.
TEST_F(LabelClearanceTest, OfMoreLabelsThanNodesTellApart) {
    constexpr std::uint32_t kPoses = 6;
    constexpr double kTolerance = 0.05; // mm
    const std::uint64_t seed = testSeed();
    const LabelledHead scene(context(), queue(), kPoses, seed, blocks(headGrid()));
    ASSERT_GT(scene.labels.values.size(), 128U);
    // 20 and 148 share a bit, and so do 86 and 214.
    const std::array<std::int32_t, 6> asked{20, 148, 86, 214, 128, 0};
    for (const bool anyOpacity : {false, true}) {
        const std::vector<LabelClearance> host = scene.onHost(asked, {.threads = 1, .labelsAtAnyOpacity = anyOpacity});
        const Answered found =
            detect(toLabels({.tolerance = kTolerance}, anyOpacity), scene.batch(asked), kPoses, 2048);
        ASSERT_EQ(found.labels.size(), host.size());
        for (std::size_t i = 0; i < host.size(); ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(i));
            EXPECT_EQ(found.labels[i].pair, host[i].pair);
            EXPECT_EQ(found.labels[i].pose, host[i].pose);
            EXPECT_EQ(found.labels[i].label, host[i].label);
            expectBothCanBe(found.labels[i].bounds, host[i].bounds);
            // What is a hundred voxels away single precision may know a little less well.
            EXPECT_NE(found.labels[i].end, ClearanceEnd::Budget);
            if (host[i].bounds.hi < kInfinity) {
                EXPECT_LE(found.labels[i].bounds.hi - found.labels[i].bounds.lo, 3 * kTolerance);
            }
        }
        const std::vector<PairClearance> all = found.clearances;
        for (std::size_t i = 0; i < host.size() && !anyOpacity; ++i) {
            EXPECT_LE(all.at(found.labels[i].pair).bounds.lo, found.labels[i].bounds.hi) << "a part is no nearer";
        }
    }
}

TEST_F(LabelClearanceTest, BeyondTheMaximumNothingIsMeasured) {
    constexpr std::uint32_t kPoses = 12;
    const std::uint64_t seed = testSeed();
    const LabelledHead scene(context(), queue(), kPoses, seed,
                             mapOf(headGrid(), [](auto x, auto, auto) { return x < 24 ? 1.0 : 2.0; }));
    const std::array<std::int32_t, 3> asked{1, 9, 2};
    const std::vector<LabelClearance> all = scene.onHost(asked);
    std::size_t beyond = 0;
    for (const double maximum : {0.5, 10.0}) {
        const Answered found = detect(toLabels({.maximum = maximum}), scene.batch(asked), kPoses, 2048);
        for (std::size_t i = 0; i < all.size(); ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(i) + ", maximum " +
                         std::to_string(maximum));
            const LabelClearance& label = found.labels.at(i);
            if (label.label == 9) {
                EXPECT_EQ(label.bounds.lo, kInfinity) << "the map has it not";
                EXPECT_EQ(label.end, ClearanceEnd::Closed);
            } else if (label.end == ClearanceEnd::Beyond) {
                EXPECT_EQ(label.bounds.lo, maximum);
                EXPECT_EQ(label.bounds.hi, kInfinity);
                EXPECT_GE(all[i].bounds.hi, maximum);
                ++beyond;
            } else {
                EXPECT_LE(all[i].bounds.lo, maximum * (1 + 1e-4));
                expectBothCanBe(label.bounds, all[i].bounds);
            }
        }
    }
    EXPECT_GT(beyond, 0U);
}

/// Each item has a map of its own, which knows other labels by other numbers.
TEST_F(LabelClearanceTest, OfSeveralItems) {
    constexpr std::uint32_t kPoses = 3;
    const std::uint64_t seed = testSeed();
    const LabelledHead first(context(), queue(), kPoses, seed,
                             mapOf(headGrid(), [](auto x, auto, auto) { return x < 24 ? 1.0 : 200.0; }));
    const LabelledHead second(context(), queue(), kPoses, seed + 1,
                              mapOf(headGrid(), [](auto, auto y, auto) { return y < 24 ? 200.0 : 3.0; }));
    const BatchItem items[] = {first.item, second.item};
    const std::array<std::int32_t, 3> asked{200, 1, 3};
    const Answered found = detect(toLabels(), {items, {}, kDefaultThreshold, asked}, 2 * kPoses, 2048);
    std::vector<LabelClearance> host = first.onHost(asked);
    for (const LabelClearance& label : second.onHost(asked)) {
        host.push_back(label);
    }
    ASSERT_EQ(found.labels.size(), host.size());
    for (std::size_t i = 0; i < host.size(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(i));
        EXPECT_EQ(found.labels[i].item, i / (kPoses * asked.size()));
        EXPECT_EQ(found.labels[i].label, host[i].label);
        expectBothCanBe(found.labels[i].bounds, host[i].bounds);
        EXPECT_EQ(found.labels[i].bounds.lo == kInfinity, host[i].bounds.lo == kInfinity);
    }
}

/// Poses on the device, one of which is none; next to no room; and the part of a device buffer.
TEST_F(LabelClearanceTest, IsOnTheDeviceForTheNextPass) {
    constexpr std::uint32_t kPoses = 4;
    LabelledHead scene(context(), queue(), kPoses, testSeed(),
                       mapOf(headGrid(), [](auto x, auto, auto) { return x < 24 ? 1.0 : 2.0; }));
    std::vector<float> floats;
    for (Mat4& pose : scene.poses) {
        for (double& element : pose) {
            floats.push_back(static_cast<float>(element));
            element = static_cast<double>(floats.back());
        }
    }
    const std::array<std::int32_t, 2> asked{2, 1};
    const std::vector<LabelClearance> host = scene.onHost(asked);
    floats[16 * 3] = std::numeric_limits<float>::quiet_NaN();
    const RawVulkan::HostBuffer buffer =
        raw().makeBuffer(std::span<const float>(floats), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const PoseBuffer poses =
        take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer, .stride = 64, .count = kPoses}));
    scene.item.world_from_object = {};
    scene.item.poses = &poses;
    DetectorDesc desc = toLabels();
    desc.devicePoses = true;
    const Detector device = take(Detector::create(context(), desc));
    for (const bool closest : {false, true}) {
        Results results = take(Results::create(context(), {.maxPairs = kPoses + 1,
                                                           .clustersAtOnce = closest ? 2048 : 64,
                                                           .clearances = true,
                                                           .closest = closest,
                                                           .labelClearances = 3}));
        EXPECT_EQ(results.readLabelClearances().error().code, ErrorCode::NotReady);
        const BufferRange range = results.labelClearances();
        EXPECT_EQ(range.size, (kPoses + 1) * 3 * sizeof(ClearanceResult));
        EXPECT_EQ(range.offset % 256, 0U);
        const RawVulkan::HostBuffer copy = raw().makeBuffer(range.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        const VkCommandBuffer commands = raw().begin();
        take(device.cmdDetect(commands, scene.batch(asked), results));
        take(results.cmdReadBack(commands));
        const VkBufferCopy region{range.offset, 0, range.size};
        raw().vk().vkCmdCopyBuffer(commands, range.buffer, copy.buffer, 1, &region);
        raw().submitAndWait(commands);
        const std::vector<LabelClearance> read = take(results.readLabelClearances());
        ASSERT_EQ(read.size(), host.size());
        for (std::size_t i = 0; i < read.size(); ++i) {
            SCOPED_TRACE(i);
            ClearanceResult found{};
            std::memcpy(&found, static_cast<const std::byte*>(copy.mapped) + i * sizeof found, sizeof found);
            EXPECT_EQ(static_cast<double>(found.lo), read[i].bounds.lo);
            EXPECT_EQ(static_cast<double>(found.hi), read[i].bounds.hi);
            EXPECT_EQ(found.end, static_cast<std::uint32_t>(read[i].end));
            EXPECT_EQ(found.reserved, 0U);
            if (read[i].pose == 3) {
                EXPECT_EQ(read[i].bounds.lo, 0);
                EXPECT_EQ(read[i].bounds.hi, kInfinity);
                EXPECT_EQ(read[i].end, ClearanceEnd::Rounding);
            } else {
                expectBothCanBe(read[i].bounds, host[i].bounds);
            }
        }
    }
}

TEST_F(LabelClearanceTest, RefusesWhatHasNoAnswer) {
    const auto refusal = [&](const DetectorDesc& desc) {
        const Result<Detector> made = Detector::create(context(), desc);
        EXPECT_FALSE(made.ok());
        return made.ok() ? std::string() : made.error().text;
    };
    DetectorDesc desc = toLabels();
    desc.clearance.reset();
    EXPECT_THAT(refusal(desc), HasSubstr("clearances to labels are clearances"));
    desc = toLabels({}, true);
    desc.labelClearances = false;
    EXPECT_THAT(refusal(desc), HasSubstr("labelsAtAnyOpacity is about clearances to labels"));

    const auto noResults = [&](const ResultsDesc& wanted) {
        const Result<Results> made = Results::create(context(), wanted);
        EXPECT_FALSE(made.ok());
        return made.ok() ? std::string() : made.error().text;
    };
    EXPECT_THAT(noResults({.labelClearances = 1}), HasSubstr("ResultsDesc::clearances is false"));
    EXPECT_THAT(noResults({.clearances = true, .labelClearances = 4097}), HasSubstr("at most 4096 labels"));
    EXPECT_THAT(noResults({.maxPairs = 100000, .clearances = true, .labelClearances = 4096}),
                HasSubstr("maxStorageBufferRange"));

    LabelledHead scene(context(), queue(), 1, 1, blocks(headGrid()));
    BlockingDetector device = detector(toLabels({.maximum = 1}));
    const auto refused = [&](std::span<const std::int32_t> asked) {
        const Result<BatchAnswer> answer = device.detect(scene.batch(asked));
        return answer.ok() ? std::string() : answer.error().text;
    };
    EXPECT_EQ(refused({}), "");
    const std::vector<std::int32_t> many(5000, 1);
    EXPECT_EQ(refused(many), "5000 labels are asked for, one call measures at most 4096; ask for fewer");
    const std::array<std::int32_t, 1> one{1};
    EXPECT_EQ(refused(one), "");
    const LabelData coarse = mapOf(unitGrid(4), [](auto...) { return 1.0; });
    const LabelMap elsewhere = take(LabelMap::upload(context(), queue(), coarse));
    scene.item.labels = &elsewhere;
    EXPECT_EQ(refused(one), "batch item 0: the label map is not on the grid of the volume; resample it to that");
    scene.item.labels = nullptr;
    EXPECT_EQ(refused(one), "batch item 0: labels is null, and clearances to labels are asked for");
    const LabelMap never = take(LabelMap::create(context(), scene.labels));
    scene.item.labels = &never;
    EXPECT_THAT(refused(one), HasSubstr("batch item 0: the label map"));

    scene.item.labels = &scene.map;
    Results results = take(Results::create(context(), {.maxPairs = 1, .clearances = true}));
    EXPECT_EQ(results.labelClearances().buffer, VK_NULL_HANDLE);
    const VkCommandBuffer commands = raw().begin();
    const Result<void> recorded = device.detector().cmdDetect(commands, scene.batch(one), results);
    raw().submitAndWait(commands);
    ASSERT_FALSE(recorded.ok());
    EXPECT_THAT(recorded.error().text, HasSubstr("have room for the clearances to 0 (ResultsDesc::labelClearances)"));
}

/// A device with less: the label map can be had, and what cannot is refused.
TEST_F(LabelClearanceTest, NeedsRoomForWhatIsKnownOfLabels) {
    ContextImpl& impl = context().impl();
    const VkPhysicalDeviceLimits limits = impl.limits;
    LabelledHead scene(context(), queue(), 1, 1, blocks(headGrid()));
    impl.limits.maxPerStageDescriptorStorageBuffers = 6;
    const Result<Detector> few = Detector::create(context(), toLabels());
    impl.limits = limits;
    ASSERT_FALSE(few.ok());
    EXPECT_EQ(few.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(few.error().text, HasSubstr("maxPerStageDescriptorStorageBuffers 6, 7 are needed"));

    impl.limits.maxStorageBufferRange = 4096; // 7^3 bricks of 16 bytes are more
    const Result<LabelMap> large = LabelMap::upload(context(), queue(), scene.labels);
    impl.limits = limits;
    ASSERT_TRUE(large.ok());
    scene.item.labels = &*large;
    BlockingDetector device = detector(toLabels({.maximum = 1}));
    const std::array<std::int32_t, 1> one{1};
    const Result<BatchAnswer> answer = device.detect(scene.batch(one));
    ASSERT_FALSE(answer.ok());
    EXPECT_EQ(answer.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(answer.error().text, HasSubstr("batch item 0: the label map is too large for clearances"));
}

} // namespace
} // namespace voxtact::test
