// SPDX-License-Identifier: MIT
// voxtact detect --area.
#include "cli_fixture.h"

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
        Arguments all{"detect",  "--volume",        "builtin:head:32", "--mesh", "builtin:scalpel:300",
                      "--poses", path("poses.txt"), "--format",        "csv"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    using Rows = std::vector<std::map<std::string, std::string>>;
    [[nodiscard]] Rows rows(const Arguments& more) const { return rowsOf(output(detect(more))); }
    static double loOf(const Rows& rows, std::size_t row) { return std::stod(rows.at(row).at("area_lo")); }
    static double hiOf(const Rows& rows, std::size_t row) { return std::stod(rows.at(row).at("area_hi")); }
};

TEST_F(AreaTest, AddsBoundsToEachRow) {
    const Rows usual = rows({"--area"});
    ASSERT_EQ(usual.size(), 4U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(usual[i].at("hit"), "1");
        EXPECT_EQ(usual[i].at("method"), "cpu");
        EXPECT_EQ(usual[i].at("projection"), "conservative");
        EXPECT_GT(loOf(usual, i), 10);
        EXPECT_LE(hiOf(usual, i) - loOf(usual, i), 0.100002);
    }
    EXPECT_GT(loOf(usual, 0), hiOf(usual, 1)); // more of it is in
    for (std::size_t i = 2; i < 4; ++i) {
        EXPECT_EQ(usual[i].at("hit"), "0");
        EXPECT_EQ(usual[i].at("area_lo"), "0");
        EXPECT_EQ(usual[i].at("area_hi"), "0");
    }
    const Rows fine = rows({"--area", "--area-tolerance", "0.001", "--threads", "1", "--answer", "yes-no"});
    EXPECT_LE(hiOf(fine, 0) - loOf(fine, 0), 0.001002);
    EXPECT_LE(loOf(fine, 0), hiOf(usual, 0));
    EXPECT_GE(hiOf(fine, 0), loOf(usual, 0));
    EXPECT_EQ(fine[0].at("count"), "1");
}

TEST_F(AreaTest, IsWrittenAsFinelyAsItIsAskedFor) {
    // A triangle of 8e-8 mm^2 in voxels of a ten-thousandth of a millimetre.
    writeText(path("tiny.obj"), "v 0.0001 0.0001 0.0003\nv 0.0005 0.0001 0.0003\nv 0.0001 0.0005 0.0003\nf 1 2 3\n");
    writeText(path("tiny.nrrd"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\nspace: "
                                 "left-posterior-superior\nspace origin: (0,0,0)\nspace directions: (0.0001,0,0) "
                                 "(0,0.0001,0) (0,0,0.0001)\n\n" +
                                     std::string(512, '\xc8'));
    const Rows found = rowsOf(output({"detect", "--volume", path("tiny.nrrd"), "--mesh", path("tiny.obj"), "--area",
                                      "--area-tolerance", "1e-9", "--format", "csv"}));
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
        return Arguments{"detect", "--volume", "builtin:head:16",     "--mesh",       "builtin:scalpel:300",
                         "--area", "--labels", path("labels.nii.gz"), "--label-area", path("some.csv"),
                         "--to",   labels};
    };
    const Ran ran = run(asked(many));
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(withoutProgress(ran.err),
              "voxtact: note: --to: no voxel of the label map has the labels 300, 301, 302, 303, 304, 305, 306, 307, "
              "308, 309 and 40 more; areas in them are 0\n");
    for (int label = 350; label < 4500; ++label) {
        many += "," + std::to_string(label);
    }
    EXPECT_THAT(refused(1, asked(many)), HasSubstr("4096"));
}

