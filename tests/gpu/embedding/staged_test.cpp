// SPDX-License-Identifier: MIT
// ResultsDesc::staged: what a batch is recorded with goes through mapped memory, and no answer depends on it.
#include "core/geometry/projection.h"
#include "core/method/method_table.h"
#include "device/detector/detector_impl.h"
#include "device/detector/many_poses.h"
#include "device/engine/pair_pipeline.h"
#include "device/results/results_impl.h"
#include "exact/shared.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"
#include "vulkan/context_impl.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace voxtact::test {
namespace {

constexpr std::uint32_t kMostPairs = 200;

class StagedTest : public RawGpuTest {
  protected:
    static std::vector<std::byte> answersOf(Results& results) {
        const auto bytes = std::as_bytes(take(results.read()));
        return {bytes.begin(), bytes.end()};
    }
    std::vector<std::byte> run(const Detector& detector, const Batch& batch, Results& results) {
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        return answersOf(results);
    }
};

TEST_F(StagedTest, AnswersAreTheSameByEveryMethodAndProjection) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunction function = upload(points, {0, 255});
    const Mesh mesh = take(Mesh::upload(context(), queue(), take(makeScalpel()).view(), {.clusters = true}));
    const View view{framingCamera(head.grid, 64, 64), 64, 64};
    const std::vector<Mat4> poses = randomPoses(head.grid, kMostPairs, 1, random);
    const std::span all(poses);
    std::size_t copied = 0;
    for (const Projection projection : projections()) {
        for (const CountingMethod method : countingMethods()) {
            if (method == CountingMethod::Cpu || !context().supports(method, projection)) {
                continue;
            }
            SCOPED_TRACE(std::string(toString(projection)) + " " + toString(method));
            const Detector detector =
                take(Detector::create(context(), AnyDesc{.method = method, .projection = projection}));
            Results embedded = take(Results::create(detector, {.maxPairs = kMostPairs}));
            Results staged = take(Results::create(detector, {.maxPairs = kMostPairs, .staged = true}));
            EXPECT_EQ(embedded.impl().staging.size, 0U);
            EXPECT_GT(staged.impl().staging.size, 0U);
            // Few are in the command buffer nevertheless; one batch after the other uses the same memory.
            for (const std::size_t pairs : {kMostPairs, 10U, 150U}) {
                const std::size_t before = pairs / 3;
                const std::array items{
                    BatchItem{&mesh, &volume, &function, all.first(before)},
                    BatchItem{&mesh, &volume, &function, all.subspan(before + kMostPairs - pairs, pairs - before)}};
                const Batch batch{items, view, kDefaultThreshold};
                const std::vector<std::byte> wanted = run(detector, batch, embedded);
                EXPECT_EQ(run(detector, batch, staged), wanted) << pairs << " pairs";
                copied += wanted.size();
            }
        }
    }
    EXPECT_GT(copied, kMostPairs * sizeof(PairResult));
}

/// Poses of doubles: near, far, scaled, sheared and mirrored.
std::vector<Mat4> anyDoubles(const Grid& grid, std::size_t count, std::mt19937_64& random) {
    std::vector<Mat4> poses = randomPoses(grid, count, 1.2, random);
    for (Mat4& pose : poses) {
        const double scale = std::pow(10.0, uniform(random, -12, 12));
        for (std::size_t i = 0; i < 12; ++i) {
            pose[i] *= i % 4 != 3 && random() % 3 == 0 ? scale * uniform(random, -1, 1) : 1;
        }
        pose[12 + random() % 3] *= random() % 4 == 0 ? std::pow(10.0, uniform(random, 0, 60)) : 1;
    }
    return poses;
}

