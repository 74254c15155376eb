// SPDX-License-Identifier: MIT
// voxtact plan.
#include "plan_fixture.h"

#include <cmath>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

TEST_F(PlanTest, HasARowForEachPath) {
    const std::string text = output(plan({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1"}));
    EXPECT_EQ(linesOf(text).at(0), "entry,x,y,z,safe,lower,upper,nearest,nearest_x,nearest_y,nearest_z,"
                                   "length,angle,crosses,target");
    const auto found = rows({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1", "--max", "15"});
    ASSERT_EQ(found.size(), 162U);
    std::map<std::string, int> verdicts;
    for (auto row : found) {
        const double lo = std::stod(row["lower"]);
        const double hi = std::stod(row["upper"]);
        EXPECT_LE(lo, hi);
        ++verdicts[row["safe"]];
        EXPECT_EQ(row["safe"] == "1", lo > 0);
        EXPECT_EQ(row["nearest"], hi < 1000 ? "opaque" : "");
        const double length = std::hypot(std::stod(row["x"]) - 20, std::stod(row["y"]), std::stod(row["z"]) - 30);
        EXPECT_NEAR(length, std::stod(row["length"]), 1e-4);
        EXPECT_GT(length, 30);
        EXPECT_LT(std::stod(row["angle"]), 90);
    }
    // The limits.
    for (auto row : rows({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1", "--max-length", "70"})) {
        EXPECT_LE(std::stod(row["length"]), 70);
    }
    EXPECT_LT(rows({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1", "--max-angle", "20"}).size(), 162U);
    EXPECT_EQ(rows({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1", "--entry-radius", "50"}).size(), 162U);
}

TEST_F(PlanTest, TheBestPathsDiffer) {
    std::vector<double> clearances;
    for (const auto& row : rows({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1"})) {
        clearances.push_back(std::stod(row.at("lower")));
        EXPECT_NE(row.at("upper"), "inf");
    }
    std::sort(clearances.rbegin(), clearances.rend());
    EXPECT_GT(clearances.at(0), clearances.at(1));
}

TEST_F(PlanTest, NamesLabels) {
    const auto found = rows(labelled({"--avoid", "Skull,70", "--margin", "1", "--max", "40"}));
    const auto same = rows(labelled({"--avoid", "120,Cortex", "--margin", "1", "--max", "40"}));
    EXPECT_EQ(found, same);
    bool named = false;
    for (auto row : found) {
        EXPECT_TRUE(row["nearest"].empty() || row["nearest"] == "Skull" || row["nearest"] == "Cortex");
        named = named || !row["nearest"].empty();
        EXPECT_FALSE(row["crosses"].empty());
    }
    EXPECT_TRUE(named);
    // A label as a target, and as the surface of entries.
    EXPECT_FALSE(
        rows({"--labels", path("labels.nii.gz"), "--target", "Cortex", "--avoid", "Skin", "--entry-label", "Cortex"})
            .empty());
}

TEST_F(PlanTest, WritesASurfaceAndFacts) {
    output(plan(labelled({"--avoid", "Skull", "--surface", path("entries.ply")})));
    const std::string ply = readText(path("entries.ply"));
    EXPECT_THAT(ply, HasSubstr("element vertex 162\n"));
    EXPECT_THAT(ply, HasSubstr("element face 320\n"));
    const std::size_t header = ply.find("end_header\n") + 11;
    EXPECT_EQ(ply.size() - header, 162 * (12 + 3 + 4 + 4 + 1) + 320 * (1 + 12 + 1));
    const Ran ran = run(plan(labelled({"--avoid", "Skull", "--summary", "--output", path("rows.csv")})));
    EXPECT_THAT(ran.err, HasSubstr("summary: paths: 162; safe: "));
    EXPECT_THAT(ran.err, HasSubstr("summary: every path is safe from "));
    output(plan(labelled({"--avoid", "Skull", "--report", path("report.html")})));
    const std::string html = readText(path("report.html"));
    EXPECT_THAT(html, HasSubstr("<h1>Paths to (20.00, 0.00, 30.00)</h1>"));
    EXPECT_THAT(html, testing::EndsWith("</body></html>\n"));
    EXPECT_THAT(html, testing::Not(HasSubstr("http")));
    const std::string json = output({"plan", "--volume", "builtin:head:30", "--target", "20,0,30", "--avoid-opacity",
                                     "200:0,201:1", "--max", "1", "--entries", "12", "--format", "json", "--timing"});
    for (const char* name :
         {"\"margin\": 0.0", "\"targets\": 1", "\"upper\":\"inf\"", "\"target\":\"1\"", "\"entries_per_s\""}) {
        EXPECT_THAT(json, HasSubstr(name));
    }
}

TEST_F(PlanTest, TakesAMeshWithTipAndAxis) {
    const Arguments same{"--target", "20,0,30", "--avoid-opacity", "200:0,201:1"};
    const auto with = [&](const Arguments& more) {
        Arguments all = same;
        all.insert(all.end(), more.begin(), more.end());
        return rows(all);
    };
    output({"make", "mesh", "builtin:needle:3:90", path("needle.stl")});
    const auto exact = with({"--mesh", "builtin:needle:3:90"});
    const auto mesh = with({"--mesh", path("needle.stl"), "--tip", "0,0,0", "--axis", "0,0,2"});
    ASSERT_EQ(exact.size(), mesh.size());
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double lo = std::stod(mesh[i].at("lower"));
        EXPECT_LE(std::stod(exact[i].at("lower")), std::stod(mesh[i].at("upper")) + 1e-5);
        EXPECT_LE(lo, std::stod(exact[i].at("upper")) + 0.01);
    }
}

TEST_F(PlanTest, ANameOfSeveralLabelsIsAllOfThem) {
    writeText(path("twins.txt"), "70 Cortex\n90 Shell\n120 Shell\n");
    const auto named = [&](const std::string& avoid) {
        return output(plan(labelled({"--avoid", avoid, "--label-names", path("twins.txt")})));
    };
    EXPECT_EQ(named("Shell"), named("90,120"));
    EXPECT_NE(named("Shell"), named("90"));
    EXPECT_NE(named("Shell"), named("120"));
    EXPECT_THAT(refused(2, plan({"--labels", path("labels.nii.gz"), "--label-names", path("twins.txt"), "--avoid", "70",
                                 "--target", "Shell"})),
                HasSubstr("2 labels are called 'Shell', 90 and 120 among them"));
    EXPECT_THAT(
        refused(2, plan(labelled({"--avoid", "70", "--label-names", path("twins.txt"), "--entry-label", "Shell"}))),
        HasSubstr("2 labels are called 'Shell'"));
}

TEST_F(PlanTest, ALabelThatNoVoxelHasIsRefused) {
    const std::string file = path("full.mha");
    writeText(file,
              "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 4 4 4\n"
              "ElementSpacing = 1 1 1\nOffset = 0 0 0\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
              "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
                  std::string(64, '\5'));
    const auto line = [&](const std::string& target, const std::string& avoid) {
        return refused(2, {"plan", "--volume", file, "--labels", file, "--target", target, "--avoid", avoid,
                           "--entry-radius", "2", "--entries", "12"});
    };
    EXPECT_THAT(line("0", "5"), HasSubstr("--target: no voxel of the label map has the label '0'"));
    EXPECT_THAT(line("5", "0"), HasSubstr("--avoid: no voxel of the label map has the label '0'"));
}

TEST_F(PlanTest, ASavedVolumeIsOnItsGrid) {
    output({"make", "volume", "builtin:head:48", path("saved.nii.gz")});
    output({"plan", "--volume", "builtin:head:48", "--labels", path("saved.nii.gz"), "--target", "20,0,30", "--avoid",
            "70", "--entries", "12"});
}

TEST_F(PlanTest, ReportsSayNoMoreThanIsCertain) {
    const std::string page = path("report.html");
    const Arguments asked{"--target", "0,-0.001,30", "--avoid-opacity", "200:0,201:1", "--max", "15"};
    Arguments all = asked;
    all.insert(all.end(), {"--report", page});
    output(plan(all));
    const std::string text = readText(page);
    EXPECT_EQ(text.find("-0.00"), std::string::npos);
    EXPECT_EQ(text.find("mm2"), std::string::npos);
    std::size_t found = 0;
    for (auto row : rows(asked)) {
        const double lo = std::stod(row["lower"]);
        const std::string title = "<title>" + row["entry"] + ": ";
        const std::size_t at = text.find(title);
        if (row["safe"] == "1" && at != std::string::npos) {
            EXPECT_LE(std::stod(text.substr(at + title.size())), lo);
            ++found;
        }
    }
    EXPECT_GT(found, 10U);
}

TEST_F(PlanTest, RefusesWhatItCannotUse) {
    const auto line = [&](const Arguments& more) { return refused(2, plan(more)); };
    const Arguments avoid{"--avoid-opacity", "200:0,201:1"};
    const auto avoiding = [&](const Arguments& more) {
        Arguments all = avoid;
        all.insert(all.end(), more.begin(), more.end());
        return line(all);
    };
    EXPECT_THAT(avoiding({"--target", "500,0,0"}), HasSubstr("--target: (500, 0, 0) is outside the volume"));
    EXPECT_THAT(avoiding({"--target", "1,2"}), HasSubstr("is not a point x,y,z"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--axis", "0,0,0"}), HasSubstr("--axis: 0,0,0 has no direction"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--axis", "0,1"}), HasSubstr("is not three numbers"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--axis", "0,0,1"}), HasSubstr("has its own tip and axis"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--mesh", "builtin:scalpel:300", "--tip", "0,0,0"}),
                HasSubstr("--axis: add it"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--mesh", "builtin:needle:3:1"}), HasSubstr("no smaller than that"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--entries", "0"}), HasSubstr("--entries"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--margin", "-1"}), HasSubstr("--margin"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--surface", "a.stl"}), HasSubstr("must be .ply"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--report", "a.pdf"}), HasSubstr("must be .html"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--progress", "always"}), HasSubstr("--progress: 'always' is unknown"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--opacity-threshold", "1", "--opacity", "0:0,1:0"}),
                HasSubstr("meets the surface of entries"));
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--max-length", "1"}), HasSubstr("too long"));
    EXPECT_THAT(line({"--target", "0,0,0"}), HasSubstr("no obstacle; add --avoid or --avoid-opacity"));
    EXPECT_THAT(line({"--target", "0,0,0", "--avoid", "1"}), HasSubstr("--avoid: it needs a label map; add --labels"));
    EXPECT_THAT(line(labelled({"--avoid", "Skul"})), HasSubstr("did you mean Skull?"));
    EXPECT_THAT(line(labelled({"--avoid", "999"})), HasSubstr("no voxel of the label map has the label '999'"));
    EXPECT_THAT(refused(2, plan({"--labels", path("labels.nii.gz"), "--avoid", "Skin", "--target", "Cortx"})),
                HasSubstr("did you mean Cortex?"));
    output({"make", "volume", "builtin:head:18", path("coarse.nii.gz")});
    EXPECT_THAT(
        refused(1, plan({"--labels", path("coarse.nii.gz"), "--target", "0,0,0", "--avoid", "70"})),
        HasSubstr("plan: --labels: '" + path("coarse.nii.gz") + "': the label map is not on the grid of the volume"));
    for (const char* radius : {"1e-9", "0.001"}) {
        EXPECT_THAT(avoiding({"--target", "0,0,0", "--entry-radius", radius}),
                    HasSubstr("--entry-radius: '" + std::string(radius) + "' is not a number above 0.001"));
    }
    // By the option that it was given by; and an empty text is none.
    for (const char* list : {"100:0,90:1", "bogus", ""}) {
        EXPECT_THAT(line({"--target", "0,0,0", "--avoid-opacity", list}),
                    HasSubstr("plan: --avoid-opacity '" + std::string(list) + "': "));
    }
    EXPECT_THAT(avoiding({"--target", "0,0,0", "--opacity", "bogus"}), HasSubstr("plan: --opacity 'bogus': "));
    for (const char* option : {"--entry-label", "--avoid-volume"}) {
        EXPECT_THAT(avoiding({"--target", "0,0,0", option, ""}), HasSubstr("an empty value"));
    }
    EXPECT_EQ(filesInFolder(), 3U);
}

/// Entries that are given are not where something is opaque.
TEST_F(PlanTest, SaysWhatItDoesNotAsk) {
    const Arguments given{"--target",       "0,0,0", "--avoid-opacity", "200:0,201:1",
                          "--entry-radius", "40",    "--opacity",       "40:0,80:1"};
    output(plan(given), {.note = "are not used"});
}

} // namespace
} // namespace voxtact::test
