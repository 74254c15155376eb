// SPDX-License-Identifier: MIT
// voxtact compare: the same pairs by every method, verified and timed.
#include "cli/cli_fixture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::json;

class CompareTest : public CliDeviceTest {
  protected:
    /// A scene that takes a moment, and what is added. In less than that limit a busy machine might leave out a batch.
    static Arguments compare(const Arguments& more = {}) {
        Arguments all{"compare",
                      "--volume",
                      "builtin:head:32",
                      "--mesh",
                      "builtin:scalpel:500",
                      "--size",
                      "128x128",
                      "--number",
                      "12",
                      "--oracle",
                      "4",
                      "--repetitions",
                      "2",
                      "--cache",
                      "off",
                      "--progress",
                      "never",
                      "--time-limit",
                      "240"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    static Json json(const Arguments& more = {}) {
        Arguments all = compare(more);
        all.insert(all.end(), {"--format", "json"});
        return Json::parse(output(all));
    }
    /// The series of a method, in order.
    static std::vector<Json> seriesOf(const Json& result, const std::string& method, const std::string& mode) {
        std::vector<Json> found;
        for (const Json& series : result["series"]) {
            if (series["method"] == method && series["mode"] == mode) {
                found.push_back(series);
            }
        }
        return found;
    }
};

TEST_F(CompareTest, MethodsAgreeAndTheJsonSaysHow) {
    const Json result = json({"--sweep", "none"});
    EXPECT_TRUE(result["agrees"]);
    EXPECT_EQ(result["scene"]["poses"], 12);
    EXPECT_EQ(result["scene"]["triangles"], 500);
    EXPECT_EQ(result["poses"].size(), 12U);
    EXPECT_EQ(result["oracle"]["poses"], 4) << "three that touch, and one that does not";
    EXPECT_EQ(result["oracle"]["by_reason"]["none"], 0);
    EXPECT_TRUE(result["series"].empty());
    for (const Json& rule : result["agreement"]) {
        EXPECT_TRUE(rule["agrees"]) << rule;
        EXPECT_TRUE(rule["checked"]) << rule;
        EXPECT_GT(rule["compared"].get<int>(), 0) << rule;
    }
    EXPECT_EQ(result["counts"]["query"], result["counts"]["atomic"]);
    EXPECT_EQ(result["counts"]["compute"], result["counts"]["cpu"]);
    EXPECT_GT(result["counts"]["cpu"].get<std::vector<int>>(), std::vector<int>(12, 0));
}

/// Of eight poses, four of which touch, the oracle looks at some that do.
TEST_F(CompareTest, TheOracleLooksWhereSomethingTouches) {
    const Json result =
        Json::parse(output({"compare", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:300", "--number", "8",
                            "--oracle", "2", "--sweep", "none", "--size", "64x64", "--format", "json"}));
    ASSERT_EQ(result["oracle"]["checks"].size(), 2U);
    for (const Json& check : result["oracle"]["checks"]) {
        EXPECT_GT(check["oracle"], 0) << check;
    }
    for (const Json& method : result["methods"]) {
        EXPECT_EQ(method["trusted"], true) << method;
        EXPECT_EQ(method["self_test"] == "", method["method"] == "cpu") << method;
    }
}

TEST_F(CompareTest, WhereNothingTouchesNothingIsClaimed) {
    const Json result = json({"--sweep", "none", "--opacity", "0:0,255:0"});
    const Json& oracle = *(result["agreement"].end() - 2); // by fragments; then by counts, with cpu
    EXPECT_EQ(oracle["checked"], false);
    EXPECT_TRUE(oracle["agrees"].is_null());
    EXPECT_EQ(oracle["why_not"], "neither has a fragment on these poses");
    EXPECT_THAT(output(compare({"--sweep", "none", "--opacity", "0:0,255:0"})),
                HasSubstr("fragment by fragment: not checked, neither has a fragment"));
    EXPECT_EQ(result["oracle"]["checks"].size(), 4U) << "all might have missed something";
    EXPECT_THAT(result["notes"].dump(), HasSubstr("no pose touches: agreement means little"));
    const Json alone =
        Json::parse(output({"compare", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:300", "--number", "2",
                            "--oracle", "0", "--methods", "cpu", "--sweep", "none", "--format", "json"}));
    EXPECT_TRUE(alone["agrees"].is_null()) << "nothing was held against anything";
}

TEST_F(CompareTest, EverySeriesSaysWhatItWasMeasuredOn) {
    const Json result = json();
    for (const char* method : {"query", "atomic", "cpu"}) {
        const std::vector<Json> sync = seriesOf(result, method, "sync");
        const std::vector<Json> pipelined = seriesOf(result, method, "pipelined");
        ASSERT_EQ(sync.size(), 4U) << method;
        ASSERT_EQ(pipelined.size(), 4U) << method;
        EXPECT_EQ(pipelined[3]["batch"], 1024);
        EXPECT_EQ(sync[0]["batch"], 1);
    }
    for (const Json& series : result["series"]) {
        const Json& wall = series["wall_ms"];
        EXPECT_GE(wall["samples"].size(), 1U);
        EXPECT_LE(wall["samples"].size(), 2U);
        EXPECT_LE(wall["min"], wall["median"]);
        EXPECT_LE(wall["median"], wall["max"]);
        EXPECT_GT(series["pairs_per_s"].get<double>(), 0);
        EXPECT_EQ(series["gpu_ms"].is_null(), series["method"] == "cpu" || series["method"] == "oracle");
        for (const char* fact : {"device", "driver", "driver_version", "cpu", "cpu_threads", "voxtact", "git_revision",
                                 "hardware_filter"}) {
            EXPECT_TRUE(series["machine"].contains(fact)) << fact;
        }
    }
}

/// However little time there is, what stands side by side is of the same pairs.
TEST_F(CompareTest, MethodsAreTimedOnTheSamePoses) {
    const Json result = Json::parse(
        output({"compare", "--volume", "builtin:head:32", "--mesh", "builtin:scalpel:500", "--number", "20000",
                "--oracle", "0", "--size", "64x64", "--time-limit", "1", "--repetitions", "2", "--format", "json"}));
    std::map<std::string, Json> first;
    bool cut = false;
    for (const Json& series : result["series"]) {
        const std::string way = series["mode"].get<std::string>() + " " + series["batch"].dump();
        const Json& same = first.emplace(way, series).first->second;
        EXPECT_EQ(series["pairs_a_sample"], same["pairs_a_sample"]) << way << " " << series["method"];
        cut = cut || series["pairs_a_sample"] < 20000;
        // Those that count the same on a pose do so on the same poses.
        const std::string method = series["method"];
        const std::string kind = method == "cpu" || method == "compute" ? " counted" : " rasterised";
        EXPECT_EQ(series["fragments_a_pair"], first.emplace(way + kind, series).first->second["fragments_a_pair"])
            << way << " " << method;
    }
    EXPECT_TRUE(cut);
    EXPECT_THAT(result["notes"].dump(), HasSubstr("all methods are timed on the same "));
}

TEST_F(CompareTest, CsvHasOneHeaderAndSaysWhatAgrees) {
    const auto lines = linesOf(output(compare({"--methods", "query,cpu,query"}))); // named twice, measured once
    EXPECT_EQ(lines.front(),
              "sweep,method,mode,batch,width,height,triangles,fragments,samples,wall_ms_median,wall_ms_p10,wall_ms_p90,"
              "gpu_ms_median,pairs_per_s,fragments_per_s,voxels,pairs_a_sample");
    std::size_t rows = 0;
    for (std::size_t i = 1; i < lines.size() && !lines[i].starts_with("#"); ++i, ++rows) {
        EXPECT_EQ(std::count(lines[i].begin(), lines[i].end(), ','), 16) << lines[i];
        EXPECT_EQ(fieldsOf(lines[i]).at(15), "32x32x32");
    }
    EXPECT_EQ(rows, 2U * 8U + 1U) << "two methods, two modes, four batches; and the oracle";
    const std::vector<std::string> comments(lines.begin() + static_cast<std::ptrdiff_t>(rows) + 1, lines.end());
    EXPECT_THAT(comments, Each(StartsWith("# ")));
    EXPECT_THAT(comments, testing::Contains(HasSubstr("fastest for 1 pair")));
}

TEST_F(CompareTest, OnePoseAloneKeepsItsNumber) {
    const Json all = json({"--sweep", "none"});
    const Json one = json({"--sweep", "none", "--only-pose", "7"});
    EXPECT_EQ(one["poses"], Json::array({7}));
    EXPECT_EQ(one["counts"]["query"][0], all["counts"]["query"][7]);
    EXPECT_THAT(refused(2, compare({"--only-pose", "12"})), HasSubstr("--only-pose: there is no pose 12"));
}

TEST_F(CompareTest, PosesAreThoseOfMakePoses) {
    const Json made = json({"--sweep", "none", "--seed", "7"});
    const std::string file = poses(12);
    Arguments given = compare({"--sweep", "none", "--poses", file, "--format", "json"});
    const auto count = std::find(given.begin(), given.end(), "--number");
    given.erase(count, count + 2);
    EXPECT_EQ(Json::parse(output(given))["counts"], made["counts"]);
}

TEST_F(CompareTest, SweepsOfTrianglesAndFragments) {
    const Json result = json({"--sweep", "triangles", "--methods", "query,cpu"});
    std::vector<int> triangles;
    for (const Json& series : seriesOf(result, "cpu", "pipelined")) {
        triangles.push_back(series["triangles"]);
    }
    ASSERT_GE(triangles.size(), 5U);
    EXPECT_TRUE(std::is_sorted(triangles.begin(), triangles.end()));
    EXPECT_EQ(triangles.back(), 200000);
    const Json more = json({"--sweep", "fragments", "--methods", "query,cpu"});
    std::vector<double> fragments;
    for (const Json& series : seriesOf(more, "query", "pipelined")) {
        fragments.push_back(series["fragments_a_pair"]);
    }
    ASSERT_GE(fragments.size(), 5U);
    EXPECT_TRUE(std::is_sorted(fragments.begin(), fragments.end()));
    output({"make", "mesh", "builtin:scalpel:500", path("own.stl")});
    const Arguments own{"compare",  "--volume", "builtin:head:32", "--mesh",    path("own.stl"),
                        "--number", "4",        "--oracle",        "0",         "--size",
                        "64x64",    "--sweep",  "triangles",       "--methods", "query,cpu",
                        "--format", "text",     "--cache",         "off"};
    EXPECT_THAT(output(own), HasSubstr("no sweep of triangles"));
}

TEST_F(CompareTest, SweepOfVoxelsVariesTheVolumeAlone) {
    const Json result = json({"--sweep", "voxels", "--methods", "query,cpu"});
    std::vector<Json> voxels;
    for (const Json& series : seriesOf(result, "cpu", "pipelined")) {
        EXPECT_EQ(series["sweep"], "voxels");
        EXPECT_EQ(series["triangles"], 500);
        EXPECT_EQ(series["width"], 128);
        voxels.push_back(series["voxels"]);
    }
    EXPECT_EQ(voxels, (std::vector<Json>{{16, 16, 16}, {24, 24, 24}, {32, 32, 32}, {48, 48, 48}, {64, 64, 64}}));
    // The same poses and the same camera as in a run on a volume of that size.
    Arguments large = compare({"--sweep", "fragments", "--methods", "query,cpu", "--format", "json"});
    *std::find(large.begin(), large.end(), "builtin:head:32") = "builtin:head:64";
    const Json alone = Json::parse(output(large));
    for (const char* method : {"query", "cpu"}) {
        const std::vector<Json> series = seriesOf(alone, method, "pipelined");
        const auto same = std::find_if(series.begin(), series.end(), [](const Json& s) { return s["width"] == 128; });
        ASSERT_NE(same, series.end());
        EXPECT_EQ((*same)["voxels"], Json({64, 64, 64}));
        EXPECT_GT((*same)["fragments_a_pair"], 0);
        EXPECT_EQ(seriesOf(result, method, "pipelined").at(4)["fragments_a_pair"], (*same)["fragments_a_pair"]);
    }
}

TEST_F(CompareTest, SizesThatCannotBeHadAreTold) {
    const auto sweep = [](const std::string& volume) {
        return output({"compare", "--volume", volume, "--mesh", "builtin:scalpel:500", "--number", "4", "--oracle", "0",
                       "--size", "64x64", "--sweep", "voxels", "--methods", "query,cpu", "--cache", "off"});
    };
    const std::string small = sweep("builtin:head:4");
    EXPECT_THAT(small, AllOf(HasSubstr("no point of builtin:head:2"), HasSubstr("no point of builtin:head:3"),
                             HasSubstr("4x4x4"), HasSubstr("8x8x8")));
    output({"make", "volume", "builtin:head:8", path("own.nrrd")});
    EXPECT_THAT(sweep(path("own.nrrd")), HasSubstr("no sweep of voxels: the volume is no builtin"));
}

TEST_F(CompareTest, AllSweepsAreThoseThatAreNamed) {
    const Json result = json({"--sweep", "all", "--methods", "cpu"});
    std::vector<std::string> sweeps;
    for (const Json& series : result["series"]) {
        if (sweeps.empty() || sweeps.back() != series["sweep"]) {
            sweeps.push_back(series["sweep"]);
        }
    }
    EXPECT_EQ(sweeps, (std::vector<std::string>{"batch", "triangles", "fragments", "voxels"}));
}

TEST_F(CompareTest, TheReportIsOneFile) {
    output(compare({"--report", path("report.html"), "--output", path("out.csv"), "--sweep", "batch"}));
    const std::string page = readText(path("report.html"));
    EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
    EXPECT_THAT(page, AllOf(HasSubstr("the same pairs by every method"), HasSubstr("voxtact compare --volume"),
                            HasSubstr("<polyline"), HasSubstr("<th>pairs_per_s</th>")));
    EXPECT_THAT(page, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("<link")), Not(HasSubstr(" src="))));
    EXPECT_EQ(filesInFolder(), 2U);
}

