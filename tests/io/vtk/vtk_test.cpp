// SPDX-License-Identifier: MIT
// PolyData of VTK, legacy and XML: VTK itself is the judge.
#include "../io_test_support.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::ElementsAre;
using Triangle = std::array<double, 9>;

/// Each triangle from its smallest corner on, in order.
std::vector<Triangle> normalized(std::vector<Triangle> triangles) {
    for (Triangle& triangle : triangles) {
        std::array<Triangle, 3> turned{triangle, triangle, triangle};
        std::rotate(turned[1].begin(), turned[1].begin() + 3, turned[1].end());
        std::rotate(turned[2].begin(), turned[2].begin() + 6, turned[2].end());
        triangle = *std::min_element(turned.begin(), turned.end());
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

std::vector<Triangle> trianglesOf(const MeshData& mesh) {
    std::vector<Triangle> triangles(mesh.indices.size() / 3);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            triangles[i / 3][3 * (i % 3) + axis] = mesh.positions[3 * std::size_t{mesh.indices[i]} + axis];
        }
    }
    return normalized(std::move(triangles));
}

/// The triangles of each file that VTK names.
std::map<std::string, std::vector<Triangle>> askVtk(const std::string& arguments) {
    const std::string command = "'" VOXTACT_TEST_PYTHON "' '" VOXTACT_TEST_VTK "' " + arguments;
    FILE* const pipe = ::popen(command.c_str(), "r");
    std::string text;
    std::array<char, 4096> piece{};
    for (std::size_t got = 1; pipe != nullptr && got > 0;) {
        got = std::fread(piece.data(), 1, piece.size(), pipe);
        text.append(piece.data(), got);
    }
    EXPECT_EQ(pipe == nullptr ? -1 : ::pclose(pipe), 0)
        << VOXTACT_TEST_PYTHON " cannot import vtkmodules: install python3-vtk9";
    std::map<std::string, std::vector<Triangle>> answers;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name;
        words >> name;
        std::vector<double> numbers;
        for (std::string word; words >> word;) {
            numbers.push_back(std::strtod(word.c_str(), nullptr));
        }
        std::vector<Triangle>& triangles = answers[name];
        triangles.resize(numbers.size() / 9);
        for (std::size_t i = 0; i < 9 * triangles.size(); ++i) {
            triangles[i / 9][i % 9] = numbers[i];
        }
        triangles = normalized(std::move(triangles));
    }
    return answers;
}

void expectNear(const std::vector<Triangle>& ours, const std::vector<Triangle>& theirs, const std::string& name) {
    ASSERT_EQ(ours.size(), theirs.size()) << name;
    for (std::size_t i = 0; i < 9 * ours.size(); ++i) {
        ASSERT_NEAR(ours[i / 9][i % 9], theirs[i / 9][i % 9], 2e-6) << name << " triangle " << i / 9;
    }
}

/// Damages a file in each way; whatever is made of it, it must be an answer in one line.
void expectSound(const std::string& name, const std::string& content) {
    const auto read = [&](const std::string& bytes) {
        const auto mesh = io::readMesh(std::as_bytes(std::span(bytes)), name);
        if (!mesh.ok()) {
            EXPECT_EQ(mesh.error().text.find('\n'), std::string::npos);
            EXPECT_NE(mesh.error().code, ErrorCode::Internal) << mesh.error().text;
        }
    };
    for (std::size_t length = 0; length < content.size(); ++length) {
        read(content.substr(0, length));
    }
    for (std::size_t at = 0; at < content.size(); ++at) {
        for (const char other : {'\0', '9', '\xFF'}) {
            std::string changed = content;
            changed[at] = other;
            read(changed);
        }
    }
}

TEST(Vtk, EveryLayoutThatVtkWritesIsReadAsVtkReadsIt) {
    const TemporaryFolder folder;
    const auto written = askVtk("write '" + folder.path().string() + "'");
    ASSERT_EQ(written.size(), 8U + 96U);
    for (const auto& [name, triangles] : written) {
        const auto mesh = io::readMesh(folder / name);
        ASSERT_TRUE(isOk(mesh)) << name;
        expectNear(trianglesOf(*mesh), triangles, name);
        EXPECT_THAT(mesh->notes, testing::Contains("8 points or lines left out")) << name;
        EXPECT_FALSE(io::readMesh(folder / name, {.space = io::MeshSpace::RAS, .scale = 1}).ok()) << name;
    }
}

