// SPDX-License-Identifier: MIT
// The oracle against scenes whose answer is known without a rasteriser.
#include "cpu/scenes/oracle_scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace voxtact::test {
namespace {

using oracle::Doubt;
using oracle::Evidence;
using oracle::oracleEvidence;
using oracle::OracleFragment;
using oracle::oracleSurvivors;
using testing::HasSubstr;

VolumeData opaqueImage() {
    return makeUnitImage(4, [](auto, auto, auto) { return 255; });
}

std::size_t countOf(const OracleScene& scene) {
    const Result<std::vector<OracleFragment>> survivors = oracleSurvivors(scene.pair());
    EXPECT_TRUE(survivors.ok());
    return survivors->size();
}

TEST(Oracle, PlaneThroughAHalfOpaqueVolume) {
    OracleScene scene;
    scene.volume = makeUnitImage(8, [](auto x, auto, auto) { return x < 4 ? 0 : 255; });
    addRectangle(scene.mesh, {0.1, 0.1, 0.4}, {0.9, 0.1, 0.4}, {0.9, 0.9, 0.4}, {0.1, 0.9, 0.4});
    scene.view = squareView(0, 1, 64, 64);
    // The opacity reaches a half where x does: columns 32 to 57, rows 6 to 57.
    EXPECT_EQ(countOf(scene), 26U * 52U);
    scene.world_from_object = translation({0, 0, 0.5});
    EXPECT_EQ(countOf(scene), 26U * 52U);
    scene.world_from_object = translation({0.25, 0, 0}); // columns 32 to 63: the view ends there
    EXPECT_EQ(countOf(scene), 32U * 52U);
}

TEST(Oracle, CubeShowsFrontAndBack) {
    OracleScene scene;
    scene.volume = opaqueImage();
    constexpr double kLo = 0.25;
    constexpr double kHi = 0.75;
    for (const double z : {kLo, kHi}) {
        addRectangle(scene.mesh, {kLo, kLo, z}, {kHi, kLo, z}, {kHi, kHi, z}, {kLo, kHi, z});
    }
    for (const double at : {kLo, kHi}) {
        addRectangle(scene.mesh, {at, kLo, kLo}, {at, kHi, kLo}, {at, kHi, kHi}, {at, kLo, kHi});
        addRectangle(scene.mesh, {kLo, at, kLo}, {kHi, at, kLo}, {kHi, at, kHi}, {kLo, at, kHi});
    }
    scene.view = squareView(0, 1, 64, 48);
    EXPECT_EQ(countOf(scene), 2U * 32U * 24U);
}

TEST(Oracle, TentOfOneOpaqueVoxel) {
    OracleScene scene;
    scene.volume = makeUnitImage(9, [](auto x, auto y, auto z) { return x == 4 && y == 5 && z == 3 ? 255 : 0; });
    scene.threshold = 0.25;
    constexpr double kZ = (3 + 0.5 + 0.2) / 9;
    addRectangle(scene.mesh, {0, 0, kZ}, {1, 0, kZ}, {1, 1, kZ}, {0, 1, kZ});
    scene.view = squareView(0, 1, 200, 150);
    std::vector<OracleFragment> expected;
    for (std::uint32_t y = 0; y < 150; ++y) {
        for (std::uint32_t x = 0; x < 200; ++x) {
            const double u = (x + 0.5) / 200;
            const double v = (y + 0.5) / 150;
            const double tent =
                0.8 * std::max(0.0, 1 - std::abs(9 * u - 4.5)) * std::max(0.0, 1 - std::abs(9 * v - 5.5));
            ASSERT_GT(std::abs(tent - 0.25), 1e-6) << "choose another viewport";
            if (tent > 0.25) {
                expected.push_back({u > v ? 0U : 1U, x, y});
            }
        }
    }
    std::sort(expected.begin(), expected.end());
    EXPECT_GT(expected.size(), 300U);
    EXPECT_EQ(oracleSurvivors(scene.pair()).value(), expected);
}

TEST(Oracle, OnlyThePartInTheDomainCounts) {
    OracleScene scene;
    scene.volume = opaqueImage();
    addRectangle(scene.mesh, {-0.5, 0.25, 0.5}, {0.5, 0.25, 0.5}, {0.5, 0.75, 0.5}, {-0.5, 0.75, 0.5});
    scene.view = squareView(-1, 2, 96, 96); // a pixel is 1/32: columns 32 to 47, rows 40 to 55
    EXPECT_EQ(countOf(scene), 16U * 16U);
    scene.world_from_object = translation({0, 0, 0.75});
    EXPECT_EQ(countOf(scene), 0U);
}

TEST(Oracle, NearAndFarPlanesCut) {
    OracleScene scene;
    scene.volume = opaqueImage();
    // Depth grows with x: near cuts at 0.25, far at 0.75.
    addRectangle(scene.mesh, {0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0});
    scene.view = squareView(0, 1, 64, 64);
    EXPECT_EQ(countOf(scene), 64U * 64U);
    scene.view.clip_from_world[10] = 2;
    scene.view.clip_from_world[14] = -0.5;
    EXPECT_EQ(countOf(scene), 32U * 64U);
}

TEST(Oracle, AnEdgeOnTriangleHasNoFragment) {
    OracleScene scene;
    scene.volume = opaqueImage();
    addTriangle(scene.mesh, {0.1, 0.5 + 1.0 / 128, 0.2}, {0.9, 0.5 + 1.0 / 128, 0.2}, {0.5, 0.5 + 1.0 / 128, 0.8});
    scene.view = squareView(0, 1, 64, 64); // through the centres of row 32
    EXPECT_EQ(countOf(scene), 0U);
    const Evidence on = oracleEvidence(scene.pair(), {0, 32, 32}, {}).value();
    EXPECT_EQ(on.doubt, Doubt::Coverage);
    EXPECT_FALSE(on.covered);
    EXPECT_NEAR(on.edgeDistance, 0, 1e-12);
    for (const OracleFragment& off : {OracleFragment{0, 32, 33}, OracleFragment{0, 2, 32}}) {
        const Evidence evidence = oracleEvidence(scene.pair(), off, {}).value();
        EXPECT_EQ(evidence.doubt, Doubt::None);
        EXPECT_FALSE(evidence.survives);
        EXPECT_LT(evidence.edgeDistance, -0.9);
    }
}

/// Where the ray through a pixel's centre meets the plane y = 0.75. Camera at `eye`, 90 degrees, along +z.
struct FloorPoint {
    double x, depth;
};
FloorPoint floorPoint(const Vec3& eye, std::uint32_t size, std::uint32_t x, std::uint32_t y) {
    const double nx = (x + 0.5) / size * 2 - 1;
    const double ny = (y + 0.5) / size * 2 - 1;
    const double depth = (0.75 - eye[1]) / ny;
    return {eye[0] + nx * depth, depth};
}

/// Compares the survivors with rays where the oracle has no doubt; returns how many pixels it has doubts about.
std::size_t compareWithRays(const OracleScene& scene, const Vec3& eye, double nearPlane, double halfWidth, double lo,
                            double hi) {
    std::set<std::array<std::uint32_t, 2>> seen;
    const std::vector<OracleFragment> survivors = oracleSurvivors(scene.pair()).value();
    for (const OracleFragment& fragment : survivors) {
        EXPECT_TRUE(seen.insert({fragment.x, fragment.y}).second) << "twice at " << fragment.x << ", " << fragment.y;
    }
    std::size_t expectedCount = 0;
    std::size_t doubts = 0;
    for (std::uint32_t y = 0; y < scene.view.height; ++y) {
        for (std::uint32_t x = 0; x < scene.view.width; ++x) {
            const FloorPoint point = floorPoint(eye, scene.view.width, x, y);
            const double z = eye[2] + point.depth;
            const bool expected = point.depth >= nearPlane && std::abs(point.x - 0.5) <= halfWidth && z >= lo &&
                                  z <= hi && point.x >= 0 && point.x <= 1 && z >= 0 && z <= 1;
            expectedCount += expected ? 1U : 0U;
            if (expected == seen.contains({x, y})) {
                continue;
            }
            ++doubts;
            bool doubted = false;
            for (const std::uint32_t triangle : {0U, 1U}) {
                doubted |= oracleEvidence(scene.pair(), {triangle, x, y}, {}).value().doubt != Doubt::None;
            }
            EXPECT_TRUE(doubted) << "pixel " << x << ", " << y;
        }
    }
    EXPECT_GT(expectedCount, 1000U);
    return doubts;
}

TEST(Oracle, FloorInPerspective) {
    OracleScene scene;
    scene.volume = opaqueImage();
    addRectangle(scene.mesh, {0.1, 0.75, -0.5}, {0.9, 0.75, -0.5}, {0.9, 0.75, 0.8}, {0.1, 0.75, 0.8});
    const Vec3 eye{0.53, 0.21, -0.7};
    scene.view = perspectiveView(translation(eye), 0.01, 10, 300);
    EXPECT_LE(compareWithRays(scene, eye, 0.01, 0.4, -0.5, 0.8), 20U);
}

TEST(Oracle, FloorThroughTheNearPlane) {
    OracleScene scene;
    scene.volume = opaqueImage();
    // From far behind the eye to far ahead; the near plane cuts it in the viewport.
    addRectangle(scene.mesh, {-40, 0.75, -30}, {41, 0.75, -30}, {41, 0.75, 50}, {-40, 0.75, 50});
    const Vec3 eye{0.5, 0.47, 0.05};
    scene.view = perspectiveView(translation(eye), 0.3517, 100, 300);
    EXPECT_LE(compareWithRays(scene, eye, 0.3517, 40.5, -30, 50), 20U);
}

/// A jittered net of n^2 cells over the square from (-1,-1) to (2,2) at z = 0.5, each cell in two triangles.
MeshData makeNet(std::mt19937& random, std::uint32_t n) {
    constexpr double kJitter = 0.2; // from 0.25 the net may fold
    MeshData mesh;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const bool inner = i > 0 && j > 0 && i < n && j < n;
            const double jitter = inner ? kJitter * 3 / n : 0;
            mesh.positions.push_back(static_cast<float>(-1 + 3.0 * i / n + uniform(random, -jitter, jitter)));
            mesh.positions.push_back(static_cast<float>(-1 + 3.0 * j / n + uniform(random, -jitter, jitter)));
            mesh.positions.push_back(0.5F);
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t at = j * (n + 1) + i;
            const std::uint32_t corners[4] = {at, at + 1, at + n + 2, at + n + 1};
            const auto start = static_cast<std::uint32_t>(random() % 2);
            for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) {
                mesh.indices.push_back(corners[(k + start) % 4]);
            }
        }
    }
    return mesh;
}

