// SPDX-License-Identifier: MIT
// Meshes split at their creases. Needs no device.
#include "support/scenes.h"
#include "voxtact/render.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// The corners of a mesh's triangles, in order, as positions.
std::vector<double> cornersOf(const MeshData& mesh) {
    std::vector<double> corners;
    for (const std::uint32_t index : mesh.indices) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corners.push_back(mesh.positions.at(std::size_t{3} * index + axis));
        }
    }
    return corners;
}

MeshData split(const MeshData& mesh, double degrees) {
    Result<MeshData> made = splitAtCreases(mesh.view(), degrees);
    EXPECT_TRUE(made.ok()) << made.error().text;
    EXPECT_EQ(cornersOf(*made), cornersOf(mesh));
    return std::move(*made);
}

/// A cube whose eight vertices are shared by its twelve triangles.
MeshData sharedCube() {
    MeshData mesh;
    for (int vertex = 0; vertex < 8; ++vertex) {
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back((vertex >> axis & 1) != 0 ? 1.0F : 0.0F);
        }
    }
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

TEST(CreasesTest, ACubeHasThreeVerticesAtEachCorner) {
    const MeshData cube = sharedCube();
    EXPECT_EQ(split(cube, 40).positions.size(), 3U * 24);
    EXPECT_EQ(split(cube, 89).positions.size(), 3U * 24);
    EXPECT_EQ(split(cube, 91).positions, cube.positions);
    EXPECT_EQ(split(cube, 91).indices, cube.indices);
}

TEST(CreasesTest, SmoothMeshesStayAsTheyAre) {
    const Result<MeshData> ellipsoid = makeEllipsoid(2000);
    ASSERT_TRUE(ellipsoid.ok());
    EXPECT_EQ(split(*ellipsoid, 60).positions, ellipsoid->positions);
    EXPECT_EQ(split(*ellipsoid, 180).indices, ellipsoid->indices);
}

TEST(CreasesTest, AnEdgeThatTheCreaseEndsOn) {
    // Four triangles round the origin: a flat half, and two that rise by 45 degrees and are flat to each other.
    MeshData mesh;
    mesh.positions = {0, 0, 0, 0, -1, 0, -1, 0, 0, 0, 1, 0, 1, 0, 1};
    mesh.indices = {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4};
    // The three vertices on the crease are there twice.
    EXPECT_EQ(split(mesh, 40).positions.size(), 3U * 8);
    EXPECT_EQ(split(mesh, 50).positions.size(), 3U * 5);
}

TEST(CreasesTest, WithoutAreaAndUnused) {
    MeshData mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 7, 7, 7, 2, 0, 0};
    mesh.indices = {0, 1, 2, 0, 1, 4, 1, 1, 1};
    split(mesh, 40);
}

TEST(CreasesTest, Refusals) {
    const MeshData cube = sharedCube();
    for (const double degrees : {-1.0, 181.0, std::numeric_limits<double>::quiet_NaN()}) {
        const Result<MeshData> made = splitAtCreases(cube.view(), degrees);
        ASSERT_FALSE(made.ok());
        EXPECT_EQ(made.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(made.error().text, HasSubstr("angle of creases"));
    }
    EXPECT_THAT(splitAtCreases({}).error().text, HasSubstr("no triangles"));
}

} // namespace
} // namespace voxtact::test
