// SPDX-License-Identifier: MIT
#include "view/model/command_text.h"
#include "view/model/live_answer.h"
#include "view/model/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace voxtact::test {

using namespace voxtact::view;
using testing::HasSubstr;
using testing::Not;

namespace {

Document document() {
    Document out;
    out.sources.volume = "builtin:head:64";
    out.sources.mesh = "builtin:scalpel:300";
    out.edit.curve = {{-40.5, 0}, {80, 0.1}};
    out.edit.threshold = 0.25;
    out.edit.world_from_object = translation({1.5, -2, 1.0 / 3});
    out.domain = {-1024, 3071};
    return out;
}

} // namespace

TEST(ViewCommand, SaysEverythingThatAnAnswerDependsOn) {
    EXPECT_EQ(copyAsCommand(document(), {CountingMethod::Cpu, Projection::Conservative}, ""),
              "echo '1 0 0 1.5 0 1 0 -2 0 0 1 0.3333333333333333 0 0 0 1' | voxtact detect --volume builtin:head:64 "
              "--mesh builtin:scalpel:300 --poses - --opacity=-40.5:0,80:0.1 --tf-domain=-1024:3071 --tf-size 256 "
              "--threshold 0.25 --projection conservative --count cpu");
}

TEST(ViewCommand, NamesTheDeviceWhereOneAnswers) {
    const MethodChoice query{CountingMethod::Query, Projection::View};
    EXPECT_THAT(copyAsCommand(document(), query, "1"), HasSubstr(" --count query --device 1"));
    EXPECT_THAT(copyAsCommand(document(), {}, "1"), Not(HasSubstr("--device")));
}

TEST(ViewCommand, FilesHaveAbsolutePathsInOneWord) {
    Document files = document();
    files.sources = {"a head.nii", "tool's.stl", "ras", 0.5, "", ""};
    const std::string text = copyAsCommand(files, {}, "");
    const std::string here = std::filesystem::current_path().string();
    EXPECT_THAT(text, HasSubstr("--volume '" + here + "/a head.nii'"));
    EXPECT_THAT(text, HasSubstr("/tool'\\''s.stl' --mesh-space ras --mesh-scale 0.5"));
}

TEST(ViewCommand, HasTheLabelMapAndItsNames) {
    Document labelled = document();
    EXPECT_THAT(copyAsCommand(labelled, {}, ""), Not(HasSubstr("--label")));
    labelled.sources.labels = "/data/an atlas.nii";
    labelled.sources.labelNames = "/data/names.txt";
    EXPECT_THAT(copyAsCommand(labelled, {}, ""),
                HasSubstr(" --labels '/data/an atlas.nii' --label-names /data/names.txt"));
}

TEST(ViewCommand, ShellWords) {
    EXPECT_EQ(shellWord("a-b_c/1.nii.gz"), "a-b_c/1.nii.gz");
    EXPECT_EQ(shellWord(""), "''");
    EXPECT_EQ(shellWord("a b"), "'a b'");
    EXPECT_EQ(shellWord("$(x);`y`"), "'$(x);`y`'");
}

TEST(ViewAnswer, TheDeepestContactsComeFirstAndAreNotTooMany) {
    BatchAnswer batch;
    batch.pairs.resize(1);
    batch.pairs[0].hit = true;
    batch.contacts.resize(kShownContacts + 5);
    for (std::size_t i = 0; i < batch.contacts.size(); ++i) {
        batch.contacts[i].depth = static_cast<double>(i);
    }
    batch.contactsFound = batch.contacts.size();
    batch.triangles = {{0, 3, 1}, {0, 8, 2}};
    const LiveAnswer answer = liveAnswer(batch, 7, translation({1, 2, 3}), 0.5);
    EXPECT_EQ(answer.contacts.size(), kShownContacts);
    EXPECT_EQ(answer.contacts.front().depth, static_cast<double>(kShownContacts + 4));
    EXPECT_EQ(answer.contactsFound, kShownContacts + 5);
    EXPECT_THAT(answer.triangles, testing::ElementsAre(3, 8));
    EXPECT_EQ(answer.revision, 7U);
}

TEST(ViewAnswer, VerdictsAreThoseOfDetect) {
    PairAnswer answer;
    EXPECT_STREQ(verdict(answer), "no");
    EXPECT_EQ(hitNumber(answer), 0);
    answer.possible = true;
    EXPECT_STREQ(verdict(answer), "possible");
    EXPECT_EQ(hitNumber(answer), 2);
    answer.hit = true;
    EXPECT_STREQ(verdict(answer), "yes");
    EXPECT_EQ(hitNumber(answer), 1);
}

TEST(ViewTimes, PercentilesAreOfTheLastThousand) {
    Times times;
    EXPECT_EQ(times.percentile(0.5), 0);
    times.add(3);
    EXPECT_EQ(times.percentile(0.99), 3);
    for (int i = 1; i <= 1000; ++i) {
        times.add(i);
    }
    EXPECT_EQ(times.count(), 1000U);
    EXPECT_EQ(times.percentile(0.5), 500);
    EXPECT_EQ(times.percentile(0.99), 990);
    EXPECT_EQ(times.percentile(1), 1000);
}

TEST(ViewStrip, AnAnswerIsInSightUntilTheNext) {
    Strip strip;
    EXPECT_TRUE(strip.pieces(5).empty());
    strip.add(1, 0, 2);
    strip.add(3, 1, 4);
    const std::vector<Strip::Piece> two = strip.pieces(4);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_EQ(two[0].from, 3);
    EXPECT_EQ(two[0].to, 1);
    EXPECT_EQ(two[0].hit, 0);
    EXPECT_EQ(two[0].milliseconds, 2);
    EXPECT_EQ(two[1].from, 1);
    EXPECT_EQ(two[1].to, 0);
    EXPECT_EQ(two[1].hit, 1);
    // What is older than the strip is cut, and what went out of sight before is not there.
    const std::vector<Strip::Piece> later = strip.pieces(11.5);
    ASSERT_EQ(later.size(), 2U);
    EXPECT_EQ(later[0].from, Strip::kSeconds);
    EXPECT_EQ(later[0].to, 8.5);
    const std::vector<Strip::Piece> last = strip.pieces(100);
    ASSERT_EQ(last.size(), 1U);
    EXPECT_EQ(last[0].hit, 1);
    EXPECT_EQ(last[0].from, Strip::kSeconds);
    // It forgets: what it holds does not grow.
    for (int i = 0; i < 1000; ++i) {
        strip.add(100 + 0.1 * i, i % 3, 1);
    }
    EXPECT_LE(strip.pieces(200).size(), 102U);
}

TEST(ViewReport, IsJsonWithWhatTheContractPromises) {
    BatchAnswer batch;
    batch.pairs.resize(1);
    batch.pairs[0] = {.hit = true, .count = 42, .method = CountingMethod::Cpu, .projection = Projection::Conservative};
    const LiveAnswer answer = liveAnswer(batch, 1, translation({5, 6, 7}), 0.5);
    Times times;
    const Document shown = document();
    StateReport report;
    report.answer = &answer;
    report.times = &times;
    report.frameTimes = report.times;
    report.document = &shown;
    report.command = "voxtact \"detect\"";
    const auto json = nlohmann::json::parse(reportText(report));
    EXPECT_EQ(json["hit"], 1);
    EXPECT_EQ(json["count"], 42);
    EXPECT_EQ(json["method"], "cpu");
    EXPECT_EQ(json["projection"], "conservative");
    EXPECT_EQ(json["pose"], (nlohmann::json{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1}));
    EXPECT_EQ(json["command"], report.command);
}

} // namespace voxtact::test
