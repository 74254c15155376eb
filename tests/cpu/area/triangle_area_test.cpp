// SPDX-License-Identifier: MIT
// What each triangle has of a contact area.
#include "cpu/area/area_held.h"

#include "core/base/infinity.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"

#include <algorithm>
#include <map>

namespace voxtact::test {
namespace {

AreaAnswer triangleAreas(const Held& held, std::span<const Mat4> poses, const cpu::AreaDesc& desc,
                         double threshold = 0.5) {
    cpu::AreaMeter meter = take(cpu::AreaMeter::create(desc));
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, poses};
    return take(meter.measureTriangles({std::span(&item, 1), {}, threshold}));
}

/// One of a mesh's triangles, alone.
MeshData triangleOf(const MeshData& mesh, std::size_t number) {
    MeshData alone;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const double* const at = &mesh.positions[std::size_t{3} * mesh.indices[3 * number + corner]];
        alone.positions.insert(alone.positions.end(), at, at + 3);
        alone.indices.push_back(corner);
    }
    return alone;
}

void expectEqual(const PairArea& one, const PairArea& other) {
    EXPECT_EQ(one.pair, other.pair);
    EXPECT_EQ(one.bounds.lower, other.bounds.lower);
    EXPECT_EQ(one.bounds.upper, other.bounds.upper);
    EXPECT_EQ(one.end, other.end);
}

/// Against each triangle measured alone; those that are not told of have nothing.
TEST(TriangleArea, IsWhatTheTriangleHasAlone) {
    std::mt19937_64 random(testSeed());
    std::size_t told = 0;
    std::size_t partly = 0;
    for (int round = 0; round < 30 || (round < 1000 && partly < 100); ++round) {
        const RandomScene scene = makeRandomScene(random, 3);
        const Held held(scene.mesh, scene.volume, scene.points, scene.domain, scene.tableSize);
        const std::size_t count = scene.mesh.indices.size() / 3;
        // So little that parts are divided.
        const cpu::AreaDesc desc{.threads = 1, .tolerance = 1e-5 * surfaceOf(scene.mesh) + 1e-9, .maxSteps = 4096};
        const AreaAnswer found = triangleAreas(held, scene.poses, desc, scene.threshold);
        const std::vector<PairArea> pairs = areas(held, scene.poses, desc, scene.threshold);
        ASSERT_EQ(found.pairs.size(), pairs.size());
        std::map<std::pair<std::uint32_t, std::uint32_t>, TriangleArea> byNumber;
        for (const TriangleArea& area : found.triangles) {
            EXPECT_EQ(area.pose, area.pair);
            EXPECT_GT(area.bounds.upper, 0);
            EXPECT_TRUE(byNumber.try_emplace({area.pair, area.triangle}, area).second);
        }
        EXPECT_TRUE(std::ranges::is_sorted(
            found.triangles, {}, [](const TriangleArea& area) { return std::pair(area.pair, area.triangle); }));
        for (std::uint32_t pair = 0; pair < pairs.size(); ++pair) {
            expectEqual(found.pairs[pair], pairs[pair]);
            Bounds sum;
            for (std::uint32_t triangle = 0; triangle < std::min<std::size_t>(count, 40); ++triangle) {
                const MeshData alone = triangleOf(scene.mesh, triangle);
                const Held one(alone, scene.volume, scene.points, scene.domain, scene.tableSize);
                const Bounds wanted = area(one, desc, scene.threshold, scene.poses[pair]).bounds;
                const auto at = byNumber.find({pair, triangle});
                if (at == byNumber.end()) {
                    EXPECT_EQ(wanted.lower, 0);
                    continue;
                }
                const TriangleArea& area = at->second;
                const double whole = surfaceOf(alone, scene.poses[pair]);
                EXPECT_NEAR(area.whole, whole, 1e-6 * whole + 1e-12);
                EXPECT_LE(area.bounds.lower, wanted.upper);
                EXPECT_GE(area.bounds.upper, wanted.lower);
                EXPECT_LE(area.bounds.lower, whole * (1 + 1e-6) + 1e-12);
                const Bounds& all = pairs[pair].bounds;
                EXPECT_LE(area.bounds.upper - area.bounds.lower, all.upper - all.lower + 1e-12 * all.upper);
                partly += area.bounds.lower > 0 && area.bounds.upper < 0.99 * whole ? 1 : 0;
                ++told;
            }
            for (const TriangleArea& area : found.triangles) {
                sum.lower += area.pair == pair ? area.bounds.lower : 0;
                sum.upper += area.pair == pair ? area.bounds.upper : 0;
            }
            const double rounding = 1e-12 * (1 + pairs[pair].bounds.upper);
            EXPECT_NEAR(sum.lower, pairs[pair].bounds.lower, rounding);
            EXPECT_NEAR(sum.upper, pairs[pair].bounds.upper, rounding);
        }
    }
    std::cout << told << " triangles, " << partly << " of them partly\n";
    EXPECT_GE(partly, 100U);
}

