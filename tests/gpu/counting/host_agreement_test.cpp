// SPDX-License-Identifier: MIT
// The device against the host: compute against the host engine bit for bit, the rasteriser against the oracle fragment
// by fragment.
#include "gpu_fixture.h"

#include "bench/engines/localize.h"
#include "core/method/method_table.h"
#include "cpu/scenes/random_scene.h"
#include "few_kinds.h"
#include "oracle/oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <iterator>
#include <map>

namespace voxtact::test {
namespace {

constexpr std::size_t kScenes = 700;
constexpr std::size_t kPosesOfAScene = 15; // 10,500 poses in all, in the long form

/// A sampler may take the difference of two voxels, which must not overflow.
constexpr double kWidestDomain = 1e37;

/// A RandomScene on the device and on the host engine.
struct BothSides {
    Volume volume;
    TransferFunction function;
    Mesh mesh;
    cpu::Volume hostVolume;
    cpu::TransferFunction hostFunction;
    cpu::Mesh hostMesh;

    BothSides(const Context& context, const QueueAccess& queue, const RandomScene& scene)
        : volume(take(Volume::upload(context, queue, scene.volume.view()))),
          function(take(TransferFunction::upload(context, queue, scene.transferFunction()))),
          mesh(take(Mesh::upload(context, queue, scene.mesh.view()))),
          hostVolume(take(cpu::Volume::create(scene.volume.view()))),
          hostFunction(take(cpu::TransferFunction::create(scene.transferFunction()))),
          hostMesh(take(cpu::Mesh::create(scene.mesh.view()))) {}
};

/// A scalpel at random poses in the MR head of Debian's mricron-data.
RandomScene realHead(std::size_t poses, double grow, std::mt19937_64& random) {
    RandomScene scene;
    scene.volume = take(io::readVolume(headPath()));
    scene.points = {{40, 0}, {80, 1}};
    scene.domain = {0, 255};
    scene.mesh = take(makeScalpel());
    scene.view = {framingCamera(scene.volume.grid, 512, 512), 512, 512};
    scene.poses = randomPoses(scene.volume.grid, poses, grow, random);
    return scene;
}

std::vector<std::uint64_t> countsOf(const BatchAnswer& answer) {
    std::vector<std::uint64_t> counts;
    std::ranges::transform(answer.pairs, std::back_inserter(counts), &PairAnswer::count);
    return counts;
}

class HostAgreementTest : public GpuTest {
  protected:
    /// The detectors of one way to treat the boundary, made once: a compute pipeline takes its time on lavapipe.
    struct Detectors {
        std::vector<BlockingDetector> raster; ///< of the methods that must count the same
        BlockingDetector compute;
        cpu::Detector host;
    };

    [[nodiscard]] Detectors makeDetectors(Boundary boundary, Projection projection = Projection::View,
                                          std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel) const {
        AnyDesc desc{.projection = projection, .boundary = boundary, .samplesPerVoxel = samplesPerVoxel};
        std::vector<BlockingDetector> raster;
        for (const CountingMethod method : methodsThatCount(Coverage::Rasteriser)) {
            desc.method = method;
            raster.push_back(detector(desc));
        }
        desc.method = CountingMethod::Compute;
        desc.filter = Filter::Exact;
        return {std::move(raster), detector(desc),
                take(cpu::Detector::create(
                    {.boundary = boundary, .projection = projection, .samplesPerVoxel = samplesPerVoxel}))};
    }

    /// Random scenes by detectors for both ways to treat the boundary.
    void expectAgreementOnScenes(Detectors range, Detectors clamp, std::size_t scenes) {
        std::mt19937_64 random(testSeed());
        std::uint64_t survivors = 0;
        const std::size_t least = scenes * kPosesOfAScene;
        FewKindsOfImage few;
        for (std::size_t i = 0; (i < scenes || survivors <= least) && i < 10 * scenes && !HasFailure(); ++i) {
            const RandomScene scene = few.next([&] { return makeRandomScene(random, kPosesOfAScene); });
            survivors += expectAgreement(scene.rangeTest ? range : clamp, scene, "scene " + std::to_string(i));
        }
        EXPECT_GT(survivors, least);
    }

    /// All of them on every pose. Returns the survivors in all.
    std::uint64_t expectAgreement(Detectors& detectors, const RandomScene& scene, const std::string& which) {
        const BothSides sides(context(), queue(), scene);
        const BatchItem item{&sides.mesh, &sides.volume, &sides.function, scene.poses};
        const Batch batch{std::span(&item, 1), scene.view, scene.threshold};
        const cpu::BatchItem hostItem{&sides.hostMesh, &sides.hostVolume, &sides.hostFunction, scene.poses};
        const auto host = countsOf(take(detectors.host.detect({std::span(&hostItem, 1), scene.view, scene.threshold})));
        EXPECT_EQ(countsOf(take(detectors.compute.detect(batch))), host) << which << ": compute against cpu";
        const auto query = countsOf(take(detectors.raster[0].detect(batch)));
        for (BlockingDetector& other : std::span(detectors.raster).subspan(1)) {
            const BatchAnswer answer = take(other.detect(batch));
            EXPECT_EQ(countsOf(answer), query) << which << ": " << toString(answer.pairs[0].method) << " against query";
        }
        std::uint64_t survivors = 0;
        for (const std::uint64_t count : host) {
            survivors += count;
        }
        return survivors;
    }

