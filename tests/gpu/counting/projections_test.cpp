// SPDX-License-Identifier: MIT
// The projections two-view and dominant-axis by every method: what they see that a view does not, counts that are known
// beforehand, and what is refused.
#include "core/method/method_table.h"
#include "device/scene/scene_impl.h"
#include "gpu_fixture.h"
#include "support/scenes.h"

#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Of the device.
std::vector<CountingMethod> countingOnes() {
    std::vector<CountingMethod> methods = methodsThatCount(Coverage::Rasteriser);
    methods.push_back(CountingMethod::Compute);
    return methods;
}

/// World x, y and z in [0,1] fill the view volume.
View boxView(std::uint32_t side) {
    View view = flatView(0, 1, side, side);
    view.clip_from_world[10] = 1;
    view.clip_from_world[14] = 0;
    return view;
}

class ProjectionsTest : public GpuTest {
  protected:
    /// The count of a mesh in an opaque unit cube, which all methods must agree on.
    std::uint64_t countOf(const MeshData& mesh, AnyDesc desc, const View& view, const Grid& grid = unitGrid(16)) {
        const Mesh uploaded = upload(mesh);
        const Volume volume = upload(makeBytes(grid, [](auto...) { return 255.0; }));
        const TransferFunction function = upload(byteRamp(), {0, 255});
        const Mat4 pose = identity();
        const BatchItem item{&uploaded, &volume, &function, std::span(&pose, 1)};
        desc.method = CountingMethod::QueryAny;
        const PairAnswer any = detectOne(desc, item, view);
        std::uint64_t first = 0;
        for (const CountingMethod method : countingOnes()) {
            desc.method = method;
            desc.filter = defaultFilter(method);
            const PairAnswer answer = detectOne(desc, item, view);
            EXPECT_EQ(answer.projection, desc.projection);
            EXPECT_EQ(any.hit, answer.hit) << toString(method);
            first = method == CountingMethod::Query ? answer.count : first;
            EXPECT_EQ(answer.count, first) << toString(method);
        }
        return first;
    }

    std::vector<std::uint64_t> counts(const AnyDesc& desc, const BatchItem& item, const View& view,
                                      double threshold = kDefaultThreshold) {
        BlockingDetector one = detector(desc);
        std::vector<std::uint64_t> out;
        for (const PairAnswer& pair : take(one.detect({std::span(&item, 1), view, threshold})).pairs) {
            EXPECT_EQ(pair.pair, out.size());
            out.push_back(pair.count);
        }
        return out;
    }
};

TEST_F(ProjectionsTest, TwoViewFindsWhatIsEdgeOn) {
    // A plate along the direction of view.
    const MeshData plate = makeRectangle({0.5, 0.25, 0.25}, {0.5, 0.75, 0.25}, {0.5, 0.75, 0.75}, {0.5, 0.25, 0.75});
    const View view = boxView(64);
    EXPECT_EQ(countOf(plate, {}, view), 0U);
    EXPECT_EQ(countOf(plate, {.projection = Projection::TwoView}, view), 32U * 32U);
    EXPECT_EQ(countOf(plate, {.projection = Projection::DominantAxis}, {}), 8U * 8U);
    // One that faces the view is edge-on from the side.
    const MeshData facing = makeFlat(0.25, 0.75, 0.25, 0.75, 0.5);
    EXPECT_EQ(countOf(facing, {.projection = Projection::TwoView}, view), 32U * 32U);
}

TEST_F(ProjectionsTest, TwoViewIsBlindWhereBothViewsAre) {
    // Its normal is at right angles to both directions of view.
    const MeshData plate = makeRectangle({0.25, 0.5, 0.25}, {0.75, 0.5, 0.25}, {0.75, 0.5, 0.75}, {0.25, 0.5, 0.75});
    EXPECT_EQ(countOf(plate, {.projection = Projection::TwoView}, boxView(64)), 0U);
    EXPECT_EQ(countOf(plate, {.projection = Projection::DominantAxis}, {}), 8U * 8U);
}