/// What the passes get of pairs is the host's to the last bit when the device makes it of poses of the host's.
TEST_F(StagedTest, ManyPosesBecomeTheSamePairsOnTheDevice) {
    constexpr std::uint32_t kMany = 2 * kFewestHostPoses;
    std::mt19937_64 random(testSeed());
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = take(Mesh::upload(context(), queue(), makeFlat(0, 1, 0, 1, 0.5).view(), {.clusters = true}));
    std::vector<Detector> hosts;
    std::vector<Detector> devices;
    for (const Projection projection : {Projection::Certified, Projection::TwoView, Projection::DominantAxis}) {
        AnyDesc desc{.method = CountingMethod::Compute, .projection = projection};
        hosts.push_back(take(Detector::create(context(), desc)));
        desc.devicePoses = true;
        devices.push_back(take(Detector::create(context(), desc)));
    }
    std::size_t finite = 0;
    for (std::size_t scene = 0; scene < randomCases(300, 12); ++scene) {
        SCOPED_TRACE(scene);
        std::vector<Volume> volumes; // an oblique one and one along the axes
        Grid grid = unitGrid(6);
        for (const Mat4& turned : {randomRotation(random), identity()}) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                grid.spacing[axis] = uniform(random, 0.2, 3);
                grid.origin[axis] = uniform(random, -100, 100);
                for (std::size_t other = 0; other < 3; ++other) {
                    grid.direction[3 * axis + other] = turned[4 * other + axis];
                }
            }
            volumes.push_back(take(Volume::upload(
                context(), queue(), makeBytes(grid, [](auto...) { return 0.0; }).view(), {.bricks = true})));
        }
        const std::vector<Mat4> poses = anyDoubles(grid, kMany, random);
        // More items than the set-up takes at once, and one without poses.
        std::vector<BatchItem> items{{&mesh, &volumes[0], &function, {}}};
        for (std::size_t first = 0; first < kMany; first += 20) {
            items.push_back({&mesh, &volumes[items.size() % 2], &function,
                             std::span(poses).subspan(first, std::min<std::size_t>(20, kMany - first))});
        }
        ASSERT_GT(items.size(), VOXTACT_SETUP_ITEMS);
        const Batch batch{items, {framingCamera(grid, 16, 16), 16, 16}, kDefaultThreshold};
        for (std::size_t i = 0; i < devices.size(); ++i) {
            const ProjectionRow& row = rowOf(devices[i].impl().desc.projection);
            SCOPED_TRACE(row.name);
            Results embedded = take(Results::create(hosts[i], {.maxPairs = kMany}));
            Results staged = take(Results::create(devices[i], {.maxPairs = kMany, .staged = true}));
            const std::vector<std::byte> wanted = run(hosts[i], batch, embedded);
            EXPECT_EQ(run(devices[i], batch, staged), wanted);
            if (context().impl().floatControls.doubles()) {
                EXPECT_EQ(std::memcmp(staged.impl().staging.mapped, poses.data(), kMany * sizeof(Mat4)), 0)
                    << "the poses went another way";
            }
            const std::size_t bytes =
                kMany * (row.certified ? sizeof(shader::CertifiedPair) : row.views * sizeof(shader::PairTransform));
            const std::vector<std::byte> ofHost = raw().readBuffer(embedded.impl().transforms.get(), bytes);
            const std::vector<std::byte> ofDevice = raw().readBuffer(staged.impl().transforms.get(), bytes);
            std::vector<float> host(bytes / sizeof(float));
            std::vector<float> device(host.size());
            std::memcpy(host.data(), ofHost.data(), bytes);
            std::memcpy(device.data(), ofDevice.data(), bytes);
            for (std::size_t word = 0; word < host.size() && !HasFailure(); ++word) {
                EXPECT_TRUE(std::bit_cast<std::uint32_t>(host[word]) == std::bit_cast<std::uint32_t>(device[word]) ||
                            (std::isnan(host[word]) && std::isnan(device[word])))
                    << "word " << word << ": " << host[word] << ", " << device[word];
                finite += std::isfinite(host[word]) ? 1U : 0U;
            }
        }
    }
    EXPECT_GT(finite, 100'000U);
}

