// SPDX-License-Identifier: MIT
#include "viewer/model/answers/command_text.h"
#include "viewer/model/answers/live_answer.h"
#include "viewer/model/answers/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace voxtact::test {

using namespace voxtact::view;
using testing::HasSubstr;
using testing::Not;

namespace {

Document document() {
    Document out;
    out.sources.volume = "builtin:head:64";
    out.sources.meshes = {{"builtin:scalpel:300"}};
    out.edit.curve = {{-40.5, 0}, {80, 0.1}};
    out.edit.threshold = 0.25;
    out.edit.pose() = translation({1.5, -2, 1.0 / 3});
    out.domain = {-1024, 3071};
    return out;
}

} // namespace

TEST(ViewCommand, SaysEverythingThatAnAnswerDependsOn) {
    EXPECT_EQ(copyAsCommand(document(), {CountingMethod::Cpu, Projection::Certified}, ""),
              "echo '1 0 0 1.5 0 1 0 -2 0 0 1 0.3333333333333333 0 0 0 1' | voxtact count --volume builtin:head:64 "
              "--mesh builtin:scalpel:300 --poses - --opacity=-40.5:0,80:0.1 --tf-domain=-1024:3071 --tf-size 256 "
              "--opacity-threshold 0.25 --projection certified --method cpu");
}

TEST(ViewCommand, NamesTheDeviceWhereOneAnswers) {
    const MethodChoice query{CountingMethod::Query, Projection::View};
    EXPECT_THAT(copyAsCommand(document(), query, "1"), HasSubstr(" --method query --device 1"));
    EXPECT_THAT(copyAsCommand(document(), {}, "1"), Not(HasSubstr("--device")));
}

TEST(ViewCommand, FilesHaveAbsolutePathsInOneWord) {
    Document files = document();
    files.sources = {"a head.nii", {{"tool's.stl", "ras", 0.5}}, "", "", 1};
    const std::string text = copyAsCommand(files, {}, "");
    const std::string here = std::filesystem::current_path().string();
    EXPECT_THAT(text, HasSubstr("--volume '" + here + "/a head.nii'"));
    EXPECT_THAT(text, HasSubstr("/tool'\\''s.stl' --mesh-space ras --mesh-scale 0.5"));
}

TEST(ViewCommand, HasALineForEachMesh) {
    Document two = document();
    two.sources.meshes.push_back({"/data/gone.stl"});
    two.sources.meshes.push_back({"/data/plate.stl", "ras", 2});
    two.edit.instruments.push_back({2, translation({0, 0, 9}), false});
    two.edit.holes = 1;
    const std::string text = copyAsCommand(two, {}, "");
    EXPECT_EQ(std::ranges::count(text, '\n'), 2);
    EXPECT_THAT(text, testing::StartsWith("# for the volume in the file, without the drilled hole\necho "));
    EXPECT_THAT(text, Not(HasSubstr("gone.stl")));
    const std::string second = text.substr(text.rfind('\n') + 1);
    EXPECT_THAT(second, testing::StartsWith("echo '1 0 0 0 0 1 0 0 0 0 1 9 0 0 0 1' | "));
    EXPECT_THAT(second, HasSubstr(" --mesh /data/plate.stl --mesh-space ras --mesh-scale 2 "));
    EXPECT_THAT(commandFor(two, two.edit.instruments[1], {}, ""), testing::EndsWith(second));
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
    const LiveAnswer live = liveAnswer(batch, 7, std::vector<Instrument>(1), 0.5);
    ASSERT_EQ(live.meshes.size(), 1U);
    const MeshAnswer& answer = live.meshes.front();
    EXPECT_EQ(answer.contacts.size(), kShownContacts);
    EXPECT_EQ(answer.contacts.front().depth, static_cast<double>(kShownContacts + 4));
    EXPECT_EQ(answer.contactsFound, kShownContacts + 5);
    EXPECT_THAT(answer.triangles, testing::ElementsAre(3, 8));
    EXPECT_EQ(live.revision, 7U);
}

