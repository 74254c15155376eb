// SPDX-License-Identifier: MIT
// voxtact bench --paper: the paper's tables, measured again.
#include "cli/cli_fixture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::json;

class PaperTest : public CliDeviceTest {
  protected:
    /// Scenes that take a moment, and what is added.
    static Arguments paper(const Arguments& more = {}, const std::string& repetitions = "2") {
        Arguments all = withSweeps(repetitions);
        all.emplace_back("--no-sweeps");
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    static Arguments withSweeps(const std::string& repetitions) {
        return {"bench",  "--paper", "--progress", "never", "--scale",       "8",
                "--size", "48x48",   "--number",   "2",     "--repetitions", repetitions};
    }
    static Json json(const Arguments& more = {}, const std::string& repetitions = "2") {
        Arguments all = paper({"--format", "json"}, repetitions);
        all.insert(all.end(), more.begin(), more.end());
        return Json::parse(output(all));
    }
    /// The rows of one scene, by method.
    static std::map<std::string, Json> rowsOf(const Json& result, const std::string& scene) {
        std::map<std::string, Json> rows;
        for (const Json& row : result["tables"]) {
            if (row["scene"] == scene) {
                rows[row["method"]] = row;
            }
        }
        return rows;
    }
    static std::map<std::string, Json> survivors(const Json& result) {
        std::map<std::string, Json> all;
        for (const Json& row : result["tables"]) {
            all[std::string(row["scene"]) + " " + std::string(row["method"])] = row["survivors"];
        }
        return all;
    }
};

const std::vector<std::string> kScenes{"v1s1", "v1s2", "v2s1", "v2s2"};
const std::string kNoInterval = "from 6 --repetitions on";

void expectSpread(const Json& spread, std::size_t samples) {
    ASSERT_EQ(spread["samples"].size(), samples) << spread;
    EXPECT_LE(spread["min"], spread["p10"]);
    EXPECT_LE(spread["p10"], spread["median"]);
    EXPECT_LE(spread["median"], spread["p90"]);
    EXPECT_LE(spread["p90"], spread["max"]);
}

/// Percents are of the times of the same round.
void expectPercents(const Json& columns) {
    const auto sample = [&](const char* column, std::size_t i) { return double{columns[column]["samples"][i]}; };
    for (std::size_t i = 0; i < columns["rendering_ms"]["samples"].size(); ++i) {
        const double rendering = sample("rendering_ms", i);
        const double collision = 100 * sample("collision_ms", i) / rendering;
        const double overhead = 100 * (sample("total_ms", i) - rendering) / rendering;
        // Times are written with six digits.
        EXPECT_NEAR(sample("collision_percent", i), collision, 1e-4 * (1 + collision));
        EXPECT_NEAR(sample("overhead_percent", i), overhead, 1e-3 * (1 + std::abs(overhead)));
    }
}

TEST_F(PaperTest, MeasuresEveryMethodInEveryScene) {
    const Json result = json({"--validate"});
    EXPECT_EQ(result["agrees"], true);
    EXPECT_EQ(result["width"], 48);
    EXPECT_EQ(result["published"]["overhead_percent"], Json({4.3, 15.9}));
    EXPECT_THAT(result["notes"].dump(), HasSubstr(kNoInterval)) << "of two rounds";
    EXPECT_TRUE(result["tables"][0]["wall"]["overhead_percent"]["low"].is_null());
    ASSERT_EQ(result["scenes"].size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        const Json& scene = result["scenes"][i];
        EXPECT_EQ(scene["name"], kScenes[i]);
        EXPECT_EQ(scene["triangles"], i % 2 == 0 ? 3068 : 49998);
        EXPECT_EQ(scene["voxels"], i < 2 ? Json({32, 32, 32}) : Json({32, 32, 16}));
        EXPECT_EQ(scene["volume"], i < 2 ? "builtin:head:32" : "builtin:vessels:32");
        EXPECT_GT(scene["opaque_share"], 0.03);
        EXPECT_LT(scene["opaque_share"], 0.2);
        const auto rows = rowsOf(result, kScenes[i]);
        ASSERT_TRUE(rows.contains("cpu") && rows.contains("query-any"));
        for (const auto& [method, row] : rows) {
            SCOPED_TRACE(kScenes[i] + " " + method);
            EXPECT_EQ(row["hits"], 2) << "every pose touches";
            EXPECT_EQ(row["survivors"].is_null(), method == "query-any") << "it does not count";
            for (const char* column : {"collision_ms", "rendering_ms", "total_ms", "overhead_percent"}) {
                expectSpread(row["wall"][column], 2);
            }
            EXPECT_TRUE(row["wall"]["mesh_ms"].is_null());
            expectPercents(row["wall"]);
        }
        EXPECT_EQ(rows.at("cpu")["survivors"],
                  rows.contains("compute") ? rows.at("compute")["survivors"] : rows.at("cpu")["survivors"]);
    }
}

TEST_F(PaperTest, SweepsAndThePage) {
    Arguments all = withSweeps("2");
    all.insert(all.end(), {"--format", "json", "--report", path("paper.html")});
    const Json result = Json::parse(output(all));
    std::map<std::string, std::set<std::string>> methods;
    for (const Json& series : result["series"]) {
        methods[series["sweep"]].insert(std::string(series["method"]));
        expectSpread(series["wall_ms"], series["wall_ms"]["samples"].size());
    }
    ASSERT_EQ(methods.size(), 4U);
    for (const char* sweep : {"batch", "triangles", "fragments", "voxels"}) {
        EXPECT_THAT(methods[sweep], testing::IsSupersetOf({"query", "atomic", "cpu"})) << sweep;
    }
    ASSERT_EQ(result["polygons"]["ways"].size(), 5U);
    EXPECT_EQ(result["polygons"]["triangles"], 3068);
    EXPECT_EQ(result["polygons"]["ways"].back()["missed"], 0);
    EXPECT_EQ(result["polygons"]["ways"][0]["found"], result["polygons"]["ways"][3]["found"]);
    ASSERT_EQ(result["integration"].size(), 5U);
    for (const Json& point : result["integration"]) {
        expectSpread(point["wall_ms"], 2);
    }
    EXPECT_THAT(readText(path("paper.html")),
                AllOf(HasSubstr("bench --paper"), HasSubstr("<th>wall collision_ms</th>"), HasSubstr("polygons ways"),
                      HasSubstr("integration"), Not(HasSubstr("<script")), Not(HasSubstr("src="))));
}

TEST_F(PaperTest, TimestampsSayWhatTheMeshAndTheVolumeTake) {
    const Json result = json();
    if (result["notes"].dump().find("the queue has no timestamps") != std::string::npos) {
        EXPECT_TRUE(result["tables"][0]["gpu"].is_null());
        GTEST_SKIP() << "no timestamps";
    }
    for (const Json& row : result["tables"]) {
        SCOPED_TRACE(row["scene"].dump() + row["method"].dump());
        const Json& gpu = row["gpu"];
        for (const char* column : {"mesh_ms", "volume_ms", "rendering_ms"}) {
            expectSpread(gpu[column], 2);
        }
        for (std::size_t i = 0; i < 2; ++i) {
            const double parts = double{gpu["mesh_ms"]["samples"][i]} + double{gpu["volume_ms"]["samples"][i]};
            // As the total has them, the two stamps around the frame: what is before the mesh is in both or in neither.
            EXPECT_GT(double{gpu["rendering_ms"]["samples"][i]}, parts);
            EXPECT_LE(double{gpu["rendering_ms"]["samples"][i]}, double{row["wall"]["rendering_ms"]["samples"][i]});
        }
        if (row["method"] == "cpu") {
            EXPECT_TRUE(gpu["collision_ms"].is_null() && gpu["total_ms"].is_null() &&
                        gpu["overhead_percent"].is_null());
            continue;
        }
        expectSpread(gpu["collision_ms"], 2);
        expectSpread(gpu["total_ms"], 2);
        expectPercents(gpu);
    }
}

TEST_F(PaperTest, SixRoundsHaveAnInterval) {
    const Json six = json({}, "6");
    EXPECT_THAT(six["notes"].dump(), Not(HasSubstr(kNoInterval)));
    for (const Json& row : six["tables"]) {
        const Json& overhead = row["wall"]["overhead_percent"];
        EXPECT_EQ(overhead["confidence"], 0.96875);
        EXPECT_EQ(overhead["low"], overhead["min"]);
        EXPECT_EQ(overhead["high"], overhead["max"]);
    }
}

TEST_F(PaperTest, TheSameSeedGivesTheSamePoses) {
    const auto one = survivors(json({"--seed", "5"}, "1"));
    EXPECT_EQ(one, survivors(json({"--seed", "5"}, "1")));
    EXPECT_NE(one, survivors(json({"--seed", "6"}, "1")));
}

TEST_F(PaperTest, CsvIsOneTable) {
    const auto lines = linesOf(output(paper()));
    const std::string header = "scene,method,clock,width,height,triangles,poses,survivors,hits,samples,mesh_ms,"
                               "volume_ms,collision_ms,collision_ms_p10,collision_ms_p90,rendering_ms,rendering_ms_p10,"
                               "rendering_ms_p90,total_ms,total_ms_p10,total_ms_p90,collision_percent,overhead_percent,"
                               "overhead_low,overhead_high,confidence";
    EXPECT_EQ(lines.front(), header);
    const auto comments = std::find_if(lines.begin(), lines.end(), [](auto& line) { return line.starts_with("#"); });
    EXPECT_THAT(std::vector(comments, lines.end()), Each(StartsWith("# ")));
    std::set<std::string> scenes;
    for (auto line = lines.begin() + 1; line != comments; ++line) {
        const auto fields = fieldsOf(*line);
        ASSERT_EQ(std::count(line->begin(), line->end(), ','), 25) << *line;
        scenes.insert(fields[0]);
        EXPECT_EQ(fields[9], "2");
        EXPECT_EQ(fields[10].empty(), fields[2] == "wall" || fields[15].empty()) << *line;
    }
    EXPECT_EQ(scenes, std::set<std::string>(kScenes.begin(), kScenes.end()));
    const std::string page = readText(VOXTACT_LAB_PAGE);
    for (std::string column : fieldsOf(header)) {
        for (const std::string suffix : {"_p10", "_p90"}) {
            if (column.ends_with(suffix)) {
                column.resize(column.size() - suffix.size());
            }
        }
        EXPECT_THAT(page, HasSubstr("`" + column + "`"));
    }
}

TEST_F(PaperTest, TextReadsLikeThePaper) {
    const std::string text = output(paper({"--format", "text", "--output", path("out.txt")}));
    EXPECT_EQ(text, "");
    EXPECT_THAT(readText(path("out.txt")),
                AllOf(HasSubstr("# By wall clock"), HasSubstr("total rendering"), HasSubstr("overhead %"),
                      HasSubstr("published: 4.3 to 15.9 %, on other hardware"), HasSubstr("published: 3,800 pairs"),
                      HasSubstr("query, atomic and subgroup count the same"), HasSubstr("# --scale 8")));
    EXPECT_EQ(filesInFolder(), 1U);
}

TEST_F(PaperTest, FilesStandForTheBuiltins) {
    std::filesystem::create_directories(path("data/volumes"));
    std::filesystem::create_directories(path("data/meshes"));
    output({"make", "mesh", "builtin:ellipsoid:49998", path("data/meshes/armadillo_49998.ply")});
    output({"make", "volume", "builtin:vessels:256", path("data/volumes/bonsai_256x256x128.nrrd")});
    const Json result = Json::parse(output({"bench", "--paper", "--data", path("data"), "--size", "16x16",
                                            "--repetitions", "1", "--number", "1", "--no-sweeps", "--format", "json"}));
    EXPECT_EQ(result["scenes"][0]["volume"], "builtin:head:256");
    EXPECT_EQ(result["scenes"][0]["voxels"], Json({256, 256, 256}));
    EXPECT_EQ(result["scenes"][3]["volume"], "bonsai_256x256x128.nrrd");
    EXPECT_EQ(result["scenes"][3]["mesh"], "armadillo_49998.ply");
    EXPECT_EQ(result["scenes"][3]["opacity"], "50:0,100:1");
    EXPECT_EQ(result["scenes"][2]["mesh"], "builtin:scalpel:3068");
}

TEST_F(PaperTest, FilesOfAnotherSizeAreRefused) {
    std::filesystem::create_directories(path("data/volumes"));
    EXPECT_THAT(refused(1, {"bench", "--paper", "--data", path("data")}),
                AllOf(HasSubstr("none of volumes/mrhead_256.nii.gz"), HasSubstr("exists")));
    output({"make", "volume", "builtin:head:32", path("data/volumes/mrhead_256.nii.gz")});
    EXPECT_THAT(refused(1, {"bench", "--paper", "--data", path("data")}),
                AllOf(HasSubstr("32x32x32 voxels of uint8"), HasSubstr("need 256x256x256")));
    EXPECT_THAT(refused(2, {"bench", "--paper", "--data", path("data"), "--scale", "2"}), HasSubstr("--scale"));
}

TEST_F(PaperTest, WhatCannotBeDoneIsOneLine) {
    for (const Arguments& more : std::vector<Arguments>{{"--volume", "builtin:head:32"},
                                                        {"--mesh", "builtin:scalpel"},
                                                        {"--opacity", "0:0,1:1"},
                                                        {"--opacity-threshold", "0.2"}}) {
        EXPECT_THAT(refused(2, paper(more)), AllOf(HasSubstr("--paper has its own scenes"), HasSubstr(more[0])));
    }
    EXPECT_THAT(refused(2, paper({"--certified"})), HasSubstr("--paper"));
    EXPECT_THAT(refused(2, paper({"--outputs"})), HasSubstr("--paper"));
    for (const Arguments& more :
         std::vector<Arguments>{{"--data", "."}, {"--size", "8x8"}, {"--scale", "2"}, {"--report", "r.html"}}) {
        Arguments all{"bench", "--outputs"};
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_THAT(refused(2, all), HasSubstr(more[0] + " needs --paper"));
    }
    EXPECT_THAT(refused(2, paper({"--size", "0x8"})), HasSubstr("--size"));
    EXPECT_THAT(refused(2, paper({"--size", "99999x8"})), HasSubstr("--size"));
    EXPECT_THAT(refused(2, paper({"--scale", "17"})), HasSubstr("--scale"));
    EXPECT_THAT(refused(1, paper({"--output", path("none/out.csv")})), HasSubstr("does not exist"));
    EXPECT_THAT(refused(1, paper({"--report", path("none/out.html")})), Not(testing::IsEmpty()));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(PaperTest, NeedsADevice) {
    const RunOptions none{.environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
    EXPECT_THAT(refused(1, paper({"--output", path("out.csv")}), none), HasSubstr("Vulkan"));
    EXPECT_EQ(filesInFolder(), 0U);
}

} // namespace
} // namespace voxtact::test
