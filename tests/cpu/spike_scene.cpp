// SPDX-License-Identifier: MIT
#include "spike_scene.h"

#include "support/scenes.h"

namespace voxtact::test {

SpikeScene spikeScene(bool falling, int turn) {
    constexpr double kStep = 4000; // from voxel to voxel
    constexpr double kEntry = 17;  // from entry to entry, a 235th of that
    SpikeScene out;
    OracleScene& scene = out.scene;
    Grid grid; // voxel space is world space
    grid.size = {8, 8, 8};
    scene.volume = makeVolume<std::int16_t>(grid, ScalarType::Int16,
                                            [&](auto x, auto, auto) { return -15000 + kStep * (falling ? 7 - x : x); });
    scene.tableSize = 4096;
    scene.domain = {-32768, -32768 + kEntry * scene.tableSize};
    out.value = scene.domain.lo + 1234.5 * kEntry;
    scene.points = {{out.value - 0.9 * kEntry, 0}, {out.value, 1}, {out.value + 0.9 * kEntry, 0}};
    scene.threshold = 0.999;
    const double rise = (out.value + 15000) / kStep;
    out.place = falling ? 7 - rise : rise;
    const Vec3 corners[] = {{0.1, 1.1, 2.3}, {6.9, 3.2, 3.4}, {3.3, 5.9, 4.5}};
    const auto corner = [&](int i) { return corners[(i + turn) % 3]; };
    addTriangle(scene.mesh, corner(0), corner(1), corner(2));
    return out;
}

} // namespace voxtact::test
