// SPDX-License-Identifier: MIT
#include "viewer/model/files/open_file.h"
#include "viewer/panels/panels.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxtact::view {

namespace {

void drawMenu(State& state) {
    if (!ImGui::BeginMenuBar()) {
        return;
    }
    if (ImGui::BeginMenu("File")) {
        drawFileMenu(state);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Edit", !state.blank)) {
        if (ImGui::MenuItem("Undo", "Ctrl+Z", false, state.history.canUndo())) {
            state.undo();
        }
        if (ImGui::MenuItem("Redo", "Ctrl+Y", false, state.history.canRedo())) {
            state.redo();
        }
        ImGui::Separator();
        if (ImGui::MenuItem("Copy as command", "Ctrl+C")) {
            copyCommand(state);
        }
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("View", !state.blank)) {
        for (const char* name : {"front", "back", "left", "right", "top", "bottom"}) {
            if (ImGui::MenuItem(name)) {
                state.camera.direction = directionNamed(name).value_or(state.camera.direction);
            }
        }
        if (ImGui::MenuItem("Frame the volume", "F")) {
            state.camera = framing(state.volume.grid, state.camera.direction);
        }
        ImGui::MenuItem("Handles at the tip", "H", &state.showGizmo);
        if (ImGui::MenuItem("Handles along other axes", "T")) {
            state.gizmoAxes = nextOf(state.gizmoAxes);
        }
        ImGui::MenuItem("Counts of all methods", "K", &state.comparing);
        ImGui::Separator();
        if (ImGui::MenuItem("Dark", nullptr, state.theme == Theme::Dark)) {
            state.theme = Theme::Dark;
        }
        if (ImGui::MenuItem("Light", nullptr, state.theme == Theme::Light)) {
            state.theme = Theme::Light;
        }
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Help")) {
        if (ImGui::MenuItem("Keys and mouse", "F1")) {
            state.helpOpen = true;
        }
        ImGui::EndMenu();
    }
    const Sources& sources = state.document.sources;
    const std::string coarser = sources.coarser == 1 ? "" : " (coarser by " + std::to_string(sources.coarser) + ")";
    std::string names = sources.volume + coarser;
    for (const Instrument& instrument : state.document.edit.instruments) {
        names += state.blank ? "" : "   " + sources.meshes[instrument.mesh].path;
    }
    const float edge = scaled(14);
    const float room = ImGui::GetWindowWidth() - ImGui::GetCursorPosX() - 2 * edge;
    const std::string shown = shortened(names, room);
    ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(shown.c_str()).x - edge);
    ImGui::TextColored(quietColour(), "%s", shown.c_str());
    if (shown != names && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", names.c_str());
    }
    ImGui::EndMenuBar();
}

