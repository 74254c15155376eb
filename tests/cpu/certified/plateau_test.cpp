// SPDX-License-Identifier: MIT
// Certified answers are about the control points: no table rounds them, and voxels that have the very value of an end
// are opaque.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

namespace voxtact::test {
namespace {

constexpr std::uint32_t kSide = 27;

/// 1 from voxel 9 to voxel 17 along each axis, and 0 elsewhere: `scale` times that, and `offset` more.
VolumeData maskOf(ScalarType type, float scale = 1, float offset = 0) {
    Grid grid;
    grid.size = {kSide, kSide, kSide};
    VolumeData bytes = makeBytes(grid, [](auto x, auto y, auto z) {
        const auto isIn = [](auto at) { return at >= 9 && at <= 17; };
        return isIn(x) && isIn(y) && isIn(z) ? 1.0 : 0.0;
    });
    if (type == ScalarType::UInt8) {
        return bytes;
    }
    VolumeData out{grid, type, std::vector<std::byte>(bytes.voxels.size() * sizeof(float)), "mask", {}};
    for (std::size_t i = 0; i < bytes.voxels.size(); ++i) {
        const float value = offset + scale * static_cast<float>(bytes.voxels[i]);
        std::memcpy(out.voxels.data() + i * sizeof value, &value, sizeof value);
    }
    return out;
}

struct Says {
    PairAnswer pair;
    PairDistance clearance;
    Bounds area;
};

/// Of a triangle at height z, tilted a little, in the middle of the image.
Says ask(const VolumeData& image, const std::vector<ControlPoint>& points, double threshold, double z,
         bool stopAtFirst) {
    MeshData data;
    addTriangle(data, {10.2, 10.3, z}, {16.1, 11.2, z + 0.1}, {12.4, 15.9, z + 0.2});
    const cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
    const cpu::Volume volume = take(cpu::Volume::create(image.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({points}));
    cpu::DetectorDesc desc;
    desc.projection = Projection::Certified;
    desc.stopAtFirst = stopAtFirst;
    cpu::Detector detector = take(cpu::Detector::create(desc));
    const Mat4 pose = identity();
    const cpu::BatchItem item{&mesh, &volume, &function, {&pose, 1}};
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    cpu::AreaMeter areas = take(cpu::AreaMeter::create({.threads = 1}));
    return {take(detector.detect({{&item, 1}, {}, threshold})).pairs.at(0),
            take(meter.measure({{&item, 1}, {}, threshold})).pairs.at(0),
            take(areas.measure({{&item, 1}, {}, threshold})).pairs.at(0).bounds};
}

void expectMask(const VolumeData& image, const std::vector<ControlPoint>& points, double threshold,
                const std::string& what) {
    SCOPED_TRACE(what);
    for (const bool stopAtFirst : {false, true}) {
        const Says inside = ask(image, points, threshold, 16.4, stopAtFirst);
        EXPECT_TRUE(inside.pair.hit);
        EXPECT_FALSE(inside.pair.possible);
        EXPECT_GT(inside.area.lower, 15);
        EXPECT_NEAR(inside.area.lower, inside.area.upper, 1e-6) << "of a triangle that is inside";
        const Says outside = ask(image, points, threshold, 17.25, stopAtFirst);
        EXPECT_FALSE(outside.pair.hit || outside.pair.possible) << "between 1 and 0";
        EXPECT_NEAR(outside.clearance.bounds.lower, 0.25, 0.011);
        EXPECT_NEAR(outside.clearance.bounds.upper, 0.25, 0.011);
        ASSERT_TRUE(outside.clearance.closest);
        EXPECT_LE(outside.clearance.closest->volume[2], 17 + 1e-5);
    }
}

TEST(Plateaus, OfVoxelsThatHaveTheVeryValueAreOpaque) {
    expectMask(maskOf(ScalarType::UInt8), {{1, 0}, {1, 1}}, 0.5, "bytes, a step");
    expectMask(maskOf(ScalarType::UInt8), {{0, 0}, {1, 1}}, 1, "bytes, a ramp to its end");
    expectMask(maskOf(ScalarType::UInt8), {{1, 0}, {1, 1}, {1, 0}}, 0.5, "bytes, one value");
    expectMask(maskOf(ScalarType::Float32), {{1, 0}, {1, 1}}, 0.5, "floats");
    expectMask(maskOf(ScalarType::Float32, 2e38F, -1e38F),
               {{static_cast<double>(1e38F), 0}, {static_cast<double>(1e38F), 1}}, 0.5, "large floats");
    expectMask(maskOf(ScalarType::Float32, 0.125F, 1e6F), {{1e6, 0}, {1e6 + 0.125, 1}}, 1, "floats far from zero");
    expectMask(maskOf(ScalarType::UInt8), {{-1e30, 0}, {0.999999, 0}, {0.999999, 0.1}}, 0.1, "just below");
}

/// A table of 256 entries over the values of a CT is 16 values coarse.
TEST(Plateaus, AThresholdIsWhereThePointsHaveIt) {
    Grid grid;
    grid.size = {9, 9, 9};
    VolumeData image{grid, ScalarType::Float32, std::vector<std::byte>(9 * 9 * 9 * sizeof(float)), "ramp", {}};
    for (std::size_t i = 0; i < 9 * 9 * 9; ++i) {
        const float value = i == 0 ? -1024.0F : i == 1 ? 3071.0F : 1100.0F + 4 * (static_cast<float>(i % 9) - 4.0F);
        std::memcpy(image.voxels.data() + i * sizeof value, &value, sizeof value);
    }
    const cpu::Volume volume = take(cpu::Volume::create(image.view()));
    const std::array points{ControlPoint{1099, 0}, ControlPoint{1100, 1}};
    for (const ValueRange& domain : {ValueRange{}, ValueRange{-1024, 3071}, ValueRange{0, 255}}) {
        const cpu::TransferFunction function = take(cpu::TransferFunction::create({points, domain}));
        for (const double x : {3.99, 4.01}) {
            MeshData data;
            addTriangle(data, {x, 3, 3}, {x, 6, 3}, {x, 3, 6});
            const cpu::Mesh mesh = take(cpu::Mesh::create(data.view()));
            cpu::DetectorDesc desc;
            desc.projection = Projection::Certified;
            cpu::Detector detector = take(cpu::Detector::create(desc));
            const Mat4 pose = identity();
            const cpu::BatchItem item{&mesh, &volume, &function, {&pose, 1}};
            const PairAnswer says = take(detector.detect({{&item, 1}, {}, 1})).pairs.at(0);
            EXPECT_EQ(says.hit, x > 4) << x;
            EXPECT_FALSE(says.possible) << x;
        }
    }
}

} // namespace
} // namespace voxtact::test
