// SPDX-License-Identifier: MIT
// voxtact area.
#include "cli/cli_fixture.h"

#include <array>
#include <cmath>
#include <filesystem>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// A scalpel whose tip goes along z: in the head, deeper in it, above it, and far away.
class AreaTest : public CliTest {
  protected:
    void SetUp() override {
        writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0    0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 60   0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 120  0 0 0 1\n"
                                     "1 0 0 0  0 1 0 0  0 0 1 500  0 0 0 1\n");
    }
    [[nodiscard]] Arguments detect(const Arguments& more) const {
        Arguments all{"area",    "--volume",        "builtin:head:32", "--mesh", "builtin:scalpel:300",
                      "--poses", path("poses.txt"), "--format",        "csv"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    using Rows = std::vector<std::map<std::string, std::string>>;
    [[nodiscard]] Rows rows(const Arguments& more) const { return rowsOf(output(detect(more))); }
    static double loOf(const Rows& rows, std::size_t row) { return std::stod(rows.at(row).at("lower")); }
    static double hiOf(const Rows& rows, std::size_t row) { return std::stod(rows.at(row).at("upper")); }
};

TEST_F(AreaTest, AddsBoundsToEachRow) {
    const Rows usual = rows({});
    ASSERT_EQ(usual.size(), 4U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_GT(loOf(usual, i), 10);
        EXPECT_LE(hiOf(usual, i) - loOf(usual, i), 0.100002);
    }
    EXPECT_GT(loOf(usual, 0), hiOf(usual, 1)); // more of it is in
    for (std::size_t i = 2; i < 4; ++i) {
        EXPECT_EQ(usual[i].at("lower"), "0");
        EXPECT_EQ(usual[i].at("upper"), "0");
    }
    const Rows fine = rows({"--tolerance", "0.001", "--threads", "1"});
    EXPECT_LE(hiOf(fine, 0) - loOf(fine, 0), 0.001002);
    EXPECT_LE(loOf(fine, 0), hiOf(usual, 0));
    EXPECT_GE(hiOf(fine, 0), loOf(usual, 0));
}

TEST_F(AreaTest, IsWrittenAsFinelyAsItIsAskedFor) {
    // A triangle of 8e-8 mm^2 in voxels of a ten-thousandth of a millimetre.
    writeText(path("tiny.obj"), "v 0.0001 0.0001 0.0003\nv 0.0005 0.0001 0.0003\nv 0.0001 0.0005 0.0003\nf 1 2 3\n");
    writeText(path("tiny.nrrd"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\nspace: "
                                 "left-posterior-superior\nspace origin: (0,0,0)\nspace directions: (0.0001,0,0) "
                                 "(0,0.0001,0) (0,0,0.0001)\n\n" +
                                     std::string(512, '\xc8'));
    const Rows found = rowsOf(output(
        {"area", "--volume", path("tiny.nrrd"), "--mesh", path("tiny.obj"), "--tolerance", "1e-9", "--format", "csv"}));
    EXPECT_NEAR(loOf(found, 0), 8e-8, 2e-11);
    EXPECT_NEAR(hiOf(found, 0), 8e-8, 2e-11);
    EXPECT_LE(loOf(found, 0), 8.0001e-8);
    EXPECT_GE(hiOf(found, 0), 7.9999e-8);
}

TEST_F(AreaTest, SaysSoBrieflyWhereManyLabelsAreNowhere) {
    output({"make", "volume", "builtin:head:16", path("labels.nii.gz")});
    std::string many = "300";
    for (int label = 301; label < 350; ++label) {
        many += "," + std::to_string(label);
    }
    const auto asked = [&](const std::string& labels) {
        return Arguments{
            "area", "--volume", "builtin:head:16", "--mesh", "builtin:scalpel:300", "--labels", path("labels.nii.gz"),
            "--in", labels};
    };
    const Ran ran = run(asked(many));
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(withoutProgress(ran.err),
              "voxtact: note: --in: no voxel of the label map has the labels 300, 301, 302, 303, 304, 305, 306, 307, "
              "308, 309 and 40 more; the area is 0\n");
    for (int label = 350; label < 4500; ++label) {
        many += "," + std::to_string(label);
    }
    EXPECT_THAT(refused(1, asked(many)), HasSubstr("4096"));
}

TEST_F(AreaTest, SaysWhatRoundingDecides) {
    // A plate in a face of the image.
    writeText(path("plate.obj"), "v -0.2 -0.2 -0.5\nv 0.2 -0.2 -0.5\nv 0 0.2 -0.5\nf 1 2 3\n");
    const RunOptions options{.note =
                                 "the bounds of 1 of 1 areas are farther apart than the tolerance: rounding leaves 1 "
                                 "undecided, 0 reached the iteration limit"};
    writeText(path("box.nrrd"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\nspace: "
                                "left-posterior-superior\nspace origin: (0,0,0)\nspace directions: (1,0,0) (0,1,0) "
                                "(0,0,1)\n\n\xff");
    const Rows found = rowsOf(output({"area", "--volume", path("box.nrrd"), "--mesh", path("plate.obj"), "--opacity",
                                      "0:0,1:1", "--tolerance", "0.001", "--format", "csv"},
                                     options));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].at("lower"), "0");
    EXPECT_NEAR(hiOf(found, 0), 0.08, 1e-5);
}

TEST_F(AreaTest, HasARowForEachLabel) {
    output({"make", "volume", "builtin:head:32", path("labels.nii.gz")});
    const auto asked = [&](const std::string& labels) {
        return detect({"--tolerance", "0.01", "--labels", path("labels.nii.gz"), "--in", labels});
    };
    const Rows table = rows({"--tolerance", "0.01"});
    const std::string csv = output(asked("all"));
    EXPECT_EQ(linesOf(csv).at(0), "pose,mesh,volume,label,lower,upper");
    double lo = 0;
    double hi = 0;
    for (const auto& row : rowsOf(csv)) {
        if (row.at("pose") == "0") {
            lo += std::stod(row.at("lower"));
            hi += std::stod(row.at("upper"));
        }
        EXPECT_NE(row.at("label"), "0");
    }
    EXPECT_LE(lo, hiOf(table, 0)); // what is opaque has a label
    EXPECT_GE(hi, loOf(table, 0));

    const Rows some = rowsOf(output(asked("84,137")));
    ASSERT_EQ(some.size(), 8U);
    EXPECT_EQ(some[0].at("label"), "84");
    EXPECT_EQ(some[1].at("label"), "137");
    EXPECT_GT(loOf(some, 1) + loOf(some, 0), 0);
    EXPECT_EQ(some[7].at("upper"), "0");

    const Ran ran = run(asked("999"));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("no voxel of the label map has the label 999; the area is 0"));
    EXPECT_EQ(rowsOf(ran.out)[0].at("upper"), "0");
}

