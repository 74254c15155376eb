// SPDX-License-Identifier: MIT
#include "view/model/session_file.h"
#include "view/panels/panels.h"

#include "view/model/command_text.h"
#include "voxtact/io.h"

#include <imgui_stdlib.h>

#include <array>
#include <ostream>

namespace voxtact::view {

namespace {

Result<void> savePose(const std::filesystem::path& path, const State& state) {
    return io::writeFile(path, [&state](std::ostream& out) -> Result<void> {
        out << poseText(state.document.edit.world_from_object) << "\n";
        return {};
    });
}

Result<void> loadFunction(const std::filesystem::path& path, State& state) {
    Result<std::vector<ControlPoint>> points = io::readTransferFunction(path);
    if (!points.ok()) {
        return points.error();
    }
    Result<std::vector<ColourPoint>> colours = io::readColours(path);
    if (!colours.ok()) {
        return colours.error();
    }
    if (!colours->empty()) {
        state.document.colours = *colours;
    }
    state.command([&](Edit& edit) { edit.curve = *points; });
    state.curvePoint.reset();
    return {};
}

Result<void> loadPoses(const std::filesystem::path& path, State& state) {
    Result<std::vector<Mat4>> poses = io::readPoses(path);
    if (!poses.ok()) {
        return poses.error();
    }
    state.document.poses = std::move(*poses);
    state.takePose(0);
    state.history.end();
    return {};
}

/// A dialog that asks for one path.
struct PathDialog {
    const char* title;
    const char* button;
    std::string path;
    Result<void> (*act)(const std::filesystem::path& path, State& state);
};

std::array<PathDialog, 6>& dialogs() {
    static std::array<PathDialog, 6> all{{
        {"Save session", "save", "session.json",
         [](const std::filesystem::path& path, State& state) -> Result<void> {
             if (const Result<void> written = writeSession(path, state.saved()); !written.ok()) {
                 return written.error();
             }
             state.say("the session is in " + path.string() +
                       (state.document.edit.holes == 0 ? "" : ", without the holes that were drilled"));
             return {};
         }},
        {"Save transfer function", "save", "curve.json",
         [](const std::filesystem::path& path, State& state) { return writeTransferFunction(path, state.document); }},
        {"Save pose", "save", "pose.txt",
         [](const std::filesystem::path& path, State& state) { return savePose(path, state); }},
        {"Save picture", "save", "picture.png",
         [](const std::filesystem::path& path, State& state) -> Result<void> {
             state.screenshot = path.string();
             return {};
         }},
        {"Open transfer function", "open", "", loadFunction},
        {"Open poses", "open", "", loadPoses},
    }};
    return all;
}

void drawPathDialog(PathDialog& dialog, State& state) {
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 30, 0});
    if (!ImGui::BeginPopupModal(dialog.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        return;
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::IsWindowAppearing()) {
        ImGui::SetKeyboardFocusHere();
    }
    bool done = ImGui::InputText("##path", &dialog.path, ImGuiInputTextFlags_EnterReturnsTrue);
    done |= ImGui::Button(dialog.button);
    ImGui::SameLine();
    if (ImGui::Button("cancel")) {
        ImGui::CloseCurrentPopup();
    } else if (done && !dialog.path.empty()) {
        ImGui::CloseCurrentPopup();
        state.say(std::string(dialog.title) + ": " + dialog.path);
        if (const Result<void> acted = dialog.act(dialog.path, state); !acted.ok()) {
            state.complain(acted.error().text);
        }
    }
    ImGui::EndPopup();
}

const char*& asked() {
    static const char* title = nullptr;
    return title;
}

} // namespace

void drawFileMenu(State& state) {
    for (const PathDialog& dialog : dialogs()) {
        if (ImGui::MenuItem((std::string(dialog.title) + " ...").c_str())) {
            asked() = dialog.title; // opened outside of the menu, which has an ID of its own
        }
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) {
        state.quit = true;
    }
}

void drawDialogs(State& state) {
    if (asked() != nullptr) {
        ImGui::OpenPopup(asked());
        asked() = nullptr;
    }
    for (PathDialog& dialog : dialogs()) {
        drawPathDialog(dialog, state);
    }
    if (!state.error.empty() && !ImGui::IsPopupOpen("That did not work")) {
        ImGui::OpenPopup("That did not work");
    }
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 34, 0});
    if (ImGui::BeginPopupModal("That did not work", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::TextWrapped("%s", state.error.c_str());
        if (ImGui::Button("go on")) {
            state.error.clear();
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
}

} // namespace voxtact::view
