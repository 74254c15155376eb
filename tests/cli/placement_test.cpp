// SPDX-License-Identifier: MIT
// What is said of meshes that do not lie where the image is, and which option it names. No device is needed.
#include "cli_fixture.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string_view>

namespace voxtact::test {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kStill = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";

class PlacementTest : public CliTest {
  protected:
    /// An image from (100, 50, 0) to (200, 150, 100) mm, opaque everywhere.
    PlacementTest() {
        writeText(path("image.nrrd"),
                  "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 10 10 10\n"
                  "space directions: (10,0,0) (0,10,0) (0,0,10)\nspace origin: (105,55,5)\nencoding: raw\n\n" +
                      std::string(1000, '\x78'));
    }

    /// A tetrahedron of 40 mm, from (120, 70, 20) on, in another unit or space.
    [[nodiscard]] std::string mesh(const std::string& name, double scale, double side, double from = 120,
                                   const std::string& head = "") const {
        std::string text = head;
        for (const std::array<double, 3>& corner :
             {std::array<double, 3>{0, 0, 0}, {40, 0, 0}, {0, 40, 0}, {0, 0, 40}}) {
            text += "v " + std::to_string(side * scale * (from + corner[0])) + " " +
                    std::to_string(side * scale * (70 + corner[1])) + " " + std::to_string(scale * (20 + corner[2])) +
                    "\n";
        }
        writeText(path(name), text + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
        return path(name);
    }

    [[nodiscard]] Json pairRow(const std::string& mesh, const Arguments& more = {}) const {
        Arguments all{"info", path("image.nrrd"), mesh, "--format", "json"};
        all.insert(all.end(), more.begin(), more.end());
        const Json rows = Json::parse(output(all)).at("rows");
        EXPECT_EQ(rows.size(), 3U);
        EXPECT_EQ(rows.at(2).at("kind"), "pair");
        EXPECT_EQ(rows.at(2).at("path"), mesh);
        EXPECT_EQ(rows.at(2).at("volume"), path("image.nrrd"));
        EXPECT_TRUE(rows.at(2).at("min_x").is_null());
        return rows.at(2);
    }

    [[nodiscard]] std::string errorsOf(const std::string& command, const std::string& mesh,
                                       const Arguments& more = {}) const {
        Arguments all{command, "--volume", path("image.nrrd"), "--mesh", mesh, "--iso", "100"};
        all.insert(all.end(), more.begin(), more.end());
        const Ran ran = run(all);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.err;
    }
};

TEST_F(PlacementTest, InfoSaysHowMuchIsInside) {
    Json row = pairRow(mesh("in.obj", 1, 1));
    EXPECT_EQ(row.at("overlap_percent"), 100);
    EXPECT_EQ(row.at("box_distance"), 0);
    EXPECT_EQ(row.at("hint"), "");
    row = pairRow(mesh("half.obj", 1, 1, 80)); // from 80 to 120: the image begins at 100
    EXPECT_EQ(row.at("overlap_percent"), 50);
    EXPECT_EQ(row.at("hint"), "");
    row = pairRow(mesh("beside.obj", 1, 1, 230));
    EXPECT_EQ(row.at("overlap_percent"), 0);
    EXPECT_EQ(row.at("box_distance"), 30);
    EXPECT_EQ(row.at("hint"), "");
    EXPECT_THAT(output({"info", path("image.nrrd"), path("half.obj"), path("beside.obj"), "--format", "text"}),
                AllOf(HasSubstr("half.obj\n  in           " + path("image.nrrd") +
                                "\n  overlap      50 % of the mesh's box is inside\n"),
                      HasSubstr("overlap      none, the boxes are 30 mm apart\n")));
}

TEST_F(PlacementTest, InfoNamesTheOptionThatWouldHelp) {
    const std::string ras = mesh("ras.obj", 1, -1);
    const Json row = pairRow(ras);
    EXPECT_EQ(row.at("overlap_percent"), 0);
    EXPECT_NEAR(row.at("box_distance").get<double>(), std::hypot(220, 120), 1e-6);
    EXPECT_EQ(row.at("hint"), "100 % of its box would be inside with --mesh-space ras");
    EXPECT_EQ(pairRow(ras, {"--mesh-space", "ras"}).at("overlap_percent"), 100);
    EXPECT_EQ(pairRow(mesh("in.obj", 1, 1), {"--mesh-space", "ras"}).at("hint"),
              "100 % of its box would be inside with --mesh-space lps");
    EXPECT_EQ(pairRow(mesh("metres.obj", 1e-3, 1)).at("hint"),
              "100 % of its box would be inside with --mesh-scale 1000");
    EXPECT_EQ(pairRow(mesh("microns.obj", 1e3, 1)).at("hint"),
              "100 % of its box would be inside with --mesh-scale 0.001");
    EXPECT_EQ(pairRow(mesh("both.obj", 1e-3, -1)).at("hint"),
              "100 % of its box would be inside with --mesh-space ras --mesh-scale 1000");
    EXPECT_THAT(output({"info", path("image.nrrd"), ras, "--format", "text"}),
                HasSubstr("  or           100 % of its box would be inside with --mesh-space ras\n"));
    // A space that contradicts the file is no help.
    EXPECT_EQ(pairRow(mesh("said.obj", 1, -1, 120, "# SPACE=LPS\n")).at("hint"), "");
}

TEST_F(PlacementTest, EveryQuestionSaysWhatComesNearNothing) {
    const std::string ras = mesh("ras.obj", 1, -1);
    const std::string metres = mesh("metres.obj", 1e-3, 1);
    writeText(path("still.txt"), std::string(kStill) + kStill);
    for (const std::string command : {"touch", "count", "distance", "area", "overlap"}) {
        EXPECT_EQ(errorsOf(command, ras), "voxtact: note: " + ras + " does not come near " + path("image.nrrd") +
                                              " at its pose, the boxes are 251 mm apart; 100 % of its box would be "
                                              "inside with --mesh-space ras\n");
        EXPECT_THAT(errorsOf(command, metres),
                    AllOf(HasSubstr("inside with --mesh-scale 1000\n"), Not(HasSubstr("mm long"))));
        EXPECT_EQ(errorsOf(command, mesh("in.obj", 1, 1)), "");
        EXPECT_THAT(errorsOf(command, mesh("far.obj", 1, 1, 900)),
                    HasSubstr("apart; are --mesh-space, --mesh-scale and the poses (world mm, LPS) right?"));
    }
    const Arguments poses{"--poses", path("still.txt")};
    EXPECT_THAT(errorsOf("motion", ras, poses), HasSubstr("does not come near " + path("image.nrrd") +
                                                          " at any of 2 poses, the boxes are 251 mm apart; 100 %"));
    EXPECT_EQ(errorsOf("motion", mesh("in.obj", 1, 1), poses), "");
}

TEST_F(PlacementTest, PosesOfAnotherSpaceAreSuspected) {
    const std::string tool = mesh("origin.obj", 1, 1, -20); // y from 70 on
    writeText(path("ras.txt"), "1 0 0 -140 0 1 0 -20 0 0 1 20 0 0 0 1\n");
    EXPECT_THAT(errorsOf("touch", tool, {"--poses", path("ras.txt")}),
                HasSubstr("100 % of its box would be inside with --poses-space ras"));
    EXPECT_EQ(errorsOf("touch", tool, {"--poses", path("ras.txt"), "--poses-space", "ras"}), "");
    writeText(path("lps.txt"), "1 0 0 140 0 1 0 20 0 0 1 20 0 0 0 1\n");
    EXPECT_THAT(errorsOf("touch", tool, {"--poses", path("lps.txt"), "--poses-space", "ras"}),
                HasSubstr("inside with --poses-space lps"));
    writeText(path("needle.txt"), "1 0 0 -140 0 1 0 -90 0 0 1 20 0 0 0 1\n");
    EXPECT_THAT(errorsOf("touch", "builtin:needle", {"--poses", path("needle.txt")}),
                HasSubstr("inside with --poses-space ras"));
}

/// The poses of one motion in each format.
TEST_F(PlacementTest, FormatsOfPoses) {
    const std::string tool = mesh("origin.obj", 1, 1, -20);
    writeText(path("matrix.txt"), "0 -1 0 330 1 0 0 90 0 0 1 20 0 0 0 1\n1 0 0 140 0 1 0 20 0 0 1 20 0 0 0 1\n");
    const auto rows = [&](const Arguments& more) {
        Arguments all{"distance", "--volume", path("image.nrrd"), "--mesh", tool, "--iso", "100"};
        all.insert(all.end(), more.begin(), more.end());
        const Ran ran = run(all);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.out;
    };
    const std::string expected = rows({"--poses", path("matrix.txt")});
    EXPECT_THAT(linesOf(expected).at(1), HasSubstr(",20")) << "from 220 on, beyond 200";
    const std::string half = "0.70710678118654752";
    for (const auto& [format, text] :
         std::map<std::string, std::string>{{"t-xyzw", "330 90 20 0 0 " + half + " " + half + "\n140,20,20,0,0,0,1\n"},
                                            {"t-wxyz", "330 90 20 " + half + " 0 0 " + half + "\n140 20 20 1 0 0 0\n"},
                                            {"xyzw-t", "0 0 " + half + " " + half + " 330 90 20\n0 0 0 1 140 20 20\n"},
                                            {"wxyz-t", half + " 0 0 " + half + " 330 90 20\n1 0 0 0 140 20 20\n"}}) {
        writeText(path("poses.txt"), text);
        EXPECT_EQ(rows({"--poses", path("poses.txt"), "--poses-format", format}), expected) << format;
    }
    const Arguments asked{"touch", "--volume", path("image.nrrd"), "--mesh", tool, "--poses", path("poses.txt")};
    EXPECT_THAT(refused(1, asked), HasSubstr("7 numbers, a pose has 16"));
    Arguments other = asked;
    other.insert(other.end(), {"--poses-format", "quaternion"});
    EXPECT_THAT(refused(2, other), HasSubstr("--poses-format: 'quaternion' is unknown; choose from: matrix, t-xyzw"));
    other.back() = "t-xyzw";
    EXPECT_THAT(refused(1, other), HasSubstr("line 1: the quaternion has the norm"));
}

/// An element of explicit VR little endian.
std::string element(std::uint32_t tag, const char* type, std::string value) {
    if (value.size() % 2 != 0) {
        value += std::string_view(type) == "UI" ? '\0' : ' ';
    }
    const auto little = [](std::uint32_t number, std::size_t bytes) {
        std::string text;
        for (std::size_t i = 0; i < bytes; ++i) {
            text += static_cast<char>(number >> 8 * i & 0xFF);
        }
        return text;
    };
    const auto size = static_cast<std::uint32_t>(value.size());
    return little(tag >> 16, 2) + little(tag & 0xFFFF, 2) + type +
           (std::string_view(type) == "OW" ? little(0, 2) + little(size, 4) : little(size, 2)) + value;
}

/// 40 x 40 pixels of 2 mm, all 120.
std::string sliceAt(int height) {
    const auto number = [](char value) { return std::string{value, '\0'}; };
    std::string pixels;
    for (int i = 0; i < 1600; ++i) {
        pixels += number('\x78');
    }
    return element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(0x0020000E, "UI", "1.2.3.4") +
           element(0x00200032, "DS", "110\\60\\" + std::to_string(height)) +
           element(0x00200037, "DS", "1\\0\\0\\0\\1\\0") + element(0x00280002, "US", number(1)) +
           element(0x00280004, "CS", "MONOCHROME2") + element(0x00280010, "US", number(40)) +
           element(0x00280011, "US", number(40)) + element(0x00280030, "DS", "2\\2") +
           element(0x00280100, "US", number(16)) + element(0x00280101, "US", number(16)) +
           element(0x00280102, "US", number(15)) + element(0x00280103, "US", number(0)) +
           element(0x7FE00010, "OW", pixels);
}

/// Refused by default, and every answer from resampled slices says so.
TEST_F(PlacementTest, SlicesAreResampledOnlyWhenAsked) {
    std::filesystem::create_directory(path("ct"));
    std::filesystem::create_directory(path("even"));
    for (int i = 0; i < 20; ++i) {
        writeText(path("even/s" + std::to_string(i)), sliceAt(5 * i));
        if (i != 7) {
            writeText(path("ct/s" + std::to_string(i)), sliceAt(5 * i));
        }
    }
    const std::string tool = mesh("in.obj", 1, 1);
    writeText(path("still.txt"), std::string(kStill) + kStill);
    const std::string note =
        "resampled to a regular grid by linear interpolation, as floats: gaps of 5 to 10 mm become";
    for (const std::string command : {"touch", "count", "distance", "area", "overlap", "motion"}) {
        const auto ask = [&](const std::string& folder, const Arguments& more) {
            Arguments all{command, "--volume", path(folder), "--mesh", tool, "--iso", "100"};
            if (command == "motion") {
                all.insert(all.end(), {"--poses", path("still.txt")});
            }
            all.insert(all.end(), more.begin(), more.end());
            return all;
        };
        EXPECT_THAT(
            refused(1, ask("ct", {})),
            AllOf(HasSubstr("a slice is missing between 's6' (at 30 mm) and 's8' (at 40 mm): most gaps are 5 mm"),
                  HasSubstr("(to the program: --resample)")));
        const Ran ran = run(ask("ct", {"--resample"}));
        EXPECT_THAT(ran.err, HasSubstr(note)) << command;
        EXPECT_EQ(rowsOf(ran.out).at(0).at("resampled"), "1") << command;
        const Ran even = run(ask("even", {"--resample", "--format", "json"}));
        EXPECT_THAT(even.err, Not(HasSubstr("resampled")));
        EXPECT_EQ(Json::parse(even.out).at("rows").at(0).at("resampled"), "no") << command;
        EXPECT_THAT(run(ask("even", {})).out, Not(HasSubstr("resampled")));
    }
    const Ran info = run({"info", path("ct"), "--resample", "--format", "json"});
    EXPECT_EQ(Json::parse(info.out).at("rows").at(0).at("resampled"), "yes");
    const Ran plan = run({"plan", "--volume", path("ct"), "--resample", "--iso", "100", "--target", "150,100,50",
                          "--avoid-opacity", "200:0,201:1", "--entries", "42", "--border-entries"});
    EXPECT_EQ(rowsOf(plan.out).at(0).at("resampled"), "1") << plan.err;
}

} // namespace
} // namespace voxtact::test