TEST(Vtk, DamagedFilesAreAnswered) {
    const TemporaryFolder folder;
    static_cast<void>(askVtk("write '" + folder.path().string() + "'"));
    for (const char* name : {"legacy_0042.vtk", "legacy_0142.vtk", "legacy_0151.vtk", "xml_001000.vtp",
                             "xml_011110.vtp", "xml_020100.vtp", "xml_021001.vtp"}) {
        expectSound(name, contentOf(folder / name));
    }
}

const std::string kPoints = "POINTS 5 float\n0 0 0 1 0 0 1 1 0\n0 1 0 5 5 5\n";
std::string legacy(const std::string& body, const std::string& title = "a title") {
    const bool isNew = body.find("OFFSETS") != std::string::npos;
    return std::string("# vtk DataFile Version ") + (isNew ? "5.1\n" : "3.0\n") + title +
           "\nASCII\nDATASET POLYDATA\n" + body;
}
Result<MeshData> read(const std::string& content, const char* name = "m.vtk") {
    return io::readMesh(std::as_bytes(std::span(content)), name);
}

TEST(Vtk, HandWrittenFilesMeanWhatVtkTakesThemFor) {
    const TemporaryFolder folder;
    std::string names;
    std::vector<std::string> files;
    for (const std::string& body : std::vector<std::string>{
             kPoints + "POLYGONS 1 4\n3 0 1 2\nPOINT_DATA 5\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4 5\n",
             kPoints + "TRIANGLE_STRIPS 1 5\n4 0 1 3 2\nPOLYGONS 2 8\n3 0 1 4 3\n1 2 4\n",
             "FIELD FieldData 2\nTime 1 1 double\n0.5\nm 2 2 int\n1 2\n3 4\n" + kPoints + "POLYGONS 1 4\n3 2 1 0\n",
             kPoints + "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 8.6\n\n"
                       "POLYGONS 2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 2\n"}) {
        const std::string name = std::to_string(files.size()) + ".vtk";
        names += " '" + folder.write(name, legacy(body)).string() + "'";
        files.push_back(name);
    }
    const auto theirs = askVtk("read" + names);
    for (const std::string& name : files) {
        const auto mesh = io::readMesh(folder / name);
        ASSERT_TRUE(isOk(mesh)) << name;
        ASSERT_TRUE(theirs.contains(name));
        expectNear(trianglesOf(*mesh), theirs.at(name), name);
    }
}

TEST(Vtk, TheSpaceThatSlicerWritesIsTaken) {
    const std::string cells = kPoints + "POLYGONS 1 4\n3 1 2 3\n";
    const auto mesh = read(legacy(cells, "3D Slicer output. SPACE=RAS"));
    ASSERT_TRUE(isOk(mesh));
    EXPECT_EQ(mesh->positions[0], -1);
    EXPECT_THAT(mesh->notes, ElementsAre("the file says SPACE=RAS: x and y are negated"));
    const auto field = read(legacy("FIELD FieldData 1\nSPACE 1 1 string\nRAS\n" + cells));
    ASSERT_TRUE(isOk(field));
    EXPECT_EQ(field->positions[0], -1);
    expectRefused(read(legacy("FIELD FieldData 1\nSPACE 1 1 string\nLPS\n" + cells, "SPACE=RAS")),
                  "it says both SPACE=LPS and SPACE=RAS");
}

TEST(Vtk, RefusesWhatIsNoSurface) {
    expectRefused(read("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"),
                  "it holds 'STRUCTURED_POINTS', which is no surface; save the surface as PolyData");
    expectRefused(read("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"), "'UNSTRUCTURED_GRID'");
    expectRefused(read("# vtk DataFile Version 3.0\nt\nHEX\nDATASET POLYDATA\n"), "neither ASCII nor BINARY");
    expectRefused(read("vtk\nt\nASCII\n"), "it does not begin with # vtk DataFile Version");
    expectRefused(read(legacy(kPoints)), "it holds no triangle");
    expectRefused(read(legacy(kPoints + "POLYGONS 1 4\n3 0 1 5\n")),
                  "m.vtk line 9: polygons: cell 0: it uses point 5, there are 5");
    expectRefused(read(legacy(kPoints + "POLYGONS 1 4\n3 0 1 -1\n")), "'-1' is not a natural number");
    expectRefused(read(legacy(kPoints + "POLYGONS 1 3\n2 0 1\n")), "it needs 3 corners or more, and has 2");
    expectRefused(read(legacy(kPoints + "POLYGONS 2 4\n3 0 1 2\n")), "cell 1: its corners go on behind the section");
    expectRefused(read(legacy(kPoints + "POLYGONS 1 5\n3 0 1 2 0\n")), "its cells take 1 numbers fewer than stated");
    expectRefused(read(legacy(kPoints + "POLYGONS 1 4\n3 0 1 2\nPOLYGONS 1 4\n3 0 1 2\n")), "two sections polygons");
    expectRefused(read(legacy(kPoints + "POLYGONS 1 4\n3 0 1 2\n1 2 3\n")), "'1' is no section of PolyData");
    expectRefused(read(legacy("POINTS 5 long\n")), "POINTS needs a number and a type");
    expectRefused(read(legacy("POINTS 99999999999999 float\n")), "truncated");
    expectRefused(read(legacy(kPoints + "POLYGONS 9 99999999999999999\n3 0 1 2\n")), "truncated");
    EXPECT_THAT(read(legacy(kPoints + "POLYGONS 1 4\n3 0 1 2\n") + std::string(9, '\0'))->notes,
                ElementsAre("10 bytes of zeros and white space behind the mesh left out"));
}

