// SPDX-License-Identifier: MIT
// voxtact compare --localize: which triangles touch, by each way to tell.
#include "cli/cli_fixture.h"

#include <nlohmann/json.hpp>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

class LocalizeCommandTest : public CliDeviceTest {
  protected:
    static Arguments localize(const Arguments& more = {}) {
        Arguments all{"compare", "--localize", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--size",
                      "128x128", "--progress", "never",    "--cache",         "off",    "--repetitions",       "1"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

TEST_F(LocalizeCommandTest, WaysOfTheViewAgreeAndMissWhatIsCertified) {
    const Json result = Json::parse(output(localize({"--format", "json", "--number", "6"})));
    EXPECT_TRUE(result["agrees"]);
    EXPECT_EQ(result["poses"].size(), 6U);
    std::vector<std::string> names;
    for (const Json& way : result["ways"]) {
        names.push_back(way["way"]);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"polygon", "leaf", "leaf-bricks", "fragments", "certified"}));
    const Json& ways = result["ways"];
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_EQ(ways[i]["triangles"], ways[0]["triangles"]);
        EXPECT_EQ(ways[i]["missed"], ways[0]["missed"]);
    }
    EXPECT_EQ(ways[0]["queries"], 6 * 500);
    EXPECT_LT(ways[2]["queries"], ways[1]["queries"]);
    EXPECT_LT(ways[1]["queries"], ways[0]["queries"]);
    EXPECT_GT(ways[4]["triangles"], 0);
    EXPECT_EQ(ways[4]["missed"], 0);
    EXPECT_EQ(ways[0]["triangles"].get<int>() - ways[0]["false"].get<int>() + ways[0]["missed"].get<int>(),
              ways[4]["triangles"].get<int>());
    EXPECT_EQ(result["not_certified"].size(), ways[0]["false"]);
    EXPECT_EQ(ways[3]["samples"], 6);
}

TEST_F(LocalizeCommandTest, WhereNothingTouchesNothingAgrees) {
    writeText(path("away.txt"), "1 0 0 1000 0 1 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_TRUE(Json::parse(output(localize({"--format", "json", "--poses", path("away.txt")})))["agrees"].is_null());
}

TEST_F(LocalizeCommandTest, CsvHasARowAWay) {
    const auto lines = linesOf(output(localize({"--only-pose", "3"})));
    ASSERT_GT(lines.size(), 6U);
    EXPECT_EQ(lines.front(), "way,poses,triangles,missed,missed_percent,false,queries,boxes,samples,wall_ms_median,"
                             "wall_ms_p10,wall_ms_p90,gpu_ms_median");
    EXPECT_EQ(fieldsOf(lines[1])[0], "polygon");
    EXPECT_EQ(fieldsOf(lines[1])[6], "500");
    EXPECT_EQ(fieldsOf(lines[5])[0], "certified");
    EXPECT_THAT(lines[6], HasSubstr("the same triangles with the same counts"));
    EXPECT_THAT(output(localize({"--only-pose", "3", "--format", "text", "--validate"})), HasSubstr("leaf-bricks"));
}

TEST_F(LocalizeCommandTest, AShareOfNothingIsNone) {
    const Json result =
        Json::parse(output(localize({"--only-pose", "3", "--format", "json", "--opacity", "300:0,400:1"})));
    EXPECT_TRUE(result["ways"][0]["missed_percent"].is_null());
    EXPECT_EQ(result["ways"][0]["missed"], 0);
    EXPECT_EQ(result["scene"]["opacity"], "300:0,400:1");
    EXPECT_EQ(result["summary"][1], "the camera shows 0 touching triangles; 0 certainly touch");
    EXPECT_THAT(result["notes"].dump(), HasSubstr("no pose touches"));
}

TEST_F(LocalizeCommandTest, WhatHasNothingToDoWithItIsRefused) {
    EXPECT_THAT(refused(2, localize({"--sweep", "batch"})), AllOf(HasSubstr("--localize"), HasSubstr("--sweep")));
    EXPECT_THAT(refused(2, localize({"--report", path("report.html")})), HasSubstr("--report"));
    EXPECT_THAT(refused(2, localize({"--only-pose", "8"})), HasSubstr("there is no pose 8; the last is 7"));
    EXPECT_THAT(refused(2, localize({"--mesh", "builtin:ellipsoid"})), HasSubstr("--volume, --mesh: give each once"));
    EXPECT_THAT(refused(1, localize({"--output", path("none/out.csv")})), HasSubstr("does not exist"));
}

} // namespace
} // namespace voxtact::test
