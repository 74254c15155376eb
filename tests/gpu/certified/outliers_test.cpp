// SPDX-License-Identifier: MIT
// Volumes of which little is certain: with voxels that are far from all others, as what stands for no data may be, and
// of denormals.
#include "certified/counted_fixture.h"
#include "certified/sides.h"
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/oracle_scenes.h"
#include "voxtact/cpu.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace voxtact::test {
namespace {

class MarginOutliersTest : public CertifiedTest {};
class ClearanceOutliersTest : public CertifiedTest {};

/// One of each 8^3 voxels costs certainty about itself alone.
TEST_F(MarginOutliersTest, DoNotSpoilTheirBricks) {
    const std::uint64_t seed = testSeed();
    const DetectorDesc desc{
        .method = CountingMethod::Compute, .projection = Projection::Conservative, .stopAtFirst = true, .margin = 0.01};
    BlockingDetector device = take(BlockingDetector::create(context(), desc, queue()));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    std::uint64_t hits = 0;
    std::uint64_t noes = 0;
    for (std::uint64_t number = 0; number < randomCases(300, 5); ++number) {
        // In every other case only an outlier can be opaque.
        const auto caseOf = [&](double outlier, bool near) {
            CertifiedCase of = outlierCase(seed + number, outlier, near);
            of.scene.points = number % 2 == 0 ? of.scene.points : std::vector<ControlPoint>{{205, 0}, {206, 1}};
            return of;
        };
        const auto ask = [&](const CertifiedCase& of) {
            return askPair(device, context(), queue(), of.scene.pair(), number % 4 < 2).pairs.at(0);
        };
        const PairAnswer plain = ask(caseOf(10, false));
        hits += plain.hit ? 1U : 0U;
        noes += plain.hit || plain.possible ? 0U : 1U;
        for (const double outlier : {-1e6, 1e7, -1e20, -3.4e38, 3.4e38}) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(number) + ", " +
                         std::to_string(outlier));
            const PairAnswer found = ask(caseOf(outlier, false));
            EXPECT_EQ(found.hit, plain.hit);
            EXPECT_EQ(found.possible, plain.possible);
            const CertifiedCase near = caseOf(outlier, true);
            const oracle::OraclePair pair = near.scene.pair();
            const HostSide host(pair.volume, pair.transferFunction, pair.mesh);
            const cpu::BatchItem item = host.item({&pair.world_from_object, 1});
            expectNoContradiction(ask(near),
                                  take(meter.within({{&item, 1}, {}, pair.threshold}, desc.margin)).pairs.at(0));
        }
    }
    EXPECT_GT(hits, 3U);
    EXPECT_GT(noes, 0U);
}

/// A ball in a cube of so many voxels of 1 mm, and four poses of a small mesh in a corner of that, 30 mm away.
struct BallScene {
    static constexpr std::uint32_t kSide = 48;

    double scale; ///< of the values
    VolumeData image;
    std::array<ControlPoint, 4> points;
    MeshData mesh;
    std::vector<Mat4> poses;

    BallScene(double valueScale, std::optional<float> outlier) : scale(valueScale) {
        Grid grid;
        grid.size = {kSide, kSide, kSide};
        image = makeVolume<float>(grid, ScalarType::Float32, [&](auto... place) {
            const double middle = kSide / 2.0;
            const double radius = std::sqrt((((place - middle) * (place - middle)) + ...));
            const double value = std::clamp(kSide / 6.0 - radius + 0.5, 0.0, 1.0) * scale;
            return outlier && ((place % 8 == 3) && ...) ? *outlier : static_cast<float>(value);
        });
        points = {{{0, 0}, {0.45 * scale, 0}, {0.55 * scale, 1}, {scale, 1}}};
        const std::array<Vec3, 4> corners{{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {0, 0, 6}}};
        for (std::size_t left = 0; left < 4; ++left) {
            addTriangle(mesh, corners[left], corners[(left + 1) % 4], corners[(left + 2) % 4]);
        }
        for (int i = 0; i < 4; ++i) {
            poses.push_back(translation({0.05 * kSide + 2 * i, 0.1 * kSide, 0.1 * kSide}));
        }
    }
};

