// SPDX-License-Identifier: MIT
// Scenes whose count of survivors is known beforehand.
#include "gpu_fixture.h"
#include "support/scenes.h"

#include <cmath>

namespace voxtact::test {
namespace {

class AnalyticTest : public GpuTest {
  protected:
    Volume full() {
        return upload(makeBytes(unitGrid(8), [](auto...) { return 255.0; }));
    }
    Volume empty() {
        return upload(makeBytes(unitGrid(8), [](auto...) { return 0.0; }));
    }
    TransferFunction ramp() { return upload(byteRamp(), kBytes); }
};

TEST_F(AnalyticTest, PlaneThroughHalfOpaqueVolume) {
    const Volume volume = upload(makeBytes(unitGrid(8), [](std::uint32_t x, auto...) { return x < 4 ? 255.0 : 0.0; }));
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    EXPECT_EQ(survivors(plane, volume, ramp(), flatView(0, 1, 64, 64)), 64U * 32U);
    EXPECT_EQ(survivors(plane, volume, ramp(), flatView(0, 1, 128, 32)), 64U * 32U);
}

TEST_F(AnalyticTest, CubeCountsTheFacesThatAreNotEdgeOn) {
    const Mesh cube = upload(makeCube(0.25, 0.75));
    const View view = flatView(0, 1, 64, 64);
    EXPECT_EQ(survivors(cube, full(), ramp(), view), 2U * 32U * 32U);
    EXPECT_EQ(survivors(cube, empty(), ramp(), view), 0U);
}

TEST_F(AnalyticTest, SharedDiagonalsAreCountedOnce) {
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    EXPECT_EQ(survivors(plane, full(), ramp(), flatView(0, 1, 33, 33)), 33U * 33U);
}

TEST_F(AnalyticTest, OneOpaqueVoxelIsATent) {
    // Float voxels are filtered in float by every driver at hand; 8-bit ones are not.
    const Volume volume = upload(
        makeVolume<float>(unitGrid(8), ScalarType::Float32, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            return x == 3 && y == 4 && z == 5 ? 1.0 : 0.0;
        }));
    constexpr ControlPoint kRamp[] = {{0, 0}, {1, 1}};
    const TransferFunction function = upload(kRamp, {0, 1});
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 5.5 / 8));
    constexpr std::uint32_t kSide = 256;
    const auto expected = [](double threshold) {
        std::uint64_t count = 0;
        for (std::uint32_t y = 0; y < kSide; ++y) {
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const double dx = std::abs((x + 0.5) / kSide * 8 - 3.5);
                const double dy = std::abs((y + 0.5) / kSide * 8 - 4.5);
                count += std::max(1 - dx, 0.0) * std::max(1 - dy, 0.0) >= threshold ? 1U : 0U;
            }
        }
        return count;
    };
    // Half a step of weights with 8 fraction bits, along two axes.
    constexpr double kWeightError = 1.0 / 256;
    const std::uint64_t count = survivors(plane, volume, function, flatView(0, 1, kSide, kSide));
    EXPECT_GE(count, expected(0.5 + kWeightError));
    EXPECT_LE(count, expected(0.5 - kWeightError));
    EXPECT_GT(count, 500U);
}

TEST_F(AnalyticTest, OutsideTheTextureDomainNothingSurvives) {
    const Mesh plane = upload(makeFlat(-0.5, 1.5, -0.5, 1.5, 0.5));
    EXPECT_EQ(survivors(plane, full(), ramp(), flatView(-0.5, 1.5, 64, 64)), 32U * 32U);
    const Mesh above = upload(makeFlat(0, 1, 0, 1, 1.0625));
    EXPECT_EQ(survivors(above, full(), ramp(), flatView(0, 1, 64, 64)), 0U);
}

