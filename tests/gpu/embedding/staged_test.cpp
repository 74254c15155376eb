// SPDX-License-Identifier: MIT
// ResultsDesc::staged: what a batch is recorded with goes through mapped memory, and no answer depends on it.
#include "core/method/method_table.h"
#include "detect/results/results_impl.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

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
            const Detector detector = take(Detector::create(context(), {.method = method, .projection = projection}));
            Results embedded = take(Results::create(context(), {.maxPairs = kMostPairs}));
            Results staged = take(Results::create(context(), {.maxPairs = kMostPairs, .staged = true}));
            EXPECT_EQ(embedded.impl().staging.size, 0U);
            EXPECT_GT(staged.impl().staging.size, 0U);
            // Few are in the command buffer all the same; one batch after the other uses the same memory.
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
    const BatchItem host{&mesh, &volume, &function, poses};
    BatchItem device{.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &onDevice};
    const std::array mixed{host, device, host};
    const std::array plain{host, host, host};
    const Detector detector =
        take(Detector::create(context(), {.method = CountingMethod::Compute, .devicePoses = true}));
    Results staged = take(Results::create(context(), {.maxPairs = 210, .staged = true}));
    Results embedded = take(Results::create(context(), {.maxPairs = 210}));
    EXPECT_EQ(run(detector, {mixed, view, kDefaultThreshold}, staged),
              run(detector, {plain, view, kDefaultThreshold}, embedded));
}

} // namespace
} // namespace voxtact::test
