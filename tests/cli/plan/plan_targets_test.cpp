// SPDX-License-Identifier: MIT
// voxtact plan: several targets.
#include "plan_fixture.h"

#include <algorithm>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

TEST_F(PlanTest, SeveralTargetsAreEachAsAlone) {
    writeText(path("targets.txt"), "# mm\n-5.5 3 28 far\n\n1 2 33\n");
    const Arguments avoid{"--labels", path("labels.nii.gz"), "--avoid", "Skull", "--margin", "1", "--max", "50"};
    const auto with = [&](const Arguments& more) {
        Arguments all = avoid;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const auto all = rows(with({"--target", "20,0,30", "--target", "-5,0,30", "--target-label", "Cortex,90",
                                "--targets", path("targets.txt"), "--by-target", path("targets.csv")}));
    std::vector<std::map<std::string, std::string>> expected;
    for (const auto& [name, target] :
         {std::pair("1", "20,0,30"), std::pair("2", "-5,0,30"), std::pair("Cortex", "Cortex"), std::pair("Skin", "90"),
          std::pair("far", "-5.5,3,28"), std::pair("6", "1,2,33")}) {
        for (auto row : rows(with({"--target", target}))) {
            row["target"] = name;
            expected.push_back(std::move(row));
        }
    }
    EXPECT_EQ(all, expected);
    // What is said of each is what its rows have.
    const std::vector<std::string> lines = linesOf(readText(path("targets.csv")));
    ASSERT_EQ(lines.size(), 7U);
    const std::vector<std::string> columns = fieldsOf(lines[0]);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        std::map<std::string, std::string> of;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            of[columns[k]] = fieldsOf(lines[i]).at(k);
        }
        int paths = 0;
        int safe = 0;
        double best = -1;
        for (auto row : all) {
            if (row["target"] == of["target"]) {
                ++paths;
                safe += row["safe"] == "1" ? 1 : 0;
                best = row["safe"] == "1" ? std::max(best, std::stod(row["lower"])) : best;
            }
        }
        EXPECT_EQ(of["paths"], std::to_string(paths));
        EXPECT_EQ(of["safe"], std::to_string(safe));
        EXPECT_EQ(of["best"].empty(), safe == 0);
        EXPECT_EQ(of["best_lower"].empty() ? -1 : std::stod(of["best_lower"]), best);
        EXPECT_LE(std::stod(of["safe_area_mm2"]), std::stod(of["area_mm2"]));
        EXPECT_GT(std::stod(of["area_mm2"]), 100);
    }
    // The page ranks all of them, and has a section for each.
    const Ran ran =
        run(plan(with({"--target", "20,0,30", "--target", "-5,0,30", "--summary", "--report", path("report.html")})));
    EXPECT_EQ(ran.status, 0);
    const std::string html = readText(path("report.html"));
    for (const char* part : {"<h1>Paths to 2 targets</h1>", "Safest paths of all targets",
                             "<h2 id=\"target-2\">Target 2, (-5.00, 0.00, 30.00)</h2>"}) {
        EXPECT_THAT(html, HasSubstr(part));
    }
    EXPECT_THAT(ran.err, HasSubstr("summary: target '2': every path is safe from "));
    EXPECT_THAT(ran.err, HasSubstr("summary: best: entry "));
}