std::string xml(const std::string& piece, const std::string& root = "byte_order=\"LittleEndian\"") {
    return R"(<VTKFile type="PolyData" version="1.0" )" + root + "><PolyData>" + piece + "</PolyData></VTKFile>\n";
}
std::string piece(const std::string& corners, const std::string& ends = "3", const std::string& format = "ascii") {
    return R"(<Piece NumberOfPoints="3" NumberOfPolys="1"><Points><DataArray type="Float64" NumberOfComponents="3" )"
           R"(format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points><Polys><DataArray type="Int32" Name="connectivity" )"
           "format=\"" +
           format + "\">" + corners + R"(</DataArray><DataArray type="Int32" Name="offsets" format="ascii">)" + ends +
           "</DataArray></Polys></Piece>";
}

TEST(Vtp, PiecesBecomeOneMesh) {
    const auto mesh = read(xml(piece("0 1 2") + piece("2 1 0")), "m.vtp");
    ASSERT_TRUE(isOk(mesh));
    EXPECT_THAT(mesh->indices, ElementsAre(0, 1, 2, 2, 1, 0));
    const auto field = R"(<FieldData><Array type="String" Name="SPACE" NumberOfTuples="1" format="ascii">82 65 83 0)"
                       "</Array></FieldData>";
    EXPECT_EQ(read(xml(field + piece("1 2 0")), "m.vtp")->positions[0], -1);
}

TEST(Vtp, RefusesWhatItCannotRead) {
    const auto refused = [](const std::string& content, const char* reason) {
        expectRefused(read(content, "m.vtp"), reason, "m.vtp");
    };
    refused("<VTKFile type=\"ImageData\"></VTKFile>", "it holds 'ImageData', which is no surface");
    refused("<VTKFil></VTKFil>", "it has no element VTKFile");
    refused("<VTKFile>", "its XML is damaged or cut off at byte");
    refused(xml(piece("0 1 3")), "Polys: cell 0: it uses point 3, there are 3");
    refused(xml(piece("0 1 -2")), "the array 'connectivity': '-2' is not a natural number");
    refused(xml(piece("0 1 2", "4")), "its offset 4 is not between 0 and 3");
    refused(xml(piece("0 1 2", "3 3")), "a piece states 1 Polys, and has 2");
    refused(xml(piece("0 1 2 0")), "its connectivity has 1 numbers that no cell uses");
    refused(xml(piece("AAAA", "3", "binary")), "the array 'connectivity' is cut off or damaged");
    refused(xml(piece("////fw==", "3", "binary")), "the array 'connectivity' is cut off or damaged");
    refused(xml(piece("", "3", "binary"), ""), "does not say its byte_order");
    refused(xml(piece("", "3", "appended")), "lies behind the appended data");
    refused(xml(piece("", "3", "hex")), "has the unknown format 'hex'");
    refused(xml(piece("0 1 2"), "compressor=\"vtkLZ4DataCompressor\""), "compressed by 'vtkLZ4DataCompressor'");
    refused(xml(piece("0 1 2"), "header_type=\"Int8\""), "its header_type 'Int8' is neither");
    // Blocks that claim to unpack to far more than deflate can pack.
    refused(xml(piece("AQAAAP///38AAAAAAQAAAAAAAAA=", "3", "binary"),
                R"(byte_order="LittleEndian" compressor="vtkZLibDataCompressor")"),
            "is cut off or damaged");
}

} // namespace
} // namespace voxtact::test
