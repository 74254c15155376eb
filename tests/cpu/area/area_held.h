// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/clearance/held.h"
#include "cpu/scenes/oracle_scenes.h"
#include "support/contact_scenes.h"
#include "support/host_meters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

/// What the tests of an AreaMeter measure.
namespace voxtact::test {

inline std::vector<PairArea> areas(const Held& held, std::span<const Mat4> poses, const cpu::AreaDesc& desc = {},
                                   double threshold = 0.5) {
    cpu::AreaMeter meter = take(cpu::AreaMeter::create(desc));
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, poses};
    return take(meter.measure({std::span(&item, 1), {}, threshold})).pairs;
}

inline PairArea area(const Held& held, const cpu::AreaDesc& desc = {}, double threshold = 0.5,
                     const Mat4& pose = identity()) {
    return areas(held, std::span(&pose, 1), desc, threshold).at(0);
}

/// It is between the bounds, and these are as near to each other as was asked for.
inline void expectArea(double wanted, const PairArea& found, double tolerance = 1e-6) {
    EXPECT_LE(found.bounds.lower, wanted + 1e-9 * (1 + wanted));
    EXPECT_GE(found.bounds.upper, wanted - 1e-9 * (1 + wanted));
    EXPECT_LE(found.bounds.upper - found.bounds.lower, tolerance);
    EXPECT_EQ(found.end, StopReason::Closed);
}

/// Of all triangles at a pose, mm^2.
inline double surfaceOf(const MeshData& mesh, const Mat4& pose = identity()) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<Vec3, 3> t{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const double* at = &mesh.positions[std::size_t{3} * mesh.indices[i + corner]];
            t[corner] = transformPoint(pose, {at[0], at[1], at[2]});
        }
        const Vec3 a{t[1][0] - t[0][0], t[1][1] - t[0][1], t[1][2] - t[0][2]};
        const Vec3 b{t[2][0] - t[0][0], t[2][1] - t[0][1], t[2][2] - t[0][2]};
        sum += std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return sum;
}

/// 32 voxels a side of 1 mm, the first at the origin, whose value is 8 times x.
inline VolumeData valueRamp() {
    Grid grid;
    grid.size = {32, 32, 32};
    return makeBytes(grid, [](auto x, auto, auto) { return 8.0 * x; });
}

/// Of a table of 256 entries, entry i is at the value i.
inline constexpr ValueRange kEntries{-0.5, 255.5};

} // namespace voxtact::test