TEST_F(PlanTest, EachTargetHasASurfaceAndAHeatMapOfItsOwn) {
    writeText(path("targets.txt"), "20 0 30 left/first\n-5 0 30 .hidden\n1 2 33\n");
    const Arguments avoid{"--labels", path("labels.nii.gz"), "--avoid", "Skull", "--max", "50",
                          "--output", path("rows.csv")};
    const auto with = [&](const Arguments& more) {
        Arguments all = avoid;
        all.insert(all.end(), more.begin(), more.end());
        return plan(all);
    };
    output(with({"--targets", path("targets.txt"), "--surface", path("s {target}.ply"), "--heat-map",
                 path("{target}.nii.gz")}));
    for (const auto& [name, target] :
         {std::pair("left_first", "20,0,30"), std::pair("_hidden", "-5,0,30"), std::pair("3", "1,2,33")}) {
        SCOPED_TRACE(name);
        output(with({"--target", target, "--surface", path("alone.ply"), "--heat-map", path("alone.nii.gz")}));
        EXPECT_EQ(readText(path("s " + std::string(name) + ".ply")), readText(path("alone.ply")));
        EXPECT_EQ(readText(path(std::string(name) + ".nii.gz")), readText(path("alone.nii.gz")));
    }
    // Of one target the word may be there, too.
    output(with({"--target", "Cortex", "--surface", path("one {target} {target}.ply")}));
    EXPECT_FALSE(readText(path("one Cortex Cortex.ply")).empty());
}

TEST_F(PlanTest, TargetsInRas) {
    writeText(path("lps.txt"), "-5.5 3 28 far\n");
    writeText(path("ras.txt"), "5.5 -3 28 far\n");
    const Arguments avoid{"--avoid-opacity", "100:0,160:1", "--targets"};
    const auto with = [&](const Arguments& more) {
        Arguments all = avoid;
        all.insert(all.end(), more.begin(), more.end());
        return rows(all);
    };
    EXPECT_EQ(with({path("ras.txt"), "--target", "-20,10,30", "--space", "ras"}),
              with({path("lps.txt"), "--target", "20,-10,30"}));
}

TEST_F(PlanTest, RefusesOneFileForTwoTargets) {
    writeText(path("targets.txt"), "20 0 30 a/b\n-5 0 30 a:b\n");
    const auto line = [&](const Arguments& more) {
        Arguments all{"--avoid-opacity", "200:0,201:1", "--targets", path("targets.txt")};
        all.insert(all.end(), more.begin(), more.end());
        return refused(2, plan(all));
    };
    EXPECT_THAT(line({"--surface", path("{target}.ply")}),
                HasSubstr("--surface: the targets 'a/b' and 'a:b' would both be written to '" + path("a_b.ply") +
                          "'; rename one of them in a file of --targets"));
    writeText(path("targets.txt"), "20 0 30 a\n-5 0 30 b\n");
    EXPECT_THAT(line({"--surface", path("{target}.ply"), "--output", path("b.ply")}),
                HasSubstr("--output and --surface: both are '" + path("b.ply") + "'"));
    EXPECT_THAT(line({"--surface", path("{target}.txt")}), HasSubstr("must be .ply"));
    writeText(path("targets.txt"), "20 0 30 labels\n-5 0 30 b\n");
    EXPECT_THAT(line({"--labels", path("labels.nii.gz"), "--heat-map", path("{target}.nii.gz")}),
                HasSubstr("labels.nii.gz' is the file that --labels reads, and is not overwritten"));
}

TEST_F(PlanTest, JsonHasWhatIsSaidOfEachTarget) {
    const auto text = [&](const std::string& format, const Arguments& more) {
        Arguments all{
            "plan",     "--volume", "builtin:head:30", "--labels", path("labels.nii.gz"), "--avoid", "Skull",
            "--target", "20,0,30",  "--target",        "Cortex",   "--entries",           "100",     "--format",
            format};
        all.insert(all.end(), more.begin(), more.end());
        return output(all);
    };
    text("csv", {"--by-target", path("t.csv")});
    const std::string json = text("json", {"--timing"});
    const std::vector<std::string> lines = linesOf(readText(path("t.csv")));
    const std::vector<std::string> columns = fieldsOf(lines.at(0));
    std::size_t found = json.find("\n],\n\"by_target\": [\n{");
    ASSERT_NE(found, std::string::npos);
    EXPECT_LT(found, json.find("\"timing\": "));
    for (std::size_t target = 1; target < lines.size(); ++target) {
        const std::vector<std::string> fields = fieldsOf(lines[target]);
        for (const char* name : {"target", "paths", "safe", "area_mm2", "safe_area_mm2"}) {
            const auto at = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin());
            const bool word = std::string(name) == "target";
            const std::string quote = word ? "\"" : "";
            const std::string member = "\"" + std::string(name) + "\":" + quote + fields.at(at) + quote;
            found = json.find(member, found);
            EXPECT_NE(found, std::string::npos) << member;
        }
    }
}

