// SPDX-License-Identifier: MIT
#include "shown_panels.h"

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <string>
#include <string_view>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

/// A part of the window; null where it is not shown.
const ImGuiWindow* activePart(const std::string& name) {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        const std::string_view whole = window->Name;
        const std::size_t from = whole.find("/" + name + "_");
        if (window->WasActive && from != std::string_view::npos &&
            whole.find('/', from + 1) == std::string_view::npos) {
            return window;
        }
    }
    return nullptr;
}

/// The part of the list that scrolls.
const ImGuiWindow* listOfMeshes() {
    return activePart("meshes");
}

} // namespace

TEST(ViewOffer, ItsButtonOpensTheOtherReading) {
    State state = smallState();
    state.offersOf = [](const State& of) {
        Document document = of.saved();
        document.sources.meshes[0].space = "ras";
        return std::vector<Offer>{
            {"far away", "--mesh-space ras", {FileKind::Session, std::move(document), "tool.stl"}}};
    };
    ShownPanels panels(state);
    panels.frame();
    EXPECT_NE(panels.shownText().find("far away"), std::string::npos);
    const ImGuiWindow* const column = activePart("right");
    ASSERT_NE(column, nullptr);
    for (float y = column->Pos.y; y < column->Pos.y + column->Size.y && !state.wanted; y += 8) {
        panels.click(static_cast<double>(column->Pos.x) + 30, static_cast<double>(y));
    }
    ASSERT_TRUE(state.wanted);
    EXPECT_EQ(state.wanted->document.sources.meshes[0].space, "ras");
    EXPECT_EQ(state.wanted->path, "tool.stl");
}

TEST(ViewMeshList, IsScrolledToTheMeshThatBecomesTheChosenOne) {
    State state = smallState();
    constexpr std::size_t kMeshes = 9;
    for (std::size_t mesh = 1; mesh < kMeshes; ++mesh) {
        state.document.sources.meshes.push_back(state.document.sources.meshes.front());
        state.meshes.push_back(state.meshes.front());
        state.document.edit.instruments.push_back({mesh, identity(), true});
    }
    ShownPanels panels(state);
    const auto scrolled = [&panels] {
        panels.frame();
        panels.frame(); // to where the frame before asked for
        return listOfMeshes()->Scroll.y;
    };
    ASSERT_NE(listOfMeshes(), nullptr);
    const float most = listOfMeshes()->ScrollMax.y;
    ASSERT_GT(most, 0);
    EXPECT_EQ(scrolled(), 0);
    state.choose(1); // in sight
    EXPECT_EQ(scrolled(), 0);
    state.choose(kMeshes - 1);
    EXPECT_EQ(scrolled(), most);
    state.choose(4);
    EXPECT_LT(scrolled(), most);
    EXPECT_GT(scrolled(), 0);
    // The choice stays, and so does what the wheel has scrolled.
    const ImRect list = listOfMeshes()->InnerRect;
    panels.turnWheel(static_cast<double>(list.GetCenter().x), static_cast<double>(list.GetCenter().y), 20);
    EXPECT_EQ(scrolled(), 0);
    // One that is opened is the chosen one.
    state.document.edit.chosen = kMeshes - 1;
    EXPECT_EQ(scrolled(), most);
}

} // namespace voxtact::test