    /// Traces a pair and holds each fragment that differs from the oracle's against its doubts.
    void expectEveryDifferenceHasAReason(FragmentTrace& trace, const RandomScene& scene, std::size_t pose,
                                         const std::string& which) {
        const BothSides sides(context(), queue(), scene);
        const BatchItem item{&sides.mesh, &sides.volume, &sides.function, std::span(&scene.poses[pose], 1)};
        std::vector<oracle::OracleFragment> device;
        for (const shader::TracedFragment& fragment :
             take(trace.survivors({std::span(&item, 1), scene.view, scene.threshold}))) {
            device.push_back({fragment.triangle, fragment.x, fragment.y});
        }
        std::ranges::sort(device);
        const oracle::OraclePair pair{scene.mesh.view(), scene.volume.view(), scene.transferFunction(),
                                      scene.view,        scene.poses[pose],   scene.threshold};
        const std::vector<oracle::OracleFragment> oracle = take(oracle::oracleSurvivors(pair));
        // What a clipped triangle covers twice differs too: the second of two equal fragments has no partner.
        std::vector<oracle::OracleFragment> differing;
        std::ranges::set_symmetric_difference(device, oracle, std::back_inserter(differing));
        oracle::Tolerance tolerance;
        tolerance.value = scene.volume.type == ScalarType::UInt8 ? oracle::kEightBitFilterError : 0;
        const std::vector<oracle::Evidence> evidence = take(oracle::oracleEvidence(pair, differing, tolerance));
        for (std::size_t i = 0; i < differing.size(); ++i) {
            ++reasons_[evidence[i].doubt];
            const bool oracles = std::ranges::binary_search(oracle, differing[i]);
            EXPECT_NE(evidence[i].doubt, oracle::Doubt::None)
                << which << ": triangle " << differing[i].triangle << " at (" << differing[i].x << ", "
                << differing[i].y << "), only " << (oracles ? "the oracle's" : "the device's") << "; edge "
                << evidence[i].edgeDistance << " px, domain " << evidence[i].domainDistance << ", opacity "
                << evidence[i].opacity << " in [" << evidence[i].opacityLow << ", " << evidence[i].opacityHigh
                << "], threshold " << scene.threshold;
        }
        compared_ += oracle.size();
    }

    void report() const {
        std::cout << "survivors of the oracle: " << compared_;
        for (const auto& [doubt, count] : reasons_) {
            std::cout << ", differ by " << oracle::toString(doubt) << ": " << count;
        }
        std::cout << "\n";
    }

