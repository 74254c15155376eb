// SPDX-License-Identifier: MIT
// The projections two-view and dominant-axis by the engine: against the reference and the oracle, and where the counts
// are known.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/count/reference.h"
#include "oracle/oracle.h"
#include "support/host_meters.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr ValueRange kByteValues{0, 255};
constexpr cpu::DetectorDesc kDominant{.projection = Projection::DominantAxis};

std::vector<std::uint64_t> engineCounts(const RandomScene& scene, cpu::DetectorDesc desc, const View& view) {
    const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create(scene.transferFunction()));
    const cpu::Mesh mesh = take(cpu::Mesh::create(scene.mesh.view()));
    desc.boundary = scene.rangeTest ? Boundary::Range : Boundary::Clamp;
    cpu::Detector detector = take(cpu::Detector::create(desc));
    const cpu::BatchItem item{&mesh, &volume, &function, scene.poses};
    std::vector<std::uint64_t> out;
    for (const PairAnswer& pair : take(detector.detect({std::span(&item, 1), view, scene.threshold})).pairs) {
        EXPECT_EQ(pair.projection, desc.projection);
        out.push_back(pair.count);
    }
    return out;
}

/// As many samples as the volume's size allows for in a quick test.
std::uint32_t randomSamples(std::mt19937_64& random, const Grid& grid) {
    const std::uint32_t longest = std::max({grid.size[0], grid.size[1], grid.size[2]});
    const std::uint32_t most = std::clamp(256 / longest, 1U, kMaxSamplesPerVoxel);
    return 1 + static_cast<std::uint32_t>(below(random, most));
}

cpu::ReferencePair referencePair(const RandomScene& scene, const Mat4& pose, std::uint32_t samples) {
    return {scene.mesh.view(), scene.volume.view(), scene.transferFunction(), scene.view, pose,
            scene.threshold,   scene.rangeTest,     Projection::DominantAxis, samples};
}

TEST(Projections, DominantAxisIsTheReference) {
    std::mt19937_64 random(testSeed());
    std::uint64_t survivors = 0;
    std::size_t hits = 0;
    const std::size_t rounds = randomCases(500, 4);
    for (std::size_t round = 0; round < rounds; ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        const RandomScene scene = makeRandomScene(local, 4);
        cpu::DetectorDesc desc = kDominant;
        desc.threads = 1 + static_cast<std::uint32_t>(below(local, 3));
        desc.samplesPerVoxel = randomSamples(local, scene.volume.grid);
        std::vector<std::uint64_t> expected;
        for (const Mat4& pose : scene.poses) {
            expected.push_back(cpu::referenceCounts(referencePair(scene, pose, desc.samplesPerVoxel)).survivors);
            survivors += expected.back();
            hits += expected.back() > 0 ? 1U : 0U;
        }
        ASSERT_EQ(engineCounts(scene, desc, {}), expected) << "round " << round << ", scene " << seed;
        desc.stopAtFirst = true;
        const auto first = engineCounts(scene, desc, {});
        for (std::size_t i = 0; i < first.size(); ++i) {
            ASSERT_EQ(first[i], expected[i] > 0 ? 1U : 0U) << "round " << round << ", scene " << seed;
        }
    }
    std::cout << hits << " pairs of " << 4 * rounds << " with a survivor, " << survivors << " survivors\n";
    EXPECT_GT(hits, 4 * rounds / 10) << "a test that hits nothing proves nothing";
}

TEST(Projections, DominantAxisIsTheReferenceBeyondReason) {
    std::mt19937_64 random(testSeed());
    constexpr float kExtremes[] = {3e38F, -3e38F, 1e30F, -1e30F, 1e-38F, 1e-45F, 0, 1, -1, 1e19F, 0.5F, 0.25F};
    for (int round = 0; round < 300; ++round) {
        RandomScene scene;
        scene.volume = makeBytes(unitGrid(6, 9, 4), [](auto...) { return 255.0; });
        scene.points.assign(byteRamp().begin(), byteRamp().end());
        scene.domain = kByteValues;
        scene.poses = {identity()};
        scene.rangeTest = round % 3 != 0;
        for (int i = 0; i < 90; ++i) {
            scene.mesh.positions.push_back(kExtremes[below(random, std::size(kExtremes))]);
        }
        for (int i = 0; i < 120; ++i) {
            scene.mesh.indices.push_back(static_cast<std::uint32_t>(below(random, 30)));
        }
        EXPECT_EQ(engineCounts(scene, kDominant, {})[0],
                  cpu::referenceCounts(referencePair(scene, identity(), 1)).survivors);
    }
}

