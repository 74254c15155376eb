// SPDX-License-Identifier: MIT
// What the engine is made of: opaque sets, occupancy, row spans, clusters.
#include "core/geometry/clusters.h"
#include "core/geometry/pair_transform.h"
#include "core/transfer/opaque_ranges.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "host/count/occupancy.h"
#include "host/count/row_spans.h"
#include "host/count/scalar_sample.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

bool inIntervals(std::span<const cpu::Interval> intervals, float value) {
    return std::any_of(intervals.begin(), intervals.end(),
                       [&](const cpu::Interval& interval) { return interval.lo <= value && value <= interval.hi; });
}

std::vector<float> randomOpacities(std::mt19937_64& random) {
    std::vector<float> table(2 + below(random, 300));
    for (float& entry : table) {
        entry = chance(random, 0.7) ? 0.0F : chance(random, 0.2) ? 0.5F : static_cast<float>(uniform(random, 0, 1));
    }
    return table;
}

TEST(OpaqueSets, AreExactFloatByFloat) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 200; ++round) {
        const std::vector<float> table = randomOpacities(random);
        const double lo = uniform(random, -1000, 1000);
        const shader::ItemConstants constants =
            itemConstants(1, 0, {lo, lo + std::pow(10, uniform(random, -2, 5))}, chance(random, 0.3) ? 0.5 : 0.2);
        const cpu::OpaqueSet set(table, constants);
        ASSERT_TRUE(set.valid());
        const auto check = [&](float value) {
            ASSERT_EQ(inIntervals(set.intervals(), value), cpu::isOpaque(table, constants, value)) << value;
        };
        for (const cpu::Interval& interval : set.intervals()) {
            // The ends, and the floats next to them.
            for (const float end : {interval.lo, interval.hi}) {
                check(end);
                check(std::nextafter(end, -3e38F));
                check(std::nextafter(end, 3e38F));
            }
        }
        for (int i = 0; i < 500; ++i) {
            check(static_cast<float>(uniform(random, -2000, 60000)));
        }
        for (const float value : {0.0F, -0.0F, 3.4e38F, -3.4e38F, 1e-45F}) {
            check(value);
        }
    }
}

TEST(OpaqueSets, OverflowingConstantsAreNotUsed) {
    const std::vector<float> table{0, 1};
    EXPECT_FALSE(cpu::OpaqueSet(table, itemConstants(1, 0, {0, 1e-300}, 0.5)).valid());
}

TEST(OccupancyTest, BoxesAgreeWithTheirSamples) {
    std::mt19937_64 random(testSeed());
    std::size_t proven = 0;
    for (int round = 0; round < 100; ++round) {
        std::mt19937_64 local(random());
        const RandomScene scene = makeRandomScene(local, 1);
        const cpu::VolumeImpl volume(scene.volume.view());
        cpu::TransferFunctionImpl function;
        function.domain = scene.domain;
        function.table = take(sampleTable(scene.transferFunction()));
        const cpu::Occupancy occupancy(volume, function, scene.threshold);
        for (int i = 0; i < 300; ++i) {
            float at[3];
            cpu::BrickBox box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                at[axis] = chance(random, 0.1) ? (chance(random, 0.5) ? 0.0F : 1.0F)
                                               : static_cast<float>(uniform(random, 0, 1));
                const shader::ExactCell cell = shader::exactCell(at[axis], volume.image.size[axis]);
                const float shifted = at[axis] * static_cast<float>(volume.image.size[axis]) - 0.5F;
                EXPECT_EQ(cell.weight, shifted - std::floor(shifted));
                const int brick = (static_cast<int>(std::floor(shifted)) + 1) >> kBrickShift;
                ASSERT_LT(brick, volume.bricks.count[axis]);
                box.lo[axis] = static_cast<int>(below(random, static_cast<std::size_t>(brick) + 1));
                box.hi[axis] = brick + static_cast<int>(
                                           below(random, static_cast<std::size_t>(volume.bricks.count[axis] - brick)));
            }
            const bool opaque = cpu::sampleIsOpaque(volume.image, occupancy, at[0], at[1], at[2]);
            const cpu::BrickClass found = occupancy.within(box);
            proven += found != cpu::kMixedBrick ? 1U : 0U;
            if (opaque) {
                ASSERT_NE(found, cpu::kClearBrick);
                ASSERT_FALSE(occupancy.nothingOpaque());
            } else {
                ASSERT_NE(found, cpu::kOpaqueBrick);
            }
        }
    }
    EXPECT_GT(proven, 1000U);
}

