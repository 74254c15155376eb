// SPDX-License-Identifier: MIT
#include "shown_panels.h"
#include "viewer/model/answers/comparison.h"
#include "viewer/model/answers/report.h"
#include "viewer/panels/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <thread>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

constexpr MethodChoice kHost{CountingMethod::Cpu, Projection::Certified};
constexpr MethodChoice kQuery{CountingMethod::Query, Projection::View};
constexpr std::array kMethods{kHost, kQuery};

LiveAnswer answerTo(const LiveQuestion& question, std::uint64_t count) {
    LiveAnswer out;
    out.revision = question.revision;
    out.milliseconds = 2;
    out.meshes.resize(1);
    out.meshes[0].pair.count = count;
    out.meshes[0].pair.hit = count > 0;
    out.meshes[0].pair.exactness = Exactness::Exact;
    out.meshes[0].triangles = {1, 4};
    return out;
}

const Error kRefused{ErrorCode::Unsupported, 0, "no room"};

} // namespace

TEST(ViewComparison, AsksOneAfterTheOther) {
    Comparison comparison;
    EXPECT_FALSE(comparison.isOf({}));
    EXPECT_FALSE(comparison.next());
    comparison.begin({}, kMethods);
    EXPECT_TRUE(comparison.isOf({}));
    EXPECT_FALSE(comparison.complete());
    const auto first = comparison.next();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->method, kHost);
    EXPECT_FALSE(comparison.next()) << "the first is waited for";
    comparison.take(answerTo(*first, 7));
    const auto second = comparison.next();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->method, kQuery);
    EXPECT_FALSE(comparison.complete());
    comparison.take(kRefused);
    EXPECT_FALSE(comparison.next());
    EXPECT_TRUE(comparison.complete());
    EXPECT_EQ(comparison.methods()[0].answer->meshes[0].pair.count, 7U);
    EXPECT_FALSE(comparison.methods()[1].answer);
    EXPECT_EQ(comparison.methods()[1].refused, "no room");
}

TEST(ViewComparison, WhatIsCancelledIsAskedForAgain) {
    Comparison comparison;
    comparison.begin({}, kMethods);
    ASSERT_TRUE(comparison.next());
    comparison.take(Error{ErrorCode::Cancelled, 0, "a newer question"});
    const auto again = comparison.next();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->method, kHost);
}

TEST(ViewComparison, AnswersToTheEditBeforeAreNoneAnyMore) {
    Comparison comparison;
    comparison.begin({}, kMethods);
    const auto before = comparison.next();
    Edit moved;
    moved.threshold = 0.5;
    EXPECT_FALSE(comparison.isOf(moved));
    comparison.begin(moved, kMethods);
    EXPECT_TRUE(comparison.isOf(moved));
    EXPECT_FALSE(comparison.next()) << "whoever was asked is busy until then";
    comparison.take(answerTo(*before, 7));
    EXPECT_EQ(comparison.answered(), 0U);
    const auto after = comparison.next();
    ASSERT_TRUE(after);
    EXPECT_EQ(after->edit.threshold, 0.5);
    EXPECT_NE(after->revision, before->revision);
}

TEST(ViewComparison, IsReportedWhileItIsShown) {
    Comparison comparison;
    const Times times;
    const Document document;
    StateReport report;
    report.times = &times;
    report.frameTimes = &times;
    report.document = &document;
    const auto methods = [&report] { return nlohmann::json::parse(reportText(report))["methods"]; };
    EXPECT_TRUE(methods().is_null());
    report.comparison = &comparison;
    EXPECT_EQ(methods(), nlohmann::json::array());
    comparison.begin(document.edit, kMethods);
    comparison.take(answerTo(*comparison.next(), 7));
    const nlohmann::json json = methods();
    ASSERT_EQ(json.size(), 2U);
    EXPECT_EQ(json[0]["method"], "cpu");
    EXPECT_EQ(json[0]["projection"], "certified");
    EXPECT_EQ(json[0]["touch"], 1);
    EXPECT_EQ(json[0]["count"], 7);
    EXPECT_EQ(json[0]["triangles"], 2);
    EXPECT_TRUE(json[1]["touch"].is_null());
}

TEST(ViewComparison, BeginsWhenNothingMovesAndAClickChoosesAMethod) {
    State state = smallState();
    ShownPanels shown(state);
    state.methods.assign(kMethods.begin(), kMethods.end());
    state.keys.push_back({GLFW_KEY_K});
    shown.frame();
    EXPECT_TRUE(state.comparing);
    while (!state.atRest()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    shown.frame();
    ASSERT_TRUE(state.comparison.isOf(state.document.edit));
    EXPECT_TRUE(state.compares());
    state.comparison.take(answerTo(*state.comparison.next(), 7));
    ASSERT_TRUE(state.comparison.next());
    state.comparison.take(kRefused);
    EXPECT_FALSE(state.compares());
    // Moved, it is of another question until that rests.
    state.command([](Edit& edit) { edit.pose() = translation({1, 0, 0}); });
    shown.frame();
    EXPECT_FALSE(state.comparison.isOf(state.document.edit));
    shown.frame();
    ASSERT_EQ(state.comparison.methods().size(), 2U);
    // The second row of the table is the last that there is.
    const double em = ImGui::GetFontSize();
    for (double y = 6 * em; y < 14 * em; y += em / 2) {
        shown.click(5 * em, y);
    }
    EXPECT_EQ(state.method, kQuery);
    shown.frame();
    EXPECT_TRUE(state.comparing);
    state.keys.push_back({GLFW_KEY_K});
    shown.frame();
    EXPECT_FALSE(state.comparing);
}

} // namespace voxtact::test
