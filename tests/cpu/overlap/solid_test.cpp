// SPDX-License-Identifier: MIT
// Touches and distances of solids: what a closed mesh encloses counts.
#include "cpu/overlap/overlap_held.h"
#include "cpu/overlap/solids.h"

#include <gmock/gmock.h>

#include <cmath>

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

} // namespace
} // namespace voxtact::test