TEST_F(AreaTest, GoesWithWhatTheHostAnswers) {
    const Rows found = rows({"--area", "--clearance", "--margin", "3", "--count", "cpu"});
    EXPECT_EQ(found[0].at("clearance_hi"), "0");
    EXPECT_EQ(loOf(found, 0), loOf(rows({"--area"}), 0));
    EXPECT_GT(std::stod(found[2].at("clearance_lo")), 3);
    EXPECT_EQ(hiOf(found, 2), 0);
    const Rows around = rows({"--area", "--pose-tolerance", "50,10"});
    EXPECT_EQ(around[2].at("hit"), "1"); // somewhere near
    EXPECT_EQ(hiOf(around, 2), 0);       // not here
}

TEST_F(AreaTest, SaysWhatRoundingDecides) {
    // A plate in a face of the image.
    writeText(path("plate.obj"), "v -0.2 -0.2 -0.5\nv 0.2 -0.2 -0.5\nv 0 0.2 -0.5\nf 1 2 3\n");
    const RunOptions options{.note =
                                 "the bounds of 1 of 1 areas are farther apart than the tolerance: rounding decides 1 "
                                 "of them, 0 took too many steps"};
    writeText(path("box.nrrd"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\nspace: "
                                "left-posterior-superior\nspace origin: (0,0,0)\nspace directions: (1,0,0) (0,1,0) "
                                "(0,0,1)\n\n\xff");
    const Rows found = rowsOf(output({"detect", "--volume", path("box.nrrd"), "--mesh", path("plate.obj"), "--opacity",
                                      "0:0,1:1", "--area", "--area-tolerance", "0.001", "--format", "csv"},
                                     options));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].at("area_lo"), "0");
    EXPECT_NEAR(hiOf(found, 0), 0.08, 1e-5);
}

TEST_F(AreaTest, WritesTheAreaInEachLabel) {
    output({"make", "volume", "builtin:head:32", path("labels.nii.gz")});
    const auto asked = [&](const std::string& name, const Arguments& more) {
        Arguments arguments = detect(
            {"--area", "--area-tolerance", "0.01", "--labels", path("labels.nii.gz"), "--label-area", path(name)});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Rows table = rowsOf(output(arguments));
        return std::pair(table, rowsOf(readText(path(name))));
    };
    const auto [table, all] = asked("all.csv", {});
    EXPECT_EQ(linesOf(readText(path("all.csv"))).at(0), "pose,mesh,volume,label,name,area_lo,area_hi");
    EXPECT_EQ(table[0].count("labels"), 1U);
    double lo = 0;
    double hi = 0;
    for (const auto& row : all) {
        if (row.at("pose") == "0") {
            lo += std::stod(row.at("area_lo"));
            hi += std::stod(row.at("area_hi"));
        }
        EXPECT_NE(row.at("label"), "0");
    }
    EXPECT_LE(lo, hiOf(table, 0)); // what is opaque has a label
    EXPECT_GE(hi, loOf(table, 0));

    const auto [bare, some] = asked("some.csv", {"--to", "84,137", "--answer", "yes-no"});
    EXPECT_EQ(bare[0].count("labels"), 0U);
    ASSERT_EQ(some.size(), 8U);
    EXPECT_EQ(some[0].at("label"), "84");
    EXPECT_EQ(some[1].at("label"), "137");
    EXPECT_GT(std::stod(some[1].at("area_lo")) + std::stod(some[0].at("area_lo")), 0);
    EXPECT_EQ(some[7].at("area_hi"), "0");

    Arguments nowhere =
        detect({"--area", "--labels", path("labels.nii.gz"), "--label-area", path("none.csv"), "--to", "999"});
    const Ran ran = run(nowhere);
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("no voxel of the label map has the label 999; areas in it are 0"));
    EXPECT_EQ(rowsOf(readText(path("none.csv")))[0].at("area_hi"), "0");
}

