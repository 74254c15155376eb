// SPDX-License-Identifier: MIT
#include "core/method/method_table.h"
#include "viewer/panels/panels.h"

#include <algorithm>

namespace voxtact::view {

namespace {

void drawSaid(const State& state, const ComparedMethod& compared) {
    const MeshAnswer* answer = compared.answer ? compared.answer->of(state.document.edit.instrument().mesh) : nullptr;
    if (answer == nullptr) {
        ImGui::TableNextColumn();
        ImGui::TextColored(quietColour(), "%s", compared.refused.empty() ? "..." : "refused");
        if (!compared.refused.empty() && ImGui::IsItemHovered()) {
            ImGui::SetTooltip("%s", compared.refused.c_str());
        }
        ImGui::TableNextColumn();
        ImGui::TableNextColumn();
        ImGui::TableNextColumn();
        return;
    }
    ImGui::TableNextColumn();
    ImGui::TextColored(verdictColour(hitNumber(answer->pair)), "%s", verdict(answer->pair));
    ImGui::TableNextColumn();
    ImGui::Text("%s%llu", answer->pair.exactness == Exactness::Exact ? "" : ">= ",
                static_cast<unsigned long long>(answer->pair.count));
    ImGui::TableNextColumn();
    ImGui::Text("%d", static_cast<int>(answer->triangles.size()));
    ImGui::TableNextColumn();
    ImGui::Text("%.2f", compared.answer->milliseconds);
}

/// Returns true if clicked.
bool drawRow(const State& state, const ComparedMethod& compared) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const bool clicked = ImGui::Selectable(toString(compared.method.projection), compared.method == state.method,
                                           ImGuiSelectableFlags_SpanAllColumns);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(toString(compared.method.count));
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(toString(defaultFilter(compared.method.count)));
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(rowOf(compared.method.count).host ? "host" : "device");
    drawSaid(state, compared);
    return clicked;
}

} // namespace

void drawComparison(State& state) {
    if (!state.comparing) {
        return;
    }
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({em, 3 * em}, ImGuiCond_Appearing);
    const ImVec2 all = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowSize({std::min(em * 44, all.x - 2 * em), std::min(em * 22, all.y - 4 * em)},
                             ImGuiCond_Appearing);
    if (ImGui::Begin("Counts of all methods", &state.comparing, ImGuiWindowFlags_NoCollapse)) {
        const bool current = state.comparison.isOf(state.document.edit);
        ImGui::TextColored(quietColour(), "%s",
                           current && state.comparison.complete()
                               ? "for the chosen mesh; click a method to answer by it"
                               : "counting ...");
        const ImGuiTableFlags flags =
            ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp;
        if (ImGui::BeginTable("methods", 8, flags)) {
            ImGui::TableSetupScrollFreeze(0, 1);
            for (const char* column : {"projection", "method", "filter", "by", "touches", "count", "triangles", "ms"}) {
                ImGui::TableSetupColumn(column);
            }
            ImGui::TableHeadersRow();
            ImGui::PushStyleVar(ImGuiStyleVar_Alpha, ImGui::GetStyle().Alpha * (current ? 1.0F : 0.5F));
            int number = 0;
            for (const ComparedMethod& compared : state.comparison.methods()) {
                ImGui::PushID(number++);
                if (drawRow(state, compared)) {
                    state.method = compared.method;
                }
                ImGui::PopID();
            }
            ImGui::PopStyleVar();
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

} // namespace voxtact::view
