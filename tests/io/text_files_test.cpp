// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <cerrno>
#include <clocale>
#include <fstream>
#include <functional>
#include <istream>
#include <limits>
#include <new>
#include <streambuf>
#include <system_error>
#include <utility>

namespace voxtact::test {
namespace {

const std::string kIdentity = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n";

TEST(Poses, RowsBecomeColumns) {
    const TemporaryFolder folder;
    const auto path =
        folder.write("poses.txt", "\xEF\xBB\xBF# two poses\r\n\r\n1 2 3 4\t5 6 7 8 9 +10 1.1e1 12 0 0 0 1 # last\r\n"
                                  "-1e-3 .5 5. 0 0 1 0 0 0 0 1 0 0 0 0 1");
    const auto poses = io::readPoses(path);
    ASSERT_TRUE(isOk(poses));
    ASSERT_EQ(poses->size(), 2U);
    EXPECT_EQ((*poses)[0], (Mat4{1, 5, 9, 0, 2, 6, 10, 0, 3, 7, 11, 0, 4, 8, 12, 1}));
    EXPECT_EQ((*poses)[1][0], -1e-3);
    EXPECT_EQ((*poses)[1][4], 0.5);
    EXPECT_EQ((*poses)[1][8], 5);
}

/// As numpy, 3D Slicer and ITK write a pose. The transform of ITK goes from the place of the object to the object.
TEST(Poses, AsOtherProgramsWriteThem) {
    const TemporaryFolder folder;
    const Mat4 turned{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    const std::string itk = "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
                            "Parameters: 0 1 0 -1 0 0 0 0 1 -6 5 -7\nFixedParameters: 0 0 0\n";
    // y = A (x - c) + t + c: the same transform, about (1, 2, 3).
    const std::string centred = "#Insight Transform File V1.0\nTransform: MatrixOffsetTransformBase_double_3_3\n"
                                "Parameters: 0 1 0 -1 0 0 0 0 1 -5 2 -7\nFixedParameters: 1 2 3\n";
    for (const std::string& text :
         {std::string("0,-1,0,5,1e+00,0,0,6,0,0,1,7,0,0,0,1\n"),
          std::string("0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1 # a pose\n"),
          std::string("0 -1 0 5\n1 0 0 6\n\n0 0 1 7\n0 0 0 1"), std::string("0,-1,0,5\n1,0,0,6\n0,0,1,7\n0,0,0,1\n"),
          std::string("0 -1 0 5 1 0 0 6 0 0 1 7\n"), std::string("0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7\n"), itk,
          centred}) {
        const auto poses = io::readPoses(folder.write("p.txt", text));
        ASSERT_TRUE(isOk(poses)) << text;
        EXPECT_THAT(*poses, testing::ElementsAre(turned)) << text;
    }
    const auto several =
        io::readPoses(folder.write("p.txt", itk + kIdentity + "0 -1 0 5\n1 0 0 6\n0 0 1 7\n0 0 0 1\n"));
    ASSERT_TRUE(isOk(several));
    EXPECT_THAT(*several, testing::ElementsAre(turned, identity(), turned));
    struct Case {
        std::string text;
        const char* reason;
    };
    const std::string head = "Transform: AffineTransform_double_3_3\n";
    for (const Case& bad :
         {Case{"1 0 0 0\n0 1 0 0\n", "line 2: the end in a pose of four lines of 4 numbers"},
          Case{"1 0 0 0\n0 1 0\n", "line 2: 3 numbers in a pose of four lines"},
          Case{"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n", "line 4"},
          Case{"1,0,0,0,0,1,0,0,0,0,1,0,0,0,1\n", "'1,0,0,0,0,1,0,0,0,0,1,0,0,0,1' is not a number"},
          Case{"1,,0,0,0,1,0,0,0,0,1,0,0,0,0,1\n", "'' is not a number"},
          Case{"Transform: Euler3DTransform_double_3_3\nParameters: 0 0 0 0 0 0\n",
               "line 1: the ITK transform 'Euler3DTransform_double_3_3' is not supported; save it as an affine one"},
          Case{"Transform: AffineTransform_double_2_2\n", "is not supported"},
          Case{head, "line 1: a line 'Parameters:' is missing"},
          Case{head + "Parameters: 1 0 0 0 1 0 0 0 1 0 0\n", "line 2: 'Parameters:' has 11 numbers, not 12"},
          Case{head + "Parameters: 1 0 0 0 1 0 0 0 1 0 0 0\n", "line 2: a line 'FixedParameters:' is missing"},
          Case{head + "Parameters: 1 0 0 0 0 0 0 0 1 0 0 0\nFixedParameters: 0 0 0\n", "line 3"},
          Case{head + "Parameters: 1 0 0 0 1 0 0 0 1 0 x 0\n", "line 2: 'x' is not a number"}}) {
        const auto path = folder.write("p.txt", bad.text);
        expectRefused(io::readPoses(path), bad.reason, path);
    }
}

/// A third of a turn about (1, 1, 1): x becomes y, y becomes z. The order of the numbers is that of the format's name.
TEST(Poses, TranslationsAndQuaternions) {
    using io::PoseFormat;
    const TemporaryFolder folder;
    const auto read = [&](const std::string& text, PoseFormat format) {
        return io::readPoses(folder.write("p.txt", text), format);
    };
    struct Case {
        PoseFormat format;
        const char* name;
        const char* third;   ///< of a turn
        const char* quarter; ///< about x: y becomes z
    };
    const Mat4 third{0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 7, 8, 9, 1};
    const Mat4 quarter{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 1, -2, 3, 1};
    for (const Case& one :
         {Case{PoseFormat::TranslationXyzw, "t-xyzw", "7 8 9 .5 .5 .5 .5", "1,-2,3,0.70710678,0,0,0.70710678"},
          Case{PoseFormat::TranslationWxyz, "t-wxyz", "7 8 9 -.5 -.5 -.5 -.5", "1 -2 3 0.70710678 0.70710678 0 0"},
          Case{PoseFormat::XyzwTranslation, "xyzw-t", ".5 .5 .5 .5 7 8 9", "0.70710678, 0, 0, 0.70710678, 1, -2, 3"},
          Case{PoseFormat::WxyzTranslation, "wxyz-t", ".5 .5 .5 .5 7 8 9", "0.70710678 0.70710678 0 0 1 -2 3"}}) {
        EXPECT_STREQ(toString(one.format), one.name);
        EXPECT_EQ(io::poseFormatFromName(one.name), one.format);
        const auto poses = read(std::string("# t q\n") + one.third + "\n\n" + one.quarter + " # last\n", one.format);
        ASSERT_TRUE(isOk(poses)) << one.name;
        ASSERT_EQ(poses->size(), 2U);
        EXPECT_EQ((*poses)[0], third) << one.name;
        for (std::size_t i = 0; i < quarter.size(); ++i) {
            EXPECT_NEAR((*poses)[1][i], quarter[i], 1e-15) << one.name << ' ' << i; // the norm is 1 - 1e-9
        }
    }
    EXPECT_EQ(io::poseFormatFromName("matrix"), PoseFormat::Matrix);
    EXPECT_EQ(io::poseFormatFromName("xyzw"), std::nullopt);
    const auto refused = [&](const std::string& text, const char* reason, PoseFormat format) {
        expectRefused(read(text, format), reason, "p.txt");
    };
    refused("0 0 0 0 0 0 1\n0 0 0 0.1 0 0 1\n",
            "line 2: the quaternion has the norm 1.004987562112089, not 1; are its numbers in the order of the format "
            "t-xyzw?",
            PoseFormat::TranslationXyzw);
    refused("0 0 0 0 0 0 1\n", "the norm 0, not 1", PoseFormat::XyzwTranslation);
    refused("0 0 0 1e300 1e300 0 1\n", "the norm inf, not 1", PoseFormat::TranslationXyzw);
    refused("0 0 0 0 0 1\n", "line 1: 6 numbers, a pose of the format t-wxyz has 7", PoseFormat::TranslationWxyz);
    refused(kIdentity, "line 1: 16 numbers, a pose of the format wxyz-t has 7", PoseFormat::WxyzTranslation);
    refused("0 0 0 0 0 0 x\n", "line 1: 'x' is not a number", PoseFormat::TranslationXyzw);
    refused("# none\n", "it holds no pose; a pose is a line of 7 numbers", PoseFormat::TranslationXyzw);
    refused("Transform: AffineTransform_double_3_3\n", "is not a number", PoseFormat::TranslationXyzw);
    refused("0 0 0 0 0 0 1\n", "line 1: 7 numbers, a pose has 16, or 12 (row by row)", PoseFormat::Matrix);
}

TEST(Poses, ShortestTextIsExact) {
    const TemporaryFolder folder;
    const Mat4 pose{0.1, 1.0 / 3, -1e-300, 0, 2e17, 5e-324, 1, 0, 7, 8, 9, 0, -0.0, 1e308, 3, 1};
    const auto poses = io::readPoses(folder.write("p.txt", "0.1 2e17 7 -0 0.3333333333333333 5e-324 8 1e308 "
                                                           "-1e-300 1 9 3 0 0 0 1\n" +
                                                               kIdentity));
    ASSERT_TRUE(isOk(poses));
    EXPECT_THAT(*poses, testing::ElementsAre(pose, identity()));
}

TEST(Poses, LocaleDoesNotMatter) {
    const TemporaryFolder folder;
    const std::string before = std::setlocale(LC_ALL, nullptr);
    // Where no such locale is installed the test is weaker, not wrong.
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    const auto poses = io::readPoses(folder.write("p.txt", "1.5 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"));
    std::setlocale(LC_ALL, before.c_str());
    ASSERT_TRUE(isOk(poses));
    EXPECT_EQ((*poses)[0][0], 1.5);
}

TEST(Poses, RefusalsNameTheLine) {
    const TemporaryFolder folder;
    struct Case {
        std::string line;
        const char* reason;
    };
    for (const Case& bad :
         {Case{"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1", "line 3: 15 numbers, a pose has 16, or 12 (row by row)"},
          Case{"1", "line 3: 1 number, a pose has 16, or 12 (row by row)"},
          Case{"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 2", "line 3: 17 numbers, a pose has 16"},
          Case{"1 0 0 x 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: 'x' is not a number"},
          Case{"1,5 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: '1,5' is not a number"},
          Case{"+-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: '+-1' is not a number"},
          Case{"+ 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: '+' is not a number"},
          Case{"0x1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: '0x1' is not a number"},
          Case{"nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: 'nan' is not a finite number"},
          Case{"1 inf 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: 'inf' is not a finite number"},
          Case{"1e999 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 3: '1e999' is outside what a double holds"},
          Case{"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.5 1", "line 3"},
          Case{"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 trailing", "line 3: 'trailing' is not a number"}}) {
        const auto path = folder.write("poses.txt", "# comment\n" + kIdentity + bad.line + "\n");
        expectRefused(io::readPoses(path), bad.reason, path);
    }
    const auto empty = folder.write("empty.txt", "# nothing\n\n");
    expectRefused(io::readPoses(empty), "it holds no pose", empty);
    expectRefused(io::readPoses(folder.write("nothing.txt", "")), "it holds no pose");
    expectRefused(io::readPoses(folder / "absent.txt"), "absent.txt': there is no such file");
    expectRefused(io::readPoses(folder.path()), "it is a folder, not a file");
}

/// Some text, and then what `fail` throws, once.
class FailingBuffer : public std::streambuf {
  public:
    FailingBuffer(std::string text, std::function<void()> fail) : text_(std::move(text)), fail_(std::move(fail)) {}

  protected:
    int_type underflow() override {
        if (gptr() == nullptr) {
            setg(text_.data(), text_.data(), text_.data() + text_.size());
            return traits_type::to_int_type(text_.front());
        }
        if (const auto fail = std::exchange(fail_, {})) {
            fail();
        }
        return traits_type::eof();
    }

  private:
    std::string text_;
    std::function<void()> fail_;
};

TEST(Poses, WhatCannotBeReadIsNotTheEnd) {
    const std::error_code problem(EIO, std::generic_category());
    // At the end of a line, and within one.
    for (const std::string& text : {kIdentity + kIdentity, kIdentity + "1 0 0", std::string("1")}) {
        FailingBuffer buffer(text, [&] { throw std::ios_base::failure("underflow", problem); });
        std::istream stream(&buffer);
        Result<io::PoseReader> reader = io::PoseReader::over(stream, "standard input");
        ASSERT_TRUE(isOk(reader));
        std::vector<Mat4> poses;
        const Result<bool> more = reader->read(9, poses);
        expectRefused(more, "cannot read 'standard input': " + problem.message());
        EXPECT_EQ(more.error().code, ErrorCode::File);
        const std::size_t before = poses.size();
        // Whatever comes behind it.
        expectRefused(reader->read(9, poses), "reading stopped before its end");
        EXPECT_EQ(poses.size(), before);
    }
}

TEST(Poses, NoMemoryIsNotTheEnd) {
    FailingBuffer buffer(kIdentity + "1 0", [] { throw std::bad_alloc(); });
    std::istream stream(&buffer);
    Result<io::PoseReader> reader = io::PoseReader::over(stream, "a");
    ASSERT_TRUE(isOk(reader));
    std::vector<Mat4> poses;
    const Result<bool> more = reader->read(9, poses);
    ASSERT_FALSE(more.ok());
    EXPECT_EQ(more.error().code, ErrorCode::OutOfMemory);
}

TEST(TextFiles, OneThatOpensAndCannotBeRead) {
    const std::filesystem::path file = "/proc/self/mem"; // nothing is at address 0
    if (!std::ifstream(file).is_open()) {
        GTEST_SKIP() << file << " cannot be opened";
    }
    const std::string why = std::generic_category().message(EIO);
    expectRefused(io::readPoses(file), why, file);
    expectRefused(io::readPoints(file), why, file);
    expectRefused(io::readLabelNames(file), why, file);
    expectRefused(io::readCamera(file), why, file);
    expectRefused(io::readTransferFunction(file), why, file);
    expectRefused(io::readColours(file), why, file);
}

TEST(Camera, AnyNumberOfLines) {
    const TemporaryFolder folder;
    const auto camera = io::readCamera(folder.write("c.txt", "1 0 0 0 # x\n0 2 0 0\n0 0 3 4\n0 0 1 0\n"));
    ASSERT_TRUE(isOk(camera));
    EXPECT_EQ(*camera, (Mat4{1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 1, 0, 0, 4, 0}));
}

TEST(Camera, Refusals) {
    const TemporaryFolder folder;
    expectRefused(io::readCamera(folder.write("a", "1 2 3\n")), "3 numbers, a camera has 16 (row by row)",
                  folder / "a");
    expectRefused(io::readCamera(folder.write("b", kIdentity + "0")), "line 2: more than 16 numbers", folder / "b");
    expectRefused(io::readCamera(folder.write("c", "1 0 0 0\n0 1 0 y")), "line 2: 'y' is not a number", folder / "c");
    expectRefused(io::readCamera(folder.write("d", "1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1")), "the matrix is singular",
                  folder / "d");
    expectRefused(io::readCamera(folder.write("e", "")), "0 numbers", folder / "e");
}

std::vector<std::pair<double, double>> pairs(const std::vector<ControlPoint>& points) {
    std::vector<std::pair<double, double>> list;
    for (const ControlPoint& point : points) {
        list.emplace_back(point.value, point.opacity);
    }
    return list;
}

TEST(TransferFunction, TextAndJson) {
    const TemporaryFolder folder;
    const auto expected = testing::ElementsAre(std::pair(-1000.0, 0.0), std::pair(0.5, 0.25), std::pair(0.5, 1.0));
    for (const char* text :
         {"# HU\r\n-1000 0\r\n\r\n.5 0.25 # step\n+0.5 1", R"({"points": [[-1000, 0], [0.5, 0.25], [0.5, 1]], "x": 1})",
          R"( {"points": [{"value": -1e3, "opacity": 0, "color": [1, 2, 3]}, [0.5, 0.25], [0.5, 1]]})"}) {
        const auto points = io::readTransferFunction(folder.write("tf", text));
        ASSERT_TRUE(isOk(points)) << text;
        EXPECT_THAT(pairs(*points), expected) << text;
    }
}

TEST(TransferFunction, Refusals) {
    const TemporaryFolder folder;
    struct Case {
        const char* text;
        const char* reason;
    };
    for (const Case& bad :
         {Case{"0 0\n1", "line 2: 1 number, a point has 2 (value opacity)"}, Case{"0 0\n1 1 1", "line 2: 3 numbers"},
          Case{"0 0\n1 1.5", "line 2: the opacity 1.5 is outside 0..1"}, Case{"0 -0.1", "line 1: the opacity -0.1"},
          Case{"1 0\n\n0 1", "line 3: the value 0 is below the one before it (1)"},
          Case{"0 zero", "line 1: 'zero' is not a number"}, Case{"", "it holds no point"},
          Case{"{\n\"points\": [[0, 0],\n", "line 3"}, Case{"{}", "it has no 'points'"},
          Case{R"({"points": [[0, 0]], "points": [[9, 1]]})", "it says 'points' twice"},
          Case{R"({"points": [{"value": 1, "value": 2, "opacity": 0}]})", "it says 'value' twice"},
          Case{"[]", "it has no 'points'"}, Case{R"({"points": []})", "it has no 'points'"},
          Case{R"({"points": [[0, 0], [1]]})", "points[1]: expected [value, opacity]"},
          Case{R"({"points": [["0", 0]]})", "points[0]: expected"},
          Case{R"({"points": [[0, 2]]})", "points[0]: the opacity 2 is outside 0..1"},
          Case{R"({"points": [[1, 0], {"value": 0, "opacity": 1}]})", "points[1]: the value 0 is below"},
          Case{R"({"points": [[1e999, 0]]})", "number overflow"}}) {
        const auto path = folder.write("tf.txt", bad.text);
        expectRefused(io::readTransferFunction(path), bad.reason, path);
    }
}

TEST(TransferFunction, OfParaView) {
    const TemporaryFolder folder;
    const auto path = folder.write("map.json", R"([{"ColorSpace": "Diverging", "Name": "CT",
        "Points": [-100, 0, 0.5, 0, 300, 0.25, 0.5, 0, 1000, 1, 0.2, 0.7],
        "RGBPoints": [-100, 0, 0, 0, 1000, 1, 0.5, 0.25]}])");
    const auto points = io::readTransferFunction(path);
    ASSERT_TRUE(isOk(points));
    ASSERT_EQ(points->size(), 3U);
    EXPECT_EQ((*points)[1].value, 300);
    EXPECT_EQ((*points)[1].opacity, 0.25);
    EXPECT_EQ((*points)[2].opacity, 1);
    const auto colours = io::readColours(path);
    ASSERT_TRUE(isOk(colours));
    ASSERT_EQ(colours->size(), 2U);
    EXPECT_EQ((*colours)[1].colour, (std::array<double, 3>{1, 0.5, 0.25}));

