// SPDX-License-Identifier: MIT
// voxtact distance, and voxtact touch --margin.
#include "cli/cli_fixture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// A scalpel whose tip goes along z: in the head, 20 mm or so above it, and far away.
class DistanceTest : public CliTest {
  protected:
    void SetUp() override {
        writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0    0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 120  0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 500  0 0 0 1\n");
    }
    [[nodiscard]] Arguments detect(const Arguments& more) const {
        Arguments all{"distance", "--volume",        "builtin:head:30", "--mesh", "builtin:scalpel:300",
                      "--poses",  path("poses.txt"), "--format",        "csv"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] std::vector<std::map<std::string, std::string>> rows(const Arguments& more,
                                                                       const RunOptions& options = {}) const {
        return rowsOf(output(detect(more), options));
    }
    /// Its output. A number that no voxel has is measured to, with a note.
    static std::string expectMeasured(const Arguments& arguments) {
        const Ran ran = run(arguments);
        const bool nowhere = std::ranges::any_of(
            arguments, [](const std::string& argument) { return argument.find("999") != std::string::npos; });
        EXPECT_EQ(ran.status, 0);
        EXPECT_EQ(withoutProgress(ran.err), nowhere
                                                ? "voxtact: note: --to: no voxel of the label map has the label 999; "
                                                  "the distance is infinite\n"
                                                : "");
        return ran.out;
    }
};

TEST_F(DistanceTest, AddsBoundsToEachRow) {
    const auto found = rows({});
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].at("lower"), "0");
    EXPECT_EQ(found[0].at("upper"), "0");
    const double lo = std::stod(found[1].at("lower"));
    const double hi = std::stod(found[1].at("upper"));
    EXPECT_GT(lo, 10);
    EXPECT_LT(hi, 40);
    EXPECT_LE(hi - lo, 0.010002);
    // 380 mm farther along the same line, nearly.
    EXPECT_NEAR(std::stod(found[2].at("lower")), lo + 380, 1);
    const auto fine = rows({"--tolerance", "0.0001", "--threads", "1"});
    const double fineLo = std::stod(fine[1].at("lower"));
    EXPECT_LE(std::stod(fine[1].at("upper")) - fineLo, 0.000102);
    EXPECT_GE(fineLo, lo);
}

TEST_F(DistanceTest, GoesNoFartherThanItIsTold) {
    const auto found = rows({"--max", "100"});
    EXPECT_LT(std::stod(found[1].at("upper")), 40);
    EXPECT_EQ(found[2].at("lower"), "100");
    EXPECT_EQ(found[2].at("upper"), "inf");
}

TEST_F(DistanceTest, OfNothingIsInfinite) {
    const Arguments how{"--opacity", "0:0"};
    const RunOptions transparent{.note = "nothing touches"};
    EXPECT_EQ(rows(how, transparent)[1].at("lower"), "inf");
    Arguments json = detect(how);
    json[8] = "json";
    EXPECT_THAT(output(json, transparent), HasSubstr(R"("lower":"inf","upper":"inf")"));
}

TEST_F(DistanceTest, AMarginIsAnsweredLikeATouch) {
    const auto touches = [&](const std::string& margin) {
        Arguments arguments = detect({"--margin", margin});
        arguments[0] = "touch";
        return rowsOf(output(arguments));
    };
    const double distance = std::stod(rows({})[1].at("upper"));
    for (const auto& [margin, hits] : {std::pair(0.0, "100"), std::pair(distance - 1, "100"),
                                       std::pair(distance + 0.001, "110"), std::pair(1000.0, "111")}) {
        const auto found = touches(std::to_string(margin));
        ASSERT_EQ(found.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(found[i].at("touch"), std::string(1, hits[i])) << margin << ", pose " << i;
            EXPECT_EQ(found[i].at("x").empty(), hits[i] == '0');
        }
    }
    // The tip is at z = 120; the witness point is opaque, and so near.
    EXPECT_NEAR(120 - std::stod(touches("1000")[1].at("z")), distance, 0.5);
}

