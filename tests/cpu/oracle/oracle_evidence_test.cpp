// SPDX-License-Identifier: MIT
// What the oracle doubts: fragments made by hand, and another rasteriser that is as wrong as the tolerances allow.
#include "cpu/judges/oracle_other.h"
#include "cpu/scenes/oracle_scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace voxtact::test {
namespace {

using oracle::Doubt;
using oracle::Evidence;
using oracle::oracleEvidence;
using oracle::OracleFragment;
using oracle::oracleSurvivors;
using oracle::Tolerance;

constexpr Tolerance kNearZero{1e-9, 1e-9, 0};

Evidence evidence(const OracleScene& scene, const OracleFragment& fragment, const Tolerance& tolerance = {}) {
    return oracleEvidence(scene.pair(), fragment, tolerance).value();
}

/// A half-opaque image (x from 0.5) and a rectangle at z = 0.4 whose left edge is `left` pixels from that of a view of
/// 64 pixels.
OracleScene handMade(double left) {
    OracleScene scene;
    scene.volume = makeUnitImage(8, [](auto x, auto, auto) { return x < 4 ? 0 : 255; });
    const double at = left / 64;
    addRectangle(scene.mesh, {at, 0.1, 0.4}, {0.9, 0.1, 0.4}, {0.9, 0.9, 0.4}, {at, 0.9, 0.4});
    scene.view = squareView(0, 1, 64, 64);
    return scene;
}

TEST(OracleEvidence, EdgesWithinTheTolerance) {
    // The second triangle has the left edge. Pixel 40's centre is 0, 1, 2 sub-pixels away from it.
    for (const int away : {-2, -1, 0, 1, 2}) {
        const OracleScene scene = handMade(40.5 - away / 256.0);
        const Evidence at = evidence(scene, {1, 40, 40});
        EXPECT_NEAR(at.edgeDistance, away / 256.0, 1e-9);
        EXPECT_EQ(at.covered, away >= 0) << "a left edge has its own pixels";
        EXPECT_EQ(at.survives, at.covered);
        EXPECT_EQ(at.doubt, std::abs(away) < 2 ? Doubt::Coverage : Doubt::None) << away;
        EXPECT_EQ(evidence(scene, {1, 40, 40}, {3.0 / 256, 0, 0}).doubt, Doubt::Coverage);
        EXPECT_EQ(evidence(scene, {1, 40, 40}, kNearZero).doubt, away == 0 ? Doubt::Coverage : Doubt::None);
        EXPECT_EQ(evidence(scene, {1, 42, 46}).doubt, Doubt::None);
    }
    // On an edge where all is transparent there is nothing to disagree on.
    EXPECT_EQ(evidence(handMade(10.5), {1, 10, 40}).doubt, Doubt::None);
}

TEST(OracleEvidence, CutsOfTheClippingPlanesAreEdges) {
    OracleScene scene = handMade(8);
    scene.volume = makeUnitImage(2, [](auto, auto, auto) { return 255; });
    scene.mesh = {};
    addRectangle(scene.mesh, {0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0});
    for (const double plane : {20.5, 20.5 + 1.0 / 256, 20.5 - 1.0 / 256, 20.5 + 4.0 / 256, 20.5 - 4.0 / 256}) {
        for (const bool isNear : {true, false}) {
            scene.view = squareView(0, 1, 64, 64);
            scene.view.clip_from_world[10] = isNear ? 1 : 64 / plane;
            scene.view.clip_from_world[14] = isNear ? -plane / 64 : 0;
            const bool close = std::abs(plane - 20.5) < 1.5 / 256;
            EXPECT_EQ(evidence(scene, {1, 20, 50}).doubt, close ? Doubt::Coverage : Doubt::None) << plane;
            EXPECT_NEAR(std::abs(evidence(scene, {1, 20, 50}).edgeDistance), std::abs(plane - 20.5), 1e-9);
        }
    }
}

TEST(OracleEvidence, FacesOfTheDomain) {
    OracleScene scene = handMade(8);
    scene.volume = makeUnitImage(2, [](auto, auto, auto) { return 255; });
    scene.mesh = {};
    addRectangle(scene.mesh, {-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5});
    for (const int away : {-3, -1, 0, 1, 3}) {
        // Pixel 20's centre is so many sub-pixels inside the face x = 0.
        scene.view = squareView(0, 1, 64, 64);
        scene.view.clip_from_world[12] += 2 * (20.5 - away / 256.0) / 64;
        const Evidence at = evidence(scene, {1, 20, 40});
        EXPECT_NEAR(at.domainDistance, away / 256.0 / 64, 1e-9);
        EXPECT_EQ(at.survives, at.domainDistance >= 0);
        EXPECT_EQ(at.doubt, std::abs(away) < 2 ? Doubt::Coordinate : Doubt::None) << away;
    }
    // In the face itself.
    scene.mesh = {};
    addRectangle(scene.mesh, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1});
    scene.view = squareView(-1, 2, 64, 64);
    EXPECT_EQ(evidence(scene, {0, 36, 33}).doubt, Doubt::Coordinate);
}

