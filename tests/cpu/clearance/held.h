// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

/// What the tests of a ClearanceMeter measure.
namespace voxtact::test {

/// A mesh, a volume and a transfer function of the engine.
struct Held {
    Held(const MeshData& data, const VolumeData& image, std::span<const ControlPoint> points, const ValueRange& domain,
         std::uint32_t entries = 256)
        : mesh(take(cpu::Mesh::create(data.view()))), volume(take(cpu::Volume::create(image.view()))),
          function(take(cpu::TransferFunction::create({points, domain, entries}))) {}

    [[nodiscard]] std::vector<PairDistance> measure(std::span<const Mat4> poses, const cpu::ClearanceDesc& desc = {},
                                                    double threshold = 0.5) const {
        cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create(desc));
        const cpu::BatchItem item{&mesh, &volume, &function, poses};
        return take(meter.measure({std::span(&item, 1), {}, threshold})).pairs;
    }
    [[nodiscard]] PairDistance measure(const Mat4& pose, const cpu::ClearanceDesc& desc = {},
                                       double threshold = 0.5) const {
        return measure(std::span(&pose, 1), desc, threshold).at(0);
    }

    cpu::Mesh mesh;
    cpu::Volume volume;
    cpu::TransferFunction function;
};

inline void expectAbout(double wanted, const PairDistance& found, double slack = 1e-5) {
    EXPECT_LE(found.bounds.lower, wanted + slack);
    EXPECT_GE(found.bounds.upper, wanted - slack);
    EXPECT_LE(found.bounds.upper - found.bounds.lower, kDefaultTolerance);
    EXPECT_EQ(found.end, StopReason::Closed);
}

inline MeshData oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    MeshData mesh;
    addTriangle(mesh, a, b, c);
    return mesh;
}

/// The tip at the object's origin, the rest behind it along +x.
inline MeshData needle() {
    return oneTriangle({0, 0, 0}, {5, 0.5, 0}, {5, 0, 0.5});
}

} // namespace voxtact::test