/// A child without a frame of its own for a picture, to its edges.
template <class Draw> void pane(const char* name, const ImVec2& size, Draw&& draw) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::BeginChild(name, size, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    draw();
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

void drawPanes(State& state, const ImVec2& size) {
    if (state.maximised == Maximised::Picture) {
        pane("picture", size, [&] { drawPicture(state); });
        return;
    }
    if (state.maximised != Maximised::None) {
        const auto slice = static_cast<std::size_t>(state.maximised) - static_cast<std::size_t>(Maximised::Slice0);
        pane("slice", size, [&] { drawSlice(state, slice); });
        return;
    }
    const float gap = ImGui::GetStyle().ItemSpacing.y;
    const float lower = std::floor(std::min(size.y * 0.36F, size.x / 3));
    pane("picture", {size.x, size.y - lower - gap}, [&] { drawPicture(state); });
    const float width = std::floor((size.x - 2 * gap) / 3);
    for (std::size_t slice = 0; slice < kSlices.size(); ++slice) {
        if (slice > 0) {
            ImGui::SameLine(0, gap);
        }
        pane(kSlices[slice].name, {width, lower}, [&] { drawSlice(state, slice); });
    }
}

/// A bordered child that scrolls, or grows with its contents. `whole`: height with all contents, known after the first
/// display.
template <class Draw> void card(const char* name, float height, float& whole, Draw&& draw) {
    const ImGuiStyle& style = ImGui::GetStyle();
    // A growing child gets its height a frame later: until then it is cut, and its contents keep their width.
    const ImGuiWindowFlags fixed = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    const bool inSight =
        ImGui::BeginChild(name, {0, height}, false,
                          ImGuiWindowFlags_AlwaysUseWindowPadding | (height < whole ? ImGuiWindowFlags_None : fixed));
    draw();
    if (inSight) {
        const ImGuiWindow& window = *ImGui::GetCurrentWindow();
        whole = std::ceil(window.DC.CursorMaxPos.y - window.Pos.y + window.Scroll.y + style.WindowPadding.y);
    }
    ImGui::EndChild();
}

/// Heights of the cards with all contents, from the previous frame; estimates before the first one.
struct Heights {
    float answer = ImGui::GetFontSize() * 12;
    float curve = ImGui::GetFontSize() * 14;
    float instrument = ImGui::GetFontSize() * 18;
};

Heights& heights() {
    static Heights all;
    return all;
}

void drawColumn(State& state) {
    Heights& whole = heights();
    const ImGuiStyle& style = ImGui::GetStyle();
    constexpr float kLeastRows = 4.4F;  // of the instrument
    constexpr float kLeastContacts = 6; // lines, with heading and names
    const float row = ImGui::GetFrameHeight() + style.ItemSpacing.y;
    const float least = std::min(kLeastRows * row + 2 * style.WindowPadding.y, whole.instrument);
    const float contacts = kLeastContacts * ImGui::GetTextLineHeightWithSpacing() + 2 * style.WindowPadding.y;
    const float rest =
        ImGui::GetContentRegionAvail().y - whole.answer - whole.curve - contacts - 3 * style.ItemSpacing.y;
    // In a low window the instrument's rows scroll, so that some contacts are visible; in a lower one the column
    // scrolls, and all cards are complete.
    const bool isLow = rest < least;
    const float instrument = isLow ? whole.instrument : std::min(rest, whole.instrument);
    card("answer", whole.answer, whole.answer, [&] { drawAnswer(state); });
    card("curve", whole.curve, whole.curve, [&] { drawCurve(state); });
    card("instrument", instrument, whole.instrument, [&] { drawInstrument(state); });
    float last = 0; // the remaining height
    card("contacts", isLow ? contacts : 0, last, [&] { drawContacts(state); });
}

void drawStatus(const State& state) {
    char frames[64];
    const char* fine = state.fineShare >= 1 ? "fine" : "coarse";
    std::snprintf(frames, sizeof frames, "%s   %.0f ms per frame", fine, state.frameTimes.percentile(0.5));
    const std::string device = frames + ("   " + state.deviceName);
    const std::string text = shortened(device, ImGui::GetWindowWidth() / 2);
    const float right = ImGui::GetWindowWidth() - ImGui::CalcTextSize(text.c_str()).x - scaled(12);
    const std::string status = state.status.empty() ? "F1: keys" : state.status;
    const std::string said = shortened(status, right - ImGui::GetCursorPosX() - 2 * ImGui::GetFontSize());
    ImGui::TextColored(quietColour(), "%s", said.c_str());
    if (said != status && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", status.c_str());
    }
    ImGui::SameLine(right);
    ImGui::TextColored(quietColour(), "%s", text.c_str());
    if (text != device && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", device.c_str());
    }
}

/// All below the menu.
void drawScene(State& state) {
    const ImVec2 all = ImGui::GetContentRegionAvail();
    const float gap = ImGui::GetStyle().ItemSpacing.y;
    const float height = all.y - ImGui::GetTextLineHeightWithSpacing();
    const float column = std::min(ImGui::GetFontSize() * 25, all.x / 2);
    ImGui::BeginChild("left", {all.x - column - gap, height}, false, ImGuiWindowFlags_NoBackground);
    drawPanes(state, ImGui::GetContentRegionAvail());
    ImGui::EndChild();
    ImGui::SameLine(0, gap);
    ImGui::BeginChild("right", {0, height}, false, ImGuiWindowFlags_NoBackground);
    drawColumn(state);
    ImGui::EndChild();
    drawStatus(state);
}

} // namespace

void drawPanels(State& state) {
    if (std::exchange(state.themeSet, state.theme) != state.theme) {
        setColours(state.theme);
    }
    takeKeys(state);
    takeDropped(state);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("voxtact", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_MenuBar |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    drawMenu(state);
    if (!state.blank) {
        drawScene(state);
    }
    drawDialogs(state);
    ImGui::End();
    drawLoading(state);
    if (!state.blank) {
        drawComparison(state);
    }
    drawHelp(state);
    state.itemHeld = ImGui::IsAnyItemActive();
}

} // namespace voxtact::view
