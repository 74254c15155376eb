// SPDX-License-Identifier: MIT
// What mesh files say beside their triangles, and what is harmless behind these.
#include "io_test_support.h"

namespace voxtact::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

Result<MeshData> read(const std::string& name, const std::string& content, std::optional<io::MeshSpace> space = {}) {
    return io::readMesh(std::as_bytes(std::span(content)), name, {.space = space, .scale = 1});
}

std::string stlWithHeader(const std::string& header, int triangles = 1) {
    std::string bytes = header;
    bytes.resize(80);
    append(bytes, static_cast<std::uint32_t>(triangles));
    for (int i = 0; i < triangles; ++i) {
        for (const float number : {0.F, 0.F, 1.F, 1.F, 2.F, 3.F, 4.F, 2.F, 3.F, 1.F, 6.F, 3.F}) {
            append(bytes, number);
        }
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

/// One triangle whose first corner is (1, 2, 3), with a comment in each format.
std::vector<std::pair<std::string, std::string>> triangleWith(const std::string& comment) {
    return {{"m.obj", "# " + comment + "\nv 1 2 3\nv 4 2 3\nv 1 6 3\nf 1 2 3\n"},
            {"m.ply", "ply\nformat ascii 1.0\ncomment " + comment +
                          "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n1 2 3\n4 2 3\n1 6 3\n3 0 1 2\n"},
            {"m.stl", "solid " + comment +
                          "\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 2 3\nvertex 1 6 3\n"
                          "endloop\nendfacet\nendsolid\n"},
            {"m.stl", stlWithHeader(comment)}};
}

TEST(MeshHeader, TheSpaceThatAFileSaysIsTaken) {
    constexpr auto kLps = io::MeshSpace::LPS;
    constexpr auto kRas = io::MeshSpace::RAS;
    const auto firstX = [](const Result<MeshData>& mesh) {
        EXPECT_TRUE(isOk(mesh));
        return mesh.ok() ? static_cast<double>(mesh->positions[0]) : 0.0;
    };
    for (const auto& [name, content] : triangleWith("3D Slicer output. SPACE=RAS")) {
        const auto mesh = read(name, content);
        EXPECT_EQ(firstX(mesh), -1) << name;
        EXPECT_THAT(mesh->notes, ElementsAre("the file says SPACE=RAS: x and y are negated"));
        EXPECT_EQ(firstX(read(name, content, kRas)), -1) << name;
        EXPECT_TRUE(read(name, content, kRas)->notes.empty());
        expectRefused(read(name, content, kLps), "it says SPACE=RAS, and LPS is asked for; leave the space out", name);
    }
    for (const auto& [name, content] : triangleWith("3D Slicer output. SPACE=LPS")) {
        EXPECT_EQ(firstX(read(name, content)), 1) << name;
        EXPECT_EQ(firstX(read(name, content, kLps)), 1) << name;
        EXPECT_TRUE(read(name, content)->notes.empty());
        expectRefused(read(name, content, kRas), "it says SPACE=LPS, and RAS is asked for", name);
    }
    for (const auto& [name, content] : triangleWith("SPACE=LPS SPACE=RAS")) {
        expectRefused(read(name, content), "it says both SPACE=LPS and SPACE=RAS", name);
    }
    for (const auto& [name, content] : triangleWith("space")) {
        EXPECT_EQ(firstX(read(name, content)), 1) << name;
        EXPECT_EQ(firstX(read(name, content, kRas)), -1) << name;
    }
}

TEST(MeshHeader, BytesBehindAnStl) {
    for (const std::size_t more : {1U, 2U, 49U}) {
        for (const char* header : {"m", "solid m"}) {
            const auto mesh = read("m.stl", stlWithHeader(header, 2) + std::string(more, '\1'));
            ASSERT_TRUE(isOk(mesh));
            EXPECT_EQ(mesh->indices.size(), 6U);
            EXPECT_THAT(mesh->notes, ElementsAre(HasSubstr(" behind the triangles that the header states left out")));
        }
    }
    expectRefused(read("m.stl", stlWithHeader("m", 2) + std::string(50, '\1')), "it is not a proper binary STL file");
    const std::string text = triangleWith("m")[2].second;
    const auto zero = read("m.stl", text + std::string(3, '\0'));
    ASSERT_TRUE(isOk(zero));
    EXPECT_EQ(zero->indices.size(), 3U);
    EXPECT_FALSE(read("m.stl", text + std::string("\0solid x\n", 9)).ok());
}

TEST(MeshHeader, KindsOfOff) {
    const auto off = [](const std::string& head, const std::string& behind) {
        return head + "0 0 0" + behind + "\n1 0 0" + behind + "\n0 1 0" + behind + "\n3 0 1 2\n";
    };
    for (const auto& [head, behind] :
         std::vector<std::pair<std::string, std::string>>{{"OFF\n3 1 0\n", ""},
                                                          {"OFF3 1 0\n", ""},
                                                          {"OFF 3 1\n", ""},
                                                          {"COFF\n3 1 0\n", " 255 0 0 255"},
                                                          {"COFF 3 1 0\n", " .5 0 0"},
                                                          {"NOFF\n3 1 0\n", " 0 0 1"},
                                                          {"STOFF\n3 1 0\n", " 0 1"},
                                                          {"STCNOFF\n3 1 0\n", " 0 0 1 1 1 1 1 0 1"},
                                                          {"NCOFF\n3 1 0\n", " 0 0 1 1 1 1"}}) {
        const auto mesh = read("m.off", off(head, behind));
        ASSERT_TRUE(isOk(mesh)) << head;
        EXPECT_THAT(mesh->positions, ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0)) << head;
    }
    expectRefused(read("m.off", off("NOFF\n3 1 0\n", " 0 0")),
                  "a vertex of this kind of OFF has 6 numbers, this one has 5");
    expectRefused(read("m.off", off("COFF\n3 1 0\n", " 1 2 3 4 5")), "has 6 to 7 numbers, this one has 8");
    expectRefused(read("m.off", off("OFF\n3 1 0\n", " 1 2 3")), "a vertex has 3 coordinates");
    for (const char* head :
         {"4OFF\n3 1 0\n", "nOFF 3\n3 1 0\n", "OFFX 3 1 0\n", "XOFF\n3 1 0\n", "OFF BINARY\n3 1 0\n"}) {
        expectRefused(read("m.off", off(head, "")), "it is not a plain OFF file in text");
    }
}

TEST(MeshHeader, WideNumbersOfAPly) {
    const auto ply = [](const char* type, auto... corners) {
        std::string bytes = std::string("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\n"
                                        "property double y\nproperty double z\nelement face 1\nproperty list uint8 ") +
                            type + " vertex_indices\nend_header\n";
        for (const double number : {0., 0., 0., 1., 0., 0., 0., 1., 0.}) {
            append(bytes, number);
        }
        bytes += '\3';
        (append(bytes, corners), ...);
        return bytes;
    };
    using Whole = std::uint64_t;
    for (const char* type : {"uint64", "int64", "ulong", "long"}) {
        const auto mesh = read("m.ply", ply(type, Whole{0}, Whole{1}, Whole{2}));
        ASSERT_TRUE(isOk(mesh)) << type;
        EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2));
    }
    expectRefused(read("m.ply", ply("uint64", Whole{0}, Whole{1}, Whole{3})), "it uses vertex 3, the file has 3");
    expectRefused(read("m.ply", ply("uint64", Whole{0}, Whole{1}, ~Whole{0})), "it uses vertex 1");
    // A list of any length that 64 bits can say.
    std::string lying = ply("uint64");
    lying.replace(lying.find("list uint8"), 10, "list ulong");
    lying.back() = '\xFF';
    expectRefused(read("m.ply", lying + std::string(7, '\xFF')), "is negative or beyond all reason");
}