TEST_F(ProjectionsTest, TwoViewIsTheViewAndTheSideView) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:64"));
    const Volume volume = upload(head);
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh scalpel = upload(take(makeScalpel()));
    const std::vector<Mat4> poses = randomPoses(head.grid, 300, 1.2, random);
    const BatchItem item{&scalpel, &volume, &function, poses};
    const View view{framingCamera(head.grid, 200, 160), 200, 160};
    const View side{sideView(view.clip_from_world), 200, 160};
    for (const CountingMethod method : countingOnes()) {
        AnyDesc desc{.method = method, .filter = defaultFilter(method)};
        std::vector<std::uint64_t> expected = counts(desc, item, view);
        const std::vector<std::uint64_t> second = counts(desc, item, side);
        std::uint64_t sides = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            expected[i] += second[i];
            sides += second[i];
        }
        desc.projection = Projection::TwoView;
        EXPECT_EQ(counts(desc, item, view), expected) << toString(method);
        EXPECT_GT(sides, 10000U);
    }
}

TEST_F(ProjectionsTest, AnAxisAlignedPlateHasItsArea) {
    // 8 x 4 voxels of a volume of 16 x 8 x 32, at right angles to each axis.
    const auto at = [](double x, double y, double z) { return Vec3{x / 16, y / 8, z / 32}; };
    const MeshData plates[] = {
        makeRectangle(at(4, 2, 3.25), at(12, 2, 3.25), at(12, 6, 3.25), at(4, 6, 3.25)),
        makeRectangle(at(4, 2.25, 20), at(12, 2.25, 20), at(12, 2.25, 24), at(4, 2.25, 24)),
        makeRectangle(at(9.75, 2, 20), at(9.75, 6, 20), at(9.75, 6, 28), at(9.75, 2, 28)),
    };
    for (const MeshData& plate : plates) {
        for (const std::uint32_t samples : {1U, 2U, 4U}) {
            EXPECT_EQ(countOf(plate, {.projection = Projection::DominantAxis, .samplesPerVoxel = samples}, {},
                              unitGrid(16, 8, 32)),
                      32U * samples * samples)
                << samples;
        }
    }
}

TEST_F(ProjectionsTest, DominantAxisOfTheRasteriserIsThatOfCompute) {
    // Up to fragments whose coverage or opacity is within rounding of a decision: the filter is the same here.
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:64"));
    const Volume volume = upload(head);
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh scalpel = upload(take(makeScalpel()));
    const std::vector<Mat4> poses = randomPoses(head.grid, 300, 1.2, random);
    const BatchItem item{&scalpel, &volume, &function, poses};
    AnyDesc desc{.projection = Projection::DominantAxis, .filter = Filter::Exact, .samplesPerVoxel = 4};
    const std::vector<std::uint64_t> raster = counts(desc, item, {});
    desc.method = CountingMethod::Compute;
    const std::vector<std::uint64_t> compute = counts(desc, item, {});
    std::uint64_t survivors = 0;
    std::uint64_t differ = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto difference = static_cast<std::uint64_t>(
            std::abs(static_cast<std::int64_t>(raster[i]) - static_cast<std::int64_t>(compute[i])));
        EXPECT_LE(difference, 8 + compute[i] / 200) << "pose " << i;
        survivors += compute[i];
        differ += difference;
    }
    std::cout << survivors << " survivors, the counts differ by " << differ << "\n";
    EXPECT_GT(survivors, 100000U);
    EXPECT_LE(differ, survivors / 1000);
}