void expectEveryPixelOnce(const OracleScene& scene, const std::string& what) {
    std::vector<std::uint32_t> hits(std::size_t{scene.view.width} * scene.view.height);
    const std::vector<OracleFragment> survivors = oracleSurvivors(scene.pair()).value();
    for (const OracleFragment& fragment : survivors) {
        ++hits[std::size_t{fragment.y} * scene.view.width + fragment.x];
    }
    EXPECT_EQ(std::count(hits.begin(), hits.end(), 1U), std::ssize(hits)) << what;
}

TEST(Oracle, ATessellationCoversEveryPixelOnce) {
    std::mt19937 random(testSeed(20260101));
    OracleScene scene;
    scene.volume = opaqueImage();
    scene.volume.grid.spacing = {100, 100, 100}; // all of the net is inside
    scene.volume.grid.origin = {-150, -150, -150};
    for (const std::uint32_t n : {1U, 2U, 7U, 40U, 150U}) {
        for (int turn = 0; turn < 6; ++turn) {
            scene.mesh = makeNet(random, n);
            const double angle = turn == 0 ? 0 : uniform(random, 0, 6.3);
            Mat4 rotation = identity();
            rotation[0] = rotation[5] = std::cos(angle);
            rotation[1] = std::sin(angle);
            rotation[4] = -rotation[1];
            const Mat4 about = multiply(translation({0.5, 0.5, 0}), multiply(rotation, translation({-0.5, -0.5, 0})));
            scene.world_from_object = about;
            scene.view = squareView(0, 1, 64, 50);
            expectEveryPixelOnce(scene, "flat, " + std::to_string(n) + " cells, turn " + std::to_string(turn));
            // Seen in perspective, tilted.
            Mat4 tilt = identity();
            tilt[8] = uniform(random, -0.4, 0.4);
            tilt[2] = uniform(random, -0.4, 0.4);
            scene.world_from_object = multiply(tilt, about);
            scene.view = perspectiveView(translation({0.5 + 0.5 * tilt[8], 0.5, -0.05 + 0.5 * tilt[2]}), 0.01, 20, 64);
            expectEveryPixelOnce(scene, "tilted, " + std::to_string(n) + " cells, turn " + std::to_string(turn));
        }
    }
}