/// A ramp over all values of the volume and a threshold in between, so that hardly a decision is within rounding. False
/// where the values are too large, or too near each other, for that.
bool makePlain(RandomScene& scene) {
    scene.domain = take(checkVolume(scene.volume.view()));
    scene.points = {{scene.domain.lo, 0}, {scene.domain.hi, 1}};
    scene.threshold = 0.4137;
    const double largest = std::max(std::abs(scene.domain.lo), std::abs(scene.domain.hi));
    return largest < 1e37 && scene.domain.hi - scene.domain.lo > largest / 100;
}

TEST(Projections, DominantAxisIsTheOracleUpToRounding) {
    std::mt19937_64 random(testSeed());
    std::uint64_t survivors = 0;
    std::uint64_t differ = 0;
    for (int round = 0; round < 150; ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        RandomScene scene = makeRandomScene(local, 2);
        scene.rangeTest = true;
        if (!makePlain(scene)) {
            continue;
        }
        cpu::DetectorDesc desc = kDominant;
        desc.samplesPerVoxel = randomSamples(local, scene.volume.grid);
        const auto counts = engineCounts(scene, desc, {});
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const std::size_t oracle = take(oracle::oracleSurvivors({scene.mesh.view(),
                                                                     scene.volume.view(),
                                                                     scene.transferFunction(),
                                                                     {},
                                                                     scene.poses[i],
                                                                     scene.threshold,
                                                                     Projection::DominantAxis,
                                                                     desc.samplesPerVoxel}))
                                           .size();
            const std::uint64_t difference =
                std::max<std::uint64_t>(counts[i], oracle) - std::min<std::uint64_t>(counts[i], oracle);
            EXPECT_LE(difference, 8 + oracle / 50)
                << "scene " << seed << ", pose " << i << ": " << counts[i] << " against the oracle's " << oracle;
            survivors += oracle;
            differ += difference;
        }
    }
    std::cout << "the oracle's survivors: " << survivors << ", the counts differ by " << differ << "\n";
    EXPECT_GT(survivors, 10000U);
    EXPECT_LE(differ, 50 + survivors / 2000);
}

TEST(Projections, TwoViewIsTheViewAndTheSideView) {
    std::mt19937_64 random(testSeed());
    std::uint64_t sides = 0;
    for (int round = 0; round < 300; ++round) {
        const std::uint64_t seed = random();
        std::mt19937_64 local(seed);
        const RandomScene scene = makeRandomScene(local, 3);
        const View side{sideView(scene.view.clip_from_world), scene.view.width, scene.view.height};
        std::vector<std::uint64_t> expected = engineCounts(scene, {.threads = 1}, scene.view);
        const std::vector<std::uint64_t> second = engineCounts(scene, {.threads = 1}, side);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            expected[i] += second[i];
            sides += second[i];
        }
        const auto both = engineCounts(scene, {.threads = 3, .projection = Projection::TwoView}, scene.view);
        ASSERT_EQ(both, expected) << "round " << round << ", scene " << seed;
        const auto first =
            engineCounts(scene, {.threads = 1, .stopAtFirst = true, .projection = Projection::TwoView}, scene.view);
        for (std::size_t i = 0; i < first.size(); ++i) {
            ASSERT_EQ(first[i], expected[i] > 0 ? 1U : 0U) << "round " << round << ", scene " << seed;
        }
    }
    EXPECT_GT(sides, 10000U);
}

std::uint64_t countOf(const MeshData& mesh, const VolumeData& volume, const cpu::DetectorDesc& desc,
                      const Mat4& pose = identity()) {
    return engineCount(mesh.view(), volume.view(), {byteRamp(), kByteValues}, {}, 0.5, desc, pose);
}

VolumeData solid(const Grid& grid) {
    return makeBytes(grid, [](auto...) { return 255.0; });
}

TEST(Projections, AnAxisAlignedPlateHasItsArea) {
    // 8 x 4 voxels of a volume of 16 x 8 x 32, at right angles to each axis.
    const VolumeData volume = solid(unitGrid(16, 8, 32));
    const auto at = [](double x, double y, double z) { return Vec3{x / 16, y / 8, z / 32}; };
    const MeshData plates[] = {
        makeRectangle(at(4, 2, 3.3), at(12, 2, 3.3), at(12, 6, 3.3), at(4, 6, 3.3)),
        makeRectangle(at(4, 2.2, 20), at(12, 2.2, 20), at(12, 2.2, 24), at(4, 2.2, 24)),
        makeRectangle(at(9.7, 2, 20), at(9.7, 6, 20), at(9.7, 6, 28), at(9.7, 2, 28)),
    };
    for (const MeshData& plate : plates) {
        for (const std::uint32_t samples : {1U, 2U, 4U, 16U}) {
            cpu::DetectorDesc desc = kDominant;
            desc.samplesPerVoxel = samples;
            EXPECT_EQ(countOf(plate, volume, desc), 32U * samples * samples) << samples;
        }
    }
    // What is outside of the image is not counted, unless it is clamped: to the square of the longest side.
    const MeshData large = makeRectangle(at(-40, -40, 3.3), at(80, -40, 3.3), at(80, 80, 3.3), at(-40, 80, 3.3));
    EXPECT_EQ(countOf(large, volume, kDominant), 16U * 8U);
    cpu::DetectorDesc clamp = kDominant;
    clamp.boundary = Boundary::Clamp;
    EXPECT_EQ(countOf(large, volume, clamp), 32U * 32U);
}