TEST(MeshHeader, StripsOfAPly) {
    const auto ply = [](const std::string& strip) {
        return "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
               "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n" +
               strip + "\n";
    };
    const auto mesh = read("m.ply", ply("9 0 1 2 3 4 -1 4 3 2"));
    ASSERT_TRUE(isOk(mesh));
    EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 2));
    EXPECT_THAT(read("m.ply", ply("4 0 1 2 -1"))->indices, ElementsAre(0, 1, 2));
    expectRefused(read("m.ply", ply("4 0 1 -1 2")), "tristrips 0: a strip needs 3 corners or more, this one has 2");
    expectRefused(read("m.ply", ply("3 0 1 5")), "tristrips 0: it uses vertex 5, the file has 5");
    expectRefused(read("m.ply", ply("3 0 1 -2")), "tristrips 0: it uses vertex -2");
}

TEST(MeshHeader, ZerosBehindTheStatedDataAreNoted) {
    const std::string zeros("\n\0\0 \0\r\n", 7);
    std::vector<std::pair<std::string, std::string>> files = triangleWith("m");
    files.erase(files.begin()); // OBJ states no number, so that zeros may stand for lost lines
    files.emplace_back("m.off", "OFF\n3 1 0\n1 2 3\n4 2 3\n1 6 3\n3 0 1 2\n");
    for (const auto& [name, content] : files) {
        const auto mesh = read(name, content + zeros + std::string(60, '\0'));
        ASSERT_TRUE(isOk(mesh)) << name;
        EXPECT_EQ(mesh->indices.size(), 3U);
        EXPECT_FALSE(read(name, content + zeros + std::string(60, '\0') + "x").ok()) << name;
    }
    for (const char* name : {"m.ply", "m.off"}) {
        const auto file = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.first == name; });
        EXPECT_THAT(read(name, file->second + zeros)->notes, ElementsAre(HasSubstr("bytes of zeros and white space")));
        EXPECT_TRUE(read(name, file->second + " \n\n")->notes.empty());
    }
    EXPECT_FALSE(read("m.obj", triangleWith("m")[0].second + zeros).ok());
}

TEST(MeshHeader, HiddenNodesAreLeftOut) {
    std::string corners;
    for (const float number : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
        append(corners, number);
    }
    const TemporaryFolder folder;
    folder.write("b.bin", corners);
    const auto readWith = [&](const std::string& visibility, const std::string& extension = "KHR_node_visibility") {
        return io::readMesh(
            folder.write("m.gltf",
                         R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},
                {"translation":[50,0,0],"children":[2],"extensions":{"KHR_node_visibility":)" +
                             visibility +
                             R"(}},{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
                "accessors":[{"componentType":5126,"count":3,"type":"VEC3","bufferView":0,"min":[0,0,0],"max":[1,1,0]}],
                "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"b.bin"}],
                "extensionsUsed":[")" +
                             extension + R"("],"extensionsRequired":[")" + extension + R"("]})"));
    };
    const auto hidden = readWith(R"({"visible":false})");
    ASSERT_TRUE(isOk(hidden));
    EXPECT_EQ(hidden->indices.size(), 3U);
    EXPECT_THAT(hidden->notes, Contains("1 hidden node (KHR_node_visibility) left out, with what is below"));
    for (const char* visible : {R"({"visible":true})", "{}"}) {
        const auto shown = readWith(visible);
        ASSERT_TRUE(isOk(shown));
        EXPECT_EQ(shown->indices.size(), 6U);
        EXPECT_TRUE(shown->notes.empty());
    }
    expectRefused(readWith(R"({"visible":0})"), "visible");
}

} // namespace
} // namespace voxtact::test
