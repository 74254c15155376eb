// SPDX-License-Identifier: MIT
// The closest points of clearances that the device measures: on a triangle, opaque as the certified oracle says, and as
// far apart as the bounds say.
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "certified/known_pairs.h"
#include "certified/sides.h"
#include "cpu/clearance/closest_point.h"
#include "cpu/scenes/margin_cases.h"
#include "few_kinds.h"
#include "oracle/certified_sample.h"
#include "voxtact/cpu.h"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr double kNever = std::numeric_limits<double>::infinity();

DetectorDesc withClosest(const ClearanceSearch& search = {}) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .clearance = search,
            .closest = true};
}

double distanceOf(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Vec3 crossOf(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

glm::dvec3 cornerOf(const oracle::OraclePair& pair, std::uint32_t triangle, std::size_t corner) {
    const std::size_t vertex = pair.mesh.indices.empty() ? 3 * std::size_t{triangle} + corner
                                                         : pair.mesh.indices[3 * std::size_t{triangle} + corner];
    const float* at = &pair.mesh.positions[3 * vertex];
    const Vec3 world = transformPoint(
        pair.world_from_object, {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
    return {world[0], world[1], world[2]};
}

/// Of what single precision computes with, mm.
double largestOf(const oracle::OraclePair& pair) {
    double largest = 0;
    for (std::size_t i = 0; i + 2 < pair.mesh.positions.size(); i += 3) {
        const float* at = &pair.mesh.positions[i];
        const Vec3 world =
            transformPoint(pair.world_from_object,
                           {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
        largest = std::max({largest, std::abs(world[0]), std::abs(world[1]), std::abs(world[2])});
    }
    const Grid& grid = pair.volume.grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        largest += std::abs(grid.origin[axis]) + std::abs(pair.world_from_object[12 + axis]) +
                   grid.spacing[axis] * grid.size[axis];
    }
    return largest;
}

/// How far a place of single precision may be off, mm: in the world, and in voxel space.
double slackOf(const oracle::OraclePair& pair) {
    return 1e-6 * largestOf(pair);
}

/// `part`: of the triangle's size, that the point may be off as well.
void expectOnTriangle(const oracle::OraclePair& pair, const ClosestPoints& closest, double slack, double part) {
    ASSERT_LT(closest.triangle, pair.mesh.indices.size() / 3);
    const glm::dvec3 at{closest.mesh[0], closest.mesh[1], closest.mesh[2]};
    const cpu::WorldTriangle triangle{cornerOf(pair, closest.triangle, 0), cornerOf(pair, closest.triangle, 1),
                                      cornerOf(pair, closest.triangle, 2)};
    const glm::dvec3 near = cpu::closestPoint(triangle, at);
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        size = std::max(size, glm::distance(triangle[i], triangle[(i + 1) % 3]));
    }
    EXPECT_LE(distanceOf(closest.mesh, {near.x, near.y, near.z}), slack + part * size);
}

/// In the volume's box, and opaque there as far as anybody can tell who knows the place to `slack`.
void expectOpaque(const oracle::OraclePair& pair, const Vec3& world, double slack) {
    const Grid& grid = pair.volume.grid;
    const Vec3 texture = transformPoint(take(textureFromWorld(grid)), world);
    double least = kNever;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        least = std::min(least, grid.spacing[axis]);
    }
    const double error = 4 * slack / least; // an axis may lean
    Vec3 index{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(texture[axis] * grid.size[axis], -error);
        EXPECT_LE((texture[axis] - 1) * grid.size[axis], error);
        index[axis] = texture[axis] * grid.size[axis] - 0.5;
    }
    const oracle::certified::Field field(pair.volume, take(checkVolume(pair.volume)));
    const oracle::certified::Opacity opacity(take(sampleTable(pair.transferFunction)), pair.transferFunction.domain,
                                             static_cast<double>(static_cast<float>(pair.threshold)));
    EXPECT_TRUE(opacity.mayBeOpaque(field.at(index, error)));
}

/// All that is promised of closest points. `found.bounds` are those of the pair.
void checkClosest(const oracle::OraclePair& pair, const PairClearance& found) {
    ASSERT_EQ(found.closest.has_value(), std::isfinite(found.bounds.hi));
    if (!found.closest) {
        return;
    }
    const ClosestPoints& closest = *found.closest;
    const double slack = slackOf(pair);
    constexpr double kOfTouch = 4e-5; // as of a contact
    expectOnTriangle(pair, closest, slack, found.bounds.hi == 0 ? kOfTouch : 0);
    expectOpaque(pair, closest.volume, slack);
    const double apart = distanceOf(closest.mesh, closest.volume);
    EXPECT_LE(apart, found.bounds.hi * (1 + 1e-6));
    EXPECT_GE(apart, found.bounds.lo - slack);
    // Single precision may have one place for two points that are very near to each other, and no direction then.
    if (apart == 0) {
        EXPECT_LE(found.bounds.hi, 10 * slack);
    }
    if (found.bounds.hi == 0 || apart == 0) {
        EXPECT_EQ(closest.perTranslation, (Vec3{}));
        EXPECT_EQ(closest.perRotation, (Vec3{}));
        return;
    }
    const Vec3 origin{pair.world_from_object[12], pair.world_from_object[13], pair.world_from_object[14]};
    Vec3 arm{};
    Vec3 away{};
    double rounding = 0; // of the two places, which may be very near to each other
    for (std::size_t axis = 0; axis < 3; ++axis) {
        arm[axis] = closest.mesh[axis] - origin[axis];
        away[axis] = (closest.mesh[axis] - closest.volume[axis]) / apart;
        rounding += 0x1p-52 * (std::abs(closest.mesh[axis]) + std::abs(closest.volume[axis])) / apart;
    }
    EXPECT_LE(distanceOf(closest.perTranslation, away), 1e-9 + rounding);
    EXPECT_LE(distanceOf(closest.perRotation, crossOf(arm, away)), 2 * slack + rounding * distanceOf(arm, {}));
}

/// The tip of the scalpel is in the head.
Mat4 inTheMiddle(const Head& scene) {
    return translation(transformPoint(worldFromTexture(scene.head.grid), {0.5, 0.5, 0.5}));
}

/// Certainly beside the head.
Mat4 farther(const Mat4& pose) {
    return multiply(translation({300, 0, 0}), pose);
}

class ClosestTest : public CertifiedTest {
  protected:
    /// One pair, whose points are checked.
    PairClearance ask(BlockingDetector& device, const oracle::OraclePair& pair, bool clusters) const {
        const PairClearance found = askPair(device, context(), queue(), pair, clusters).clearances.at(0);
        checkClosest(pair, found);
        return found;
    }
};

TEST_F(ClosestTest, OfAPlane) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    BlockingDetector device = detector(withClosest());
    const std::vector<ScalarType> types = fewTypes();
    for (int round = 0; round < 24 && !HasFailure(); ++round) {
        KnownPlane known = makeKnownPlane(random, round, types);
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        const PairClearance found = ask(device, pairOf(known), round % 2 == 0);
        ASSERT_TRUE(found.closest);
        EXPECT_NEAR(distanceOf(found.closest->mesh, found.closest->volume), known.distance,
                    known.slack + kDefaultTolerance);
        if (round / 8 % 3 == 0) {
            // The tip alone is nearest: what is half a millimetre beside it is two farther.
            const glm::dvec3 tip = cornerOf(pairOf(known), 0, 0);
            EXPECT_LE(distanceOf(found.closest->mesh, {tip.x, tip.y, tip.z}), known.slack + kDefaultTolerance);
        }
    }
}

TEST_F(ClosestTest, OfASingleVoxel) {
    BlockingDetector device = detector(withClosest());
    const OneVoxel one;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            for (const double distance : {0.05, 3.0, 50.0}) {
                const MeshData mesh = one.meshAt(axis, side, distance);
                SCOPED_TRACE("axis " + std::to_string(axis) + ", " + std::to_string(side * distance));
                const PairClearance found = ask(device, pairOf(one, mesh), axis == 1);
                ASSERT_TRUE(found.closest);
                Vec3 nearest{6, 10, 8.8};
                nearest[axis] += side * one.grid.spacing[axis] / 2;
                // Beside the axis the surface bends away, and points that are hardly farther may be found.
                EXPECT_LE(distanceOf(found.closest->volume, nearest), 0.25);
                EXPECT_GT(side * found.closest->perTranslation[axis], 0.98);
            }
        }
    }
}