TEST(OracleEvidence, OpacitiesNearTheThreshold) {
    OracleScene scene = handMade(8);
    scene.points = {{0, 0}, {255, 1}};
    const double opacity = evidence(scene, {0, 34, 20}).opacity; // on the ramp
    ASSERT_GT(opacity, 0.4);
    ASSERT_LT(opacity, 0.9);
    // A 1/256 of a voxel along x is 1/256 of the whole ramp; the table, the corners come on top.
    for (const double away : {-0.02, -0.003, 0.003, 0.02}) {
        scene.threshold = opacity + away;
        const Evidence at = evidence(scene, {0, 34, 20});
        EXPECT_EQ(at.survives, away < 0);
        EXPECT_EQ(at.doubt, std::abs(away) < 0.01 ? Doubt::Opacity : Doubt::None);
        EXPECT_LT(at.opacityLow, opacity - 1.0 / 256);
        EXPECT_GT(at.opacityHigh, opacity + 1.0 / 256);
        EXPECT_LT(at.opacityHigh - at.opacityLow, 0.015);
        EXPECT_EQ(evidence(scene, {0, 34, 20}, kNearZero).doubt, Doubt::None);
        EXPECT_EQ(evidence(scene, {0, 34, 20}, {0, 0, 4}).doubt, std::abs(away) < 0.02 ? Doubt::Opacity : Doubt::None);
    }
    // A plateau at the threshold: any rounding decides.
    scene.points = {{0, 0.3}};
    scene.threshold = 0.3;
    EXPECT_TRUE(evidence(scene, {0, 34, 20}).survives);
    EXPECT_EQ(evidence(scene, {0, 34, 20}, kNearZero).doubt, Doubt::Opacity);
}

TEST(OracleEvidence, TheTableIsFilteredToo) {
    OracleScene scene = handMade(8);
    scene.volume = makeUnitImage(2, [](auto, auto, auto) { return 120; });
    scene.tableSize = 4; // an entry is a quarter of the domain
    scene.threshold = evidence(scene, {0, 40, 20}).opacity + 0.002;
    EXPECT_EQ(evidence(scene, {0, 40, 20}, {0, 0.004, 0}).doubt, Doubt::None);
    EXPECT_EQ(evidence(scene, {0, 40, 20}, {0, 0.012, 0}).doubt, Doubt::Opacity);
}

TEST(OracleEvidence, NarrowPeaksBetweenEntriesAreSeen) {
    OracleScene scene = handMade(8);
    scene.points = {{0, 0}, {126, 0}, {128, 1}, {130, 0}};
    scene.volume = makeUnitImage(2, [](auto x, auto, auto) { return x == 0 ? 0 : 255; });
    // A tolerance of a voxel reaches over the peak, though both ends are transparent.
    const Evidence at = evidence(scene, {0, 40, 20}, {0, 0.6, 0});
    EXPECT_EQ(at.opacityLow, 0);
    EXPECT_GT(at.opacityHigh, 0.7);
}

TEST(OracleEvidence, ASliverMayBeSampledOutsideOfItself) {
    // Thinner than 1/256 pixel: snapping puts its edge onto the centres of a row, which are outside of the true
    // triangle. There its own plane is at z = 0.39, though all of it is between 0.2 and 0.3.
    const auto corner = [](double x, double subPixels, double z) {
        return Vec3{x / 64, (32.5 + subPixels / 256) / 64, z};
    };
    OracleScene scene = handMade(8);
    scene.volume = makeUnitImage(8, [](auto, auto, auto z) { return z < 3 ? 0 : 255; });
    scene.mesh = {};
    addTriangle(scene.mesh, corner(10, -0.4, 0.2), corner(50, 0.4, 0.2), corner(49.9, 0.6, 0.3));
    const Evidence found = evidence(scene, {0, 10, 32});
    EXPECT_TRUE(found.covered);
    EXPECT_FALSE(found.survives);
    EXPECT_EQ(found.doubt, Doubt::Coverage) << found.opacityHigh;
}

TEST(OracleEvidence, OutsideTheViewNothingIsInDoubt) {
    OracleScene scene = handMade(8);
    scene.world_from_object = translation({0, 0, -2});
    const Evidence at = evidence(scene, {0, 40, 40});
    EXPECT_EQ(at.edgeDistance, -std::numeric_limits<double>::infinity());
    EXPECT_FALSE(at.covered || at.survives);
    EXPECT_EQ(at.doubt, Doubt::None);
}

