// SPDX-License-Identifier: MIT
#include "cpu/scenes/spike_scene.h"

#include "support/scenes.h"

namespace voxtact::test {

SpikeScene spikeScene(ScalarType type, bool falling, int turn) {
    // In steps of 4000 for int16, from voxel to voxel; uint8 is the same at a 200th, so that 12 voxels fit.
    const double unit = type == ScalarType::Int16 ? 200 : 1;
    const double least = type == ScalarType::Int16 ? -15000 : 10;
    const double step = 20 * unit;
    const double entry = 0.085 * unit; // of the table: a 235th of a voxel
    SpikeScene out;
    OracleScene& scene = out.scene;
    Grid grid; // voxel space is world space
    grid.size = {12, 12, 12};
    const auto value = [&](auto x, auto, auto) { return least + step * (falling ? 11 - x : x); };
    scene.volume = type == ScalarType::Int16 ? makeVolume<std::int16_t>(grid, type, value)
                                             : makeVolume<std::uint8_t>(grid, ScalarType::UInt8, value);
    scene.tableSize = 4096;
    scene.domain = {least - 89 * unit, least - 89 * unit + entry * scene.tableSize};
    out.value = scene.domain.lo + 1400.5 * entry;
    scene.points = {{out.value - 0.9 * entry, 0}, {out.value, 1}, {out.value + 0.9 * entry, 0}};
    scene.threshold = 0.999;
    const double rise = (out.value - least) / step;
    out.place = falling ? 11 - rise : rise;
    const Vec3 corners[] = {{0.1, 1.1, 2.3}, {10.9, 3.2, 3.4}, {5.3, 9.9, 4.5}};
    const auto corner = [&](int i) { return corners[(i + turn) % 3]; };
    addTriangle(scene.mesh, corner(0), corner(1), corner(2));
    return out;
}

} // namespace voxtact::test