/// The tip of a triangle, from all sides of a ball.
TEST_F(ClosestTest, OfABall) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    BlockingDetector device = detector(withClosest({.tolerance = 0.004}));
    const Vec3 centre{12, 12, 12};
    const VolumeData image = makeBytes(unitGrid(25), [&](auto x, auto y, auto z) {
        return std::max(200 - 10 * std::hypot(static_cast<double>(x) - 12, static_cast<double>(y) - 12,
                                              static_cast<double>(z) - 12),
                        0.0);
    });
    const Mat4 world_from_index = worldFromIndex(image.grid);
    const Vec3 middle = transformPoint(world_from_index, centre);
    const double voxel = image.grid.spacing[0];
    const std::array points{ControlPoint{99.5, 0}, ControlPoint{100.5, 1}};
    for (int round = 0; round < 12; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        const Mat4 turn = randomRotation(random);
        const Vec3 out{turn[0], turn[1], turn[2]};
        const Vec3 beside{turn[4], turn[5], turn[6]};
        const double distance = uniform(random, 0.3, 6) * voxel;
        const auto at = [&](double along, double across) {
            Vec3 point{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                point[axis] = middle[axis] + along * out[axis] + across * beside[axis];
            }
            return point;
        };
        MeshData mesh;
        addTriangle(mesh, at(10 * voxel + distance, 0), at(14 * voxel + distance, voxel),
                    at(14 * voxel + distance, -voxel));
        const PairClearance found =
            ask(device, {mesh.view(), image.view(), {points, {0, 255}, kDefaultTableSize}, {}, identity(), 0.5},
                round % 2 == 0);
        ASSERT_TRUE(found.closest);
        EXPECT_LE(distanceOf(found.closest->volume, at(10 * voxel, 0)), 0.8 * voxel);
        EXPECT_LE(distanceOf(found.closest->mesh, at(10 * voxel + distance, 0)), 0.2 * voxel);
        EXPECT_NEAR(distanceOf(found.closest->volume, middle), 10 * voxel, 0.1 * voxel); // bytes, and trilinear
    }
}