TEST(Oracle, RefusesWhatTheEnginesRefuse) {
    OracleScene good;
    good.volume = opaqueImage();
    addTriangle(good.mesh, {0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5});
    good.view = squareView(0, 1, 8, 8);
    const auto refusal = [](const OracleScene& scene) {
        const Result<std::vector<OracleFragment>> survivors = oracleSurvivors(scene.pair());
        EXPECT_EQ(survivors.ok(), oracleEvidence(scene.pair(), {0, 0, 0}, {}).ok());
        return survivors.ok() ? std::string() : survivors.error().text;
    };
    EXPECT_EQ(refusal(good), "");
    OracleScene bad = good;
    bad.view.width = 0;
    EXPECT_THAT(refusal(bad), HasSubstr("0x8"));
    bad.view.width = cpu::kMaxViewport + 1;
    EXPECT_THAT(refusal(bad), HasSubstr("16384"));
    bad = good;
    bad.threshold = 1.5;
    EXPECT_THAT(refusal(bad), HasSubstr("threshold"));
    bad = good;
    bad.world_from_object[3] = 1;
    EXPECT_THAT(refusal(bad), HasSubstr("last row"));
    bad = good;
    bad.view.clip_from_world = {};
    EXPECT_THAT(refusal(bad), HasSubstr("singular"));
    bad = good;
    bad.mesh.indices[1] = 7;
    EXPECT_THAT(refusal(bad), HasSubstr("vertex 7"));
    bad = good;
    bad.volume.voxels.pop_back();
    EXPECT_THAT(refusal(bad), HasSubstr("63 bytes"));
    bad = good;
    bad.points.clear();
    EXPECT_THAT(refusal(bad), HasSubstr("control points"));
    EXPECT_THAT(oracleEvidence(good.pair(), {1, 0, 0}, {}).error().text, HasSubstr("triangle 1"));
    EXPECT_THAT(oracleEvidence(good.pair(), {0, 8, 0}, {}).error().text, HasSubstr("(8, 0)"));
    EXPECT_THAT(oracleEvidence(good.pair(), {0, 0, 0}, {-1, 0, 0}).error().text, HasSubstr("tolerance"));
}

} // namespace
} // namespace voxtact::test