/// Of what may become a denormal, and of few poses, the host makes the pairs, whatever the detector was made for.
TEST_F(StagedTest, OtherPosesAreTheHostsAllTheSame) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(take(makeScalpel()));
    const AnyDesc desc{.method = CountingMethod::Compute, .projection = Projection::Certified};
    AnyDesc many = desc;
    many.devicePoses = true;
    const Detector host = take(Detector::create(context(), desc));
    const Detector device = take(Detector::create(context(), many));
    Results embedded = take(Results::create(device, {.maxPairs = kFewestHostPoses}));
    Results staged = take(Results::create(device, {.maxPairs = kFewestHostPoses, .staged = true}));
    std::vector<Mat4> poses = randomPoses(head.grid, kFewestHostPoses, 1, random);
    const auto expectTheHosts = [&](std::size_t count) {
        const BatchItem item{&mesh, &volume, &function, std::span(poses).first(count)};
        const Batch batch{{&item, 1}};
        EXPECT_EQ(run(device, batch, staged), run(host, batch, embedded));
        EXPECT_NE(std::memcmp(staged.impl().staging.mapped, poses.data(), sizeof(Mat4)), 0);
    };
    expectTheHosts(kFewestHostPoses - 1);
    poses[random() % poses.size()][1 + random() % 2] = 1e-320;
    expectTheHosts(kFewestHostPoses);
}

/// The conveniences take that way by themselves on a GPU, which this device says it is for once.
TEST_F(StagedTest, ConveniencesMakePairsOnAGpu) {
    if (!context().impl().floatControls.doubles()) {
        GTEST_SKIP() << "this device has no doubles";
    }
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunction function = upload(points, {0, 255});
    const Mesh mesh = take(Mesh::upload(context(), queue(), take(makeScalpel()).view(), {.clusters = true}));
    const std::vector<Mat4> poses = randomPoses(head.grid, kFewestHostPoses + 50, 1, random);
    const BatchItem item{&mesh, &volume, &function, poses};
    const Batch batch{{&item, 1}};
    for (const bool yesNo : {false, true}) {
        const AnyDesc desc{
            .method = CountingMethod::Compute, .projection = Projection::Certified, .stopAtFirst = yesNo};
        const Detector detector = take(Detector::create(context(), desc));
        EXPECT_EQ(forManyPoses(detector.impl(), poses.size()).has_value(), !context().impl().onHost);
        const std::vector<PairAnswer> wanted =
            take(take(BlockingDetector::create(context(), desc, queue())).detect(batch)).pairs;
        const bool onHost = std::exchange(context().impl().onHost, false);
        EXPECT_TRUE(passDesc(forManyPoses(detector.impl(), poses.size()).value()).devicePoses);
        EXPECT_FALSE(forManyPoses(detector.impl(), kFewestHostPoses - 1));
        BlockingDetector blocking = take(BlockingDetector::create(context(), desc, queue()));
        const std::vector<PairAnswer> found = take(blocking.detect(batch)).pairs;
        EXPECT_FALSE(blocking.detector().impl().desc.devicePoses);
        std::vector<PairAnswer> piped;
        device::PairPipeline pipeline = take(device::PairPipeline::create(
            gpu().device, context(), blocking.detector(), {.frames = 2, .pairsPerSubmission = kFewestHostPoses}));
        take(pipeline.run(batch, {.pair = [&](const device::TimedAnswer& timed) { piped.push_back(timed.answer); }}));
        context().impl().onHost = onHost;
        ASSERT_EQ(found.size(), wanted.size());
        ASSERT_EQ(piped.size(), wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            EXPECT_EQ(found[i].hit, wanted[i].hit) << i;
            EXPECT_EQ(found[i].count, wanted[i].count) << i;
            EXPECT_EQ(piped[i].possible, wanted[i].possible) << i;
            EXPECT_EQ(piped[i].count, wanted[i].count) << i;
        }
    }
}