TEST_F(AreaTest, WritesTheAreaOfEachTriangle) {
    const Rows table = rows({"--triangles", path("triangles.csv")});
    EXPECT_EQ(linesOf(readText(path("triangles.csv"))).at(0), "pose,mesh,volume,triangle,triangle_area,lower,upper");
    std::array<double, 2> lo{};
    std::array<double, 2> hi{};
    std::size_t partly = 0;
    const Rows triangles = rowsOf(readText(path("triangles.csv")));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::size_t pose = std::stoul(triangles[i].at("pose"));
        ASSERT_LT(pose, 2U) << "the others touch nothing";
        lo.at(pose) += loOf(triangles, i);
        hi.at(pose) += hiOf(triangles, i);
        const double whole = std::stod(triangles[i].at("triangle_area"));
        EXPECT_LE(loOf(triangles, i), whole + 1e-6);
        EXPECT_LT(std::stoul(triangles[i].at("triangle")), 300U);
        EXPECT_EQ(triangles[i].at("mesh"), "builtin:scalpel:300");
        partly += loOf(triangles, i) > 0 && hiOf(triangles, i) < whole ? 1 : 0;
    }
    EXPECT_GT(partly, 3U);
    for (std::size_t pose = 0; pose < 2; ++pose) {
        const double rounding = 1e-6 * static_cast<double>(triangles.size());
        EXPECT_NEAR(lo.at(pose), loOf(table, pose), rounding);
        EXPECT_NEAR(hi.at(pose), hiOf(table, pose), rounding);
    }
}

TEST_F(AreaTest, RefusesWhatDoesNotGoTogether) {
    EXPECT_THAT(refused(2, detect({"--in", "1"})), HasSubstr("--in: it needs a label map; add --labels"));
    EXPECT_THAT(refused(2, detect({"--tolerance", "0"})),
                HasSubstr("--tolerance: '0' is not a number from 1e-09 mm^2 on"));
    for (const char* option : {"--method", "--device", "--on", "--to", "--max"}) {
        EXPECT_THAT(refused(2, detect({option, "1"})), HasSubstr(option));
    }
    output({"make", "volume", "builtin:head:16", path("other.nii.gz")});
    EXPECT_THAT(refused(2, detect({"--labels", path("other.nii.gz"), "--in", "all", "--triangles", path("a.csv")})),
                HasSubstr("--triangles: not with --in"));
    EXPECT_THAT(refused(1, detect({"--labels", path("other.nii.gz"), "--in", "all"})), HasSubstr("--labels: "));
    EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
}

} // namespace
} // namespace voxtact::test
