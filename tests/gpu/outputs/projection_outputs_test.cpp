// SPDX-License-Identifier: MIT
// The outputs in addition to the counts in the projections that have no test of their own for them: two-view,
// dominant-axis.
#include "gpu_fixture.h"

#include "core/method/method_table.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <map>

namespace voxtact::test {
namespace {

/// The triangles are small compared with the voxels.
constexpr std::uint32_t kSamples = 4;
constexpr Outputs kOutputs{.triangles = true, .bounds = true};

class ProjectionOutputsTest : public GpuTest, public testing::WithParamInterface<Projection> {};

std::map<std::uint32_t, std::uint64_t> sumsByPair(const BatchAnswer& answer) {
    std::map<std::uint32_t, std::uint64_t> sums;
    for (const TouchedTriangle& touched : answer.triangles) {
        sums[touched.pair] += touched.count;
    }
    return sums;
}

TEST_P(ProjectionOutputsTest, AreTheSameOnDeviceAndHost) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData head = take(makeBuiltinVolume("head:48"));
    const MeshData scalpel = take(makeScalpel());
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const std::vector<Mat4> poses = randomPoses(head.grid, 12, 0.3, random);
    const View view{framingCamera(head.grid, 200, 200), 200, 200};
    const Volume volume = upload(head);
    const Mesh mesh = upload(scalpel);
    const TransferFunction function = upload(points, {0, 255});
    const cpu::Volume hostVolume = take(cpu::Volume::create(head.view()));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(scalpel.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create({points, {0, 255}}));
    const BatchItem item{&mesh, &volume, &function, poses};
    const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};

    const BatchAnswer host =
        take(take(cpu::Detector::create({.projection = GetParam(), .outputs = kOutputs, .samplesPerVoxel = kSamples}))
                 .detect({{&hostItem, 1}, view, kDefaultThreshold}));
    const BatchAnswer compute = take(detector({.method = CountingMethod::Compute,
                                               .projection = GetParam(),
                                               .filter = Filter::Exact,
                                               .outputs = kOutputs,
                                               .samplesPerVoxel = kSamples})
                                         .detect({{&item, 1}, view, kDefaultThreshold}));
    ASSERT_FALSE(host.triangles.empty()) << seed;
    ASSERT_EQ(compute.triangles.size(), host.triangles.size()) << seed;
    for (std::size_t i = 0; i < host.triangles.size(); ++i) {
        EXPECT_EQ(compute.triangles[i].pair, host.triangles[i].pair) << seed;
        EXPECT_EQ(compute.triangles[i].triangle, host.triangles[i].triangle) << seed;
        EXPECT_EQ(compute.triangles[i].count, host.triangles[i].count) << seed;
    }
    for (std::size_t pair = 0; pair < poses.size(); ++pair) {
        EXPECT_EQ(compute.pairs[pair].count, host.pairs[pair].count) << seed;
        ASSERT_EQ(compute.bounds[pair].has_value(), host.bounds[pair].has_value()) << seed;
        if (host.bounds[pair]) {
            EXPECT_EQ(compute.bounds[pair]->lo, host.bounds[pair]->lo) << seed;
            EXPECT_EQ(compute.bounds[pair]->hi, host.bounds[pair]->hi) << seed;
        }
    }
    for (const CountingMethod method : methodsThatCount(Coverage::Rasteriser)) {
        const BatchAnswer raster = take(
            detector({.method = method, .projection = GetParam(), .outputs = kOutputs, .samplesPerVoxel = kSamples})
                .detect({{&item, 1}, view, kDefaultThreshold}));
        const std::map<std::uint32_t, std::uint64_t> sums = sumsByPair(raster);
        for (const PairAnswer& pair : raster.pairs) {
            const auto sum = sums.find(pair.pair);
            EXPECT_EQ(sum == sums.end() ? 0 : sum->second, pair.count) << toString(method) << ", seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Projections, ProjectionOutputsTest,
                         testing::Values(Projection::View, Projection::TwoView, Projection::DominantAxis),
                         [](const testing::TestParamInfo<Projection>& made) {
                             return "Number" + std::to_string(static_cast<std::uint32_t>(made.param));
                         });

} // namespace
} // namespace voxtact::test
