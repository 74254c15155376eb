// SPDX-License-Identifier: MIT
#include "shown_panels.h"

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <string>
#include <string_view>
#include <vector>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

/// A part of the window; null where it is not shown.
const ImGuiWindow* partNamed(std::string_view name) {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        const std::string_view whole = window->Name;
        const std::size_t from = whole.find("/" + std::string(name) + "_"); // the parts of a part come behind it
        if (window->WasActive && from != std::string_view::npos &&
            whole.find('/', from + 1) == std::string_view::npos) {
            return window;
        }
    }
    return nullptr;
}

/// All that takes room: long names, notes, labels, several meshes, a list of poses, a point and a part of the curve.
State fullState() {
    State state = smallState();
    for (const std::size_t mesh : {1U, 2U}) {
        state.document.sources.meshes.push_back({std::string(60, 'm') + ".stl"});
        state.meshes.push_back(state.meshes.front());
        state.document.edit.instruments.push_back({mesh, identity(), true});
    }
    state.document.poses.assign(1000, identity());
    state.labels = Labels{{}, {{1, std::string(60, 'l')}}};
    state.answer = LiveAnswer{};
    state.answer->meshes.resize(3);
    for (std::size_t mesh = 0; mesh < 3; ++mesh) {
        MeshAnswer& answer = state.answer->meshes[mesh];
        answer.instrument.mesh = mesh;
        answer.pair.count = 123456789;
        answer.triangles.assign(123456, 0);
        answer.labels = {{0, 1, 123456}};
        answer.contacts.assign(2000, Contact{});
        answer.contactsFound = 123456789;
    }
    state.answer->milliseconds = 123456.78;
    state.times.add(123456.78);
    state.answeredBy = "a device with a long name (and what it says of itself)";
    state.deviceName = state.answeredBy;
    state.status = std::string(100, 's');
    state.curvePoint = 1;
    state.zoomedRange = {10, 60};
    state.notesOf = [](const State&) {
        return std::vector<std::string>{std::string(30, 'n') + " " + std::string(30, 'o')};
    };
    return state;
}

/// Down or up to the end.
void scrollColumn(ShownPanels& panels, float notches) {
    const ImGuiWindow* column = partNamed("right");
    for (int i = 0; i < 5; ++i) { // what comes into sight may be higher than it was taken for
        panels.turnWheel(static_cast<double>(column->Pos.x) + 2, static_cast<double>(column->Pos.y) + 2, notches);
    }
    panels.frame();
}

/// Nothing in it is cut, or overlaps what comes below.
void expectWhole(const char* name, const std::string& where) {
    const ImGuiWindow* card = partNamed(name);
    ASSERT_NE(card, nullptr) << where;
    EXPECT_LE(card->ContentSize.x, card->WorkRect.GetWidth()) << name << where;
    const bool scrolls = (card->Flags & ImGuiWindowFlags_NoScrollbar) == 0;
    EXPECT_TRUE(scrolls || card->ScrollMax.y == 0) << name << where;
}

} // namespace

TEST(ViewLayout, NothingIsCutInTheColumnHoweverSmallTheWindowIs) {
    for (const Extent& points : {kLeastWindow, Extent{800, 600}, Extent{1280, 800}}) {
        for (const float scale : {1.0F, 2.0F}) {
            const std::string where = " " + std::to_string(points.width) + " x " + std::to_string(scale);
            State state = fullState();
            ShownPanels panels(state, scale, points);
            expectWhole("answer", where);
            expectWhole("curve", where);
            scrollColumn(panels, -100);
            expectWhole("instrument", where);
            expectWhole("contacts", where);
            const ImGuiWindow* contacts = partNamed("contacts");
            EXPECT_GT(contacts->Size.y, 6 * ImGui::GetFontSize()) << where;
            EXPECT_LE(contacts->Rect().Max.y, partNamed("right")->Rect().Max.y) << where;
        }
    }
}

TEST(ViewLayout, TheColumnOfALowWindowIsScrolledByTheWheel) {
    State state = fullState();
    ShownPanels panels(state, 1, kLeastWindow);
    const ImGuiWindow* column = partNamed("right");
    ASSERT_GT(column->ScrollMax.y, 0);
    scrollColumn(panels, -100);
    EXPECT_EQ(column->Scroll.y, column->ScrollMax.y);
}

TEST(ViewLayout, WindowsOverThePanelsAreAllInTheWindow) {
    for (const Extent& points : {kLeastWindow, Extent{1280, 800}}) {
        State state = fullState();
        state.helpOpen = state.comparing = true;
        state.loading = Loading{};
        state.loading->step = "reading";
        ShownPanels panels(state, 1, points);
        panels.frame();
        for (const char* name : {"Keys and mouse", "Counts of all methods", "loading"}) {
            const ImGuiWindow* window = ImGui::FindWindowByName(name);
            ASSERT_TRUE(window != nullptr && window->WasActive) << name;
            EXPECT_TRUE(ImRect({0, 0}, ImGui::GetIO().DisplaySize).Contains(window->Rect())) << name << points.width;
            EXPECT_LE(window->ContentSize.x, window->WorkRect.GetWidth()) << name << points.width;
        }
    }
}

TEST(ViewLayout, OfSeveralTextsTheFirstIsTakenThatHasRoom) {
    State state = smallState();
    const ShownPanels panels(state);
    ImGui::NewFrame();
    const float width = ImGui::CalcTextSize("axial -10.5").x;
    EXPECT_EQ(fitting({"axial -10.5 mm", "axial -10.5", "-10.5"}, 2 * width), "axial -10.5 mm");
    EXPECT_EQ(fitting({"axial -10.5 mm", "axial -10.5", "-10.5"}, width), "axial -10.5");
    EXPECT_EQ(fitting({"axial -10.5 mm", "axial -10.5", "-10.5"}, 1), "-10.5");
    ImGui::EndFrame();
}

} // namespace voxtact::test