/// Triangles of all kinds around a square from (0,0) to (1,1): small, slivers, huge, nearly edge-on.
MeshData makeAwkwardMesh(std::mt19937& random, std::uint32_t triangles) {
    MeshData mesh;
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double sizes[] = {0.01, 0.1, 1, 30};
        const double size = sizes[random() % 4];
        const auto near = [&](const Vec3& at, double by) {
            return Vec3{at[0] + uniform(random, -by, by), at[1] + uniform(random, -by, by),
                        at[2] + uniform(random, -by, by)};
        };
        const Vec3 a = near({0.5, 0.5, 0.5}, 0.5);
        const Vec3 b = near(a, size);
        Vec3 c = near(a, size);
        if (random() % 3 == 0) {
            c = near({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2},
                     1e-4 * std::pow(10, uniform(random, -1, 2)));
        } else if (random() % 3 == 0) {
            c = {a[0] + uniform(random, -1e-4, 1e-4), a[1] + uniform(random, -1e-4, 1e-4), c[2]}; // edge-on
        }
        addTriangle(mesh, a, b, c);
    }
    return mesh;
}

/// A mesh far from its own origin, put back by the pose: single precision loses sub-pixels.
void moveFarAway(OracleScene& scene) {
    constexpr float kFar = 3000;
    for (double& coordinate : scene.mesh.positions) {
        coordinate += kFar;
    }
    scene.world_from_object = translation({-kFar, -kFar, -kFar});
}

OracleScene awkwardScene(std::mt19937& random, std::uint32_t triangles, std::uint32_t size) {
    OracleScene scene;
    scene.volume = makeUnitImage(6, [&](auto, auto, auto) { return random() % 256; });
    scene.mesh = makeAwkwardMesh(random, triangles);
    if (random() % 2 == 0) {
        scene.view = squareView(-0.1, 1.1, size, size);
    } else {
        const Vec3 eye{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, -0.5, 0.5)};
        scene.view = perspectiveView(randomPose(random, eye), std::pow(10, uniform(random, -3, -0.5)), 5, size);
    }
    scene.threshold = uniform(random, 0.2, 0.8);
    if (random() % 2 == 0) {
        moveFarAway(scene);
    }
    return scene;
}

TEST(OracleEvidence, AgreesWithTheSurvivorsEverywhere) {
    std::mt19937 random(testSeed(4711));
    for (int round = 0; round < 6; ++round) {
        const OracleScene scene = awkwardScene(random, 60, 24);
        const oracle::OraclePair pair = scene.pair();
        const std::vector<OracleFragment> survivors = oracleSurvivors(pair).value();
        std::vector<OracleFragment> all;
        for (std::uint32_t triangle = 0; triangle < 60; ++triangle) {
            for (std::uint32_t y = 0; y < 24; ++y) {
                for (std::uint32_t x = 0; x < 24; ++x) {
                    all.push_back({triangle, x, y});
                }
            }
        }
        const std::vector<Evidence> found = oracleEvidence(pair, all, {}).value();
        std::size_t at = 0;
        for (const OracleFragment& fragment : all) {
            const Evidence& here = found[at++];
            ASSERT_EQ(here.survives, std::binary_search(survivors.begin(), survivors.end(), fragment));
            ASSERT_TRUE(!here.survives || here.covered);
            ASSERT_EQ(here.covered, here.edgeDistance > 0 || (here.covered && here.edgeDistance == 0));
            ASSERT_TRUE(!here.covered || (here.opacityLow <= here.opacity && here.opacity <= here.opacityHigh));
        }
    }
}

/// Every fragment on which the oracle and the other disagree must be in doubt. Returns how many there are.
std::size_t expectDoubtWhereTheyDiffer(const OracleScene& scene, const Tolerance& tolerance, std::mt19937& random) {
    const oracle::OraclePair pair = scene.pair();
    const std::vector<OracleFragment> mine = oracleSurvivors(pair).value();
    const std::vector<OracleFragment> others = otherSurvivors(pair, tolerance, random);
    std::vector<OracleFragment> differing;
    std::set_symmetric_difference(mine.begin(), mine.end(), others.begin(), others.end(),
                                  std::back_inserter(differing));
    const std::vector<Evidence> found = oracleEvidence(pair, differing, tolerance).value();
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Evidence& e = found[i];
        EXPECT_NE(e.doubt, Doubt::None) << "triangle " << differing[i].triangle << ", pixel " << differing[i].x << ", "
                                        << differing[i].y << ", edge " << e.edgeDistance * 256 << "/256, domain "
                                        << e.domainDistance << ", opacity " << e.opacityLow << " < " << e.opacity
                                        << " < " << e.opacityHigh << ", threshold " << scene.threshold
                                        << (e.covered ? ", covered" : "") << (e.survives ? ", survives" : "");
    }
    return differing.size();
}

