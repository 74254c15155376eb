// SPDX-License-Identifier: MIT
// Triangles that stand for a curved surface: no holds for all that is within the deflection.
#include "cpu/scenes/held_scene.h"
#include "support/take.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

/// Opaque from z = 10 on; the mesh is a rectangle below.
class DeflectionTest : public testing::Test {
  protected:
    DeflectionTest() {
        Grid grid;
        grid.size = {16, 16, 16};
        scene_.volume = makeVolume<float>(grid, ScalarType::Float32, [](auto, auto, auto z) { return z - 10.0; });
        scene_.points = {{0, 0}, {0, 1}};
        scene_.threshold = 1;
    }
    Verdict touch(double gap, double deflection, Touch question = {}, double scale = 1) {
        scene_.mesh = makeFlat(2 / scale, 12 / scale, 2 / scale, 12 / scale, (10 - gap) / scale);
        scene_.mesh.deflection = deflection / scale;
        scene_.world_from_object[0] = scene_.world_from_object[5] = scene_.world_from_object[10] = scale;
        const HeldScene held(scene_);
        const Verdict plain = take(engine_.ask(question, held.batch)).pairs[0].touch;
        question.witness = !question.uncertainty;
        EXPECT_EQ(take(engine_.ask(question, held.batch)).pairs[0].touch, plain);
        return plain;
    }

    OracleScene scene_;
    cpu::HostEngine engine_ = take(cpu::HostEngine::create(1));
};

TEST_F(DeflectionTest, LeavesWhatIsWithinItUndecided) {
    EXPECT_EQ(touch(0.3, 0), Verdict::No);
    EXPECT_EQ(touch(0.3, 0.29), Verdict::No);
    EXPECT_EQ(touch(0.3, 0.31), Verdict::Undecided);
    EXPECT_EQ(touch(-0.1, 0.31), Verdict::Yes);
}

TEST_F(DeflectionTest, AddsToMarginAndUncertainty) {
    EXPECT_EQ(touch(0.9, 0.5, {.margin = 1}), Verdict::Yes);
    EXPECT_EQ(touch(1.4, 0.5, {.margin = 1}), Verdict::Undecided);
    EXPECT_EQ(touch(1.6, 0.5, {.margin = 1}), Verdict::No);
    EXPECT_EQ(touch(0.9, 0.5, {.uncertainty = PoseTolerance{1, 0}}), Verdict::Yes);
    EXPECT_EQ(touch(1.4, 0.5, {.uncertainty = PoseTolerance{1, 0}}), Verdict::Undecided);
    EXPECT_EQ(touch(1.6, 0.5, {.uncertainty = PoseTolerance{1, 0}}), Verdict::No);
}

TEST_F(DeflectionTest, IsScaledByThePose) {
    for (const double scale : {0.25, 1.0, 3.0}) {
        EXPECT_EQ(touch(0.3, 0.29, {}, scale), Verdict::No) << scale;
        EXPECT_EQ(touch(0.3, 0.31, {}, scale), Verdict::Undecided) << scale;
    }
}

TEST_F(DeflectionTest, StaysWhenTheMeshBends) {
    const MeshData flat = makeFlat(2, 12, 2, 12, 9);
    cpu::Mesh mesh = take(cpu::Mesh::create({flat.positions, flat.indices, 0.4}));
    take(mesh.update(makeFlat(2, 12, 2, 12, 9.7).positions));
    EXPECT_EQ(mesh.facts().deflection, 0.4);
    EXPECT_FALSE(cpu::Mesh::create({flat.positions, flat.indices, -0.1}).ok());
}

} // namespace
} // namespace voxtact::test