TEST_F(DistanceTest, WritesTheClosestPoints) {
    output({"make", "volume", "builtin:head:18", path("labels.nii.gz")});
    output(detect({"--witness", path("closest.csv"), "--labels", path("labels.nii.gz")}));
    const std::string text = readText(path("closest.csv"));
    EXPECT_EQ(linesOf(text).at(0), "pose,mesh,volume,triangle,mesh_x,mesh_y,mesh_z,volume_x,volume_y,volume_z,label,"
                                   "per_x,per_y,per_z,per_rx,per_ry,per_rz");
    const auto found = rowsOf(text);
    ASSERT_EQ(found.size(), 3U);
    const auto& apart = found[1];
    // The tip is at the object's origin: turning does not move it.
    EXPECT_NEAR(std::stod(apart.at("mesh_z")), 120, 1e-6);
    EXPECT_EQ(apart.at("per_rx"), "0");
    EXPECT_GT(std::stod(apart.at("per_z")), 0.99);
    const double away = std::hypot(std::stod(apart.at("mesh_x")) - std::stod(apart.at("volume_x")),
                                   std::stod(apart.at("mesh_y")) - std::stod(apart.at("volume_y")),
                                   std::stod(apart.at("mesh_z")) - std::stod(apart.at("volume_z")));
    EXPECT_NEAR(away, std::stod(rows({})[1].at("upper")), 1e-4);
    EXPECT_NE(found[0].at("label"), "0");

    output(detect({"--witness", path("closest.ply")}));
    const std::vector<std::string> ply = linesOf(readText(path("closest.ply")));
    EXPECT_THAT(ply, testing::Contains("element vertex 6"));
    EXPECT_THAT(ply, testing::Contains("element edge 3"));
    const auto end = static_cast<std::size_t>(std::find(ply.begin(), ply.end(), "end_header") - ply.begin());
    EXPECT_EQ(ply.size(), end + 1 + 6 + 3);
}

/// A map without a label but 0 once ended the program.
TEST_F(DistanceTest, AllOfNoLabelsIsRefused) {
    writeNifti(path("zero.nii"), {.sizes = {3, 8, 8, 8, 1, 1, 1, 1}, .type = 2, .bits = 8, .bytes = 512, .value = 0});
    for (const auto& [question, option] : {std::pair("distance", "--to"), std::pair("area", "--in")}) {
        Arguments arguments = detect({"--labels", path("zero.nii"), option, "all"});
        arguments[0] = question;
        EXPECT_THAT(refused(2, arguments), HasSubstr(std::string(option) + " all: the label map has no label but 0"));
    }
}

/// The point of a margin is no farther than that, whatever the tolerance of distances is.
TEST_F(DistanceTest, AWitnessIsWithinTheMargin) {
    const double lower = std::stod(rows({"--tolerance", "1e-6"})[1].at("lower"));
    Arguments touch = detect({"--margin", std::to_string(lower + 2e-6)});
    touch[0] = "touch";
    const auto found = rowsOf(output(touch));
    ASSERT_EQ(found[1].at("touch"), "1");
    // The tip is at (0, 0, 120), and nearest.
    const double away =
        std::hypot(std::stod(found[1].at("x")), std::stod(found[1].at("y")), std::stod(found[1].at("z")) - 120);
    EXPECT_NEAR(away, lower, 5e-5);
}

/// A name with a line break does not end a line of the header.
TEST_F(DistanceTest, APlyFileHasEachNameInALine) {
    const std::string mesh = path("two\nelement lines.stl");
    output({"make", "mesh", "builtin:scalpel:300", mesh});
    output({"distance", "--volume", "builtin:head:30", "--mesh", mesh, "--poses", path("poses.txt"), "--witness",
            path("named.ply")});
    const std::vector<std::string> ply = linesOf(readText(path("named.ply")));
    EXPECT_EQ(std::ranges::count_if(ply, [](const std::string& line) { return line.starts_with("element"); }), 2);
    EXPECT_THAT(ply, testing::Contains(testing::EndsWith("two element lines.stl")));
}

