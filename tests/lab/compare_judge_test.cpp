// SPDX-License-Identifier: MIT
// Who must agree with whom, on made-up numbers.
#include "bench/compare/agreement.h"
#include "bench/engines/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace voxtact::test {
namespace {

using lab::CompareVerdict;
using lab::FragmentCheck;
using lab::NamedCounts;
using oracle::Doubt;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::uint32_t> kPoses{10, 11, 12};

TEST(CompareJudge, EqualCountsAgree) {
    const std::vector<NamedCounts> group{{"query", {0, 5, 9}}, {"atomic", {0, 5, 9}}, {"subgroup", {0, 5, 9}}};
    const CompareVerdict verdict = lab::judgeEqual(group, kPoses);
    EXPECT_EQ(verdict.rule, "query = atomic = subgroup");
    EXPECT_FALSE(verdict.failed());
    EXPECT_EQ(verdict.compared, 3U);
    EXPECT_EQ(verdict.differing, 0U);
}

TEST(CompareJudge, OneFragmentIsADisagreement) {
    const std::vector<NamedCounts> group{{"compute", {7, 5, 9}}, {"cpu", {7, 4, 12}}};
    const CompareVerdict verdict = lab::judgeEqual(group, kPoses);
    ASSERT_TRUE(verdict.failed());
    EXPECT_EQ(verdict.differing, 2U);
    EXPECT_EQ(verdict.largest, 3U);
    EXPECT_EQ(verdict.first->pose, 11U) << "the pose's own number, not its place";
    EXPECT_EQ(verdict.first->text, "compute 5, cpu 4");
}

TEST(CompareJudge, OneMethodAloneIsNotChecked) {
    const std::vector<NamedCounts> group{{"cpu", {7, 4, 12}}};
    const CompareVerdict verdict = lab::judgeEqual(group, kPoses);
    EXPECT_FALSE(verdict.failed());
    EXPECT_NE(verdict.unchecked, "");
    EXPECT_EQ(verdict.compared, 0U);
}

TEST(CompareJudge, HitsAreZeroOrNot) {
    EXPECT_FALSE(lab::judgeHits({"query-any", {0, 1, 77}}, {"query", {0, 5, 9}}, kPoses).failed());
    const CompareVerdict miss = lab::judgeHits({"query-any", {0, 0, 1}}, {"query", {0, 5, 9}}, kPoses);
    ASSERT_TRUE(miss.failed());
    EXPECT_EQ(miss.first->pose, 11U);
    EXPECT_EQ(miss.first->text, "query-any misses, query 5");
    EXPECT_EQ(lab::judgeHits({"query-any", {1, 1, 1}}, {"query", {0, 5, 9}}, kPoses).first->text,
              "query-any hits, query 0");
}

TEST(CompareJudge, GroupsMayDifferAndAreTold) {
    const CompareVerdict verdict = lab::tellDifference({"query", {7, 5, 9}}, {"cpu", {6, 5, 12}}, kPoses);
    EXPECT_FALSE(verdict.failed());
    EXPECT_EQ(verdict.differing, 2U);
    EXPECT_EQ(verdict.largest, 3U);
    EXPECT_EQ(verdict.first->pose, 12U);
    EXPECT_THAT(verdict.detail, HasSubstr("4 of 23 fragments"));
}

TEST(CompareJudge, ARasteriserThatLosesHalfOfAMeshIsADisagreement) {
    const auto judge = [](std::uint64_t raster, std::uint64_t host) {
        return lab::judgeRounding({"query", {5, raster, 9}}, {"cpu", {5, host, 9}}, kPoses);
    };
    EXPECT_FALSE(judge(86, 300).failed()) << "half and 64 apart";
    const CompareVerdict lost = judge(85, 300);
    ASSERT_TRUE(lost.failed());
    EXPECT_EQ(lost.first->pose, 11U);
    EXPECT_EQ(lost.first->text, "query 85, cpu 300");
    EXPECT_TRUE(judge(515, 300).failed()) << "or has too much";
    EXPECT_TRUE(lab::judgeRounding({"query-any", {1, 0, 1}}, {"cpu", {5, 65, 9}}, kPoses).failed());
    EXPECT_FALSE(lab::judgeRounding({"query-any", {1, 0, 1}}, {"cpu", {5, 64, 9}}, kPoses).failed());
    // Of all methods: the rasteriser's agree with each other.
    const std::vector<NamedCounts> all{
        {"query", {0, 9, 0}}, {"atomic", {0, 9, 0}}, {"compute", {0, 900, 0}}, {"cpu", {0, 900, 0}}};
    EXPECT_EQ(std::ranges::count_if(lab::judgeCounts(all, kPoses), &CompareVerdict::failed), 1);
}

TEST(CompareJudge, PosesThatTouchAreThoseOfAnyMethod) {
    EXPECT_THAT(lab::touchingPoses(std::vector<NamedCounts>{{"query", {0, 5, 0, 0}}, {"cpu", {0, 5, 0, 1}}}),
                ElementsAre(1, 3));
    EXPECT_THAT(lab::touchingPoses(std::vector<NamedCounts>{{"cpu", {0, 0}}}), ElementsAre());
    EXPECT_THAT(lab::touchingPoses({}), ElementsAre());
}

FragmentCheck checkOf(std::uint32_t pose, const std::vector<Doubt>& doubts) {
    FragmentCheck check{.pose = pose, .onDevice = 100 + doubts.size(), .byOracle = 100, .counted = 100 + doubts.size()};
    for (const Doubt doubt : doubts) {
        check.differing.push_back(
            {.pose = pose, .fragment = {42, 3, 4}, .onDevice = true, .evidence = {.doubt = doubt}});
    }
    return check;
}

std::array<std::uint64_t, 4> countsOf(const std::vector<FragmentCheck>& checks) {
    std::array<std::uint64_t, 4> counts{};
    std::ranges::transform(lab::kDoubts, counts.begin(), [&](Doubt doubt) { return lab::countOf(doubt, checks); });
    return counts;
}

TEST(CompareJudge, FragmentsWithAReasonAgree) {
    const std::vector<FragmentCheck> checks{checkOf(1, {}),
                                            checkOf(2, {Doubt::Coverage, Doubt::Opacity, Doubt::Opacity})};
    const CompareVerdict verdict = lab::judgeFragments(checks);
    EXPECT_FALSE(verdict.failed());
    EXPECT_EQ(verdict.compared, 203U);
    EXPECT_THAT(verdict.detail, HasSubstr("on 2 poses: "));
    EXPECT_EQ(lab::judgeFragments(std::vector{checkOf(1, {})}).detail, "on 1 pose");
    EXPECT_EQ(verdict.differing, 3U);
    EXPECT_THAT(countsOf(checks), ElementsAre(1, 0, 2, 0));
}

TEST(CompareJudge, AFragmentWithoutAReasonIsADisagreement) {
    const std::vector<FragmentCheck> checks{checkOf(1, {Doubt::Coverage}), checkOf(2, {Doubt::Opacity, Doubt::None})};
    const CompareVerdict verdict = lab::judgeFragments(checks);
    ASSERT_TRUE(verdict.failed());
    EXPECT_EQ(verdict.first->pose, 2U);
    EXPECT_THAT(verdict.first->text, HasSubstr("triangle 42 at pixel 3,4"));
    EXPECT_THAT(countsOf(checks), ElementsAre(1, 0, 1, 1));
}

TEST(CompareJudge, NoFragmentIsNotChecked) {
    const std::vector<FragmentCheck> checks{{.pose = 1}, {.pose = 2}};
    const CompareVerdict verdict = lab::judgeFragments(checks);
    EXPECT_FALSE(verdict.failed());
    EXPECT_NE(verdict.unchecked, "");
    const std::vector<FragmentCheck> lost{{.pose = 1, .counted = 3}};
    EXPECT_TRUE(lab::judgeFragments(lost).failed()) << "it lists none of the three";
}

TEST(CompareJudge, AListThatIsNotWhatWasCountedIsADisagreement) {
    std::vector<FragmentCheck> checks{checkOf(5, {})};
    checks[0].counted = 101;
    const CompareVerdict verdict = lab::judgeFragments(checks);
    ASSERT_TRUE(verdict.failed());
    EXPECT_EQ(verdict.first->pose, 5U);
    EXPECT_EQ(verdict.first->text, "the device lists 100 fragments and counts 101");
}

TEST(CompareJudge, SamplesAreSpread) {
    EXPECT_THAT(lab::spreadEvenly(4, 100), ElementsAre(0, 25, 50, 75));
    EXPECT_THAT(lab::spreadEvenly(9, 3), ElementsAre(0, 1, 2));
    EXPECT_THAT(lab::spreadEvenly(0, 3), ElementsAre());
}

} // namespace
} // namespace voxtact::test