/// What staged pairs take is more than all else of as many: where only they do not fit, a batch is answered without.
TEST_F(StagedTest, ConveniencesDoWithoutWhereThereIsNoRoom) {
    constexpr std::uint32_t kPairs = 81920;
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunction function = upload(points, {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const std::vector<Mat4> poses(kPairs, identity());
    const BatchItem item{&mesh, &volume, &function, poses};
    const Batch batch{{&item, 1}};
    const AnyDesc desc{.method = CountingMethod::Compute, .projection = Projection::Certified, .stopAtFirst = true};
    const ResultsDesc staged{.maxPairs = kPairs, .staged = true};
    const Detector detector = take(Detector::create(context(), desc));
    const VkDeviceSize most = std::exchange(context().impl().maxAllocation, VkDeviceSize{kPairs} * 247);
    const Result<Results> refused = Results::create(detector, staged);
    BlockingDetector blocking = take(BlockingDetector::create(context(), desc, queue()));
    const Result<BatchAnswer> answer = blocking.detect(batch);
    Result<device::PairPipeline> pipeline =
        device::PairPipeline::create(gpu().device, context(), detector, {.frames = 2, .pairsPerSubmission = kPairs});
    context().impl().maxAllocation = most;
    ASSERT_FALSE(refused.ok());
    ASSERT_TRUE(answer.ok()) << answer.error().text;
    EXPECT_EQ(answer.value().pairs.size(), kPairs);
    ASSERT_TRUE(pipeline.ok()) << pipeline.error().text;
    std::uint32_t piped = 0;
    take(pipeline.value().run(batch, {.pair = [&](const device::TimedAnswer& timed) {
                                  piped += timed.answer.hit == answer.value().pairs[0].hit ? 1U : 0U;
                              }}));
    EXPECT_EQ(piped, kPairs);
}

/// Poses on the device between those of the host, which are copied to both sides of them.
TEST_F(StagedTest, BesidePosesOnTheDevice) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(take(makeScalpel()));
    const View view{framingCamera(head.grid, 64, 64), 64, 64};
    std::vector<Mat4> poses = randomPoses(head.grid, 70, 1, random);
    std::ranges::transform(poses, poses.begin(), floatPose);
    const RawVulkan::HostBuffer buffer =
        raw().makeBuffer(poses.size() * sizeof(std::array<float, 16>), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    auto* to = static_cast<float*>(buffer.mapped);
    for (const Mat4& pose : poses) {
        to = std::ranges::transform(pose, to, [](double element) { return static_cast<float>(element); }).out;
    }
    const PoseBuffer onDevice =
        take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer, .count = static_cast<std::uint32_t>(poses.size())}));
    const std::vector<Mat4> more = randomPoses(head.grid, kFewestHostPoses, 1, random);
    const BatchItem host{&mesh, &volume, &function, poses};
    const BatchItem many{&mesh, &volume, &function, more};
    BatchItem device{.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &onDevice};
    const std::array mixed{host, device, host};
    const std::array plain{host, host, host};
    const Detector detector =
        take(Detector::raster(context(), {.method = CountingMethod::Compute, .devicePoses = true}));
    Results staged = take(Results::create(detector, {.maxPairs = 600, .staged = true}));
    Results embedded = take(Results::create(detector, {.maxPairs = 600}));
    EXPECT_EQ(run(detector, {mixed, view, kDefaultThreshold}, staged),
              run(detector, {plain, view, kDefaultThreshold}, embedded));
    const std::array mixedMany{device, many, device, host};
    const std::array plainMany{host, many, host, host};
    EXPECT_EQ(run(detector, {mixedMany, view, kDefaultThreshold}, staged),
              run(detector, {plainMany, view, kDefaultThreshold}, embedded));
}

} // namespace
} // namespace voxtact::test
