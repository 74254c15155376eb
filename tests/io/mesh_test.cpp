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

std::vector<float> corners(const MeshData& mesh) {
    std::vector<float> list;
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
        EXPECT_THAT(corners(*read), testing::Pointwise(testing::FloatEq(), corners(written))) << name;
        if (std::string_view(name) != "m.obj") {
            EXPECT_EQ(corners(*read), corners(written)) << name;
        }
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

/// One triangle in an embedded buffer, under two nodes: moved, and mirrored.
std::string gltf(const std::string& indices, const std::string& extra = {}) {
    std::string buffer;
    for (const float coordinate : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
        append(buffer, coordinate);
    }
    buffer += indices;
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string base64;
    for (std::size_t i = 0; i < buffer.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8 | static_cast<unsigned char>(buffer[i + k]);
        }
        for (const unsigned shift : {18U, 12U, 6U, 0U}) {
            base64 += kDigits[bits >> shift & 63U];
        }
    }
    const std::string bytes = std::to_string(buffer.size());
    return R"({"asset": {"version": "2.0"},)" + extra +
           R"("scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"translation": [10, 0, 0], "children": [1, 2]},)"
           R"({"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1], "translation": [0, 0, 5]}],)"
           R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],)"
           R"("accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},)"
           R"({"bufferView": 1, "componentType": 5121, "count": )" +
           std::to_string(indices.size()) +
           R"(, "type": "SCALAR"}], "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": )" +
           std::to_string(indices.size()) + R"(}], "buffers": [{"byteLength": )" + bytes +
           R"(, "uri": "data:application/octet-stream;base64,)" + base64 + R"("}]})";
}

TEST(Mesh, GltfNodesAreApplied) {
    const TemporaryFolder folder;
    const auto mesh = io::readMesh(folder.write("m.gltf", gltf(std::string("\0\1\2", 3))));
    ASSERT_TRUE(isOk(mesh));
    EXPECT_THAT(corners(*mesh), testing::ElementsAre(10, 0, 0, 11, 0, 0, 10, 1, 0, /* mirrored and turned */ 10, 0, 5,
                                                     10, 1, 5, 9, 0, 5));
}

TEST(Mesh, GltfRefusals) {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& text) { return io::readMesh(folder.write("m.gltf", text)); };
    // assimp leaves such triangles out.
    expectRefused(read(gltf(std::string("\0\1\2\0\1\7", 6))), "only 1 of the 2 triangles that it states can be used",
                  folder / "m.gltf");
    expectRefused(read(gltf(std::string("\0\1\7", 3))), "m.gltf");
    expectRefused(read(gltf(std::string("\0\1\2", 3), R"("extensionsRequired": ["KHR_draco_mesh_compression"],)")),
                  "it uses the extension KHR_draco_mesh_compression");
    expectRefused(read("{\"asset\": {\"version\": \"1.0\"}}"), "it is glTF 1.0; glTF 2 is needed");
    expectRefused(read("{}"), "no 'asset'");
    expectRefused(read("{\"asset\":"), "it is not a proper glTF file");
    expectRefused(read("{\"asset\": {\"version\": \"2.0\"}}"), "it holds no triangle");
    std::string text = gltf(std::string("\0\1\2", 3));
    const auto replaced = [&](const std::string& from, const std::string& to) {
        return std::string(text).replace(text.find(from), from.size(), to);
    };
    expectRefused(read(replaced("\"count\": 3", "\"count\": 4")), "accessor 0 reaches beyond its buffer");
    expectRefused(read(replaced("\"byteLength\": 39", "\"byteLength\": 40")), "buffer 0 has 39 bytes, 40 are stated");
    expectRefused(read(replaced("5126", "5122")), "accessor 0 is of a type");
    expectRefused(read(replaced("\"POSITION\": 0", "\"POSITION\": 9")),
                  "number 9 of its 'accessors', which does not exist");
    expectRefused(io::readMesh(folder.write("m.glb", "glTF")), "it is not a GLB file");
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