/// Opaque is the value of one entry of the table alone, which no computed value is sure to be: two points on either
/// side prove it, and the point is found on the way from one to the other.
TEST_F(ClosestTest, OfASheetWithoutThickness) {
    constexpr double kOpaque = 40.5;
    constexpr double kRise = 16; // for each voxel along x
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    BlockingDetector device = detector(withClosest());
    Grid grid;
    grid.size = {9, 9, 9};
    const VolumeData image = makeBytes(grid, [](auto x, auto, auto) { return kRise * static_cast<double>(x); });
    const std::array points{ControlPoint{kOpaque - 1, 0}, ControlPoint{kOpaque, 1}, ControlPoint{kOpaque + 1, 0}};
    for (int round = 0; round < 24; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        // The first corner is the closest.
        const double x = uniform(random, 4, 7);
        MeshData mesh;
        addTriangle(mesh, {x, uniform(random, 1, 6), uniform(random, 1, 6)}, {x + 1, 0, 3}, {x + 2, 6, 5});
        const PairClearance found =
            ask(device, {mesh.view(), image.view(), {points, {0, 256}, 256}, {}, identity(), 1}, round % 2 == 0);
        ASSERT_TRUE(found.closest);
        EXPECT_NEAR(found.closest->volume[0], kOpaque / kRise, 1e-5);
        EXPECT_NEAR(found.closest->mesh[0], x, kDefaultTolerance);
    }
}