TEST_F(ProjectionsTest, TurningMeshAndVolumeTogetherKeepsTheCount) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:64"));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh scalpel = upload(take(makeScalpel()));
    const Mat4 pose = multiply(translation({10, 20, 30}), randomRotation(random));
    BlockingDetector query = detector({.projection = Projection::DominantAxis, .samplesPerVoxel = 4});
    std::vector<double> counts;
    for (int round = 0; round < 50; ++round) {
        const Mat4 motion = randomMotion(random);
        const Volume volume = upload(moved(head, motion));
        const Mat4 turned = multiply(motion, pose);
        const BatchItem item{&scalpel, &volume, &function, std::span(&turned, 1)};
        counts.push_back(static_cast<double>(take(query.detect({std::span(&item, 1), {}, 0.5})).pairs[0].count));
    }
    const auto [least, most] = std::ranges::minmax(counts);
    const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
    std::cout << "counts from " << least << " to " << most << ", mean " << mean << "\n";
    EXPECT_GT(least, 100);
    EXPECT_LE(most - least, 2 + mean / 100) << "only rounding differs";
}

TEST_F(ProjectionsTest, ItemsOfDifferentVolumesShareABatch) {
    // Each item has its own viewport.
    const MeshData flat = makeFlat(0, 1, 0, 1, 0.5);
    const Mesh mesh = upload(flat);
    const Volume small = upload(makeBytes(unitGrid(8), [](auto...) { return 255.0; }));
    const Volume large = upload(makeBytes(unitGrid(24, 40, 6), [](auto...) { return 255.0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mat4 poses[] = {identity(), translation({0, 0, 5}), translation({0.5, 0, 0.125})};
    const BatchItem items[] = {
        {&mesh, &small, &function, poses}, {&mesh, &large, &function, {}}, {&mesh, &large, &function, poses}};
    constexpr std::uint64_t kExpected[] = {64, 0, 32, 960, 0, 480};
    for (const CountingMethod method : countingOnes()) {
        BlockingDetector one = detector({.method = method, .projection = Projection::DominantAxis});
        const BatchAnswer answer = take(one.detect({items, {}, 0.5}));
        ASSERT_EQ(answer.pairs.size(), std::size(kExpected));
        for (std::size_t i = 0; i < std::size(kExpected); ++i) {
            EXPECT_EQ(answer.pairs[i].count, kExpected[i]) << toString(method) << " pair " << i;
            EXPECT_EQ(answer.pairs[i].item, i < 3 ? 0U : 2U);
        }
    }
}

TEST_F(ProjectionsTest, MeshesOfTheCallersAreReadAsStorage) {
    const Mesh owned = upload(makeFlat(0.25, 0.75, 0.25, 0.75, 0.5));
    const Volume volume = upload(makeBytes(unitGrid(16), [](auto...) { return 255.0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mat4 pose = identity();
    WrappedMesh wrapped;
    // A Mesh made by the library is as good a caller's buffer as any: positions first, then indices.
    wrapped.vertices = owned.impl().vertices;
    wrapped.vertexCount = 4;
    wrapped.indices = wrapped.vertices;
    wrapped.indexOffset = 4 * 12;
    wrapped.triangleCount = 2;
    wrapped.storage = true;
    const Mesh readable = take(Mesh::wrap(context(), wrapped));
    wrapped.storage = false;
    const Mesh unreadable = take(Mesh::wrap(context(), wrapped));
    for (const CountingMethod method : methodsThatCount(Coverage::Rasteriser)) {
        BlockingDetector one = detector({.method = method, .projection = Projection::DominantAxis});
        const BatchItem good{&readable, &volume, &function, std::span(&pose, 1)};
        EXPECT_EQ(take(one.detect({std::span(&good, 1), {}, 0.5})).pairs[0].count, 64U);
        const BatchItem bad{&unreadable, &volume, &function, std::span(&pose, 1)};
        const Result<BatchAnswer> answer = one.detect({std::span(&bad, 1), {}, 0.5});
        ASSERT_FALSE(answer.ok());
        EXPECT_EQ(answer.error().code, ErrorCode::Unsupported);
        EXPECT_THAT(answer.error().text, HasSubstr("dominant-axis cannot be used: WrappedMesh::storage is false"));
    }
}

TEST_F(ProjectionsTest, BadOnesAreRefused) {
    for (const std::uint32_t samples : {0U, 17U}) {
        const Result<Detector> detector =
            Detector::raster(context(), {.projection = Projection::DominantAxis, .samplesPerVoxel = samples});
        ASSERT_FALSE(detector.ok());
        EXPECT_EQ(detector.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(detector.error().text, HasSubstr("must be 1 to 16"));
    }
    EXPECT_THAT(Detector::raster(context(), {.projection = static_cast<Projection>(7)}).error().text,
                HasSubstr("no projection number 7"));
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Volume volume = upload(makeBytes(unitGrid(1, 1, 2000), [](auto...) { return 255.0; }));
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    for (const CountingMethod method : countingOnes()) {
        AnyDesc desc{.method = method, .projection = Projection::DominantAxis, .samplesPerVoxel = 16};
        BlockingDetector fine = detector(desc);
        const Result<BatchAnswer> answer = fine.detect({std::span(&item, 1), {}, 0.5});
        if (context().maxViewport().width >= 32000 && method != CountingMethod::Compute) {
            continue;
        }
        ASSERT_FALSE(answer.ok());
        EXPECT_EQ(answer.error().code, ErrorCode::LimitExceeded);
        EXPECT_THAT(answer.error().text, HasSubstr("32000x32000"));
    }
    // The camera is examined where there is one.
    BlockingDetector both = detector({.projection = Projection::TwoView});
    EXPECT_THAT(both.detect({std::span(&item, 1), {}, 0.5}).error().text, HasSubstr("singular"));
}

TEST_F(ProjectionsTest, OverestimationNeedsItsExtension) {
    const AnyDesc desc{.projection = Projection::DominantAxis, .overestimate = true};
    ContextDesc without = gpu().device.contextDesc();
    without.enabledDeviceExtensions = {};
    const Context context = take(Context::create(without));
    const Result<Detector> detector = Detector::create(context, desc);
    ASSERT_FALSE(detector.ok());
    EXPECT_EQ(detector.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(detector.error().text, HasSubstr("VK_EXT_conservative_rasterization"));
    for (const Projection projection : {Projection::View, Projection::TwoView}) {
        const Result<Detector> refused = Detector::raster(context, {.projection = projection, .overestimate = true});
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(refused.error().text, HasSubstr(toString(projection)));
    }
    const Result<Detector> refused = Detector::raster(
        context, {.method = CountingMethod::Compute, .projection = Projection::DominantAxis, .overestimate = true});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(refused.error().text, HasSubstr("dominant-axis by compute"));
}

/// A suite of its own: where it is skipped, that is to be seen.
class OverestimationTest : public ProjectionsTest {};

TEST_F(OverestimationTest, CountsEveryPixelThatIsTouched) {
    const auto extensions = gpu().device.contextDesc().enabledDeviceExtensions;
    if (extensions.empty()) {
        GTEST_SKIP() << "the device has no VK_EXT_conservative_rasterization";
    }
    // From the middle of one voxel to the middle of another, no voxel's centre is covered by less than 5 x 3 of them.
    const MeshData plate = makeRectangle({4.6 / 16, 4.6 / 16, 0.5}, {8.4 / 16, 4.6 / 16, 0.5},
                                         {8.4 / 16, 6.4 / 16, 0.5}, {4.6 / 16, 6.4 / 16, 0.5});
    const Mesh mesh = upload(plate);
    const Volume volume = upload(makeBytes(unitGrid(16), [](auto...) { return 255.0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    AnyDesc desc{.projection = Projection::DominantAxis};
    const std::uint64_t plain = detectOne(desc, item, {}).count;
    EXPECT_EQ(plain, 3U * 1U);
    desc.overestimate = true;
    // Both triangles count the pixels of their common edge.
    EXPECT_GE(detectOne(desc, item, {}).count, 5U * 3U);
}

} // namespace
} // namespace voxtact::test