TEST(ViewAnswer, EachMeshHasItsOwn) {
    BatchAnswer batch;
    batch.pairs.resize(2);
    batch.pairs[1].hit = true;
    batch.pairs[1].count = 5;
    batch.contacts.resize(3);
    batch.contacts[0].pair = 0;
    batch.contacts[1].pair = batch.contacts[2].pair = 1;
    batch.contacts[2].depth = 2;
    batch.contactsFound = 3;
    batch.triangles = {{0, 3, 1}, {1, 4, 2}, {1, 8, 3}};
    batch.labels = {{0, 7, 1}, {1, 7, 2}, {1, 9, 3}};
    const std::vector<Instrument> instruments{{4, identity(), true}, {2, translation({1, 2, 3}), false}};
    const LiveAnswer live = liveAnswer(batch, 1, instruments, 0.5);
    ASSERT_EQ(live.meshes.size(), 2U);
    EXPECT_EQ(live.of(0), nullptr);
    EXPECT_EQ(live.of(4), &live.meshes[0]);
    const MeshAnswer& second = *live.of(2);
    EXPECT_TRUE(second.pair.hit);
    EXPECT_EQ(second.instrument, instruments[1]);
    EXPECT_THAT(second.triangles, testing::ElementsAre(4, 8));
    ASSERT_EQ(second.contacts.size(), 2U);
    EXPECT_EQ(second.contacts.front().depth, 2);
    EXPECT_EQ(second.contactsFound, 2U);
    ASSERT_EQ(second.labels.size(), 2U);
    EXPECT_EQ(second.labels.front().label, 9);
    EXPECT_EQ(live.meshes[0].contactsFound, 1U);
    // Of a list that was cut nobody knows whose are missing: there is a contact for each survivor.
    batch.contactsFound = 6;
    EXPECT_EQ(liveAnswer(batch, 1, instruments, 0.5).of(2)->contactsFound, 5U);
}

TEST(ViewAnswer, VerdictsAreThoseOfDetect) {
    PairAnswer answer;
    EXPECT_STREQ(verdict(answer), "no");
    EXPECT_EQ(hitNumber(answer), 0);
    answer.possible = true;
    EXPECT_STREQ(verdict(answer), "undecided");
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
    batch.pairs[0] = {.hit = true, .count = 42, .method = CountingMethod::Cpu, .projection = Projection::Certified};
    batch.pairs.push_back({.pair = 1, .count = 0, .method = CountingMethod::Cpu});
    Document shown = document();
    shown.sources.meshes.push_back({"/data/plate.stl"});
    shown.edit.instruments.front().world_from_object = translation({5, 6, 7});
    shown.edit.instruments.push_back({1, identity(), false});
    const LiveAnswer answer = liveAnswer(batch, 1, shown.edit.instruments, 0.5);
    const LiveMeasures measures{1, {{1, {}, {}}}, 0};
    Times times;
    StateReport report;
    report.answer = &answer;
    report.times = &times;
    report.frameTimes = report.times;
    report.document = &shown;
    report.measures = &measures;
    report.commands = {"voxtact \"detect\"", "other"};
    const auto json = nlohmann::json::parse(reportText(report));
    EXPECT_EQ(json["touch"], 1);
    EXPECT_EQ(json["count"], 42);
    EXPECT_EQ(json["method"], "cpu");
    EXPECT_EQ(json["projection"], "certified");
    EXPECT_EQ(json["pose"], (nlohmann::json{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1}));
    EXPECT_EQ(json["command"], report.commands[0]);
    EXPECT_TRUE(json["distance"].is_null());
    EXPECT_EQ(json["chosen"], 0);
    ASSERT_EQ(json["meshes"].size(), 2U);
    EXPECT_EQ(json["meshes"][0]["mesh"], "builtin:scalpel:300");
    EXPECT_EQ(json["meshes"][0]["count"], 42);
    EXPECT_EQ(json["meshes"][0]["shown"], true);
    EXPECT_EQ(json["meshes"][1]["touch"], 0);
    EXPECT_EQ(json["meshes"][1]["shown"], false);
    EXPECT_EQ(json["meshes"][1]["command"], "other");
    EXPECT_TRUE(json["meshes"][1]["distance"].is_object());
    // Of the other one, where that is chosen.
    shown.edit.chosen = 1;
    const auto other = nlohmann::json::parse(reportText(report));
    EXPECT_EQ(other["touch"], 0);
    EXPECT_EQ(other["command"], "other");
    EXPECT_TRUE(other["distance"].is_object());
}

} // namespace voxtact::test