TEST_F(CompareTest, WhatCannotBeDoneIsOneLine) {
    EXPECT_THAT(refused(2, compare({"--methods", "query,magic"})),
                AllOf(HasSubstr("--methods"), HasSubstr("'magic' is unknown"), HasSubstr("subgroup")));
    EXPECT_THAT(refused(2, compare({"--sweep", "sideways"})),
                AllOf(HasSubstr("'sideways' is unknown"), HasSubstr("fragments, voxels, all")));
    EXPECT_THAT(refused(2, compare({"--mesh", "builtin:ellipsoid"})), HasSubstr("--volume, --mesh: give each once"));
    EXPECT_THAT(refused(2, compare({"--time-limit", "0"})), HasSubstr("--time-limit"));
    EXPECT_THAT(refused(2, compare({"--poses", "poses.txt"})), HasSubstr("--number"));
    EXPECT_THAT(refused(1, compare({"--report", path("none/report.html")})), HasSubstr("does not exist"));
    EXPECT_THAT(refused(2, compare({"--report", path("one.html"), "--output", path("one.html")})),
                HasSubstr("give each its own file"));
    EXPECT_THAT(refused(2, compare({"--report", "-"})), HasSubstr("--report: - is standard output"));
    EXPECT_THAT(refused(2, {"compare", "--volume", "builtin:head:16", "--mesh", "builtin:scalpel:100", "--number",
                            "1000000000"}),
                HasSubstr("--number: '1000000000' is not a whole number from 1 to 10000000"));
    EXPECT_THAT(refused(2, compare({"--only-pose", "-1"})), HasSubstr("--only-pose: '-1' is not a whole number"));
    EXPECT_EQ(filesInFolder(), 0U);
}

} // namespace
} // namespace voxtact::test
