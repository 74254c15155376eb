// SPDX-License-Identifier: MIT
#include "viewer/panels/panels.h"

#include "viewer/model/answers/command_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace voxtact::view {

namespace {

std::string methodText(const MethodChoice& method) {
    return std::string(toString(method.projection)) + ", " + toString(method.count);
}

void drawMethods(State& state) {
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##method", methodText(state.method).c_str(), ImGuiComboFlags_HeightLarge)) {
        return;
    }
    for (const MethodChoice& choice : state.methods) {
        if (ImGui::Selectable(methodText(choice).c_str(), choice == state.method)) {
            state.method = choice;
        }
    }
    ImGui::EndCombo();
}

void drawTimes(const State& state) {
    const LiveAnswer& answer = *state.answer;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%.2f ms, by ", answer.milliseconds);
    shortLine(quietColour(), text.data() + state.answeredBy);
    std::snprintf(text.data(), text.size(), "last %d: p50 %.2f ms, p99 %.2f ms", static_cast<int>(state.times.count()),
                  state.times.percentile(0.5), state.times.percentile(0.99));
    shortLine(quietColour(), text.data());
}

/// Draws the verdicts of the last seconds as colours, and their times as bars on a logarithmic scale from 0.01 ms on.
void drawStrip(const State& state) {
    constexpr double kLeast = 0.01; // ms
    constexpr double kMost = 1000;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 1.2F};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const auto xOf = [&](double ago) { return corner.x + size.x * static_cast<float>(1 - ago / Strip::kSeconds); };
    for (const Strip::Piece& piece : state.strip.pieces(state.seconds())) {
        ImVec4 colour = verdictColour(piece.hit);
        constexpr float kBehind = 0.35F;
        colour.w = kBehind;
        const ImVec2 lower{std::max(xOf(piece.to), xOf(piece.from) + 1), corner.y + size.y};
        list.AddRectFilled({xOf(piece.from), corner.y}, lower, ImGui::GetColorU32(colour));
        colour.w = 1;
        const double share = std::log(std::max(piece.milliseconds, kLeast) / kLeast) / std::log(kMost / kLeast);
        const float height = size.y * static_cast<float>(std::min(share, 1.0));
        list.AddRectFilled({xOf(piece.from), lower.y - height}, lower, ImGui::GetColorU32(colour));
    }
    ImGui::Dummy(size);
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("answers of the last %.0f s and their times (0.01 ms to 1 s)", Strip::kSeconds);
    }
}

/// Touched structures, shortened to a line; complete in the tooltip.
void drawLabels(const State& state) {
    if (!state.labels) {
        return;
    }
    const auto text = [&state](const LabelCount& touched) {
        return labelText(*state.labels, touched.label) + ": " + std::to_string(touched.count);
    };
    std::string line;
    std::string all;
    for (const LabelCount& touched : state.chosenAnswer()->labels) {
        line += (line.empty() ? "" : "   ") + text(touched);
        all += (all.empty() ? "" : "\n") + text(touched);
    }
    line = line.empty() ? "no label touched" : shortened(line, ImGui::GetContentRegionAvail().x);
    ImGui::TextUnformatted(line.c_str());
    if (!all.empty() && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", all.c_str());
    }
}

void drawDistance(const State& state) {
    const MeshMeasures* measured = state.chosenDistance();
    if (measured == nullptr) {
        ImGui::TextColored(quietColour(), "measuring ...");
        return;
    }
    ImVec4 colour = ImGui::GetStyle().Colors[ImGuiCol_Text];
    colour.w = state.distances->revision == state.revision ? 1.0F : 0.5F;
    const std::string text = measuresText(*measured);
    ImGui::TextColored(colour, "%s", shortened(text, ImGui::GetContentRegionAvail().x).c_str());
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s\n"
                          "Certified bounds from the host engine, in %.1f ms for all meshes: the distance\n"
                          "from the mesh to the opaque region or, if it touches,\n"
                          "the opaque area of its surface.",
                          text.c_str(), state.distances->milliseconds);
    }
    if (const std::string overlap = overlapText(*measured); !overlap.empty()) {
        ImGui::TextColored(colour, "%s", shortened(overlap, ImGui::GetContentRegionAvail().x).c_str());
        if (ImGui::IsItemHovered()) {
            ImGui::SetTooltip(
                "%s\nCertified bounds of the opaque volume inside the closed mesh, and its share of the mesh.",
                overlap.c_str());
        }
    }
}