/// What rounding leaves open ends the search, as it ends the host's: nothing is certain near it, and to look at all of
/// the volume for what is would take time without end.
TEST_F(ClearanceOutliersTest, EndWhatTheyLeaveOpen) {
    DetectorDesc desc{.method = CountingMethod::Compute, .projection = Projection::Conservative, .stopAtFirst = true};
    desc.clearance = ClearanceSearch{};
    desc.counters = true;
    const Detector device = take(Detector::create(context(), desc));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    struct Case {
        const char* name;
        double scale;
        std::optional<float> outlier;
    };
    for (const Case& of :
         {Case{"plain", 1, {}}, Case{"outliers", 1, -1e30F}, Case{"tiny", 1e-32, {}}, Case{"denormals", 1e-44, {}}}) {
        SCOPED_TRACE(of.name);
        const BallScene scene(of.scale, of.outlier);
        const TransferFunctionDesc table{scene.points, {0, scene.scale}, kDefaultTableSize};
        const Sides sides(context(), queue(), scene.image.view(), table, scene.mesh.view(), true);
        const BatchItem item = sides.item(scene.poses);
        const cpu::BatchItem hostItem = sides.hostItem(scene.poses);
        const Answered found = detect(device, {{&item, 1}, {}, 0.5}, 4, 2048);
        const ClearanceAnswer host = take(meter.measure({{&hostItem, 1}, {}, 0.5}));
        for (std::size_t i = 0; i < scene.poses.size(); ++i) {
            const PairClearance& pair = found.clearances.at(i);
            EXPECT_LE(pair.bounds.lo, host.pairs[i].bounds.hi);
            EXPECT_LE(host.pairs[i].bounds.lo, pair.bounds.hi);
            EXPECT_EQ(pair.end, of.scale < 1 || of.outlier ? ClearanceEnd::Rounding : ClearanceEnd::Closed);
        }
        // Some hundred for each cell of the mesh's surroundings.
        EXPECT_LT(found.counters.cellsSeen + found.counters.cellsLeft, 1'500'000U);
    }
}

/// A point is found where something is opaque between two values, of cells in bricks with an outlier, too.
TEST_F(ClearanceOutliersTest, HaveOpaqueClosestPoints) {
    DetectorDesc desc{.method = CountingMethod::Compute, .projection = Projection::Conservative, .stopAtFirst = true};
    desc.clearance = ClearanceSearch{.tolerance = 0.5}; // proven between points that are far apart
    desc.closest = true;
    const Detector device = take(Detector::create(context(), desc));
    const BallScene scene(1, -1e30F);
    const std::array peak{ControlPoint{0, 0}, ControlPoint{0.4, 0}, ControlPoint{0.5, 1}, ControlPoint{0.6, 0},
                          ControlPoint{1, 0}};
    const TransferFunctionDesc table{peak, {0, 1}, 257}; // the top of the peak is an entry
    constexpr double kThreshold = 0.97;                  // hardly a point is tried that is opaque by itself
    const Sides sides(context(), queue(), scene.image.view(), table, scene.mesh.view(), true);
    const BatchItem item = sides.item(scene.poses);
    const Answered found = detect(device, {{&item, 1}, {}, kThreshold}, 4, 2048);
    const Mat4 index_from_world = inverse(worldFromIndex(scene.image.grid)).value();
    const std::span<const float> voxels{reinterpret_cast<const float*>(scene.image.voxels.data()),
                                        std::size_t{BallScene::kSide} * BallScene::kSide * BallScene::kSide};
    for (const PairClearance& pair : found.clearances) {
        ASSERT_TRUE(pair.closest.has_value());
        const Vec3 at = transformPoint(index_from_world, pair.closest->volume);
        double value = 0;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            std::size_t place = 0;
            double weight = 1;
            for (std::size_t axis = 3; axis-- > 0;) {
                const auto low = static_cast<std::size_t>(std::floor(at[axis]));
                const double part = at[axis] - std::floor(at[axis]);
                const std::size_t upper = corner >> axis & 1U;
                weight *= upper == 0 ? 1 - part : part;
                place = place * BallScene::kSide + low + upper;
            }
            value += weight == 0 ? 0 : weight * voxels[place];
        }
        EXPECT_NEAR(value, 0.5, 0.0031);
    }
}

} // namespace
} // namespace voxtact::test