/// With a coarse tolerance what is known of a brick, or of a cell, is the end.
TEST_F(ClosestTest, OnRandomCases) {
    const std::uint64_t wanted = randomCases(240, 40);
    const std::uint64_t seed = testSeed();
    std::size_t apart = 0;
    std::size_t touching = 0;
    std::size_t none = 0;
    for (std::uint64_t round = 0; round < 3 || (touching == 0 && round < 60 && !HasFailure()); ++round) {
        const double tolerance = std::array{kDefaultTolerance, 0.3, 1e4}[round % 3];
        SCOPED_TRACE("tolerance " + std::to_string(tolerance) + ", round " + std::to_string(round));
        // Other cases in each round.
        const auto make = [&](std::uint64_t number) { return makeClearanceCase(seed, 1'000'000 * round + number); };
        BlockingDetector device = detector(withClosest({.tolerance = tolerance}));
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
        forFewKinds(wanted, seed, make, [&](const CertifiedCase& c, auto) {
            const oracle::OraclePair pair = c.scene.pair();
            const ClearanceBounds host =
                onHost(pair, [&](const cpu::Batch& batch) { return take(meter.measure(batch)).pairs.at(0).bounds; });
            for (const bool clusters : {false, true}) {
                const PairClearance found = ask(device, pair, clusters);
                EXPECT_LE(found.bounds.lo, host.hi);
                EXPECT_GE(found.bounds.hi, host.lo);
                if (found.closest) {
                    // They prove it: no point of one is nearer to a point of the other.
                    EXPECT_GE(distanceOf(found.closest->mesh, found.closest->volume), host.lo - slackOf(pair));
                }
                ++(!found.closest ? none : found.bounds.hi == 0 ? touching : apart);
            }
        });
    }
    std::cout << "  " << apart << " apart, " << touching << " touching, " << none << " with nothing near\n";
    EXPECT_GT(apart, wanted / 4);
    EXPECT_GT(touching, 0U);
}

/// Several volumes, transfer functions, meshes and poses in a batch; with next to no room much is left to the last
/// pass.
TEST_F(ClosestTest, OfSeveralItems) {
    constexpr std::uint32_t kPoses = 4;
    const std::uint64_t seed = testSeed();
    Head first(context(), queue(), take(makeBuiltinMesh("scalpel:600")), kPoses, seed);
    first.poses[0] = inTheMiddle(first); // whatever the others do
    first.poses[1] = farther(first.poses[1]);
    Head second(context(), queue(), take(makeBuiltinMesh("ellipsoid:200")), kPoses, seed + 1);
    const std::array bonePoints{ControlPoint{150, 0}, ControlPoint{200, 1}};
    const TransferFunction bone = upload(bonePoints, {0, 255});
    second.item.transferFunction = &bone;
    const BatchItem items[] = {first.item, second.item, first.item};
    const Head* const heads[] = {&first, &second, &first};
    const Detector device = take(Detector::create(context(), withClosest()));
    std::size_t apart = 0;
    std::size_t touching = 0;
    for (const std::uint32_t room : {2048U, 16U}) {
        const Answered together = detect(device, {items, {}, kDefaultThreshold}, 3 * kPoses + 7, room);
        for (std::size_t i = 0; i < 3 * kPoses; ++i) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", pair " + std::to_string(i) + ", room " +
                         std::to_string(room));
            const PairClearance& pair = together.clearances.at(i);
            const Head& head = *heads[i / kPoses];
            const std::span<const ControlPoint> points = i / kPoses == 1 ? std::span<const ControlPoint>(bonePoints)
                                                                         : std::span<const ControlPoint>(head.points);
            checkClosest({head.data.view(),
                          head.head.view(),
                          {points, {0, 255}, kDefaultTableSize},
                          {},
                          head.poses[i % kPoses],
                          kDefaultThreshold},
                         pair);
            apart += pair.bounds.lo > 0 && pair.closest ? 1U : 0U;
            touching += pair.bounds.hi == 0 ? 1U : 0U;
        }
    }
    EXPECT_GT(apart, 0U);
    EXPECT_GT(touching, 0U);
}