TEST_F(AnalyticTest, EdgeOnTriangleIsInvisibleToTheView) {
    // The paper's limitation (section 4): the triangle is in the middle of an opaque volume.
    const Mesh edgeOn = upload(makeRectangle({0.5, 0.2, 0.2}, {0.5, 0.8, 0.2}, {0.5, 0.8, 0.8}, {0.5, 0.2, 0.8}));
    EXPECT_EQ(survivors(edgeOn, full(), ramp(), flatView(0, 1, 64, 64)), 0U);
    const Mesh tilted = upload(makeRectangle({0.4, 0.2, 0.2}, {0.4, 0.8, 0.2}, {0.6, 0.8, 0.8}, {0.6, 0.2, 0.8}));
    EXPECT_GT(survivors(tilted, full(), ramp(), flatView(0, 1, 64, 64)), 0U);
}

/// An eye at the origin that looks along +z; near and far planes as given.
View perspectiveView(double nearPlane, double farPlane) {
    Mat4 clip_from_world{};
    clip_from_world[0] = 1;
    clip_from_world[5] = 1;
    clip_from_world[10] = farPlane / (farPlane - nearPlane);
    clip_from_world[11] = 1;
    clip_from_world[14] = -farPlane * nearPlane / (farPlane - nearPlane);
    return {clip_from_world, 64, 64};
}

TEST_F(AnalyticTest, PerspectiveCountsTheProjectedArea) {
    Grid grid = unitGrid(8);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        grid.spacing[axis] *= 4;
        grid.origin[axis] = grid.origin[axis] * 4 - 2;
    }
    grid.origin[2] += 1.5; // the volume is [-2,2] x [-2,2] x [1.5,2.5]
    const Volume volume = upload(makeBytes(grid, [](auto...) { return 255.0; }));
    const Mesh plane = upload(makeFlat(-1, 1, -1, 1, 2));
    // At depth 2 the square is half as wide as the view.
    EXPECT_EQ(survivors(plane, volume, ramp(), perspectiveView(0.5, 10)), 32U * 32U);
    EXPECT_EQ(survivors(plane, volume, ramp(), perspectiveView(2.1, 10)), 0U) << "before the near plane";
    EXPECT_EQ(survivors(plane, volume, ramp(), perspectiveView(0.5, 1.9)), 0U) << "beyond the far plane";
    const Mesh behind = upload(makeFlat(-1, 1, -1, 1, -2));
    EXPECT_EQ(survivors(behind, volume, ramp(), perspectiveView(0.5, 10)), 0U) << "behind the eye";
}

TEST_F(AnalyticTest, PerspectiveCoordinatesAreCorrected) {
    // A floor at y=1 from z=1 to z=3: the opaque half is z<2, which fills the picture from y=1/2 to y=1.
    Grid grid = unitGrid(64);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] *= 4;
        grid.origin[axis] = grid.origin[axis] * 4 - 2;
    }
    grid.origin[2] += 2; // z in [0,4]
    const Volume volume = upload(makeBytes(grid, [](auto, auto, std::uint32_t z) { return z < 32 ? 255.0 : 0.0; }));
    const Mesh floor = upload(makeRectangle({-2, 0.99, 1}, {2, 0.99, 1}, {2, 0.99, 3}, {-2, 0.99, 3}));
    const std::uint64_t count = survivors(floor, volume, ramp(), perspectiveView(0.5, 10));
    // Rows whose centre projects from z in [1,2): y = 0.99/z.
    std::uint64_t rows = 0;
    for (int row = 0; row < 64; ++row) {
        const double y = (row + 0.5) / 32 - 1;
        rows += y > 0.99 / 2 && y <= 0.99 ? 1U : 0U;
    }
    EXPECT_EQ(count, rows * 64);
}