    std::map<oracle::Doubt, std::uint64_t> reasons_;
    std::uint64_t compared_ = 0;
};

/// Half of the scenes: two tests that can run side by side.
class RandomPosesTest : public HostAgreementTest {
  protected:
    void run() {
        expectAgreementOnScenes(makeDetectors(Boundary::Range), makeDetectors(Boundary::Clamp),
                                randomCases(kScenes / 2, 35));
    }
};

TEST_F(RandomPosesTest, AllMethodsOnTheFirstHalf) {
    run();
}

TEST_F(RandomPosesTest, AllMethodsOnTheSecondHalf) {
    run();
}

TEST_F(HostAgreementTest, ComputeOfTrianglesWithAFarCorner) {
    std::mt19937_64 random(testSeed());
    std::size_t hits = 0;
    const std::size_t scenes = randomCases(3000, 100);
    FewKindsOfImage few;
    for (const Projection projection : {Projection::View, Projection::TwoView, Projection::DominantAxis}) {
        for (const Boundary boundary : {Boundary::Range, Boundary::Clamp}) {
            SCOPED_TRACE(std::string(toString(projection)) + ", " + toString(boundary));
            BlockingDetector compute = detector({.method = CountingMethod::Compute,
                                                 .projection = projection,
                                                 .filter = Filter::Exact,
                                                 .boundary = boundary});
            cpu::Detector host = take(cpu::Detector::create({.boundary = boundary, .projection = projection}));
            cpu::Detector first =
                take(cpu::Detector::create({.boundary = boundary, .stopAtFirst = true, .projection = projection}));
            cpu::Detector listing = take(cpu::Detector::create(
                {.boundary = boundary, .projection = projection, .outputs = {.triangles = true}}));
            for (std::size_t i = 0; i < scenes / 6 && !HasFailure(); ++i) {
                const RandomScene scene = few.next([&] { return makeFarCornerScene(random, 2); });
                const BothSides sides(context(), queue(), scene);
                const BatchItem item{&sides.mesh, &sides.volume, &sides.function, scene.poses};
                const cpu::BatchItem hostItem{&sides.hostMesh, &sides.hostVolume, &sides.hostFunction, scene.poses};
                const cpu::Batch onHost{std::span(&hostItem, 1), scene.view, scene.threshold};
                const auto counts = countsOf(take(host.detect(onHost)));
                EXPECT_EQ(countsOf(take(compute.detect({std::span(&item, 1), scene.view, scene.threshold}))), counts)
                    << "scene " << i;
                EXPECT_EQ(countsOf(take(listing.detect(onHost))), counts) << "scene " << i;
                const auto yesNo = countsOf(take(first.detect(onHost)));
                for (std::size_t pose = 0; pose < counts.size(); ++pose) {
                    EXPECT_EQ(yesNo[pose], counts[pose] > 0 ? 1U : 0U) << "scene " << i;
                    hits += yesNo[pose];
                }
            }
        }
    }
    EXPECT_GT(hits, scenes / 50);
}

TEST_F(HostAgreementTest, AllMethodsByTwoView) {
    expectAgreementOnScenes(makeDetectors(Boundary::Range, Projection::TwoView),
                            makeDetectors(Boundary::Clamp, Projection::TwoView), randomCases(kScenes / 14, 10));
}

TEST_F(HostAgreementTest, AllMethodsByDominantAxis) {
    expectAgreementOnScenes(makeDetectors(Boundary::Range, Projection::DominantAxis),
                            makeDetectors(Boundary::Clamp, Projection::DominantAxis), randomCases(kScenes / 14, 10));
}

TEST_F(HostAgreementTest, AllMethodsByDominantAxisWithMoreSamples) {
    expectAgreementOnScenes(makeDetectors(Boundary::Range, Projection::DominantAxis, 3),
                            makeDetectors(Boundary::Clamp, Projection::DominantAxis, 3), randomCases(kScenes / 28, 8));
}

TEST_F(HostAgreementTest, AllMethodsOnTheRealHead) {
    std::mt19937_64 random(testSeed());
    const RandomScene scene = realHead(1000, 1.4, random);
    Detectors detectors = makeDetectors(Boundary::Range);
    EXPECT_GT(expectAgreement(detectors, scene, "the head"), 100000U);
}

TEST_F(HostAgreementTest, EveryDifferingFragmentHasAReason) {
    std::mt19937_64 random(testSeed());
    FragmentTrace trace = take(FragmentTrace::create(context(), Filter::Hardware, queue()));
    FewKindsOfImage few;
    for (std::size_t i = 0; (i < randomCases(kScenes, 2) || compared_ <= 10000) && i < kScenes && !HasFailure(); ++i) {
        const RandomScene scene = few.next([&] { return makeRandomScene(random, 2); });
        if (scene.domain.hi - scene.domain.lo > kWidestDomain) {
            continue;
        }
        expectEveryDifferenceHasAReason(trace, scene, 0, "scene " + std::to_string(i));
    }
    report();
    EXPECT_GT(compared_, 10000U);
}

TEST_F(HostAgreementTest, EveryDifferingFragmentOfASliverHasAReason) {
    std::mt19937_64 random(testSeed());
    FragmentTrace trace = take(FragmentTrace::create(context(), Filter::Hardware, queue()));
    FewKindsOfImage few;
    for (std::size_t i = 0; (i < randomCases(kScenes / 7, 2) || compared_ <= 10000) && i < kScenes && !HasFailure();
         ++i) {
        RandomScene scene = few.next([&] { return makeRandomScene(random, 2); });
        if (scene.domain.hi - scene.domain.lo > kWidestDomain) {
            continue;
        }
        // One row of pixels: most triangles are thinner than a sub-pixel.
        scene.view.width = chance(random, 0.5) ? 4096 : 16384;
        scene.view.height = 1;
        expectEveryDifferenceHasAReason(trace, scene, 0, "scene " + std::to_string(i));
    }
    report();
    EXPECT_GT(compared_, 10000U);
}

TEST_F(HostAgreementTest, EveryDifferingFragmentOnTheRealHeadHasAReason) {
    std::mt19937_64 random(testSeed());
    const RandomScene scene = realHead(25, 1.0, random);
    FragmentTrace trace = take(FragmentTrace::create(context(), Filter::Hardware, queue()));
    for (std::size_t pose = 0; pose < scene.poses.size(); ++pose) {
        expectEveryDifferenceHasAReason(trace, scene, pose, "pose " + std::to_string(pose));
    }
    report();
    EXPECT_GT(compared_, 10000U);
}

} // namespace
} // namespace voxtact::test
