// SPDX-License-Identifier: MIT
// What compare --localize and bench --certified make of answers that differ.
#include "bench/compare/localize.h"
#include "bench/engine_bench/parts.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>

namespace voxtact::test {
namespace {

using lab::BenchRow;
using lab::LocalizeResult;
using lab::LocalizeWay;

LocalizeWay way(const std::string& name, bool byView, std::vector<std::vector<TouchedTriangle>> found) {
    LocalizeWay made{.name = name, .byView = byView, .found = std::move(found)};
    for (const auto& pose : made.found) {
        made.triangles += pose.size();
    }
    return made;
}

LocalizeResult twoPoses(std::vector<TouchedTriangle> secondOfLeaf) {
    LocalizeResult result;
    result.poseNumbers = {4, 9};
    result.ways.push_back(way("polygon", true, {{{0, 1, 5}, {0, 7, 2}}, {{0, 3, 1}}}));
    result.ways.push_back(way("leaf", true, {{{0, 1, 5}, {0, 7, 2}}, std::move(secondOfLeaf)}));
    result.ways.push_back({.name = "fragments", .unchecked = "no such device"});
    result.ways.push_back(way("certified", false, {{{0, 1, 1}, {0, 2, 1}}, {{0, 3, 9}, {0, 8, 1}}}));
    return result;
}

TEST(LocalizeJudgeTest, MissedAndWrongAreAgainstTheCertifiedSet) {
    LocalizeResult result = twoPoses({{0, 3, 1}});
    judgeLocalize(result);
    EXPECT_FALSE(result.verdict.failed());
    EXPECT_EQ(result.ways[0].missed, 2U) << "triangle 2 of the first pose, 8 of the second";
    EXPECT_EQ(result.ways[0].wrong, 1U) << "triangle 7";
    EXPECT_EQ(result.ways[3].missed, 0U);
    EXPECT_EQ(result.ways[3].wrong, 0U);
}

TEST(LocalizeJudgeTest, AnotherTriangleOrCountIsADisagreement) {
    LocalizeResult lost = twoPoses({});
    judgeLocalize(lost);
    ASSERT_TRUE(lost.verdict.failed());
    EXPECT_EQ(disagreementOf(lost.verdict),
              "polygon = leaf = leaf-bricks = fragments: disagreement on pose 9: triangle 3: "
              "polygon 1, leaf 0 fragments");
    LocalizeResult other = twoPoses({{0, 3, 2}});
    judgeLocalize(other);
    ASSERT_TRUE(other.verdict.failed());
    EXPECT_EQ(other.verdict.first->pose, 9U);
    EXPECT_EQ(other.verdict.first->text, "triangle 3: polygon 1, leaf 2 fragments");
}

PairAnswer answer(bool hit, bool possible, std::uint64_t count) {
    return {.hit = hit, .possible = possible, .count = count};
}

TEST(EngineJudgeTest, MissedAndFalseAreCounted) {
    const std::vector<PairAnswer> certified{answer(true, false, 3), answer(true, false, 1), answer(false, true, 0),
                                            answer(false, false, 0)};
    const std::vector<PairAnswer> answers{answer(true, false, 1), answer(false, false, 0), answer(true, false, 1),
                                          answer(true, false, 1)};
    BenchRow row{.engine = {.name = "other", .question = "yes/no"}};
    EXPECT_EQ(judgeEngine(certified, answers, row), "") << "it need not agree";
    EXPECT_EQ(row.contacts, 2U);
    EXPECT_EQ(row.untouched, 1U);
    EXPECT_EQ(row.missed, 1U);
    EXPECT_EQ(row.wrong, 1U) << "what is possible is no false contact";
}

TEST(EngineJudgeTest, CertifiedEnginesMustAgree) {
    const std::vector<PairAnswer> certified{answer(true, false, 3), answer(false, true, 0)};
    BenchRow counting{
        .mesh = "m", .poses = "onset", .engine = {.name = "compute", .question = "count", .certified = true}};
    EXPECT_EQ(judgeEngine(certified, certified, counting), "");
    EXPECT_EQ(judgeEngine(certified, std::vector<PairAnswer>{answer(true, false, 2), answer(false, true, 0)}, counting),
              "m, poses onset, pose 0: compute count says 2; expected: 3");
    BenchRow yesNo{.mesh = "m", .poses = "onset", .engine = {.name = "cpu", .question = "yes/no", .certified = true}};
    EXPECT_EQ(judgeEngine(certified, std::vector<PairAnswer>{answer(true, false, 1), answer(false, true, 0)}, yesNo),
              "");
    EXPECT_NE(judgeEngine(certified, std::vector<PairAnswer>{answer(true, false, 1), answer(false, false, 0)}, yesNo),
              "");
}

TEST(EngineOutputTest, AShareHasItsWholeOrIsNone) {
    lab::BenchResult result;
    result.rows.push_back({.mesh = "m",
                           .poses = "onset",
                           .engine = {.name = "fcl-float", .projection = "octree", .question = "yes/no"},
                           .pairs = 4,
                           .contacts = 4,
                           .missed = 1,
                           .wallRate = {1},
                           .cpuRate = {1},
                           .wallRatio = {1},
                           .cpuRatio = {1}});
    std::ostringstream out;
    writeBench(out, io::Format::Json, {.mode = lab::BenchMode::Certified}, result);
    const auto json = nlohmann::json::parse(out.str());
    EXPECT_EQ(json["rows"][0]["missed_percent"], 25);
    EXPECT_TRUE(json["rows"][0]["false_percent"].is_null()) << "there are no poses that it could be wrong on";
    EXPECT_EQ(json["rows"][0]["no_contacts"], 0);
    EXPECT_EQ(json["rows"][0]["possible"], 0);
    const std::string sentence = json["summary"][0];
    EXPECT_NE(sentence.find("; of the 4 contacts that misses 25 %"), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find("certainly do not touch"), std::string::npos) << sentence;
}

} // namespace
} // namespace voxtact::test