TEST_F(PlanTest, RefusesTargetsThatItCannotTell) {
    const auto line = [&](const Arguments& more, int status = 2) {
        Arguments all{"--avoid-opacity", "200:0,201:1"};
        all.insert(all.end(), more.begin(), more.end());
        return refused(status, plan(all));
    };
    EXPECT_THAT(line({}), HasSubstr("no target; add --target, --target-label or --targets"));
    EXPECT_THAT(line({"--target-label", "70"}), HasSubstr("--target-label: it needs a label map"));
    const std::string labels = path("labels.nii.gz");
    EXPECT_THAT(line({"--labels", labels, "--target", "70", "--target-label", "Skin,Cortex"}),
                HasSubstr("--target-label: the target 'Cortex' exists already"));
    EXPECT_THAT(line({"--target", "20,0,30", "--target", "0,0,20", "--surface", path("a.ply")}),
                HasSubstr("--surface: there are 2 targets with one file each; put {target} into '"));
    for (const char* wrong : {"20,0", "nan,0,0", "1,2,3,4", "1,,2"}) {
        EXPECT_THAT(line({"--labels", labels, "--target", wrong}),
                    HasSubstr("--target: '" + std::string(wrong) + "' is neither a point x,y,z nor a label"));
    }
    // Of what is beyond the limits the target is named.
    EXPECT_THAT(line({"--target", "20,0,30", "--target", "0,0,20", "--entry-radius", "40", "--max-length", "30"}),
                HasSubstr("target '1': no entry is left"));
    const std::string file = path("targets.txt");
    const auto lineOf = [&](const std::string& content, int status) {
        writeText(file, content);
        return line({"--targets", file}, status);
    };
    EXPECT_THAT(lineOf("1 2 3\n1 2\n", 1),
                HasSubstr("line 2: a point is three numbers x y z, and may have a name of one word behind them; "
                          "this has 2 words"));
    EXPECT_THAT(lineOf("1 2 x\n", 1), HasSubstr("line 1: 'x' is not a number"));
    EXPECT_THAT(lineOf("1 2 3 here and\n", 1), HasSubstr("this has 5 words"));
    EXPECT_THAT(lineOf("# none\n", 1), HasSubstr("it has no point"));
    EXPECT_THAT(lineOf("1 2 500\n", 2), HasSubstr("line 1: (1, 2, 500) is outside the volume"));
    EXPECT_THAT(lineOf("1 2 3 a\n4 5 6 a\n", 2), HasSubstr("line 2: the target 'a' exists already"));
    writeText(file, "1 2 3\n");
    EXPECT_THAT(line({"--targets", file, "--output", file}), HasSubstr("--targets"));
    EXPECT_THAT(line({"--targets", path("none.txt")}, 1), HasSubstr("none.txt"));
}

TEST_F(PlanTest, ReportsAreTextWhateverTargetsAreCalled) {
    writeText(path("targets.txt"), "20 0 30 a\xff<b>\n-5 0 30 c\x1b[31md\n");
    output(plan({"--targets", path("targets.txt"), "--avoid-opacity", "200:0,201:1", "--report", path("report.html")}));
    const std::string html = readText(path("report.html"));
    EXPECT_THAT(html, HasSubstr("Target a\uFFFD&lt;b&gt;, "));
    EXPECT_THAT(html, HasSubstr("<td>c\uFFFD[31md</td>"));
    EXPECT_EQ(html.find_first_of("\xff\x1b"), std::string::npos);
}

} // namespace
} // namespace voxtact::test