TEST_F(AnalyticTest, TriangleThroughTheNearPlaneIsClipped) {
    Grid grid = unitGrid(8);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] *= 8;
        grid.origin[axis] = grid.origin[axis] * 8 - 4;
    }
    const Volume volume = upload(makeBytes(grid, [](auto...) { return 255.0; }));
    // A wall at x=0.5 that comes from behind the eye: what is beyond z=1 fills x from 0 to 0.5 of the picture's half.
    const Mesh wall = upload(makeRectangle({0.5, -3, -3}, {0.5, 3, -3}, {0.5, 3, 3}, {0.5, -3, 3}));
    std::uint64_t expected = 0;
    for (int column = 0; column < 64; ++column) {
        const double x = (column + 0.5) / 32 - 1;
        const double z = x > 0 ? 0.5 / x : 0;
        if (z >= 1 && z <= 3) {
            for (int row = 0; row < 64; ++row) {
                expected += std::abs(((row + 0.5) / 32 - 1) * z) < 3 ? 1U : 0U;
            }
        }
    }
    EXPECT_EQ(survivors(wall, volume, ramp(), perspectiveView(1, 10)), expected);
}

TEST_F(AnalyticTest, ObliqueGridMovesWithItsWorld) {
    // Volume, mesh and camera turned together give what they gave before; the transition is a pixel away from any
    // pixel centre's rounding.
    std::mt19937_64 random(testSeed());
    const VolumeData straight = makeBytes(unitGrid(8), [](std::uint32_t x, auto...) { return x < 4 ? 255.0 : 0.0; });
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    for (int i = 0; i < 10; ++i) {
        const Mat4 world_from_straight =
            multiply(translation({uniform(random, -100, 100), uniform(random, -100, 100), uniform(random, -100, 100)}),
                     randomRotation(random));
        VolumeData turned = straight;
        turned.grid.origin = transformPoint(world_from_straight, straight.grid.origin);
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t r = 0; r < 3; ++r) {
                turned.grid.direction[3 * c + r] = world_from_straight[4 * c + r];
            }
        }
        View view = flatView(-0.01, 1.01, 64, 64);
        const std::uint64_t before = survivors(plane, upload(straight), ramp(), view);
        view.clip_from_world = multiply(view.clip_from_world, take(inverse(world_from_straight)));
        EXPECT_EQ(survivors(plane, upload(turned), ramp(), view, 0.5, world_from_straight), before);
    }
}

TEST_F(AnalyticTest, AnisotropicGridIsInMillimetres) {
    Grid grid;
    grid.size = {16, 8, 4};
    grid.spacing = {0.5, 2, 5};
    grid.origin = {0.25 - 4, 1 - 8, 2.5 - 10}; // [-4,4] x [-8,8] x [-10,10] mm
    const Volume volume = upload(makeBytes(grid, [](auto...) { return 255.0; }));
    const Mesh plane = upload(makeFlat(-16, 16, -16, 16, 9));
    EXPECT_EQ(survivors(plane, volume, ramp(), flatView(-16, 16, 64, 64)), 16U * 32U);
    const Mesh outside = upload(makeFlat(-16, 16, -16, 16, 9.999));
    EXPECT_EQ(survivors(outside, volume, ramp(), flatView(-16, 16, 64, 64)), 16U * 32U);
}

TEST_F(AnalyticTest, DegenerateTrianglesAreAllowedAndGiveNothing) {
    MeshData mesh = makeFlat(0, 1, 0, 1, 0.5);
    mesh.indices.insert(mesh.indices.end(), {0, 1, 1, 2, 2, 2});
    const Mesh uploaded = upload(mesh);
    EXPECT_EQ(uploaded.facts()->degenerate, 2U);
    EXPECT_EQ(uploaded.triangles(), 4U);
    EXPECT_EQ(survivors(uploaded, full(), ramp(), flatView(0, 1, 64, 64)), 64U * 64U);
}

TEST_F(AnalyticTest, ThresholdIsInclusive) {
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    constexpr ControlPoint kConstant[] = {{0, 0.25}};
    const TransferFunction constant = upload(kConstant, kBytes);
    EXPECT_EQ(survivors(plane, full(), constant, flatView(0, 1, 16, 16), 0.25), 256U);
    EXPECT_EQ(survivors(plane, full(), constant, flatView(0, 1, 16, 16), 0.251), 0U);
    EXPECT_EQ(survivors(plane, empty(), constant, flatView(0, 1, 16, 16), 0.0), 256U);
}

} // namespace
} // namespace voxtact::test
