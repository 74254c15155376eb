// SPDX-License-Identifier: MIT
// Touches and distances of solids: what a closed mesh encloses counts.
#include "cpu/overlap/known_scenes.h"
#include "cpu/overlap/overlap_held.h"
#include "cpu/overlap/solids.h"
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/overlap_oracle.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

/// A ball of radius 5 at (10, 9, 9) in air.
OracleScene ballScene() {
    Grid grid;
    grid.size = {20, 20, 20};
    OracleScene scene;
    scene.volume = makeVolume<float>(grid, ScalarType::Float32,
                                     [](auto x, auto y, auto z) { return 5 - std::hypot(x - 10.0, y - 9.0, z - 9.0); });
    scene.points = {{0, 0}, {0, 1}};
    scene.threshold = 1;
    return scene;
}

class Solids : public testing::Test {
  protected:
    Verdict touch(const MeshData& mesh, bool solid, double margin = 0) {
        scene_.mesh = mesh;
        const HeldScene held(scene_);
        return take(engine_.ask(Touch{.margin = margin, .witness = true, .solid = solid}, held.batch)).pairs[0].touch;
    }
    Bounds distance(const MeshData& mesh, bool solid) {
        scene_.mesh = mesh;
        const HeldScene held(scene_);
        return take(engine_.ask(Distance{.tolerance = 1e-3, .solid = solid}, held.batch)).pairs[0].bounds;
    }
    static MeshData ball(double x, double radius) { return transformed(solidBall(radius, 3), translation({x, 9, 9})); }

    OracleScene scene_ = ballScene();
    cpu::HostEngine engine_ = take(cpu::HostEngine::create(1));
};

TEST_F(Solids, TouchWhatTheyEnclose) {
    const MeshData around = ball(10, 8);
    EXPECT_EQ(touch(around, false), Verdict::No);
    EXPECT_EQ(touch(around, true), Verdict::Yes);
    EXPECT_EQ(touch(around, false, 1), Verdict::No);
    EXPECT_EQ(touch(around, true, 1), Verdict::Yes);
    const Bounds ofSurface = distance(around, false);
    EXPECT_GT(ofSurface.lower, 2);
    EXPECT_LT(ofSurface.upper, 3.1);
    const Bounds ofSolid = distance(around, true);
    EXPECT_EQ(ofSolid.lower, 0);
    EXPECT_EQ(ofSolid.upper, 0);
    // A cavity is outside, and what is in a ball within it is inside again.
    EXPECT_EQ(touch(joined(joined(ball(10, 9), reversed(ball(10, 8))), ball(10, 7)), true), Verdict::Yes);
}

TEST_F(Solids, AreTheirSurfaceWhereTheyEncloseNothing) {
    EXPECT_EQ(touch(ball(16, 2), false), Verdict::Yes);
    EXPECT_EQ(touch(ball(16, 2), true), Verdict::Yes);
    const MeshData beside = ball(30, 3);
    EXPECT_EQ(touch(beside, true), Verdict::No);
    EXPECT_EQ(distance(beside, true).lower, distance(beside, false).lower);
    // A cavity is outside.
    EXPECT_EQ(touch(joined(ball(10, 9), reversed(ball(10, 7))), true), Verdict::No);
}

TEST_F(Solids, NeedAnInside) {
    MeshData open = ball(10, 8);
    open.indices.resize(open.indices.size() - 3);
    scene_.mesh = open;
    const HeldScene held(scene_);
    EXPECT_THAT(engine_.ask(Touch{.solid = true}, held.batch).error().text, testing::HasSubstr("1 hole"));
    EXPECT_THAT(engine_.ask(Distance{.solid = true}, held.batch).error().text, testing::HasSubstr("1 hole"));
    EXPECT_TRUE(engine_.ask(Touch{}, held.batch).ok());
}