/// Entries around the one that is opaque look it up where a sampler's weights are coarse; and entries around the one
/// that is not are not certain.
TEST(OpaqueRangesTest, EntriesBesideTheOneThatIsOpaque) {
    constexpr std::size_t kEntries = 256;
    std::vector<float> one(kEntries, 0.0F);
    one[100] = 1;
    const ValueRange domain{0, 256}; // entry i is at value i + 0.5
    const OpaqueRanges rare(one, domain, 0.5);
    for (double entry = 98.2; entry < 101.95; entry += 0.1) {
        EXPECT_TRUE(rare.mayBeOpaque({entry + 0.5, entry + 0.5})) << entry;
    }
    for (const double entry : {90.0, 110.0}) {
        EXPECT_FALSE(rare.mayBeOpaque({entry + 0.5, entry + 0.5})) << entry;
    }
}

TEST(RowSpansTest, AreThePixelsThatTheRuleCovers) {
    constexpr int kWidth = 33;
    constexpr int kHeight = 47;
    std::mt19937_64 random(testSeed());
    // Half a pixel's grid: edges go through the pixels' centres, and along rows and columns of them.
    const auto onGrid = [&](int pixels) {
        return static_cast<float>(static_cast<double>(below(random, 12) + 24) / pixels - 1);
    };
    for (int round = 0; round < 4000; ++round) {
        shader::ExactCorner corners[3];
        constexpr double kScales[] = {0.05, 1.5, 500};
        const double scale = kScales[round % 3];
        const bool grid = round % 4 == 3;
        for (shader::ExactCorner& corner : corners) {
            corner = {grid ? onGrid(kWidth) : static_cast<float>(uniform(random, -scale, scale)),
                      grid ? onGrid(kHeight) : static_cast<float>(uniform(random, -scale, scale)),
                      0.5F,
                      1,
                      0,
                      0,
                      0};
        }
        shader::ExactTriangle triangle;
        if (!shader::exactSetUp(corners[0], corners[1], corners[2], kWidth, kHeight, triangle)) {
            continue;
        }
        const cpu::RowSpans spans(triangle);
        for (int y = triangle.minY; y <= triangle.maxY; ++y) {
            const cpu::RowSpan span = spans.span(y - triangle.minY);
            for (int x = triangle.minX; x <= triangle.maxX; ++x) {
                float t[3];
                const int column = x - triangle.minX;
                ASSERT_EQ(shader::exactFragment(triangle, x, y, t[0], t[1], t[2]),
                          span.first <= column && column <= span.last);
            }
        }
    }
}

TEST(Reciprocals, AreWithinTwoUnitsInTheLastPlace) {
    std::mt19937_64 random(testSeed());
    for (int i = 0; i < 100000; ++i) {
        const auto value = static_cast<float>(std::pow(10, uniform(random, -30, 30)) * (chance(random, 0.5) ? 1 : -1));
        const double expected = 1 / static_cast<double>(value);
        EXPECT_NEAR(static_cast<double>(shader::exactReciprocal(value)) / expected, 1, 0x1p-22) << value;
    }
    EXPECT_EQ(shader::exactReciprocalW(1.0F), 1.0F);
}

void checkClusters(const MeshData& mesh) {
    const std::vector<float> floats = floatsOf(mesh.positions);
    const MeshClusters clusters = makeClusters({floats, mesh.indices});
    std::vector<std::uint32_t> seen = clusters.triangles;
    std::sort(seen.begin(), seen.end());
    ASSERT_EQ(seen.size(), mesh.indices.size() / 3);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        ASSERT_EQ(seen[i], i);
    }
    std::uint32_t next = 0;
    for (const MeshCluster& cluster : clusters.clusters) {
        ASSERT_EQ(cluster.firstTriangle, next);
        ASSERT_LE(cluster.triangleCount, kClusterTriangles);
        next += cluster.triangleCount;
        for (std::uint32_t i = cluster.firstTriangle; i < next; ++i) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint8_t local = clusters.corners[i][corner];
                ASSERT_LT(local, cluster.vertexCount);
                const std::uint32_t vertex = clusters.vertices[cluster.firstVertex + local];
                ASSERT_EQ(vertex, mesh.indices[std::size_t{3} * clusters.triangles[i] + corner]);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const float at = floats[std::size_t{3} * vertex + axis];
                    ASSERT_TRUE(cluster.lo[axis] <= at && at <= cluster.hi[axis]);
                }
            }
        }
    }
    EXPECT_EQ(next, seen.size());
    EXPECT_EQ(clusters.clusters.size(), (seen.size() + kClusterTriangles - 1) / kClusterTriangles);
}

TEST(Clusters, HoldEveryTriangleOnce) {
    std::mt19937_64 random(testSeed());
    checkClusters(take(makeScalpel()));
    checkClusters(take(makeEllipsoid(5000)));
    checkClusters(makeFlat(0, 1, 0, 1, 0));
    for (int round = 0; round < 50; ++round) {
        checkClusters(randomMesh(random, unitGrid(8)));
    }
    MeshData same = makeFlat(0, 0, 0, 0, 0); // all centroids alike
    for (int i = 0; i < 300; ++i) {
        same.indices.insert(same.indices.end(), {0, 1, 2});
    }
    checkClusters(same);
}

} // namespace
} // namespace voxtact::test
