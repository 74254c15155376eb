// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/held_scene.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cstdint>

/// What the tests of an OverlapMeter measure.
namespace voxtact::test {

inline OverlapAnswer overlaps(const OracleScene& scene, const Overlap& question = {}, const LabelData* labels = nullptr,
                              std::uint32_t threads = 1) {
    cpu::OverlapMeter meter = take(cpu::OverlapMeter::create({.threads = threads}));
    HeldScene held(scene);
    held.item.labels = labels;
    return take(meter.measure(question, held.batch));
}

inline PairOverlap overlap(const OracleScene& scene, double tolerance = 1e-3) {
    return overlaps(scene, {.tolerance = tolerance}).pairs.at(0);
}

/// It is between the bounds, up to `slack`, and these are as near to each other as was asked for.
inline void expectVolume(double wanted, const Bounds& found, double tolerance = 1e-3, double slack = 1e-9) {
    EXPECT_LE(found.lower, wanted + slack);
    EXPECT_GE(found.upper, wanted - slack);
    EXPECT_GE(found.lower, 0);
    EXPECT_LE(found.upper - found.lower, tolerance);
}

/// An image that is opaque all over, of 1 mm a voxel, the first at the origin.
[[nodiscard]] OracleScene opaqueScene(const MeshData& mesh, std::uint32_t side = 20);

} // namespace voxtact::test
