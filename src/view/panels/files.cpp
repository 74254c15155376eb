// SPDX-License-Identifier: MIT
#include "view/model/open_file.h"
#include "view/model/session_file.h"
#include "view/panels/panels.h"

#include "view/model/command_text.h"
#include "voxtact/io.h"

#include <imgui_stdlib.h>

#include <array>
#include <ostream>
#include <utility>

namespace voxtact::view {

namespace {

Result<void> savePose(const std::filesystem::path& path, const State& state) {
    return io::writeFile(path, [&state](std::ostream& out) -> Result<void> {
        out << poseText(state.document.edit.world_from_object) << "\n";
        return {};
    });
}

constexpr const char* kOpen = "Open";

/// A dialog that asks for one path.
struct PathDialog {
    const char* title;
    const char* button;
    std::string path;
    Result<void> (*act)(const std::filesystem::path& path, State& state);
};

std::array<PathDialog, 5>& dialogs() {
    static std::array<PathDialog, 5> all{{
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
        {kOpen, "open", "", openFile},
    }};
    return all;
}

void drawPathDialog(PathDialog& dialog, State& state) {
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 30, 0});
    if (!ImGui::BeginPopupModal(dialog.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        return;
    }
    if (dialog.title == kOpen) {
        ImGui::TextColored(quietColour(), "a volume, a mesh, poses (.txt), a transfer function or a session (.json)");
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::IsWindowAppearing()) {
        if (dialog.title == kOpen) {
            dialog.path.clear();
        }
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
            state.say({});
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
        if (ImGui::MenuItem((std::string(dialog.title) + " ...").c_str(), dialog.title == kOpen ? "Ctrl+O" : nullptr)) {
            asked() = dialog.title; // opened outside of the menu, which has an ID of its own
        }
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) {
        state.quit = true;
    }
}

void askForFile() {
    asked() = kOpen;
}

void takeDropped(State& state) {
    for (const std::string& path : std::exchange(state.dropped, {})) {
        state.say("opened: " + path);
        if (const Result<void> opened = openFile(path, state); !opened.ok()) {
            state.say({});
            state.complain(opened.error().text);
        }
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
        if (ImGui::Button("go on") || state.error.empty()) {
            state.error.clear();
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
}

} // namespace voxtact::view