TEST(Projections, ATiltedPlateHasItsAreaTimesItsLargestNormalComponent) {
    // So that the count of a mesh changes by a factor of sqrt(3) at most when it is turned.
    std::mt19937_64 random(testSeed());
    const VolumeData volume = solid(unitGrid(64));
    const MeshData plate = makeFlat(-0.25, 0.25, -0.25, 0.25, 0);
    cpu::DetectorDesc desc = kDominant;
    desc.samplesPerVoxel = 4;
    const double area = 128 * 128;
    double least = 1e9;
    double most = 0;
    for (int round = 0; round < 200; ++round) {
        const Mat4 pose = multiply(translation({0.5, 0.5, 0.5}), randomRotation(random));
        const auto count = static_cast<double>(countOf(plate, volume, desc, pose));
        const double component = std::max({std::abs(pose[8]), std::abs(pose[9]), std::abs(pose[10])});
        EXPECT_NEAR(count, area * component, 0.01 * area);
        least = std::min(least, count);
        most = std::max(most, count);
    }
    std::cout << "area " << area << ", counted " << least << " to " << most << "\n";
    EXPECT_LE(most / least, std::numbers::sqrt3 * 1.01);
    EXPECT_GT(most / least, 1.4) << "rotations that find no difference prove nothing";
}

TEST(Projections, TurningMeshAndVolumeTogetherKeepsTheCount) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:64"));
    const MeshData scalpel = take(makeScalpel());
    const Mat4 pose = multiply(translation({10, 20, 30}), randomRotation(random));
    std::vector<double> counts;
    for (int round = 0; round < 100; ++round) {
        const Mat4 motion = randomMotion(random);
        const VolumeData turned = moved(head, motion);
        cpu::DetectorDesc desc = kDominant;
        desc.samplesPerVoxel = 4;
        counts.push_back(static_cast<double>(countOf(scalpel, turned, desc, multiply(motion, pose))));
    }
    const auto [least, most] = std::ranges::minmax(counts);
    const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
    std::cout << "counts from " << least << " to " << most << ", mean " << mean << "\n";
    EXPECT_GT(least, 100);
    EXPECT_LE(most - least, 2 + mean / 100) << "only rounding differs";
}

TEST(Projections, BadOnesAreRefused) {
    cpu::DetectorDesc desc = kDominant;
    for (const std::uint32_t samples : {0U, 17U}) {
        desc.samplesPerVoxel = samples;
        const Result<cpu::Detector> detector = cpu::Detector::create(desc);
        ASSERT_FALSE(detector.ok());
        EXPECT_EQ(detector.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(detector.error().text, HasSubstr("must be 1 to 16"));
    }
    desc.projection = static_cast<Projection>(9);
    EXPECT_THAT(cpu::Detector::create(desc).error().text, HasSubstr("no projection number 9"));
    desc = kDominant;
    desc.samplesPerVoxel = 16;
    cpu::Detector detector = take(cpu::Detector::create(desc));
    const cpu::Volume volume = take(cpu::Volume::create(solid(unitGrid(1, 1, 1025)).view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), kByteValues}));
    const cpu::Mesh mesh = take(cpu::Mesh::create(makeFlat(0, 1, 0, 1, 0.5).view()));
    const Mat4 pose = identity();
    const cpu::BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    const Result<BatchAnswer> answer = detector.detect({std::span(&item, 1), {}, 0.5});
    ASSERT_FALSE(answer.ok());
    EXPECT_EQ(answer.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(answer.error().text, HasSubstr("16 samples per voxel needs a viewport of 16400x16400"));
    // The camera is examined where there is one.
    cpu::Detector both = take(cpu::Detector::create({.projection = Projection::TwoView}));
    EXPECT_THAT(both.detect({std::span(&item, 1), {}, 0.5}).error().text, HasSubstr("singular"));
}

} // namespace
} // namespace voxtact::test