TEST_F(ClosestTest, BesideACountAndWithAMaximum) {
    constexpr std::uint32_t kPoses = 12;
    const std::uint64_t seed = testSeed();
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed);
    scene.poses[0] = farther(scene.poses[0]);
    DetectorDesc desc = withClosest({.maximum = 5});
    desc.stopAtFirst = false;
    desc.counters = true;
    const Answered found = detect(desc, scene.batch(), kPoses, 2048);
    desc.clearance.reset();
    desc.closest = false;
    const Answered counted = detect(desc, scene.batch(), kPoses, 2048);
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < kPoses; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", pair " + std::to_string(i));
        EXPECT_EQ(found.pairs[i].count, counted.pairs[i].count);
        EXPECT_EQ(found.pairs[i].possible, counted.pairs[i].possible);
        const PairClearance& pair = found.clearances.at(i);
        checkClosest(scene.pair(i), pair);
        if (pair.end == ClearanceEnd::Beyond) {
            EXPECT_FALSE(pair.closest);
            ++beyond;
        }
    }
    EXPECT_GT(beyond, 0U);
}

TEST_F(ClosestTest, WhereNothingIsOpaqueThereAreNone) {
    const VolumeData image = makeBytes(unitGrid(20), [](auto...) { return 100.0; });
    const Volume volume = take(Volume::upload(context(), queue(), image.view(), {.bricks = true}));
    const TransferFunction function = upload(std::array{ControlPoint{0, 0}, ControlPoint{255, 1}}, {0, 255});
    const MeshData flat = makeFlat(0.2, 0.8, 0.2, 0.8, 0.5);
    const Mesh mesh = take(Mesh::upload(context(), queue(), flat.view(), {.clusters = true}));
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
    const Detector device = take(Detector::create(context(), withClosest()));
    const PairClearance pair = detect(device, {{&item, 1}, {}, 0.5}, 1, 2048).clearances.at(0);
    EXPECT_EQ(pair.bounds.hi, kNever);
    EXPECT_FALSE(pair.closest);
    // Everything is, a little above the value: the same Results' points of before are of no use.
    const PairClearance all = detect(device, {{&item, 1}, {}, 0.3}, 1, 2048).clearances.at(0);
    ASSERT_TRUE(all.closest);
    EXPECT_EQ(all.closest->mesh, all.closest->volume);
}

/// Poses on the device, one of which is none.
TEST_F(ClosestTest, OfPosesOnTheDevice) {
    constexpr std::uint32_t kPoses = 8;
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    PosesOnDevice poses(raw(), context(), scene.poses);
    poses.spoil(3);
    DetectorDesc desc = withClosest();
    desc.devicePoses = true;
    scene.item.world_from_object = {};
    scene.item.poses = &poses.buffer();
    const Answered found = detect(desc, scene.batch(), kPoses, 2048);
    for (std::size_t i = 0; i < kPoses; ++i) {
        SCOPED_TRACE("pair " + std::to_string(i));
        if (i == 3) {
            EXPECT_FALSE(found.clearances.at(i).closest);
            continue;
        }
        checkClosest(scene.pair(i), found.clearances.at(i));
    }
}