    const auto refused = [&](const std::string& members) {
        return io::readTransferFunction(folder.write("bad.json", "[{\"RGBPoints\": [0, 0, 0, 0]" + members + "}]"));
    };
    expectRefused(refused(""), "has no opacity ('Points')");
    expectRefused(refused(R"(, "Points": [0, 0, 0.3, 0, 1, 1, 0.5, 0])"),
                  "Points[0]: the opacity behind it has the midpoint 0.3");
    expectRefused(refused(R"(, "Points": [0, 0, 0.5, 1, 1, 1, 0.5, 0])"), "the sharpness 1");
    expectRefused(refused(R"(, "Points": [0, 0, 0.5])"), "Points is not a list of four numbers a point");
    expectRefused(refused(R"(, "Points": [0, 0, 0.5, null])"), "Points is not a list of four numbers a point");
    expectRefused(refused(R"(, "Points": [0, 2, 0.5, 0])"), "opacity point 1: the opacity 2 is outside 0..1");
    expectRefused(refused(R"(, "Points": [1, 0, 0.5, 0, 0, 1, 0.5, 0])"), "opacity point 2: the value 0 is below");
    expectRefused(refused("}, {\"RGBPoints\": []"), "it holds 2 colour maps");
}

TEST(TransferFunction, OfSlicersVolumeProperty) {
    const TemporaryFolder folder;
    const std::string head = "1\n1\n0.9\n0.1\n0.2\n10\n";
    const std::string opacity = "6 -3024 0 139.919 0.589286 3071 0.616071\n";
    const std::string colours = "8 -3024 0 0 0 3071 0.827451 0.658824 1\n";
    const auto path = folder.write("ct.vp", head + opacity + "4 0 1 255 1\n" + colours + "\n");
    const auto points = io::readTransferFunction(path);
    ASSERT_TRUE(isOk(points));
    ASSERT_EQ(points->size(), 3U);
    EXPECT_EQ((*points)[1].value, 139.919);
    EXPECT_EQ((*points)[1].opacity, 0.589286);
    const std::string xml =
        "<VolumeProperty version=\"1.9\" gradientOpacity=\"4 0 1 255 1\"\n scalarOpacity=\"6 -3024 0 "
        "139.919 0.589286 3071 0.616071\" colorTransfer=\"8 -3024 0 0 0 3071 0.827451 0.658824 1\"/>\n";
    const auto element = folder.write("xml.vp", xml);
    const auto same = io::readTransferFunction(element);
    ASSERT_TRUE(isOk(same));
    ASSERT_EQ(same->size(), 3U);
    EXPECT_EQ((*same)[1].value, 139.919);
    EXPECT_EQ((*same)[2].opacity, 0.616071);
    for (const auto& file : {path, element}) {
        const auto read = io::readColours(file);
        ASSERT_TRUE(isOk(read));
        ASSERT_EQ(read->size(), 2U);
        EXPECT_EQ((*read)[1].colour, (std::array<double, 3>{0.827451, 0.658824, 1}));
    }

    const auto refused = [&](const std::string& text) {
        return io::readTransferFunction(folder.write("bad.vp", text));
    };
    expectRefused(refused("<VolumeProperty version=\"1.9\"/>\n"), "has not one attribute scalarOpacity");
    expectRefused(refused("<Scene/>\n"), "bad.vp line 1: it is not one number");
    for (const auto& [from, to, reason] :
         {std::tuple("255 1", "255 0", "bad.vp line 1: the gradient opacity 0"),
          std::tuple("6 -3024", "5 -3024", "bad.vp line 2: it is not the count of its numbers"),
          std::tuple(" scalarOpacity", " xscalarOpacity", "has not one attribute scalarOpacity"),
          std::tuple("/>", " scalarOpacity=\"2 0 0\"/>", "has not one attribute scalarOpacity")}) {
        std::string changed = xml;
        changed.replace(changed.find(from), std::string_view(from).size(), to);
        expectRefused(refused(changed), reason);
    }
    expectRefused(refused(head), "it ends before its opacity");
    expectRefused(refused(head + "4 0 0 1\n4 0 1 255 1\n" + colours),
                  "line 7: it is not the count of its numbers and 2 numbers a point");
    expectRefused(refused(head + opacity + "4 0 1 255 0.5\n" + colours), "line 8: the gradient opacity 0.5");
    expectRefused(refused(head + opacity + "4 0 1 255 1\n6 0 0 0 0 1 1\n"), "line 9: it is not the count");
    expectRefused(refused(head + opacity + "4 0 1 255 1\n" + colours + "7\n"), "line 10: it is behind the colours");
    expectRefused(refused(head + "4 1 0 0 1\n4 0 1 255 1\n" + colours), "opacity point 2: the value 0 is below");
    expectRefused(io::readTransferFunction(folder / "absent.vp"), "there is no such file");
}

TEST(Opacity, Parses) {
    const auto points = io::parseOpacity("-1000:0, -2.5e2:0.1 ,+3E+2:1");
    ASSERT_TRUE(isOk(points));
    EXPECT_THAT(pairs(*points),
                testing::ElementsAre(std::pair(-1000.0, 0.0), std::pair(-250.0, 0.1), std::pair(300.0, 1.0)));
}

TEST(Opacity, Refusals) {
    expectRefused(io::parseOpacity(""), "opacity '': point 1: expected value:opacity");
    expectRefused(io::parseOpacity("1:0,"), "opacity '1:0,': point 2: expected value:opacity");
    expectRefused(io::parseOpacity("1:0,2"), "point 2: expected value:opacity");
    expectRefused(io::parseOpacity("1:0:2"), "point 1: '0:2' is not a number");
    expectRefused(io::parseOpacity("a:0"), "point 1: 'a' is not a number");
    expectRefused(io::parseOpacity(":0"), "point 1: '' is not a number");
    expectRefused(io::parseOpacity("0:nan"), "point 1: 'nan' is not a finite number");
    expectRefused(io::parseOpacity("0:1,5:2"), "point 2: the opacity 2 is outside 0..1");
    expectRefused(io::parseOpacity("5:0,1:1"), "point 2: the value 1 is below the one before it (5)");
}

} // namespace
} // namespace voxtact::test
