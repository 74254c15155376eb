// SPDX-License-Identifier: MIT
// Lists of points.
#include "io_test_support.h"

#include <sstream>

namespace voxtact::test {
namespace {

TEST(PointList, NumbersAndMaybeAName) {
    const TemporaryFolder folder;
    const auto points = io::readPoints(
        folder.write("points.txt", "\xEF\xBB\xBF# mm\r\n\r\n1 -2.5 3e1\n  4\t5 6 left,\"deep\" # a name\n7 8 9"));
    ASSERT_TRUE(isOk(points));
    ASSERT_EQ(points->size(), 3U);
    EXPECT_EQ((*points)[0].position, (Vec3{1, -2.5, 30}));
    EXPECT_EQ((*points)[0].name, "");
    EXPECT_EQ((*points)[0].line, 3U);
    EXPECT_EQ((*points)[1].position, (Vec3{4, 5, 6}));
    EXPECT_EQ((*points)[1].name, "left,\"deep\"");
    EXPECT_EQ((*points)[1].line, 4U);
    EXPECT_EQ((*points)[2].line, 5U);
}

TEST(PointList, RefusalsNameTheLine) {
    const TemporaryFolder folder;
    struct Case {
        const char* line;
        const char* reason;
    };
    for (const Case& bad : {Case{"1 2", "line 2: a point is three numbers"}, Case{"1 2 3 a b", "this has 5 words"},
                            Case{"one", "this has 1 word"}, Case{"1 2 x", "line 2: 'x' is not a number"},
                            Case{"1 nan 3", "line 2: 'nan' is not"}, Case{"1e999 2 3", "line 2: '1e999' is outside"},
                            Case{"1,2,3", "this has 1 word"}}) {
        SCOPED_TRACE(bad.line);
        expectRefused(io::readPoints(folder.write("points.txt", std::string("1 2 3\n") + bad.line + "\n4 5 6\n")),
                      bad.reason);
    }
    expectRefused(io::readPoints(folder.write("points.txt", "# none\n")), "it has no point");
    expectRefused(io::readPoints(folder / "absent.txt"), "absent.txt");
}

constexpr const char* kFcsv = "# Markups fiducial file version = 4.11\n# CoordinateSystem = RAS\n"
                              "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"
                              "vtkMRMLMarkupsFiducialNode_0,1,2,3,0,0,0,1,1,1,0,F-1,,\r\n"
                              "vtkMRMLMarkupsFiducialNode_1,-4.5,5e1,6,0,0,0,1,1,1,0,\"left, \"\"deep\"\"\",,\n";

std::string markups(const std::string& system, const std::string& points,
                    const std::string& more = "\"coordinateUnits\": \"mm\",") {
    return "{\"markups\": [{\"type\": \"Fiducial\", " + more + "\"coordinateSystem\": " + system +
           ", \"controlPoints\": [" + points + "]}]}";
}

TEST(PointList, SlicersFiducialsStateTheirSpace) {
    const TemporaryFolder folder;
    const auto points = io::readPoints(folder.write("f.fcsv", kFcsv));
    ASSERT_TRUE(isOk(points));
    ASSERT_EQ(points->size(), 2U);
    EXPECT_EQ((*points)[0].position, (Vec3{-1, -2, 3}));
    EXPECT_EQ((*points)[0].name, "F-1");
    EXPECT_EQ((*points)[0].line, 4U);
    EXPECT_EQ((*points)[1].position, (Vec3{4.5, -50, 6}));
    EXPECT_EQ((*points)[1].name, "left, \"deep\"");
    EXPECT_TRUE(isOk(io::readPoints(folder / "f.fcsv", io::MeshSpace::RAS)));
    expectRefused(io::readPoints(folder / "f.fcsv", io::MeshSpace::LPS), "its coordinates are in RAS, not in LPS");

    // Slicer 4 writes numbers; older files say nothing.
    const std::string plain = "id,1,2,3,0,0,0,1,1,1,0,F,,\n";
    for (const auto& [word, x] : {std::pair("0", -1.0), std::pair("1", 1.0), std::pair("LPS", 1.0)}) {
        const auto one =
            io::readPoints(folder.write("g.FCSV", std::string("# CoordinateSystem = ") + word + "\n" + plain));
        ASSERT_TRUE(isOk(one));
        EXPECT_EQ((*one)[0].position[0], x) << word;
    }
    expectRefused(io::readPoints(folder.write("h.fcsv", plain)), "it does not state its coordinate system");
    EXPECT_TRUE(isOk(io::readPoints(folder / "h.fcsv", io::MeshSpace::LPS)));
    EXPECT_TRUE(isOk(io::readPoints(folder.write("b.fcsv", "\xEF\xBB\xBF# CoordinateSystem = LPS\n" + plain))));
    for (const char* second : {"RAS", "LPS"}) {
        expectRefused(io::readPoints(folder.write("two.fcsv", "# CoordinateSystem = LPS\n" + plain +
                                                                  "# CoordinateSystem = " + second + "\n")),
                      "line 3: the coordinate system is stated behind points, or twice");
    }
    // Columns in another order.
    const auto turned =
        io::readPoints(folder.write("t.fcsv", "# CoordinateSystem = LPS\n# columns = label,z,y,x\nA,3,2,1\n"));
    ASSERT_TRUE(isOk(turned));
    EXPECT_EQ((*turned)[0].position, (Vec3{1, 2, 3}));
    EXPECT_EQ((*turned)[0].name, "A");
}

TEST(PointList, SlicersMarkupsStateTheirSpace) {
    const TemporaryFolder folder;
    const std::string point =
        R"({"id": "1", "label": "entry one", "position": [1, 2.5, -3], "positionStatus": "defined"})";
    for (const auto& [system, x] : {std::pair("\"LPS\"", 1.0), std::pair("\"RAS\"", -1.0), std::pair("0", -1.0)}) {
        const auto points = io::readPoints(folder.write("m.mrk.json", markups(system, point + "," + point)));
        ASSERT_TRUE(isOk(points)) << system;
        ASSERT_EQ(points->size(), 2U);
        EXPECT_EQ((*points)[1].position, (Vec3{x, 2.5 * x, -3}));
        EXPECT_EQ((*points)[1].name, "entry one");
        EXPECT_EQ((*points)[1].line, 2U);
    }
}

TEST(PointList, SlicersPointsThatCannotBeTaken) {
    const TemporaryFolder folder;
    const auto fcsv = [&](const std::string& lines) {
        return io::readPoints(folder.write("f.fcsv", "# CoordinateSystem = LPS\n" + lines));
    };
    expectRefused(fcsv(""), "it has no point");
    expectRefused(fcsv("id,1,2\n"), "line 2: it has 3 fields");
    expectRefused(fcsv("id,1,2,x,0,0,0,1,1,1,0,F,,\n"), "line 2: 'x' is not a number");
    expectRefused(fcsv("id,1,2,nan\n"), "line 2: 'nan' is not");
    expectRefused(fcsv("id,1,2,\"3\n"), "line 2: a quote is not closed");
    expectRefused(fcsv("# columns = id,x,y\nid,1,2\n"), "its columns have no x, y, z and label");
    expectRefused(io::readPoints(folder.write("s.fcsv", "# CoordinateSystem = IJK\nid,1,2,3\n")),
                  "the coordinate system 'IJK' is not LPS or RAS");
    expectRefused(io::readPoints(folder / "absent.fcsv"), "there is no such file");

    const auto json = [&](const std::string& text) { return io::readPoints(folder.write("m.mrk.json", text)); };
    expectRefused(json("{\"markups\": []}"), "it does not hold one markup");
    expectRefused(json("[1]"), "it does not hold one markup");
    expectRefused(json("{"), "m.mrk.json");
    expectRefused(json(R"({"markups": [], "markups": []})"), "it says 'markups' twice");
    expectRefused(json(R"({"markups": [{"type": "Line"}]})"), "its markup is a 'Line'");
    expectRefused(json(markups("\"IJK\"", "")), "the coordinate system 'IJK'");
    expectRefused(json(markups("4294967296", "")), "the coordinate system '4294967296'");
    expectRefused(json(markups("\"LPS\"", "", "\"coordinateUnits\": [],")), "its coordinates are not in mm");
    expectRefused(json(markups("\"LPS\"", "", "\"coordinateUnits\": [\"mm\", \"UCUM\", \"millimeter\"],")),
                  "it has no point");
    expectRefused(json(markups("\"LPS\"", "", "\"coordinateUnits\": \"m\",")), "its coordinates are not in mm");
    expectRefused(json(markups("\"LPS\"", "")), "it has no point");
    expectRefused(json(markups("\"LPS\"", R"({"position": [1, 2, 3], "positionStatus": "undefined"})")),
                  "control point 1: its position is 'undefined', not defined");
    for (const char* position : {"[1, 2]", "[1, 2, null]", "[1, 2, \"3\"]", "3"}) {
        expectRefused(json(markups("\"LPS\"", std::string("{\"position\": ") + position + "}")),
                      "control point 1: its position is not three");
    }
}

/// What is written to a stream is what is written to a file.
TEST(WriteToStreams, IsTheFile) {
    const TemporaryFolder folder;
    VolumeData volume;
    volume.grid.size = {2, 3, 4};
    volume.voxels.resize(24);
    for (std::size_t i = 0; i < volume.voxels.size(); ++i) {
        volume.voxels[i] = static_cast<std::byte>(i);
    }
    for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"}) {
        std::ostringstream out;
        ASSERT_TRUE(isOk(io::writeVolume(out, name, volume.view())));
        ASSERT_TRUE(isOk(io::writeVolume(folder / name, volume.view())));
        EXPECT_EQ(out.str(), contentOf(folder / name));
    }
    std::ostringstream out;
    expectRefused(io::writeVolume(out, "v.png", volume.view()), "the ending of a volume is");
    const std::vector<std::uint8_t> rgba(24, 77);
    ASSERT_TRUE(isOk(io::writePng(out, 3, 2, rgba)));
    ASSERT_TRUE(isOk(io::writePng(folder / "p.png", 3, 2, rgba)));
    EXPECT_EQ(out.str(), contentOf(folder / "p.png"));
    expectRefused(io::writePng(out, 3, 3, rgba), "four a pixel");
}

} // namespace
} // namespace voxtact::test