void drawNote(const std::string& note) {
    ImGui::PushStyleColor(ImGuiCol_Text, verdictColour(2));
    ImGui::TextWrapped("%s", note.c_str());
    ImGui::PopStyleColor();
}

} // namespace

void drawAnswer(State& state) {
    heading("Does it touch?");
    for (const std::string& note : state.notes) {
        drawNote(note);
    }
    for (const Offer& offer : state.offers) {
        drawNote(offer.text);
        if (ImGui::Button(offer.button.c_str())) {
            state.wanted = offer.wanted;
        }
    }
    if (state.chosenAnswer() == nullptr) {
        ImGui::TextColored(quietColour(), "waiting for the answer ...");
        drawMethods(state);
        return;
    }
    const MeshAnswer& answer = *state.chosenAnswer();
    const bool current = state.answer->revision == state.revision;
    ImVec4 colour = verdictColour(hitNumber(answer.pair));
    colour.w = current ? 1.0F : 0.5F;
    constexpr float kLarge = 1.7F;
    ImGui::SetWindowFontScale(kLarge);
    ImGui::TextColored(colour, "%s", verdict(answer.pair));
    ImGui::SetWindowFontScale(1);
    ImGui::SameLine();
    ImGui::BeginGroup();
    shortLine(ImGui::GetStyle().Colors[ImGuiCol_Text], countText(answer.pair));
    shortLine(quietColour(), trianglesText(answer));
    ImGui::EndGroup();
    drawDistance(state);
    drawLabels(state);
    drawMethods(state);
    drawTimes(state);
    drawStrip(state);
}

std::string commandOf(const State& state) {
    return copyAsCommand(state.document, state.method, state.deviceOption);
}

void copyCommand(State& state) {
    ImGui::SetClipboardText(commandOf(state).c_str());
    state.say(state.document.edit.holes == 0
                  ? "copied: voxtact count with the shown pose, curve and method"
                  : "copied: voxtact count with the shown settings, but without the holes, which are in no file");
}

void drawContacts(State& state) {
    const MeshAnswer* answer = state.chosenAnswer();
    const std::size_t shown = answer == nullptr ? 0 : answer->contacts.size();
    const std::uint64_t found = answer == nullptr ? 0 : answer->contactsFound;
    heading("Contacts");
    const float show = ImGui::GetContentRegionMax().x - widthOfCheckbox("show");
    ImGui::SameLine();
    const std::string all = std::to_string(found);
    const std::string listed = shown < found ? ", the deepest " + std::to_string(shown) + " listed" : "";
    const float room = show - ImGui::GetCursorPosX() - ImGui::GetStyle().ItemSpacing.x;
    ImGui::TextColored(quietColour(), "%s", fitting({all + listed, all}, room).c_str());
    ImGui::SameLine(show);
    ImGui::Checkbox("show", &state.showContacts);
    const ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchSame;
    if (!ImGui::BeginTable("contacts", 5, flags)) {
        return;
    }
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* column : {"depth", "x", "y", "z", "value"}) {
        ImGui::TableSetupColumn(column);
    }
    ImGui::TableHeadersRow();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(shown));
    while (clipper.Step()) {
        for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
            const Contact& contact = answer->contacts[static_cast<std::size_t>(row)];
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::PushID(row);
            const Grid& grid = state.volume.grid;
            if (ImGui::Selectable(mmText(grid, 2, contact.depth).c_str(), false, ImGuiSelectableFlags_SpanAllColumns)) {
                state.cursor = contact.position;
                state.camera.target = contact.position;
            }
            ImGui::PopID();
            for (const double place : contact.position) {
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(mmText(grid, 1, place).c_str());
            }
            ImGui::TableNextColumn();
            // No text exceeds its column.
            ImGui::Text(std::abs(contact.value) < 1e5 ? "%.1f" : "%.4g", contact.value);
        }
    }
    ImGui::EndTable();
}

} // namespace voxtact::view
