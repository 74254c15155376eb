// SPDX-License-Identifier: MIT
// voxtact bench: engines side by side, checked and timed.
#include "cli/cli_fixture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class BenchTest : public CliDeviceTest {
  protected:
    /// A scene that takes a moment, and what is added.
    static Arguments bench(const std::string& poses, const std::string& repetitions, const Arguments& more = {}) {
        Arguments all{"bench",  "--progress",          "never",    "--certified", "--volume",      "builtin:head:30",
                      "--mesh", "builtin:scalpel:500", "--number", poses,         "--repetitions", repetitions};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    static Arguments opaque(Arguments all) {
        all.insert(all.end(), {"--opacity", "40:0,80:1"});
        return all;
    }
    static Json json(Arguments all) {
        all.insert(all.end(), {"--format", "json"});
        return Json::parse(output(all));
    }
    static std::vector<Json> rowsOf(const Json& result, const std::string& engine, const std::string& question) {
        std::vector<Json> found;
        for (const Json& row : result["rows"]) {
            if (row["engine"] == engine && row["question"] == question && row["projection"] != "view") {
                found.push_back(row);
            }
        }
        return found;
    }
};

TEST_F(BenchTest, EveryCertifiedEngineMissesNothing) {
    const Json result = json(opaque(bench("24", "2")));
    EXPECT_EQ(result["scene"]["volume"], "builtin:head:30");
    EXPECT_EQ(result["scene"]["opacity"], "40:0,80:1");
    EXPECT_EQ(result["scene"]["tf_domain"], Json({0.0, 255.0}));
    for (const char* fact : {"device", "driver", "cpu", "cpu_threads"}) {
        EXPECT_TRUE(result["machine"].contains(fact)) << fact;
    }
    EXPECT_EQ(rowsOf(result, "cpu", "yes/no").size(), 4U) << "one thread and all, two sets of poses";
    EXPECT_EQ(rowsOf(result, "cpu", "count").size(), 2U);
    EXPECT_EQ(rowsOf(result, "compute", "yes/no").size(), 2U);
    EXPECT_EQ(rowsOf(result, "compute", "count").size(), 2U);
    for (const Json& row : result["rows"]) {
        EXPECT_EQ(row["pairs"], 24);
        EXPECT_EQ(row["samples"], 2);
        EXPECT_GT(row["contacts"], 0);
        EXPECT_EQ(row["contacts"].get<int>() + row["no_contacts"].get<int>() + row["possible"].get<int>(), 24) << row;
        EXPECT_GT(row["pairs_per_s_min"], 0);
        EXPECT_LE(row["pairs_per_s_min"], row["pairs_per_s"]);
        EXPECT_LE(row["pairs_per_s"], row["pairs_per_s_max"]);
        if (row["projection"] == "certified") {
            EXPECT_EQ(row["missed_percent"], 0) << row;
            EXPECT_EQ(row["false_percent"], 0) << row;
        }
    }
    EXPECT_EQ(result["summary"].size(), VOXTACT_WITH_FCL != 0 ? 4U : 0U);
    EXPECT_EQ(result["rows"][0]["wall_ratio"], 1);
    EXPECT_EQ(result["rows"][0]["cpu_ratio_max"], 1);
}

TEST_F(BenchTest, FclIsThereOrTheTableSaysWhy) {
    const std::string text = output(opaque(bench("8", "1", {"--format", "text"})));
    EXPECT_THAT(text, HasSubstr(VOXTACT_WITH_FCL != 0 ? "fcl-float" : "# FCL: not built in"));
    const Json result = json(opaque(bench("100", "1")));
    for (const Json& row : rowsOf(result, "fcl-double", "yes/no")) {
        // Voxels are the cubes around the points that the interpolant runs through: near contact it is another shape.
        EXPECT_LT(row["missed_percent"], row["poses"] == "large" ? 20 : 80) << row;
        EXPECT_LT(row["false_percent"], row["poses"] == "large" ? 30 : 101) << row;
    }
}

TEST_F(BenchTest, AnisotropicObliqueVolumes) {
    output({"make", "volume", "builtin:ct:24", path("ct.nii.gz")});
    const Json result = json({"bench", "--certified", "--volume", path("ct.nii.gz"), "--mesh", "builtin:ellipsoid:200",
                              "--opacity", "100:0,200:1", "--number", "40", "--repetitions", "1"});
    for (const Json& row : rowsOf(result, "fcl-float", "yes/no")) {
        EXPECT_LT(row["missed_percent"], 50) << row;
    }
    if (VOXTACT_WITH_FCL != 0) {
        EXPECT_THAT(result["notes"].dump(), HasSubstr("no cubes"));
    }
}

