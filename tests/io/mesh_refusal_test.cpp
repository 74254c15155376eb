// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <cmath>

namespace voxtact::test {
namespace {

struct Case {
    std::string content;
    const char* reason;
};

void expectAllRefused(const std::string& name, const std::vector<Case>& cases) {
    const TemporaryFolder folder;
    for (const Case& bad : cases) {
        const auto path = folder.write(name, bad.content);
        expectRefused(io::readMesh(path), bad.reason, path);
    }
}

TEST(MeshRefusal, Files) {
    const TemporaryFolder folder;
    expectRefused(io::readMesh(folder / "absent.stl"), "absent.stl': there is no such file");
    expectRefused(io::readMesh(folder.path()), "it is a folder, not a file");
    expectRefused(io::readMesh(folder.write("m.xyz", "1 2 3")),
                  "its ending is none of .stl, .obj, .ply, .off, .vtk, .vtp, .gltf, .glb, .step, .stp, .iges and .igs");
    for (const char* name : {"m.stl", "m.obj", "m.ply", "m.off", "m.vtk", "m.vtp", "m.gltf", "m.glb"}) {
        expectRefused(io::readMesh(folder.write(name, "")), "the file is empty", folder / name);
        expectRefused(io::readMesh(folder.write(name, "complete rubbish, no mesh at all, of some length\n")), "",
                      folder / name);
    }
}

TEST(MeshRefusal, Obj) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expectAllRefused(
        "m.obj",
        {{corners, "it holds no triangle"},
         {corners + "p 1\nl 1 2\n", "it holds no triangle"},
         {corners + "f 1 2 4\n", "line 4: a face uses vertex 4, the file has 3"},
         {corners + "f 1 2 0\n", "line 4: a face uses vertex 0, which does not exist"},
         {corners + "f 1 2 -4\n", "line 4: a face uses vertex -4, which does not exist (3 before it)"},
         {corners + "f 1 2 x\n", "line 4: 'x' is not a vertex number"},
         {corners + "f 1 2 3.5\n", "line 4: '3.5' is not a vertex number"},
         {corners + "f 1 2 3/\x80\n", "line 4: '3/\\x80' is not a vertex number"},
         {corners + "f 1 2 99999999999\n", "line 4: a face uses vertex 99999999999, which does not exist"},
         {corners + "foo 1 2 3\n", "line 4: 'foo' is no word of an OBJ file"},
         {"w 0 0 0\n" + corners + "f 1 2 3\n", "line 1: 'w' is no word of an OBJ file"},
         {"V 0 0 0\n" + corners + "f 1 2 3\n", "line 1: 'V' is no word of an OBJ file"},
         {corners + "cstype bezier\nsurf 0 1 0 1 1 2 3\n", "line 4: 'cstype' is not supported (curved"},
         {corners + "call more.obj\nf 1 2 3\n", "line 4: 'call' is not supported"},
         {corners + "f 1 2 3\nf 1 2 \\\n", "it is truncated"},
         {corners + "f 1 2 \\", "it is truncated"},
         {"v 0 0\n" + corners + "f 1 2 3\n", "line 1: a vertex has 3, 4 or 6 numbers, this one has 2"},
         {"v 0 0 0 1 1\n" + corners + "f 1 2 3\n", "line 1: a vertex has 3, 4 or 6 numbers, this one has 5"},
         {"v 0 0 0 0\n" + corners + "f 1 2 3\n", "line 1: the vertex has the weight 0, which programs read in"},
         {"v 0 0 0 0.5\n" + corners + "f 1 2 3\n", "line 1: the vertex has the weight 0.5"},
         {"v 0 1e400 0\n" + corners + "f 1 2 3\n", "line 1: '1e400' is outside what a double holds"},
         {"v 0 1e39 0\n" + corners + "f 2 3 4\nf 1 2 3\n", "triangle 1 has a corner that is NaN, infinite, or too far"},
         {"v 0 ++1 0\n" + corners + "f 1 2 3\n", "line 1: '++1' is not a number"},
         {"v 0 0x10 0\n" + corners + "f 1 2 3\n", "line 1: '0x10' is not a number"},
         {"v 0 . 0\n" + corners + "f 1 2 3\n", "line 1: '.' is not a number"},
         {"v 0 0,5 0\n" + corners + "f 1 2 3\n", "line 1: '0,5' is not a number"},
         {"v 0 nan 0\n" + corners + "f 1 2 3\n", "line 1: 'nan' is not a finite number"},
         {"v 0 0 inf\n" + corners + "f 1 2 3\n", "line 1: 'inf' is not a finite number"},
         {std::string("\xFE\xFF\0v", 4) + corners, "its text is UTF-16"},
         {std::string("\0v", 2) + corners, "it is not text"}});
}

std::string binaryStl(std::uint32_t stated, std::size_t present, float coordinate = 1) {
    std::string bytes(80, ' ');
    append(bytes, stated);
    for (std::size_t i = 0; i < present; ++i) {
        for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, coordinate, 0.F, 0.F, 0.F, 1.F, 0.F}) {
            append(bytes, value);
        }
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

TEST(MeshRefusal, Stl) {
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const std::string open = "solid a\n" + facet;
    expectAllRefused(
        "m.stl",
        {{binaryStl(0, 0), "it holds no triangle"},
         {binaryStl(3, 2), "it is truncated: the 3 triangles that its header states take 234 bytes, 184 are there"},
         {binaryStl(3, 3).substr(0, 233), "233 are there"},
         {binaryStl(3, 3).substr(0, 83), "it is not an STL file, or it is truncated (83 bytes)"},
         {binaryStl(2, 3), "it is not a proper binary STL file: the 2 triangles"},
         {binaryStl(1, 1, NAN), "triangle 0 has a corner that is NaN"},
         {binaryStl(1, 1, INFINITY), "triangle 0 has a corner that is NaN, infinite"},
         {open, "it is truncated: no line after its last 'solid' begins with 'endsolid'"},
         {open + facet.substr(0, 30), "it is truncated: no line after"},
         {"solid a\nendsolid a\n", "it holds no triangle"},
         {open + "vertex 1 2 3\nendsolid\n", "line 9: a vertex must be in a loop"},
         {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "line 4: a vertex has 3 coordinates"},
         {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1x\n", "line 4: '1x' is not a number"},
         {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nendloop\nendfacet\n",
          "line 6: a facet needs 3 vertices, this one has 1"},
         {"solid\nhello\n", "line 2: 'hello' is no word of an STL file"},
         {"SOLID\nHELLO\n", "line 2: 'HELLO' is no word of an STL file"}});
}

TEST(MeshStl, BinaryFilesMayBeginWithSolid) {
    const TemporaryFolder folder;
    std::string bytes = binaryStl(2, 2);
    bytes.replace(0, 5, "solid");
    const auto mesh = io::readMesh(folder.write("m.stl", bytes));
    ASSERT_TRUE(isOk(mesh));
    EXPECT_EQ(mesh->indices.size(), 6U);
}

std::string ply(const std::string& format, const std::string& body, const char* faces = "1",
                const char* vertices = "3") {
    return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

TEST(MeshRefusal, Ply) {
    const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
    std::string binary;
    for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
        append(binary, value);
    }
    append(binary, std::uint8_t{3});
    for (const std::int32_t index : {0, 1, 2}) {
        append(binary, index);
    }
    const TemporaryFolder folder;
    ASSERT_TRUE(isOk(io::readMesh(folder.write("m.ply", ply("binary_little_endian", binary)))));
    ASSERT_TRUE(isOk(io::readMesh(folder.write("m.ply", ply("ascii", corners + "3 0 1 2\n")))));
    EXPECT_TRUE(isOk(io::readMesh(folder.write("m.ply", ply("binary_little_endian", binary + "\r\n")))));
    for (std::size_t length = 1; length < binary.size(); ++length) {
        expectRefused(io::readMesh(folder.write("m.ply", ply("binary_little_endian", binary.substr(0, length)))),
                      "truncated");
    }
    expectAllRefused(
        "m.ply",
        {{ply("ascii", corners + "3 0 1"), "face 0: the file is truncated"},
         {ply("ascii", corners, "0"), "it holds no triangle"},
         {ply("ascii", corners + "3 0 1 3\n"), "face 0: it uses vertex 3, the file has 3 vertices"},
         {ply("ascii", corners + "3 0 1 -1\n"), "face 0: it uses vertex -1"},
         {ply("ascii", corners + "2 0 1\n"), "face 0: a face needs 3 corners or more, this one has 2"},
         {ply("ascii", "0 0 zero\n" + corners), "vertex 0: 'zero' is not a number"},
         {ply("ascii", "0 0 nan\n" + corners), "vertex 0: 'nan' is not a finite number"},
         {ply("ascii", corners + "3 0 1 2\n", "99999999999"), "face 1: the file is truncated"},
         {ply("ascii", "", "1", "4000000000"), "vertex 0: the file is truncated"},
         {ply("ascii", "", "1", "99999999999"), "it states more vertices than 32 bits count"},
         {ply("binary", corners), "line 2: unknown PLY format"},
         {"ply\nformat ascii 1.0\nelement vertex 3\n", "its PLY header does not end"},
         {ply("binary_little_endian", binary + "x"), "it holds more than its header states"},
         {ply("ascii", corners + "3 0 1 2\n3 0 1 2\n"), "it holds more than its header states"},
         {ply("ascii", "0 0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "vertex 0: its line has more numbers"},
         {ply("ascii", "0 0\n0 1 0\n0 0 1 0\n3 0 1 2\n"), "vertex 0: its line has fewer numbers"},
         {ply("ascii", corners + "3 0 1 1.5\n"), "face 0: it uses vertex 1.5"},
         {ply("ascii", corners + "-3 0 1 2\n"), "face 0: '-3' is not the length of a list"},
         {ply("ascii", corners + "99999999999 0 1 2\n"), "face 0: the file is truncated"},
         {"ply\nformat ascii 1.0\nelement nothing 99999999999\nend_header\n", "has no properties"},
         {"ply\nformat ascii 1.0\nelement vertex 0\nelement vertex 3\n", "line 4: there are two elements"},
         {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
          "its vertices have no x, y and z"},
         {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty int x\n",
          "line 5: the element has two properties of this name"},
         {"ply\nelement vertex 1\nproperty float x\nend_header\n0\n", "its PLY header has no format"},
         {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\n",
          "line 4: the length of a list is of a type that is not whole"},
         {"ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int float vertex_indices\nend_header\n3 0 1 2\n",
          "its tristrips have no list vertex_indices of whole numbers"},
         {"ply\nformat ascii 1.0\nelement vertex x\nend_header\n", "line 3: an element needs its number"},
         {"ply\nproperty quux x\nend_header\n", "line 2"}});
}

TEST(MeshRefusal, Off) {
    const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
    expectAllRefused(
        "m.off", {{"OFF\n3 1 0\n" + corners, "it is truncated: it has 0 of 1 faces"},
                  {"OFF\n4 1 0\n" + corners, "it is truncated: it has 3 of 4 vertices"},
                  {"OFF\n3 1 0\n" + corners + "3 0 1 3\n", "line 6: '3' is not the number of one of the 3 vertices"},
                  {"OFF\n3 1 0\n" + corners + "2 0 1\n", "line 6: a face is its number of corners"},
                  {"OFF\n3 1 0\n" + corners + "3 0 1\n", "line 6: a face is its number of corners"},
                  {"OFF\n3 0 0\n" + corners, "it holds no triangle"},
                  {"OFF\n3\n" + corners, "its OFF header does not state"},
                  {"OFF\n3 1 0\n" + corners + "3 0 1 2\n3 0 1 2\n", "line 7: the file goes on after the 1 faces"},
                  {"OFF\n3 1 0\n" + corners + "3 0 1 -1\n", "line 6: '-1' is not the number"},
                  {"OFF BINARY\n3 1 0\n" + corners, "it is not a plain OFF file"},
                  {"COFF\n3 1 0\n", "it is truncated: it has 0 of 3 vertices"}});
}

TEST(MeshRefusal, NothingIsPrinted) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    expectAllRefused("m.obj", {{"f 1 2 3\n", ""}});
    expectAllRefused("m.stl", {{binaryStl(3, 2), ""}});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

} // namespace
} // namespace voxtact::test