TEST_F(DistanceTest, WritesTheClearanceToLabels) {
    output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
    const std::string whole = rows({})[1].at("lower");
    const auto labelled = [&](const std::string& to, const Arguments& more = {}) {
        Arguments how{"--labels", path("labels.nii.gz"), "--to", to};
        how.insert(how.end(), more.begin(), more.end());
        const std::string csv = expectMeasured(detect(how));
        EXPECT_EQ(linesOf(csv).at(0), "pose,mesh,volume,label,lower,upper");
        return rowsOf(csv);
    };
    // The voxels are the labels: whatever is opaque has one of them.
    double least = 1e9;
    for (const auto& row : labelled("all")) {
        EXPECT_NE(row.at("label"), "0");
        if (row.at("pose") == "1") {
            least = std::min(least, std::stod(row.at("lower")));
        }
    }
    EXPECT_NEAR(least, std::stod(whole), 0.02);
    const auto two = labelled("70,999");
    EXPECT_EQ(labelled("70,999,70"), two);
    ASSERT_EQ(two.size(), 6U);
    EXPECT_EQ(two[2].at("label"), "70");
    EXPECT_GE(std::stod(two[2].at("lower")), least);
    EXPECT_EQ(two[3].at("label"), "999");
    EXPECT_EQ(two[3].at("lower"), "inf");
    EXPECT_EQ(two[3].at("upper"), "inf");

    // The air around the head is opaque only where it becomes skin, and goes out to the faces at 100 mm.
    EXPECT_GT(std::stod(labelled("0")[1].at("lower")), 30);
    EXPECT_NEAR(std::stod(labelled("0", {"--any-opacity"})[1].at("lower")), 20, 1e-3);
    EXPECT_EQ(labelled("70", {"--any-opacity"})[1], two[2]);
}

TEST_F(DistanceTest, KnowsLabelsByName) {
    output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
    writeText(path("names.txt"), "70 skull\n90 brain\n120 brain\n999 nowhere\n");
    const auto measured = [&](const std::string& to) {
        return detect({"--labels", path("labels.nii.gz"), "--label-names", path("names.txt"), "--to", to});
    };
    const auto rowsFor = [&](const std::string& to) { return rowsOf(output(measured(to))); };
    const auto byNumber = rowsFor("90,120,70");
    EXPECT_EQ(byNumber[0].at("label_name"), "brain");
    EXPECT_EQ(rowsFor("brain,skull"), byNumber);
    EXPECT_EQ(rowsFor("brain,70,90,skull"), byNumber);
    EXPECT_THAT(refused(2, measured("skul")),
                HasSubstr("--to: no voxel of the label map has the label 'skul', did you mean skull?"));
    EXPECT_THAT(refused(2, measured("nowhere")), HasSubstr("--to: no voxel of the label map has the label 'nowhere'"));
}

TEST_F(DistanceTest, SegmentsNameTheLabels) {
    output({"make", "volume", "builtin:head:30", path("plain.nrrd")});
    std::string segmentation = readText(path("plain.nrrd"));
    segmentation.insert(segmentation.find('\n') + 1, "Segment0_Name:=skull\nSegment0_LabelValue:=70\n");
    writeText(path("head.seg.nrrd"), segmentation);
    writeText(path("names.txt"), "70 bone\n");
    const auto measured = [&](const Arguments& more) {
        Arguments how{"--labels", path("head.seg.nrrd"), "--to"};
        how.insert(how.end(), more.begin(), more.end());
        return rowsOf(output(detect(how)));
    };
    const auto byNumber = measured({"70"});
    EXPECT_EQ(byNumber[0].at("label_name"), "skull");
    EXPECT_EQ(measured({"skull"}), byNumber);
    EXPECT_EQ(measured({"70", "--label-names", path("names.txt")})[0].at("label_name"), "bone");
}

/// NRRD of bytes on a grid of 10 mm that begins at a voxel of the image's.
std::string nrrd(const std::array<int, 3>& first, const std::array<int, 3>& size, const std::string& voxels) {
    const auto list = [](const std::array<int, 3>& of, const char* between, int factor) {
        return std::to_string(factor * of[0]) + between + std::to_string(factor * of[1]) + between +
               std::to_string(factor * of[2]);
    };
    return "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: " + list(size, " ", 1) +
           "\nspace directions: (10,0,0) (0,10,0) (0,0,10)\nspace origin: (" + list(first, ",", 10) +
           ")\nencoding: raw\n\n" + voxels;
}