/// A few bright voxels in air, and a solid about one of them that may be as small as part of a voxel.
OracleScene brightScene(std::mt19937_64& random) {
    OracleScene scene;
    const Grid grid = randomSmallGrid(random);
    std::vector<std::array<std::uint32_t, 3>> bright;
    for (std::size_t i = 1 + below(random, 4); i > 0; --i) {
        auto& voxel = bright.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxel[axis] = static_cast<std::uint32_t>(below(random, grid.size[axis]));
        }
    }
    scene.volume = makeVolume<std::int16_t>(grid, ScalarType::Int16, [&](auto x, auto y, auto z) {
        return std::ranges::find(bright, std::array{x, y, z}) != bright.end() ? 1000 : -3;
    });
    const double from = uniform(random, 20, 995);
    scene.points = opaqueFrom(from);
    if (chance(random, 0.3)) { // a shell
        scene.points = {{from - 1, 0}, {from, 1}, {from + uniform(random, 0, 900), 1}, {from + 901, 0}};
    }
    const double voxel = *std::ranges::min_element(grid.spacing);
    const double size = voxel * (1 - from / 1003) * std::pow(10, uniform(random, -0.5, 1.2));
    scene.mesh = chance(random, 0.5) ? randomSolid(random, size)
                                     : solidPrism(static_cast<std::uint32_t>(3 + below(random, 5)), size, 2 * size,
                                                  chance(random, 0.5));
    const auto& at = bright.front();
    Vec3 place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = at[axis] + uniform(random, -0.2, 0.2) * static_cast<double>(below(random, 2));
    }
    scene.world_from_object =
        multiply(translation(transformPoint(worldFromIndex(grid), place)), randomRotation(random));
    return scene;
}

/// Counts of a run.
struct EnclosedTally {
    std::size_t enclosed = 0;
    std::size_t beside = 0;    ///< neither the surface nor the inside touches
    std::size_t undecided = 0; ///< the inside
    std::size_t hidden = 0;    ///< enclosed, without a witness point
};

void judgeSolid(cpu::HostEngine& engine, const OracleScene& scene, EnclosedTally& tally) {
    const HeldScene held(scene);
    const Verdict surface = take(engine.ask(Touch{}, held.batch)).pairs.at(0).touch;
    const PairTouch solid = take(engine.ask(Touch{.witness = true, .solid = true}, held.batch)).pairs.at(0);
    const PairDistance near = take(engine.ask(Distance{.tolerance = 1e-3, .solid = true}, held.batch)).pairs.at(0);
    if (surface != Verdict::No) {
        EXPECT_TRUE(solid.touch == surface || surface == Verdict::Undecided);
        return;
    }
    const oracle::OracleOverlap truth = take(oracle::overlapOracle(scene.pair(), {}, nullptr, 4000));
    if (solid.touch == Verdict::No) {
        EXPECT_EQ(truth.inside.lower, 0);
        EXPECT_GT(near.bounds.lower, 0);
        ++tally.beside;
    } else if (solid.touch == Verdict::Undecided) {
        EXPECT_EQ(near.bounds.lower, 0);
        ++tally.undecided;
    } else {
        EXPECT_GT(truth.inside.upper, 0);
        EXPECT_EQ(near.bounds.lower, 0);
        EXPECT_EQ(near.bounds.upper, 0);
        EXPECT_EQ(solid.witness.has_value(), near.closest.has_value());
        ++tally.enclosed;
        if (!solid.witness) {
            ++tally.hidden;
            return;
        }
        const Vec3& point = solid.witness->position;
        EXPECT_EQ(solid.witness->triangle, kInsideMesh);
        EXPECT_EQ(near.closest->mesh, point);
        EXPECT_EQ(near.closest->volume, point);
        EXPECT_NE(windingNumber(scene.mesh, scene.world_from_object, point), 0);
        const double value =
            valueAt(scene.volume, transformPoint(take(inverse(worldFromIndex(scene.volume.grid))), point));
        EXPECT_GE(std::max(opacityOfValue(scene.points, value - 1e-6), opacityOfValue(scene.points, value + 1e-6)),
                  scene.threshold)
            << value;
    }
}

TEST_F(Solids, HaveAWitnessPointInside) {
    std::mt19937_64 random(testSeed());
    EnclosedTally tally;
    const std::size_t cases = randomCases(40000, 100);
    for (std::size_t number = 0; number < cases && !HasFailure(); ++number) {
        SCOPED_TRACE(number);
        judgeSolid(engine_, brightScene(random), tally);
    }
    std::cout << tally.enclosed << " enclosed, " << tally.beside << " beside, " << tally.undecided << " undecided, "
              << tally.hidden << " hidden\n";
    EXPECT_GT(tally.enclosed, cases / 20);
    EXPECT_GT(tally.beside, cases / 50);
    EXPECT_LE(tally.undecided, cases / 8);
    EXPECT_EQ(tally.hidden, 0U);
}

} // namespace
} // namespace voxtact::test
