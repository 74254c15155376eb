// SPDX-License-Identifier: MIT
// The oracle of overlaps, and the scenes that are known beforehand, held against each other.
#include "cpu/overlap/known_scenes.h"
#include "cpu/overlap/solids.h"
#include "oracle/overlap_oracle.h"
#include "support/scenes.h"
#include "support/take.h"

#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

namespace voxtact::test {
namespace {

using oracle::OracleOverlap;

void expectHolds(const Bounds& bounds, double wanted, double slack) {
    EXPECT_LE(bounds.lower, wanted + slack);
    EXPECT_GE(bounds.upper, wanted - slack);
}

TEST(OverlapJudge, HoldsWhatIsKnown) {
    std::mt19937_64 random(testSeed());
    double sharpest = 1;
    for (int round = 0; round < 5; ++round) {
        for (const auto make : {halfSpaceScene, boxScene, saddleScene, lensScene}) {
            const KnownScene known = make(random);
            SCOPED_TRACE(known.name + " " + std::to_string(round));
            const OracleOverlap coarse = take(oracle::overlapOracle(known.scene.pair(), {}, nullptr, 1000));
            const OracleOverlap fine = take(oracle::overlapOracle(known.scene.pair()));
            const Bounds solid = take(oracle::solidOracle(known.scene.pair(), 5000));
            expectHolds(coarse.inside, known.wanted, known.slack);
            expectHolds(fine.inside, known.wanted, known.slack);
            expectHolds(solid, std::abs(signedVolume(known.scene.mesh, known.scene.world_from_object)), known.slack);
            EXPECT_LE(fine.inside.upper, fine.solid.upper);
            EXPECT_LE(fine.solid.lower, solid.upper + 1e-9 * solid.upper);
            EXPECT_LE(fine.inside.upper - fine.inside.lower, coarse.inside.upper - coarse.inside.lower + 1e-9);
            if (fine.inside.lower > 0) {
                sharpest = std::min(sharpest, (fine.inside.upper - fine.inside.lower) / fine.inside.upper);
            }
        }
    }
    std::cout << "known to " << sharpest << " of it at best\n";
    EXPECT_LT(sharpest, 0.3);
}

TEST(OverlapJudge, KnowsLabelsAndBandsAndWhatIsOutside) {
    Grid grid;
    grid.size = {8, 8, 8};
    OracleScene scene;
    scene.volume = linearImage(grid, {10, 0, 0}, 0);
    scene.points = opaqueFrom(40);
    scene.mesh = solidBox({1, 1, 1}, {6, 5, 3});
    const LabelData labels = take(makeLabels(makeBytes(grid, [](auto, auto y, auto) { return y < 3 ? 5 : 0; }).view()));
    const Overlap question{.bandLimits = {20, 70}, .labels = {5, 3}};
    const OracleOverlap found = take(oracle::overlapOracle(scene.pair(), question, &labels, 1U << 21U));
    const auto near = [](const Bounds& bounds, double wanted, double tolerance = 5) {
        expectHolds(bounds, wanted, 1e-9);
        EXPECT_LE(bounds.upper - bounds.lower, tolerance);
    };
    near(found.inside, 2 * 4 * 2);
    near(found.outside, 3.5 * 8 * 8 - 16, 70);
    near(found.solid, 5 * 4 * 2);
    ASSERT_EQ(found.bands.size(), 3U);
    near(found.bands[0], 1 * 4 * 2);
    near(found.bands[1], 4 * 4 * 2);
    EXPECT_EQ(found.bands[2].upper, 0);
    ASSERT_EQ(found.labels.size(), 2U);
    near(found.labels[0].inside, 2 * 1.5 * 2);
    near(found.labels[0].outside, 3.5 * 3 * 8 - 6, 30);
    EXPECT_EQ(found.labels[1].inside.upper, 0);
    EXPECT_EQ(found.labels[1].outside.upper, 0);
}

TEST(OverlapJudge, CountsWindings) {
    OracleScene scene;
    Grid grid;
    grid.size = {4, 4, 4};
    scene.volume = makeBytes(grid, [](auto...) { return 1; });
    const MeshData box = solidBox({-1, -1, -1}, {1, 1, 1});
    const MeshData ball = solidBall(3, 2);
    const auto solid = [&](const MeshData& mesh) {
        scene.mesh = mesh;
        return take(oracle::solidOracle(scene.pair()));
    };
    expectHolds(solid(reversed(box)), 8, 0);
    expectHolds(solid(joined(box, ball)), signedVolume(ball), 0);
    expectHolds(solid(joined(reversed(box), ball)), signedVolume(ball) - 8, 0);
    EXPECT_LT(solid(joined(box, reversed(box))).upper, 3);
    scene.mesh.indices.resize(33);
    EXPECT_NE(oracle::overlapOracle(scene.pair()).error().text.find("not closed"), std::string::npos);
}

TEST(OverlapJudge, KnowsSolids) {
    EXPECT_NEAR(signedVolume(solidBox({0, 0, 0}, {1, 2, 3})), 6, 1e-12);
    EXPECT_NEAR(signedVolume(solidPrism(4, 1, 3)), 6, 1e-12);
    EXPECT_NEAR(signedVolume(solidBall(3, 5)), 36 * std::numbers::pi, 0.2);
    EXPECT_NEAR(signedVolume(reversed(unshared(solidBall(3, 5)))), -36 * std::numbers::pi, 0.2);
    EXPECT_NEAR(signedVolumeAbove(solidBox({0, 0, 0}, {1, 2, 3}), identity(), {0, 0, 1}, -1), 4, 1e-12);
    EXPECT_NEAR(signedVolumeAbove(solidBox({0, 0, 0}, {1, 1, 1}), identity(), {-1, -1, -1}, 1), 1.0 / 6, 1e-12);
    EXPECT_NEAR(signedVolumeAbove(solidBox({0, 0, 0}, {1, 1, 1}), identity(), {1, 1, 1}, -1.5), 0.5, 1e-12);
    EXPECT_NEAR(lensVolume(1, 1, 1), 5 * std::numbers::pi / 12, 1e-12);
    EXPECT_NEAR(lensVolume(1, 3, 1), 4 * std::numbers::pi / 3, 1e-12);
    EXPECT_EQ(lensVolume(1, 3, 4), 0);
}

} // namespace
} // namespace voxtact::test