/// As DICOM SEG often is: around the segment alone. The same rows as of the whole map, for the distance, the area and
/// the overlap, and as obstacle of a plan.
TEST_F(DistanceTest, LabelMapsOnAPartOfTheGrid) {
    const auto inside = [](int x, int y, int z) { return x >= 3 && x < 6 && y >= 2 && y < 5 && z >= 4 && z < 8; };
    std::string whole(1000, '\0');
    for (int i = 0; i < 1000; ++i) {
        whole[static_cast<std::size_t>(i)] = inside(i % 10, i / 10 % 10, i / 100) ? '\7' : '\0';
    }
    writeText(path("image.nrrd"), nrrd({0, 0, 0}, {10, 10, 10}, std::string(1000, '\x78')));
    writeText(path("whole.nrrd"), nrrd({0, 0, 0}, {10, 10, 10}, whole));
    writeText(path("part.nrrd"), nrrd({3, 2, 4}, {3, 3, 4}, std::string(36, '\7')));
    writeText(path("beyond.nrrd"), nrrd({8, 2, 4}, {3, 3, 4}, std::string(36, '\7')));
    writeText(path("pose.txt"), "1 0 0 45 0 1 0 30 0 0 1 20 0 0 0 1\n");
    const auto measured = [&](const std::string& command, const char* option, const std::string& labels) {
        return Arguments{command,
                         "--volume",
                         path("image.nrrd"),
                         "--mesh",
                         "builtin:scalpel:500",
                         "--iso",
                         "100",
                         "--poses",
                         path("pose.txt"),
                         "--labels",
                         labels,
                         option,
                         "7"};
    };
    for (const auto& [command, option] :
         std::map<std::string, const char*>{{"distance", "--to"}, {"area", "--in"}, {"overlap", "--in"}}) {
        const std::string expected = output(measured(command, option, path("whole.nrrd")));
        EXPECT_EQ(output(measured(command, option, path("part.nrrd"))), expected) << command;
        EXPECT_THAT(refused(1, measured(command, option, path("beyond.nrrd"))),
                    HasSubstr("its 3 x 3 x 4 voxels begin at voxel 8, 2, 4 of the volume's 10 x 10 x 10, and reach "
                              "beyond them"));
    }
    EXPECT_NE(rowsOf(output(measured("area", "--in", path("part.nrrd"))))[0].at("lower"), "0");
    const auto plan = [&](const std::string& labels) {
        return output({"plan", "--volume", path("image.nrrd"), "--iso", "100", "--target", "20,20,20", "--labels",
                       path(labels), "--avoid", "7", "--entries", "42", "--border-entries"});
    };
    EXPECT_EQ(plan("part.nrrd"), plan("whole.nrrd"));
}

TEST_F(DistanceTest, RefusesALabelMapOnAnotherGrid) {
    output({"make", "volume", "builtin:head:18", path("coarse.nii.gz")});
    EXPECT_THAT(refused(1, detect({"--labels", path("coarse.nii.gz"), "--to", "all"})),
                HasSubstr("--labels: '" + path("coarse.nii.gz") + "': the label map is not on the grid of the volume"));
}

TEST_F(DistanceTest, RefusesWhatDoesNotGoTogether) {
    const auto line = [&](const Arguments& more) { return refused(2, detect(more)); };
    EXPECT_THAT(line({"--to", "1"}), HasSubstr("--to: it needs a label map; add --labels"));
    EXPECT_THAT(line({"--any-opacity"}), HasSubstr("--any-opacity: it needs labels; add --to"));
    EXPECT_THAT(line({"--labels", "l.nii"}), HasSubstr("--labels: no output has labels; add --to or --witness"));
    EXPECT_THAT(line({"--witness", "c.vtk"}), HasSubstr(".csv or .ply"));
    EXPECT_THAT(line({"--tolerance", "0"}), HasSubstr("--tolerance"));
    EXPECT_THAT(line({"--max", "0"}), HasSubstr("--max"));
    EXPECT_THAT(line({"--labels", "l.nii", "--to", "1", "--witness", "c.csv"}), HasSubstr("--witness: not with --to"));
    for (const char* option : {"--method", "--margin", "--contacts", "--on", "--device", "--projection"}) {
        EXPECT_THAT(line({option, "1"}), HasSubstr(option));
    }
    EXPECT_THAT(line({"--witness", path("poses.txt") + "/../poses.txt"}), HasSubstr("--witness"));
    EXPECT_EQ(filesInFolder(), 1U);
}

} // namespace
} // namespace voxtact::test