TEST_F(AreaTest, WritesTheAreaOfEachTriangle) {
    const Rows table = rows({"--area", "--triangle-area", path("triangles.csv"), "--answer", "yes-no"});
    EXPECT_EQ(linesOf(readText(path("triangles.csv"))).at(0),
              "pose,mesh,volume,triangle,triangle_area,area_lo,area_hi");
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
    EXPECT_EQ(output(detect({"--area", "--answer", "yes-no", "--triangle-area", path("again.csv"), "--resume",
                             path("run"), "--chunk", "1"})),
              output(detect({"--area", "--answer", "yes-no"})));
    EXPECT_EQ(readText(path("again.csv")), readText(path("triangles.csv")));
    output({"merge", path("run"), "--triangle-area", path("merged.csv")});
    EXPECT_EQ(readText(path("merged.csv")), readText(path("triangles.csv")));
}

TEST_F(AreaTest, IsTheSameInChunks) {
    output({"make", "volume", "builtin:head:32", path("labels.nii.gz")});
    const Arguments asked{"--area", "--labels", path("labels.nii.gz"), "--to", "70,120", "--count", "cpu"};
    const auto with = [&](const Arguments& more) {
        Arguments all = detect(asked);
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const std::string whole = output(with({"--label-area", path("whole.csv")}));
    for (const char* const shard : {"1/2", "2/2"}) { // of the second one, no pose comes near, and a note says so
        EXPECT_EQ(
            run(with({"--label-area", "wanted", "--resume", path("run"), "--chunk", "2", "--shard", shard})).status, 0);
    }
    EXPECT_EQ(output({"merge", path("run"), "--label-area", path("merged.csv")}), whole);
    EXPECT_EQ(readText(path("merged.csv")), readText(path("whole.csv")));
    EXPECT_FALSE(std::filesystem::exists("wanted"));
    EXPECT_THAT(refused(2, {"merge", path("run"), "--label-area", "-"}),
                HasSubstr("--label-area: - is standard output, where the rows of --output go"));
}

TEST_F(AreaTest, RefusesWhatDoesNotGoTogether) {
    EXPECT_THAT(refused(2, detect({"--area-tolerance", "1"})),
                HasSubstr("--area-tolerance: it is about areas, and --area is not given"));
    EXPECT_THAT(refused(2, detect({"--label-area", path("a.csv")})),
                HasSubstr("--label-area: it is about areas, and --area is not given"));
    EXPECT_THAT(refused(2, detect({"--triangle-area", path("a.csv")})),
                HasSubstr("--triangle-area: it is about areas, and --area is not given"));
    EXPECT_THAT(refused(2, detect({"--area", "--label-area", path("a.csv")})),
                HasSubstr("--label-area: it is about labels, and --labels is not given"));
    EXPECT_THAT(
        refused(2, detect({"--area", "--to", "1"})),
        HasSubstr("--to: it says which labels --label-clearance and --label-area are about, and neither is given"));
    EXPECT_THAT(refused(2, detect({"--area", "--area-tolerance", "0"})),
                HasSubstr("--area-tolerance: '0' is not a number at least 1e-9"));
    EXPECT_THAT(refused(2, detect({"--area", "--count", "compute"})),
                HasSubstr("--area is answered by the host; leave out --count compute, or give --count cpu"));
    EXPECT_THAT(refused(2, detect({"--area", "--clearance", "--count", "compute"})),
                HasSubstr("--area is answered by the host; leave out --count compute, or give --count cpu"));
    EXPECT_THAT(refused(2, detect({"--area", "--projection", "view"})),
                HasSubstr("--area is certified; leave out --projection view"));
    EXPECT_THAT(refused(2, detect({"--area", "--stats"})),
                HasSubstr("--stats counts what a device does, and areas are the host's"));
    output({"make", "volume", "builtin:head:16", path("other.nii.gz")});
    EXPECT_THAT(refused(1, detect({"--area", "--labels", path("other.nii.gz"), "--label-area", path("a.csv")})),
                HasSubstr("--label-area: "));
    EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
}

} // namespace
} // namespace voxtact::test
