// SPDX-License-Identifier: MIT
// Mesh files in text: what is a number, a comment, a line. The expected numbers are those of strtod().
#include "io_test_support.h"

#include <cstdlib>
#include <random>

namespace voxtact::test {
namespace {

MeshData readText(const std::string& name, const std::string& content) {
    const auto mesh = io::readMesh(std::as_bytes(std::span(content)), name);
    EXPECT_TRUE(isOk(mesh)) << content;
    return mesh.ok() ? *mesh : MeshData{};
}

/// One triangle with the given x coordinates and y = 0, 1, 0, in each format.
std::vector<std::pair<std::string, std::string>> triangleWith(const std::array<std::string, 3>& x) {
    const std::array<std::string, 3> v{x[0] + " 0 0\n", x[1] + " 1 0\n", x[2] + " 0 1\n"};
    return {{"m.obj", "v " + v[0] + "v " + v[1] + "v " + v[2] + "f 1 2 3\n"},
            {"m.off", "OFF\n3 1 0\n" + v[0] + v[1] + v[2] + "3 0 1 2\n"},
            {"m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                          v[0] + v[1] + v[2] + "3 0 1 2\n"},
            {"m.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex " + v[0] + "vertex " + v[1] + "vertex " + v[2] +
                          "endloop\nendfacet\nendsolid a\n"}};
}

void expectNumbers(const std::array<std::string, 3>& x) {
    for (const auto& [name, content] : triangleWith(x)) {
        const MeshData mesh = readText(name, content);
        ASSERT_EQ(mesh.indices.size(), 3U) << name;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            EXPECT_EQ(mesh.positions[std::size_t{3} * mesh.indices[corner]], std::strtod(x[corner].c_str(), nullptr))
                << name << ": " << x[corner];
        }
    }
}

TEST(MeshText, NumbersInEverySpelling) {
    expectNumbers({".5", "5.", "+1"});
    expectNumbers({"-.5", "-5.", "+.25e1"});
    expectNumbers({"1e2", "1E+2", "1.5e-2"});
    expectNumbers({"007", "-0", "1e-50"});
    expectNumbers({"3.4028234e38", "-3.4028235e38", "1.1754943e-38"});
    // Just above, at, and just below the middle of two floats; rounded to a double all three are the middle.
    expectNumbers(
        {"1.00000005960464477539062500000001", "1.000000059604644775390625", "1.00000005960464477539062499999999"});
    expectNumbers(
        {"1.00000017881393432617187500000001", "1.000000178813934326171875", "1.00000017881393432617187499999999"});
}

TEST(MeshText, RandomNumbersAreTheNearestDoubles) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto digits = [&] {
        std::string text = random() % 2 == 0 ? "-" : "";
        const std::size_t count = 1 + random() % 24;
        const std::size_t point = random() % (count + 1);
        for (std::size_t i = 0; i < count; ++i) {
            text += i == point ? "." : "";
            text += static_cast<char>('0' + random() % 10);
        }
        return text + "e" + std::to_string(static_cast<int>(random() % 40) - 25);
    };
    for (int i = 0; i < 500; ++i) {
        expectNumbers({digits(), digits(), digits()});
    }
}

TEST(MeshText, ObjCommentsBlanksAndColours) {
    const std::vector<double> expected{.5F, 0, 0, 1, 0, 0, 0, 1, 0};
    for (const char* content :
         {"v .5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 # c\n", "\tv .5 0 0\n  v 1 0 0\nv\t0 1 0\n f 1 2 3",
          "v .5 0 0 1\nv 1 0 0 1.0\nv 0 1 0 # w\nf 1/1 2/1/1 3//1\n",
          "v .5 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\nf -3 -2 -1\n",
          "v .5 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v .5 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
          "\xEF\xBB\xBFv .5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
          "# of C:\\meshes\\\nv .5 0 0\nv 1 0 0\nv 0 1 0\ng a\nusemtl b\ns off\nf 1 2 3\n",
          "f 1 2 3\nv .5 0 0\nv 1 \\\n0 0\nv 0 1 0\nfo 1 2 \\\n3\n"}) {
        const MeshData mesh = readText("m.obj", content);
        EXPECT_EQ(mesh.positions, expected) << content;
        EXPECT_TRUE(mesh.notes.empty());
    }
    EXPECT_THAT(readText("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf\nl 1 2 3\np 1 2\nf 1 2 3\n").notes,
                testing::ElementsAre("1 faces or lines without a corner left out", "5 points or lines left out"));
}

/// A vertex that is dropped shifts all that come after it.
TEST(MeshText, NoVertexIsDropped) {
    const MeshData mesh = readText("m.obj", "v .5 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 3 3 3\nf 2 3 4\n");
    EXPECT_THAT(mesh.positions, testing::ElementsAre(1, 0, 0, 0, 1, 0, 0, 0, 1));
}

TEST(MeshText, StlInAnyCase) {
    const std::string lower = triangleWith({"0", "1", "2"})[3].second;
    std::string upper = lower;
    for (char& c : upper) {
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    EXPECT_EQ(readText("m.stl", upper).positions, readText("m.stl", lower).positions);
    EXPECT_EQ(readText("m.stl", "  " + upper + upper).indices.size(), 6U);
    EXPECT_EQ(readText("m.stl", "\xEF\xBB\xBF" + upper).indices.size(), 3U);
}

std::string plyOf(const std::string& format, const std::string& body) {
    return "ply\nformat " + format + " 1.0\ncomment x\nelement face 1\nproperty uchar red\n" +
           "property list uchar ushort vertex_index\nelement edge 2\nproperty int vertex1\n" +
           "element vertex 3\nproperty double z\nproperty float quality\nproperty double x\nproperty short y\n"
           "property list uint8 float32 more\nend_header\n" +
           body;
}

template <class Number> void appendAs(std::string& bytes, Number number, bool big) {
    std::string one;
    append(one, number);
    bytes += big ? std::string(one.rbegin(), one.rend()) : one;
}

/// Any order of elements and properties, lists between them, what is not a number where none is asked for.
TEST(MeshText, PlyAsItsHeaderSays) {
    const std::vector<double> expected{1, 2, 3, 4, 5, 6, 7, 8, 9};
    EXPECT_EQ(
        readText("m.ply", plyOf("ascii", "255 3 0 1 2\n7\n\n8\n3 nan 1 2 0\n6 1 4 5 2 0.5 x\r\n9 - 7 8 0\n")).positions,
        expected);
    for (const bool big : {false, true}) {
        std::string body("\xFF\3", 2);
        for (const int corner : {0, 1, 2}) {
            appendAs(body, static_cast<std::uint16_t>(corner), big);
        }
        appendAs(body, std::int32_t{7}, big);
        appendAs(body, std::int32_t{8}, big);
        for (int i = 0; i < 3; ++i) {
            appendAs(body, 3.0 * i + 3, big);
            appendAs(body, 0.5F, big);
            appendAs(body, 3.0 * i + 1, big);
            appendAs(body, static_cast<std::int16_t>(3 * i + 2), big);
            body += '\1';
            appendAs(body, 0.25F, big);
        }
        const MeshData mesh = readText("m.ply", plyOf(big ? "binary_big_endian" : "binary_little_endian", body));
        EXPECT_EQ(mesh.positions, expected) << big;
        EXPECT_THAT(mesh.notes, testing::ElementsAre("2 points or lines left out"));
    }
}

TEST(MeshText, OffWithCountsOnItsFirstLineAndColours) {
    const MeshData mesh = readText("m.OFF", "# c\nOFF 3 1 # c\n\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n");
    EXPECT_THAT(mesh.positions, testing::ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
}

} // namespace
} // namespace voxtact::test