TEST(OracleEvidence, AnotherHonestRasteriserDiffersOnlyInDoubt) {
    std::mt19937 random(testSeed(31337));
    const Tolerance tolerances[] = {{1.5 / 256, 0, 0}, {}, {6.0 / 256, 1.0 / 64, 1}};
    std::size_t differing[3] = {};
    for (int round = 0; round < 60; ++round) {
        const OracleScene scene = awkwardScene(random, 200, 100);
        for (std::size_t i = 0; i < 3; ++i) {
            differing[i] += expectDoubtWhereTheyDiffer(scene, tolerances[i], random);
            ASSERT_FALSE(HasFailure()) << "round " << round << ", tolerance " << i;
        }
    }
    std::printf("awkward triangles: %zu, %zu, %zu fragments differ\n", differing[0], differing[1], differing[2]);
    EXPECT_GT(differing[1], 100U) << "nothing was tested";
}

TEST(OracleEvidence, TrianglesNearlyInAClippingPlane) {
    std::mt19937 random(testSeed(99));
    OracleScene scene;
    scene.volume = makeUnitImage(2, [](auto, auto, auto) { return 255; });
    std::size_t differing = 0;
    for (int round = 0; round < 40; ++round) {
        // Depths of the order of their rounding, seen through a turned object space.
        scene.world_from_object = randomPose(random, {0.1, 0.2, 0.3});
        const Mat4 object_from_world = inverse(scene.world_from_object).value();
        const auto corner = [&](double x, double y) {
            return transformPoint(object_from_world, {x, y, 0.5 + uniform(random, -2e-6, 2e-6)});
        };
        scene.mesh = {};
        addRectangle(scene.mesh, corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
        scene.view = squareView(0, 1, 64, 64);
        scene.view.clip_from_world[10] = random() % 2 == 0 ? 1 : 2;
        scene.view.clip_from_world[14] = scene.view.clip_from_world[10] < 2 ? -0.5 : 0;
        differing += expectDoubtWhereTheyDiffer(scene, {}, random);
    }
    EXPECT_GT(differing, 100U) << "nothing was tested";
}

/// The share of the fragments in the domain that are in doubt, covered by the oracle or not.
struct Shares {
    std::size_t fragments = 0;
    std::size_t doubts[4] = {};
    void add(const OracleScene& scene, const Tolerance& tolerance) {
        OracleScene opaque = scene;
        opaque.points = {{0, 1}};
        const std::vector<OracleFragment> all = oracleSurvivors(opaque.pair()).value();
        const std::vector<Evidence> found = oracleEvidence(scene.pair(), all, tolerance).value();
        fragments += found.size();
        for (const Evidence& one : found) {
            ++doubts[static_cast<std::size_t>(one.doubt)];
        }
    }
    [[nodiscard]] double percent(Doubt doubt) const {
        return 100.0 * static_cast<double>(doubts[static_cast<std::size_t>(doubt)]) / static_cast<double>(fragments);
    }
    double print(const char* what) const {
        const double all = percent(Doubt::Coverage) + percent(Doubt::Coordinate) + percent(Doubt::Opacity);
        std::printf("%s: of %zu fragments in doubt %.4f %% (coverage %.4f, coordinate %.4f, opacity %.4f)\n", what,
                    fragments, all, percent(Doubt::Coverage), percent(Doubt::Coordinate), percent(Doubt::Opacity));
        return all;
    }
};

TEST(OracleEvidence, DoubtIsRareOnBuiltIns) {
    std::mt19937 random(testSeed(2718));
    Shares hardware;
    Shares hardware8;
    Shares exact;
    std::size_t differing = 0;
    for (const char* volume : {"head:64", "sphere:48", "noise:48", "ct:48", "shells:48"}) {
        for (int round = 0; round < 8; ++round) {
            const OracleScene scene = randomScene(random, volume);
            differing += expectDoubtWhereTheyDiffer(scene, {}, random);
            hardware.add(scene, {});
            exact.add(scene, kNearZero);
            if (scene.volume.type == ScalarType::UInt8) {
                hardware8.add(scene, {1.5 / 256, 1.0 / 256, 1});
            }
        }
    }
    std::printf("%zu fragments differ\n", differing);
    EXPECT_LT(hardware.print("1.5/256 pixel, 1/256 voxel"), 3);
    EXPECT_LT(hardware8.print("and 8-bit filtering"), 8);
    EXPECT_LT(exact.print("near zero"), 0.1);
}

} // namespace
} // namespace voxtact::test