/// Four triangles of two plates: one in what is opaque, one half of the way in, two outside.
TEST(TriangleArea, OfKnownTriangles) {
    // Opaque from x = 12.5 on.
    const std::vector<ControlPoint> points{{90, 0}, {110, 1}};
    MeshData mesh = oneTriangle({14, 4, 8.75}, {24, 4, 8.75}, {14, 14, 8.75});
    addTriangle(mesh, {7.5, 16, 9.25}, {17.5, 16, 9.25}, {12.5, 26, 9.25});
    addTriangle(mesh, {2, 4, 10.25}, {12, 4, 10.25}, {2, 14, 10.25});
    addTriangle(mesh, {100, 4, 10.25}, {112, 4, 10.25}, {100, 14, 10.25});
    const Held held(mesh, valueRamp(), points, kEntries);
    const Mat4 pose = identity();
    const AreaAnswer found = triangleAreas(held, {&pose, 1}, {.threads = 1, .tolerance = 1e-6});
    ASSERT_EQ(found.triangles.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const double wanted = i == 0 ? 50 : 25;
        EXPECT_EQ(found.triangles[i].triangle, i);
        EXPECT_NEAR(found.triangles[i].whole, 50, 1e-9);
        EXPECT_LE(found.triangles[i].bounds.lower, wanted + 1e-9);
        EXPECT_GE(found.triangles[i].bounds.upper, wanted - 1e-9);
        EXPECT_LE(found.triangles[i].bounds.upper - found.triangles[i].bounds.lower, 1e-6);
    }
    expectArea(75, found.pairs.at(0));
}

TEST(TriangleArea, OfWhatIsTooFarAwayToTellIsUnknown) {
    MeshData mesh = makeFlat(2, 12, 3, 9, 8);
    addTriangle(mesh, {0, 0, 8}, {1e30, 0, 8}, {0, 1, 8});
    const Held held(mesh, valueRamp(), byteRamp(), {0, 255});
    const Mat4 pose = identity();
    const AreaAnswer found = triangleAreas(held, {&pose, 1}, {.threads = 1});
    ASSERT_EQ(found.triangles.size(), 3U) << "none is known to have nothing";
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(found.triangles[i].triangle, i);
        EXPECT_EQ(found.triangles[i].whole, kInfinity);
        EXPECT_EQ(found.triangles[i].bounds.lower, 0);
        EXPECT_EQ(found.triangles[i].bounds.upper, kInfinity);
    }
    EXPECT_EQ(found.pairs.at(0).end, StopReason::Rounding);
}

TEST(TriangleArea, DoesNotDependOnThreadsOrOnTheBatch) {
    std::mt19937_64 random(testSeed());
    std::size_t compared = 0;
    for (int round = 0; round < 3 || (round < 100 && compared < 100); ++round) {
        const RandomScene scene = makeRandomScene(random, 30);
        const Held held(scene.mesh, scene.volume, scene.points, scene.domain, scene.tableSize);
        const double tolerance = 1e-3 * surfaceOf(scene.mesh) + 1e-9;
        const auto measured = [&](std::uint32_t threads, std::span<const Mat4> poses) {
            return triangleAreas(held, poses, {.threads = threads, .tolerance = tolerance}, scene.threshold).triangles;
        };
        const std::vector<TriangleArea> one = measured(1, scene.poses);
        const std::vector<TriangleArea> three = measured(3, scene.poses);
        std::vector<TriangleArea> apart;
        for (std::uint32_t pose = 0; pose < scene.poses.size(); ++pose) {
            for (TriangleArea area : measured(1, std::span(scene.poses).subspan(pose, 1))) {
                area.pair = pose;
                apart.push_back(area);
            }
        }
        for (const std::vector<TriangleArea>& other : {three, apart}) {
            ASSERT_EQ(one.size(), other.size());
            for (std::size_t i = 0; i < one.size(); ++i) {
                EXPECT_EQ(one[i].pair, other[i].pair);
                EXPECT_EQ(one[i].triangle, other[i].triangle);
                EXPECT_EQ(one[i].whole, other[i].whole);
                EXPECT_EQ(one[i].bounds.lower, other[i].bounds.lower);
                EXPECT_EQ(one[i].bounds.upper, other[i].bounds.upper);
                ++compared;
            }
        }
    }
    EXPECT_GE(compared, 100U);
}

} // namespace
} // namespace voxtact::test