TEST_F(BenchTest, CsvIsTheSameSceneForTheSameSeed) {
    const auto lines = linesOf(output(opaque(bench("8", "1", {"--seed", "5"}))));
    const auto again = linesOf(output(opaque(bench("8", "1", {"--seed", "5"}))));
    EXPECT_EQ(lines.front(),
              "mesh,triangles,poses,engine,projection,question,threads,pairs,contacts,missed_percent,false_percent,"
              "samples,pairs_per_s,pairs_per_s_min,pairs_per_s_max,pairs_per_cpu_s,pairs_per_cpu_s_min,"
              "pairs_per_cpu_s_max,wall_ratio,wall_ratio_min,wall_ratio_max,cpu_ratio,cpu_ratio_min,cpu_ratio_max,"
              "no_contacts,possible");
    ASSERT_EQ(lines.size(), again.size());
    for (std::size_t i = 1; i < lines.size() && !lines[i].starts_with("#"); ++i) {
        const auto one = fieldsOf(lines[i]);
        const auto other = fieldsOf(again[i]);
        ASSERT_EQ(one.size(), 26U);
        EXPECT_TRUE(std::equal(one.begin(), one.begin() + 11, other.begin())) << lines[i] << "\n" << again[i];
    }
}

TEST_F(BenchTest, WithoutADeviceTheHostIsMeasured) {
    const RunOptions none{.environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
    const std::string text = output(opaque(bench("8", "1")), none);
    EXPECT_THAT(text, AllOf(HasSubstr("# no device"), HasSubstr("certified"), Not(HasSubstr("compute"))));
    EXPECT_THAT(refused(1, bench("8", "1", {"--device", "0"}), none), Not(testing::IsEmpty()));
}

/// Every question, by the host and by the device, and nothing of it otherwise than the host's.
TEST_F(BenchTest, LatencyIsOfEveryEngineAndVerified) {
    const Json result = json({"bench", "--latency", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300",
                              "--opacity", "40:0,80:1", "--number", "300", "--time-limit", "3"});
    EXPECT_EQ(result["scene"]["ticks"], 300);
    std::map<std::string, int> rows;
    for (const Json& row : result["rows"]) {
        const std::string engine = row["engine"];
        ++rows[engine];
        EXPECT_GE(row["ticks"], 10) << row;
        EXPECT_LE(row["ticks"], 300) << row;
        EXPECT_GT(row["p50_us"], 0) << row;
        EXPECT_LE(row["p50_us"], row["max_us"]) << row;
        const bool empty = engine == "empty submit";
        EXPECT_EQ(row["question"].is_null(), empty) << row;
        EXPECT_EQ(row["awaited"].is_null(), engine == "cpu") << row;
        EXPECT_EQ(row["recorded"].is_null(), engine == "cpu") << row;
        EXPECT_EQ(row["record_p50_us"].is_null(), row["recorded"] != "each tick") << row;
        EXPECT_TRUE(!row["record_p50_us"].is_number() || row["record_p50_us"] < row["p50_us"]) << row;
        if (engine == "cpu" && row["ticks"] == 300) {
            EXPECT_GT(row["touching"], 20) << row;
            EXPECT_LT(row["touching"], 300) << row;
        }
        EXPECT_TRUE(engine != "compute" || row["rounding"] == 0) << row;
    }
    EXPECT_EQ(rows["empty submit"], 2) << "polled and waited for";
    EXPECT_EQ(rows["cpu"] % 3, 0);
    EXPECT_EQ(rows["compute"], 12) << "three questions, each polled and waited for, recorded each tick and once";
    EXPECT_EQ(rows["query"], 2);
    EXPECT_EQ(result["summary"].size(), 3U);
}

TEST_F(BenchTest, LatencyRefusesWhatItHasNoUseFor) {
    const Arguments latency{"bench",  "--latency",           "--volume", "builtin:head:18",
                            "--mesh", "builtin:scalpel:100", "--number", "4"};
    const auto with = [&](const Arguments& more) {
        Arguments all = latency;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    EXPECT_THAT(refused(2, with({"--repetitions", "3"})), HasSubstr("--repetitions: not with --latency"));
    EXPECT_THAT(refused(2, with({"--report", "x.html"})), HasSubstr("--report needs --paper"));
    EXPECT_THAT(refused(2, with({"--certified"})), HasSubstr("--certified"));
    EXPECT_THAT(refused(2, {"bench", "--latency", "--number", "4294967295"}),
                HasSubstr("--number: '4294967295' is not a whole number from 1 to 10000000"));
    EXPECT_THAT(refused(2, bench("8", "1", {"--time-limit", "3"})), HasSubstr("--time-limit needs"));
    EXPECT_THAT(refused(2, with({"--opacity", "0:0,255:0"})), HasSubstr("no poses around the onset of contact"));
}

TEST_F(BenchTest, BatchesOfEverySizeAndVerified) {
    const Json result =
        json({"bench", "--batches", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300", "--opacity",
              "40:0,80:1", "--number", "30", "--repetitions", "2", "--time-limit", "3600"});
    std::map<std::string, std::vector<int>> sizes;
    for (const Json& row : result["rows"]) {
        const std::string where = row["poses_on"].is_null() ? "" : " " + row["poses_on"].get<std::string>();
        sizes[row["engine"].get<std::string>() + " " + row["projection"].get<std::string>() + where].push_back(
            row["batch"]);
        EXPECT_EQ(row["samples"], 2) << row;
        EXPECT_GT(row["wall_ms"]["median"], 0) << row;
        EXPECT_GT(row["pairs_per_s"], 0) << row;
    }
    for (const char* engine :
         {"cpu view", "cpu certified", "compute view host", "compute certified host", "query view host",
          "atomic view host", "compute view device", "compute certified device"}) {
        EXPECT_EQ(sizes[engine], (std::vector<int>{1, 10, 30})) << engine;
    }
    // No more than fit.
    const Json cut = json({"bench", "--batches", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300",
                           "--opacity", "40:0,80:1", "--number", "100000", "--time-limit", "0.01"});
    EXPECT_LT(cut["rows"].size(), 6 * sizes.size()) << "all sizes, 100000 poses in 10 ms";
    EXPECT_THAT(result["notes"].dump(), Not(HasSubstr("are left out")));
    EXPECT_THAT(cut["notes"].dump(), HasSubstr(" exceed --time-limit and are left out"));
    // Not even of the smallest batch.
    const Json few =
        json({"bench", "--batches", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300", "--opacity",
              "40:0,80:1", "--number", "1", "--time-limit", "0.1", "--repetitions", "100000"});
    for (const Json& row : few["rows"]) {
        EXPECT_LT(row["samples"], 100'000) << row;
    }
    EXPECT_THAT(few["notes"].dump(), HasSubstr("rows of fewer than 100000 samples"));
}

TEST_F(BenchTest, WhereNothingTouchesANoteSaysSo) {
    for (const char* mode : {"--batches", "--outputs"}) {
        const std::string none = output({"bench", mode, "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:100",
                                         "--number", "4", "--repetitions", "1", "--opacity", "0:0,255:0"});
        EXPECT_THAT(none, HasSubstr("# no pose touches: agreement means little")) << mode;
    }
}

TEST_F(BenchTest, WhatCannotBeDoneIsOneLine) {
    EXPECT_THAT(refused(2, {"bench", "--volume", "builtin:head:18"}),
                AllOf(HasSubstr("--paper has its own scenes"), HasSubstr("--certified")));
    EXPECT_THAT(refused(2, bench("8", "1", {"--volume", "builtin:sphere"})),
                HasSubstr("--volume: a benchmark needs only one"));
    EXPECT_THAT(refused(2, bench("8", "0")), HasSubstr("--repetitions"));
    EXPECT_THAT(refused(2, bench("none.txt", "1")), HasSubstr("--number"));
    EXPECT_THAT(refused(2, {"bench", "--certified", "--number", "1000000000"}),
                HasSubstr("--number: '1000000000' is not a whole number from 1 to 10000000"));
    EXPECT_THAT(refused(2, {"bench", "--certified", "--poses", "poses.txt"}), HasSubstr("unknown argument '--poses'"));
    EXPECT_THAT(refused(2, bench("8", "1", {"--mesh", "builtin:spoon"})), HasSubstr("spoon"));
    EXPECT_THAT(refused(1, bench("8", "1", {"--output", path("none/out.csv")})), HasSubstr("does not exist"));
    EXPECT_EQ(filesInFolder(), 0U);
    // Nothing is opaque: no pose touches.
    EXPECT_THAT(refused(2, bench("2", "1", {"--opacity", "0:0,255:0"})),
                HasSubstr("no poses around the onset of contact: of 200 random poses only 0 touch"));
}

} // namespace
} // namespace voxtact::test
