// SPDX-License-Identifier: MIT
#include "viewer/panels/panels.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

namespace voxtact::view {

/// At the lower edge, beside the contents; in the middle without contents.
void drawLoading(State& state) {
    if (!state.loading) {
        return;
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float line = ImGui::GetFontSize();
    // Beside the panels.
    const double middle = state.picture.corner[0] + state.picture.size[0] / 2;
    const ImVec2 at{state.blank ? size.x / 2 : static_cast<float>(middle),
                    state.blank ? size.y / 2 : size.y - 3 * line};
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, {0.5F, state.blank ? 0.5F : 1.0F});
    const auto room = static_cast<float>(state.blank ? static_cast<double>(size.x) : state.picture.size[0]);
    ImGui::SetNextWindowSize({std::min(line * 26, room), 0});
    ImGui::Begin("loading", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    const Loading& loading = *state.loading;
    ImGui::TextUnformatted(loading.step.empty() ? "waiting" : loading.step.c_str());
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1f s", loading.seconds);
    ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(seconds).x - scaled(12));
    ImGui::TextColored(quietColour(), "%s", seconds);
    const float button = ImGui::CalcTextSize("cancel").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float width = ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x;
    if (loading.share) {
        ImGui::ProgressBar(static_cast<float>(*loading.share), {width, 0});
    } else {
        // Moves back and forth while the total is unknown.
        const double turn = std::fmod(loading.seconds, 2.0);
        ImGui::PushStyleColor(ImGuiCol_Text, {0, 0, 0, 0});
        ImGui::ProgressBar(static_cast<float>(turn < 1 ? turn : 2 - turn), {width, 0});
        ImGui::PopStyleColor();
    }
    ImGui::SameLine();
    state.cancelLoading |= ImGui::Button("cancel");
    ImGui::End();
}

void drawSaving(State& state) {
    constexpr const char* kTitle = "Saving the picture";
    if (state.saving && !ImGui::IsPopupOpen(kTitle)) {
        ImGui::OpenPopup(kTitle);
    }
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 26, 0});
    if (ImGui::BeginPopupModal(kTitle, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        const Saving saving = state.saving.value_or(Saving{1, true});
        char text[32];
        std::snprintf(text, sizeof text, "%s: %.0f %%", saving.writing ? "writing" : "drawing", 100 * saving.share);
        const float button = ImGui::CalcTextSize("cancel").x + 2 * ImGui::GetStyle().FramePadding.x;
        ImGui::ProgressBar(static_cast<float>(saving.share),
                           {ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x, 0}, text);
        ImGui::SameLine();
        state.cancelSaving |= ImGui::Button("cancel");
        if (!state.saving) {
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
}

void drawQuestion(State& state) {
    if (!state.question) {
        return;
    }
    Question& question = *state.question;
    if (!ImGui::IsPopupOpen(question.title.c_str())) {
        ImGui::OpenPopup(question.title.c_str());
    }
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 36, 0});
    if (!ImGui::BeginPopupModal(question.title.c_str(), nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        return;
    }
    ImGui::TextWrapped("%s", question.text.c_str());
    const bool appearing = ImGui::IsWindowAppearing();
    for (MissingFile& file : question.files) {
        ImGui::TextColored(quietColour(), "%s", file.name.c_str());
        if (appearing && &file == question.files.data()) {
            ImGui::SetKeyboardFocusHere();
        }
        ImGui::SetNextItemWidth(-1);
        ImGui::InputText(("##" + file.name).c_str(), &file.path, ImGuiInputTextFlags_AutoSelectAll);
        if (ImGui::IsItemActive()) {
            state.field = file.path;
        }
    }
    ImGui::Spacing();
    for (std::size_t i = 0; i < question.buttons.size(); ++i) {
        if (i > 0) {
            ImGui::SameLine();
        }
        if (ImGui::Button(question.buttons[i].c_str())) {
            question.chosen = i;
        }
    }
    if (question.chosen) {
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

} // namespace voxtact::view
