// SPDX-License-Identifier: MIT
#include "viewer/panels/panels.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace voxtact::view {

namespace {

constexpr int kMostRows = 4; // more are scrolled

std::string nameOf(const MeshSource& source) {
    const std::string name = std::filesystem::path(source.path).filename().string();
    return name.empty() ? source.path : name;
}

/// Distance, or contact area.
std::string nearness(const MeshMeasures& measured) {
    const auto& [lo, hi] = measured.pair.bounds;
    if (std::isinf(lo)) {
        return "-";
    }
    if (hi == 0 && measured.area && measured.area->bounds.lower > 0) {
        return lowerText(measured.area->bounds.lower) + " mm\u00b2";
    }
    return (std::isinf(hi) ? "> " : "") + lowerText(lo) + " mm";
}

/// Draws verdict, count and distance, pale for an earlier question.
void drawSaid(const State& state, std::size_t mesh) {
    const MeshAnswer* answer = state.answer ? state.answer->of(mesh) : nullptr;
    ImGui::TableNextColumn();
    if (answer != nullptr) {
        ImVec4 colour = verdictColour(hitNumber(answer->pair));
        colour.w = state.answer->revision == state.revision ? 1.0F : 0.5F;
        ImGui::TextColored(colour, "%s", verdict(answer->pair));
    }
    ImGui::TableNextColumn();
    if (answer != nullptr) {
        const char* exact = answer->pair.exactness == Exactness::Exact ? "" : ">= ";
        ImGui::Text("%s%llu", exact, static_cast<unsigned long long>(answer->pair.count));
    }
    ImGui::TableNextColumn();
    if (const MeshMeasures* measured = state.distances ? state.distances->of(mesh) : nullptr) {
        const bool current = state.distances->revision == state.revision;
        const ImVec4 colour = current ? ImGui::GetStyle().Colors[ImGuiCol_Text] : quietColour();
        ImGui::TextColored(colour, "%s", nearness(*measured).c_str());
    }
}

/// Pending changes of the list.
struct Wish {
    std::optional<std::size_t> choose;
    std::optional<std::size_t> show;
    std::optional<std::size_t> remove;
};

void drawRow(const State& state, std::size_t number, Wish& wish) {
    const Edit& edit = state.document.edit;
    const Instrument& instrument = edit.instruments[number];
    const MeshSource& source = state.document.sources.meshes[instrument.mesh];
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    bool shown = instrument.shown;
    if (ImGui::Checkbox("##shown", &shown)) {
        wish.show = number;
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("show in picture and slices; hidden meshes are still answered");
    }
    ImGui::TableNextColumn();
    ImGui::ColorButton("##colour", instrumentColour(instrument.mesh), ImGuiColorEditFlags_NoTooltip,
                       {ImGui::GetFontSize() * 0.7F, ImGui::GetFontSize() * 0.7F});
    ImGui::SameLine();
    if (ImGui::Selectable(nameOf(source).c_str(), number == edit.chosen)) {
        wish.choose = number;
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", source.path.c_str());
    }
    drawSaid(state, instrument.mesh);
    ImGui::TableNextColumn();
    if (ImGui::SmallButton("x")) {
        wish.remove = number;
    }
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("remove; undo brings it back");
    }
}

void fulfil(State& state, const Wish& wish) {
    if (wish.choose) {
        state.choose(*wish.choose);
    }
    if (wish.show) {
        state.command([&wish](Edit& edit) { edit.instruments[*wish.show].shown ^= true; });
    }
    if (wish.remove) {
        state.remove(*wish.remove);
    }
}

} // namespace

void drawMeshes(State& state) {
    const std::size_t count = state.document.edit.instruments.size();
    if (count == 1 && state.document.edit.instrument().shown) {
        return;
    }
    const float row = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y;
    const ImGuiTableFlags flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg |
                                  (count > kMostRows ? ImGuiTableFlags_ScrollY : ImGuiTableFlags_None);
    if (!ImGui::BeginTable("meshes", 6, flags, {0, count > kMostRows ? row * kMostRows : 0})) {
        return;
    }
    for (const char* column : {"shown", "name", "verdict", "count", "distance", "remove"}) {
        const bool name = column == std::string_view("name");
        ImGui::TableSetupColumn(column, name ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed);
    }
    Wish wish;
    // Scrolls to a newly chosen mesh once.
    const std::size_t chosen = state.document.edit.instrument().mesh;
    const bool scrolls = std::exchange(state.listedMesh, chosen) != chosen;
    for (std::size_t number = 0; number < count; ++number) {
        ImGui::PushID(static_cast<int>(number));
        drawRow(state, number, wish);
        ImGui::PopID();
        if (scrolls && number == state.document.edit.chosen) {
            ImGui::ScrollToItem(ImGuiScrollFlags_KeepVisibleEdgeY);
        }
    }
    ImGui::EndTable();
    fulfil(state, wish);
}

} // namespace voxtact::view
