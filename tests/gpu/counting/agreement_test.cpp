// SPDX-License-Identifier: MIT
// The counting methods count the same thing, and so do the two ways to treat the boundary.
#include "gpu_fixture.h"
#include "support/scenes.h"

#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <numeric>

namespace voxtact::test {
namespace {

constexpr std::size_t kPoses = 1000;

class AgreementTest : public GpuTest {
  protected:
    std::vector<std::uint64_t> counts(const AnyDesc& desc, const BatchItem& item, const View& view, double threshold) {
        BlockingDetector one = detector(desc);
        const BatchAnswer answer = take(one.detect({std::span(&item, 1), view, threshold}));
        std::vector<std::uint64_t> out;
        for (const PairAnswer& pair : answer.pairs) {
            EXPECT_EQ(pair.pair, out.size());
            EXPECT_EQ(pair.pose, out.size());
            EXPECT_EQ(pair.item, 0U);
            out.push_back(pair.count);
        }
        return out;
    }

    /// query = atomic on every pose, query-any agrees, and the poses are worth something: some hit, some do not.
    void expectAgreement(const VolumeData& data, std::span<const ControlPoint> points, const ValueRange& domain) {
        std::mt19937_64 random(testSeed());
        const Volume volume = upload(data);
        const TransferFunction function = upload(points, domain);
        const Mesh scalpel = upload(take(makeScalpel()));
        const std::vector<Mat4> poses = randomPoses(data.grid, kPoses, 1.6, random);
        const BatchItem item{&scalpel, &volume, &function, poses};
        const View view{framingCamera(data.grid, 512, 512), 512, 512};
        const auto query = counts({.method = CountingMethod::Query}, item, view, kDefaultThreshold);
        const auto atomic = counts({.method = CountingMethod::Atomic}, item, view, kDefaultThreshold);
        const auto any = counts({.method = CountingMethod::QueryAny}, item, view, kDefaultThreshold);
        EXPECT_EQ(query, atomic);
        EXPECT_EQ(query, counts({.method = CountingMethod::Subgroup}, item, view, kDefaultThreshold));
        std::size_t hits = 0;
        for (std::size_t i = 0; i < poses.size(); ++i) {
            EXPECT_EQ(query[i] > 0, any[i] > 0) << "pose " << i;
            hits += query[i] > 0 ? 1U : 0U;
        }
        EXPECT_GT(hits, kPoses / 10);
        EXPECT_LT(hits, kPoses);
        RecordProperty("hits", static_cast<int>(hits));
    }
};

TEST_F(AgreementTest, QueryIsAtomicOnTheRealHead) {
    const Result<VolumeData> head = io::readVolume(headPath());
    ASSERT_TRUE(head.ok()) << head.error().text;
    constexpr ControlPoint kSkin[] = {{40, 0}, {80, 1}};
    expectAgreement(*head, kSkin, {0, 255});
}

TEST_F(AgreementTest, QueriesCountRightInLongSubmissions) {
    // llvmpipe counted one or two pairs of a long submission a hundred thousand too many.
    const VolumeData head = take(io::readVolume(headPath()));
    std::mt19937_64 random(testSeed());
    constexpr ControlPoint kSkin[] = {{40, 0}, {80, 1}};
    const Volume volume = upload(head);
    const TransferFunction function = upload(kSkin, {0, 255});
    const Mesh scalpel = upload(take(makeScalpel()));
    const std::vector<Mat4> poses = randomPoses(head.grid, 3 * kPoses, 1.0, random);
    const BatchItem item{&scalpel, &volume, &function, poses};
    const View view{framingCamera(head.grid, 512, 512), 512, 512};
    const AnyDesc query{.method = CountingMethod::Query, .boundary = Boundary::Range};
    const AnyDesc atomic{.method = CountingMethod::Atomic, .boundary = Boundary::Range};
    const std::vector<std::uint64_t> expected = counts(atomic, item, view, kDefaultThreshold);
    for (int turn = 0; turn < 4; ++turn) {
        EXPECT_EQ(counts(query, item, view, kDefaultThreshold), expected) << "turn " << turn;
    }
}

TEST_F(AgreementTest, QueryIsAtomicOnASyntheticCt) {
    const VolumeData ct = take(makeBuiltinVolume("ct:64"));
    constexpr ControlPoint kBone[] = {{200, 0}, {400, 1}};
    expectAgreement(ct, kBone, {-1024, 3071});
}

TEST_F(AgreementTest, QueryIsAtomicOnNoise) {
    const VolumeData noise = take(makeBuiltinVolume("noise:48"));
    constexpr ControlPoint kPeak[] = {{1900, 0}, {2000, 1}, {2100, 0}};
    expectAgreement(noise, kPeak, {0, 4095});
}

TEST_F(AgreementTest, ClampIsTheRangeTestWhereTheBoundaryIsTransparent) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:64"));
    const Volume volume = upload(head);
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh scalpel = upload(take(makeScalpel()));
    const std::vector<Mat4> poses = randomPoses(head.grid, kPoses, 2.0, random);
    const BatchItem item{&scalpel, &volume, &function, poses};
    const View view{framingCamera(head.grid, 256, 256), 256, 256};
    const auto range =
        counts({.method = CountingMethod::Query, .boundary = Boundary::Range}, item, view, kDefaultThreshold);
    EXPECT_EQ(range,
              counts({.method = CountingMethod::Query, .boundary = Boundary::Clamp}, item, view, kDefaultThreshold));
    EXPECT_EQ(range,
              counts({.method = CountingMethod::Atomic, .boundary = Boundary::Clamp}, item, view, kDefaultThreshold));
    EXPECT_EQ(range, counts({.method = CountingMethod::Query}, item, view, kDefaultThreshold));
    EXPECT_GT(std::accumulate(range.begin(), range.end(), std::uint64_t{0}), 0U);
}

TEST_F(AgreementTest, AutoClampsExactlyWhereItIsProven) {
    const Mesh plane = upload(makeFlat(-0.5, 1.5, -0.5, 1.5, 0.5));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const auto inner = [](double shell) {
        return makeBytes(unitGrid(8), [=](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const bool boundary = x % 7 == 0 || y % 7 == 0 || z % 7 == 0;
            return boundary ? shell : 255.0;
        });
    };
    const Volume dark = upload(inner(0));
    const Volume bright = upload(inner(200));
    const Mat4 pose = identity();
    const BlockingDetector automatic = detector({});
    const auto chosen = [&](const Volume& volume, double threshold) {
        return automatic.detector().boundaryFor({&plane, &volume, &function, std::span(&pose, 1)}, threshold);
    };
    EXPECT_EQ(chosen(dark, 0.1), Boundary::Clamp);
    EXPECT_EQ(chosen(bright, 0.1), Boundary::Range);
    EXPECT_EQ(chosen(bright, 0.9), Boundary::Clamp);
    EXPECT_EQ(chosen(dark, 0.0), Boundary::Range);
    // With an opaque boundary the two variants do differ, so the choice matters.
    const BatchItem item{&plane, &bright, &function, std::span(&pose, 1)};
    const View view = flatView(-0.5, 1.5, 64, 64);
    EXPECT_EQ(detectOne({.boundary = Boundary::Range}, item, view).count, 32U * 32U);
    EXPECT_EQ(detectOne({.boundary = Boundary::Clamp}, item, view).count, 64U * 64U);
    EXPECT_EQ(detectOne({.boundary = Boundary::Auto}, item, view).count, 32U * 32U);
}

TEST_F(AgreementTest, APeakBetweenTransparentBoundaryVoxelsIsNotClamped) {
    // Both boundary values are transparent, but what is interpolated between them is not.
    const Mesh plane = upload(makeFlat(-0.5, 1.5, -0.5, 1.5, 0.5));
    const Volume stripes = upload(
        makeBytes(unitGrid(8), [](std::uint32_t, std::uint32_t y, std::uint32_t) { return y < 4 ? 0.0 : 200.0; }));
    constexpr ControlPoint kPeak[] = {{80, 0}, {100, 1}, {120, 0}};
    const TransferFunction function = upload(kPeak, {0, 255});
    const Mat4 pose = identity();
    const BatchItem item{&plane, &stripes, &function, std::span(&pose, 1)};
    EXPECT_EQ(detector({}).detector().boundaryFor(item, 0.5), Boundary::Range);
}

TEST_F(AgreementTest, ItemsOfOneBatchKeepTheirNames) {
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Mesh cube = upload(makeCube(0.25, 0.75));
    const Volume full = upload(makeBytes(unitGrid(8), [](auto...) { return 255.0; }));
    const Volume half = upload(makeBytes(unitGrid(8), [](std::uint32_t x, auto...) { return x < 4 ? 255.0 : 0.0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mat4 poses[] = {identity(), translation({0, 0, 5}), translation({0, 0, 0.125})};
    const BatchItem items[] = {{&plane, &full, &function, std::span(poses, 2)},
                               {&cube, &half, &function, std::span(poses, 3)},
                               {&cube, &full, &function, {}},
                               {&cube, &full, &function, std::span(poses + 1, 2)}};
    constexpr std::uint64_t kExpected[] = {4096, 0, 1024, 0, 1024, 0, 2048};
    constexpr std::uint32_t kItem[] = {0, 0, 1, 1, 1, 3, 3};
    constexpr std::uint32_t kPose[] = {0, 1, 0, 1, 2, 0, 1};
    for (const MethodSupport& support : context().methods()) {
        const CountingMethod method = support.method;
        if (method == CountingMethod::QueryAny) {
            continue;
        }
        BlockingDetector one = detector({.method = method});
        const BatchAnswer answer = take(one.detect({items, flatView(0, 1, 64, 64), 0.5}));
        ASSERT_EQ(answer.pairs.size(), std::size(kExpected));
        for (std::size_t i = 0; i < answer.pairs.size(); ++i) {
            EXPECT_EQ(answer.pairs[i].count, kExpected[i]) << toString(method) << " pair " << i;
            EXPECT_EQ(answer.pairs[i].pair, i);
            EXPECT_EQ(answer.pairs[i].item, kItem[i]);
            EXPECT_EQ(answer.pairs[i].pose, kPose[i]);
            EXPECT_EQ(answer.pairs[i].method, method);
        }
    }
}

} // namespace
} // namespace voxtact::test