/// In a buffer for the next pass, and in each slot of a ring.
TEST_F(ClosestTest, AreOnTheDeviceForTheNextPass) {
    constexpr std::uint32_t kPoses = 5;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    const Detector device = take(Detector::create(context(), withClosest({.maximum = 30})));
    ResultRing ring =
        take(ResultRing::create(context(), 2, {.maxPairs = kPoses + 1, .clearances = true, .closest = true}));
    for (const std::uint64_t frame : {0U, 1U, 2U}) {
        Results* results = take(ring.begin(frame));
        const BufferRange range = results->closest();
        EXPECT_EQ(range.size, (kPoses + 1) * sizeof(ClosestResult));
        EXPECT_EQ(range.offset % 256, 0U);
        EXPECT_EQ(range.buffer, results->clearances().buffer);
        EXPECT_GE(range.offset, results->clearances().offset + results->clearances().size);
        const RawVulkan::HostBuffer copy = raw().makeBuffer(range.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        const VkCommandBuffer commands = raw().begin();
        take(device.cmdDetect(commands, scene.batch(), *results));
        take(results->cmdReadBack(commands));
        const VkBufferCopy region{range.offset, 0, range.size};
        raw().vk().vkCmdCopyBuffer(commands, range.buffer, copy.buffer, 1, &region);
        raw().submitAndWait(commands);
        const std::vector<PairClearance> read = take(take(ring.results(frame))->readClearances());
        ASSERT_EQ(read.size(), kPoses);
        for (std::size_t i = 0; i < kPoses; ++i) {
            ClosestResult found{};
            std::memcpy(&found, static_cast<const std::byte*>(copy.mapped) + i * sizeof found, sizeof found);
            EXPECT_EQ(found.some, read[i].closest ? 1U : 0U);
            EXPECT_EQ(found.reserved, 0U);
            const ClosestPoints points = read[i].closest.value_or(ClosestPoints());
            EXPECT_EQ(found.triangle, points.triangle);
            EXPECT_EQ(static_cast<double>(found.x), points.mesh[0]);
            EXPECT_EQ(static_cast<double>(found.z), points.mesh[2]);
            EXPECT_EQ(static_cast<double>(found.y) + static_cast<double>(found.wayY), points.volume[1]);
        }
    }
}

/// A detector without them leaves Results that have room for them as it would others.
TEST_F(ClosestTest, AreNotThereWhereNobodyAsks) {
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), 1, testSeed());
    DetectorDesc desc = withClosest({.maximum = 5});
    desc.closest = false;
    const Detector device = take(Detector::create(context(), desc));
    Results results = take(Results::create(context(), {.maxPairs = 1, .clearances = true, .closest = true}));
    const VkCommandBuffer commands = raw().begin();
    take(device.cmdDetect(commands, scene.batch(), results));
    take(results.cmdReadBack(commands));
    raw().submitAndWait(commands);
    EXPECT_FALSE(take(results.readClearances()).at(0).closest);
}

TEST_F(ClosestTest, AreRefusedWithoutAClearance) {
    DetectorDesc desc = withClosest();
    desc.clearance.reset();
    const Result<Detector> made = Detector::create(context(), desc);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(made.error().text, HasSubstr("closest points are of clearances"));
    const Result<Results> room = Results::create(context(), {.maxPairs = 1, .closest = true});
    ASSERT_FALSE(room.ok());
    EXPECT_THAT(room.error().text, HasSubstr("ResultsDesc::clearances is false"));

    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), 1, 1);
    const Detector device = take(Detector::create(context(), withClosest()));
    Results results = take(Results::create(context(), {.maxPairs = 1, .clearances = true}));
    EXPECT_EQ(results.closest().buffer, VK_NULL_HANDLE);
    const VkCommandBuffer commands = raw().begin();
    const Result<void> recorded = device.cmdDetect(commands, scene.batch(), results);
    raw().submitAndWait(commands);
    ASSERT_FALSE(recorded.ok());
    EXPECT_THAT(recorded.error().text, HasSubstr("no room for closest points: ResultsDesc::closest is false"));
}

} // namespace
} // namespace voxtact::test
