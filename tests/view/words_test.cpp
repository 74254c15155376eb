// SPDX-License-Identifier: MIT
#include "shown_panels.h"
#include "viewer/model/files/save_file.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace voxtact::test {

using namespace voxtact::view;

TEST(ViewWords, OneIsOne) {
    MeshAnswer answer;
    answer.pair.projection = Projection::Certified;
    answer.pair.exactness = Exactness::Exact;
    answer.pair.count = 1;
    answer.triangles = {3};
    EXPECT_EQ(countText(answer.pair), "1 certified cell");
    EXPECT_EQ(trianglesText(answer), "1 triangle");
    answer.pair.projection = Projection::View;
    answer.pair.exactness = Exactness::LowerBound;
    answer.pair.count = 2;
    answer.triangles = {3, 5};
    answer.contacts.resize(1);
    answer.contacts[0].depth = 1.25;
    EXPECT_EQ(countText(answer.pair), "at least 2 fragments");
    EXPECT_EQ(trianglesText(answer), "2 triangles, deepest 1.25 mm");
    answer.triangles.clear();
    answer.contacts.clear();
    EXPECT_EQ(trianglesText(answer), "0 triangles");
}

TEST(ViewWords, ALineThatIsTooLongIsCut) {
    State state = smallState();
    const ShownPanels panels(state);
    ImGui::NewFrame();
    EXPECT_EQ(shortened("the picture is in a.png", 1000), "the picture is in a.png");
    for (const float width : {40.0F, 100.0F, 300.0F}) {
        const std::string line = shortened("the picture is in /" + std::string(300, 'w') + ".png", width);
        EXPECT_TRUE(line.ends_with("...")) << line;
        EXPECT_LE(ImGui::CalcTextSize(line.c_str()).x, width);
        EXPECT_GT(ImGui::CalcTextSize(line.c_str()).x, width - 2 * ImGui::GetFontSize());
    }
    EXPECT_EQ(shortened("wide", 0), "...");
    ImGui::EndFrame();
}

TEST(ViewWords, TouchedLabelsAreALineWithDotsAndWholeUnderThePointer) {
    State state = smallState();
    state.labels =
        Labels{{}, {{1, "a name that is long"}, {2, "another long name"}, {3, "the last of the long names"}}};
    state.answer = LiveAnswer{};
    state.answer->meshes.resize(1);
    state.answer->meshes[0].labels = {{0, 1, 300}, {0, 2, 200}, {0, 3, 100}};
    ShownPanels panels(state);
    const std::string shown = panels.shownText();
    EXPECT_NE(shown.find("1 a name that is long: 300"), std::string::npos) << shown;
    EXPECT_NE(shown.find("...\n", shown.find("2 another")), std::string::npos) << shown;
    EXPECT_EQ(shown.find("3 the last of the long names: 100"), std::string::npos) << shown;
    // Somewhere in the card is the line.
    bool isWhole = false;
    for (double y = 30; y < 250 && !isWhole; y += 5) {
        panels.moveTo(1000, y);
        isWhole = panels.shownText().find("3 the last of the long names: 100") != std::string::npos;
    }
    EXPECT_TRUE(isWhole);
}

TEST(ViewDialogs, EscapeClosesThoseThatAskForAPath) {
    State state = smallState();
    ShownPanels panels(state);
    const auto press = [&](int key, bool control) {
        state.keys.push_back({key, false, control});
        for (int frame = 0; frame < 3; ++frame) {
            panels.frame();
        }
        return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    };
    for (const int key : std::array{GLFW_KEY_S, GLFW_KEY_P, GLFW_KEY_O}) {
        EXPECT_TRUE(press(key, true)) << key;
        EXPECT_FALSE(press(GLFW_KEY_ESCAPE, false)) << key;
        EXPECT_FALSE(state.quit);
        EXPECT_FALSE(state.shot);
        EXPECT_TRUE(state.error.empty()) << state.error;
    }
}

TEST(ViewDialogs, WhatCannotBeWrittenIsNotAskedAbout) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("dialog" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    const std::filesystem::path other = folder / "notes.md";
    std::ofstream(other) << "keep me";
    State state = smallState();
    ShownPanels panels(state);
    for (const int key : std::array{GLFW_KEY_S, GLFW_KEY_P}) {
        state.keys.push_back({key, false, true});
        panels.frame();
        panels.frame();
        panels.type(other.string());
        EXPECT_EQ(state.field, other.string());
        panels.tap(GLFW_KEY_ENTER);
        EXPECT_FALSE(state.error.empty()) << key;
        EXPECT_FALSE(state.field) << key;
        panels.tap(GLFW_KEY_ENTER);
        EXPECT_TRUE(state.error.empty()) << state.error;
    }
    // One of the same kind is asked about.
    const std::filesystem::path session = folder / "session.json";
    ASSERT_TRUE(saveSession(session, state).ok());
    state.keys.push_back({GLFW_KEY_S, false, true});
    panels.frame();
    panels.frame();
    panels.type(session.string());
    panels.tap(GLFW_KEY_ENTER);
    panels.frame(); // its field has the keyboard again
    EXPECT_EQ(state.field, session.string());
    EXPECT_TRUE(state.error.empty()) << state.error;
    panels.tap(GLFW_KEY_ESCAPE);
    std::filesystem::remove_all(folder);
}

TEST(ViewDialogs, EscapeClosesMenusAndListsAndNothingElse) {
    State state = smallState();
    ShownPanels panels(state);
    const auto isOpen = [] {
        return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    };
    const Point2 menu{20, 10};
    const Point2 presets{state.chart.corner[0] + state.chart.size[0] - 90, state.chart.corner[1] - 15};
    for (const Point2& place : {menu, presets}) {
        state.maximised = Maximised::Picture;
        panels.click(place[0], place[1]);
        panels.frame();
        ASSERT_TRUE(isOpen()) << place[0];
        state.keys.push_back({GLFW_KEY_ESCAPE});
        panels.frame();
        panels.frame();
        EXPECT_FALSE(isOpen()) << place[0];
        EXPECT_EQ(state.maximised, Maximised::Picture);
        // The next one is the window's again.
        state.keys.push_back({GLFW_KEY_ESCAPE});
        panels.frame();
        EXPECT_EQ(state.maximised, Maximised::None);
    }
}

} // namespace voxtact::test
