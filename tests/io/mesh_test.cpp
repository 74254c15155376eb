// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <cmath>

namespace voxtact::test {
namespace {

/// Two triangles of a unit square, and one without area.
MeshData square() {
    MeshData mesh;
    mesh.positions = {0, 0, 0.1F, 1, 0, 0.25F, 1, 1, -3e-7F, 0, 1, 1e10F};
    mesh.indices = {0, 1, 2, 0, 2, 3, 1, 1, 2};
    return mesh;
}

std::vector<double> corners(const MeshData& mesh) {
    std::vector<double> list;
    for (const std::uint32_t index : mesh.indices) {
        list.insert(list.end(), mesh.positions.begin() + std::ptrdiff_t{3} * index,
                    mesh.positions.begin() + std::ptrdiff_t{3} * index + 3);
    }
    return list;
}

TEST(Mesh, RoundTripsKeepTrianglesAndOrder) {
    const TemporaryFolder folder;
    const MeshData written = square();
    for (const char* name : {"m.stl", "m.STL", "m.ply", "m.obj"}) {
        ASSERT_TRUE(isOk(io::writeMesh(folder / name, written.view())));
        const auto read = io::readMesh(folder / name);
        ASSERT_TRUE(isOk(read)) << name;
        EXPECT_EQ(checkMesh(read->view())->triangles, 3U) << name;
        EXPECT_EQ(checkMesh(read->view())->degenerate, 1U) << name;
        EXPECT_EQ(read->positions.size(), 12U) << name;
        EXPECT_EQ(read->name, name);
        EXPECT_EQ(corners(*read), corners(written)) << name;
    }
    EXPECT_EQ(folder.entries(), 4U);
}

TEST(Mesh, SpaceAndScale) {
    const TemporaryFolder folder;
    const auto path = folder.write("m.obj", "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n");
    io::MeshReadOptions options;
    options.space = io::MeshSpace::RAS;
    options.scale = 1000;
    const auto mesh = io::readMesh(path, options);
    ASSERT_TRUE(isOk(mesh));
    EXPECT_THAT(mesh->positions, testing::ElementsAre(-1000, -2000, 3000, -4000, -5000, 6000, -7000, -8000, 10000));
    for (const double bad : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)}) {
        options.scale = bad;
        expectRefused(io::readMesh(path, options), "the scale of a mesh must be positive and finite");
    }
    options.scale = 1e300;
    expectRefused(io::readMesh(path, options), "too far away for a float");
}

TEST(Mesh, CoordinatesStayDoubles) {
    const TemporaryFolder folder;
    const std::string obj =
        "v 500008.9 4649781.2 1005.2\nv 500008.9 4649784.2 1005.2\nv 500008.9 4649781.2 1008.2\nf 1 2 3\n";
    const std::vector<double> expected{500008.9, 4649781.2, 1005.2,    500008.9, 4649784.2,
                                       1005.2,   500008.9,  4649781.2, 1008.2};
    const auto read = io::readMesh(folder.write("m.obj", obj));
    ASSERT_TRUE(isOk(read));
    EXPECT_EQ(read->positions, expected);
    EXPECT_TRUE(read->notes.empty());
    // Through files that hold doubles, and flipped and scaled with the same arithmetic.
    for (const char* name : {"m.ply", "n.obj"}) {
        ASSERT_TRUE(isOk(io::writeMesh(folder / name, read->view())));
        const auto again = io::readMesh(folder / name, {.space = io::MeshSpace::RAS, .scale = 1000});
        ASSERT_TRUE(isOk(again)) << name;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(again->positions[i], expected[i] * (i % 3 == 2 ? 1000.0 : -1000.0)) << name;
        }
    }
    ASSERT_TRUE(isOk(io::writeMesh(folder / "m.stl", read->view())));
    const auto rounded = io::readMesh(folder / "m.stl");
    ASSERT_TRUE(isOk(rounded));
    EXPECT_EQ(rounded->positions[1], static_cast<double>(4649781.2F));
}

TEST(Mesh, WhatStillRoundsIsNoted) {
    const TemporaryFolder folder;
    const auto read = io::readMesh(folder.write("m.obj", "v 0.1 0 0\nv 200000.1 0 0\nv 0 200000.1 0\nf 1 2 3\n"));
    ASSERT_TRUE(isOk(read));
    ASSERT_EQ(read->notes.size(), 1U);
    EXPECT_THAT(read->notes[0], testing::HasSubstr("vertices rounded by up to 0.00"));
    EXPECT_GT(checkMesh(read->view())->rounding, kNotedRounding);
}

TEST(Mesh, PolygonsPointsAndLines) {
    const TemporaryFolder folder;
    const auto mesh =
        io::readMesh(folder.write("m.obj", "# a concave pentagon, a quad over two lines, a line and a point\n"
                                           "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\n"
                                           "f 1 2 3 4 5\nf -5 -4 \\\n-3 -1\nl 1 2\np 1\n"));
    ASSERT_TRUE(isOk(mesh));
    EXPECT_EQ(mesh->indices.size(), 15U);
    EXPECT_THAT(mesh->notes, testing::ElementsAre("2 points or lines left out"));
}

TEST(Mesh, CornersWithEqualPositionsAreOneVertex) {
    const TemporaryFolder folder;
    const auto mesh = io::readMesh(folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 9 9 9\nv 1 0 0\n"
                                                         "vn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 4//2 6//2 3//2\n"));
    ASSERT_TRUE(isOk(mesh));
    EXPECT_EQ(mesh->positions.size(), 9U);
    EXPECT_THAT(mesh->indices, testing::ElementsAre(0, 1, 2, 0, 1, 2));
}

TEST(MeshWrite, Refusals) {
    const TemporaryFolder folder;
    MeshData mesh = square();
    expectRefused(io::writeMesh(folder / "m.glb", mesh.view()), "the ending of a mesh is .stl, .obj or .ply");
    expectRefused(io::writeMesh(folder / "absent" / "m.stl", mesh.view()), "absent' does not exist");
    mesh.indices.back() = 99;
    expectRefused(io::writeMesh(folder / "m.stl", mesh.view()), "m.stl': triangle 2 of the mesh uses vertex 99");
    EXPECT_EQ(folder.entries(), 0U);
}

} // namespace
} // namespace voxtact::test
