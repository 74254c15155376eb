// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "viewer/model/files/open_file.h"
#include "viewer/model/files/save_file.h"
#include "viewer/panels/fields.h"
#include "viewer/panels/panels.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <utility>

namespace voxtact::view {

namespace {

constexpr const char* kOpen = "Open";
constexpr const char* kSession = "Save session";
constexpr const char* kPicture = "Save picture";

/// Last requested width and height; 0: none yet.
std::array<int, 2>& pictureSides() {
    static std::array<int, 2> sides{0, 0};
    return sides;
}

Extent pictureSize() {
    return {static_cast<std::uint32_t>(pictureSides()[0]), static_cast<std::uint32_t>(pictureSides()[1])};
}

void drawPictureSize(const State& state) {
    constexpr int kMost = 16384;
    std::array<int, 2>& sides = pictureSides();
    if (sides[0] <= 0) {
        sides = {static_cast<int>(state.picture.extent.width), static_cast<int>(state.picture.extent.height)};
    }
    const std::array<const char*, 2> labels{"##width", "width x height"};
    for (std::size_t side = 0; side < sides.size(); ++side) {
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 5);
        if (typeNumber(labels[side], sides[side])) {
            sides[side] = std::clamp(sides[side], 16, kMost);
        }
        ImGui::SameLine();
    }
    if (ImGui::Button("size in the window")) {
        sides = {0, 0};
    }
}

/// A dialog that asks for one path.
struct PathDialog {
    const char* title;
    const char* button;
    std::string path;
    Result<void> (*check)(const std::filesystem::path& path, const State& state); ///< what act() would refuse; or null
    Result<void> (*act)(const std::filesystem::path& path, State& state);
    std::string written{};  ///< path that it wrote last, which needs no confirmation
    std::string replaced{}; ///< existing path that was confirmed
    bool takesKeyboard = false;

    /// Returns true to proceed: an existing file is replaced only after a confirmation. Opening replaces nothing.
    [[nodiscard]] bool mayAct() {
        std::error_code ignored;
        if (title == kOpen || path == written || path == replaced || !std::filesystem::exists(path, ignored)) {
            return true;
        }
        replaced = path;
        return false;
    }
};

std::array<PathDialog, 5>& dialogs() {
    static std::array<PathDialog, 5> all{{
        {kSession, "save", "session.json", checkSession,
         [](const std::filesystem::path& path, State& state) -> Result<void> {
             VOXTACT_TRY(saveSession(path, state));
             state.say("saved the session as " + path.string());
             state.taken.push_back(path.string());
             return {};
         }},
        {"Save transfer function", "save", "curve.json", checkFunction,
         [](const std::filesystem::path& path, State& state) { return saveFunction(path, state); }},
        {"Save pose", "save", "pose.txt", checkPose,
         [](const std::filesystem::path& path, State& state) { return savePose(path, state); }},
        {kPicture, "save", "picture.png", checkPicture,
         [](const std::filesystem::path& path, State& state) -> Result<void> {
             state.shot = Shot{path.string(), pictureSize()};
             return {};
         }},
        {kOpen, "open", "", nullptr, openFile},
    }};
    return all;
}

const char* keyOf(const char* title) {
    return title == kOpen ? "Ctrl+O" : title == kSession ? "Ctrl+S" : title == kPicture ? "Ctrl+P" : nullptr;
}

/// Pressed buttons.
struct Buttons {
    bool goOn = false;
    bool cancel = false;
};

Buttons drawButtons(const PathDialog& dialog, bool isAsked) {
    Buttons pressed;
    if (isAsked) {
        ImGui::TextColored(verdictColour(2), "The file exists. Replace it?");
        // At the position of the other button, so that the second click of a double click answers nothing.
        pressed.cancel = ImGui::Button("cancel");
        ImGui::SameLine();
        pressed.goOn = ImGui::Button("replace");
    } else {
        pressed.goOn = ImGui::Button(dialog.button);
        ImGui::SameLine();
        pressed.cancel = ImGui::Button("cancel");
    }
    return pressed;
}

/// Proceeds with the path. Refuses before it asks.
void goOn(PathDialog& dialog, State& state) {
    Result<void> done = dialog.check != nullptr ? dialog.check(dialog.path, state) : Result<void>();
    if (done.ok() && !dialog.mayAct()) {
        dialog.takesKeyboard = true;
        return;
    }
    ImGui::CloseCurrentPopup();
    state.say(std::string(dialog.title) + ": " + dialog.path);
    done = done.ok() ? dialog.act(dialog.path, state) : done;
    if (!done.ok()) {
        state.say({});
        state.complain(done.error().text);
    } else if (dialog.title != kPicture) { // which is not written yet, and may be cancelled
        dialog.written = dialog.path;
    }
    dialog.replaced.clear();
}

void drawPathDialog(PathDialog& dialog, State& state) {
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 30, 0});
    if (!ImGui::BeginPopupModal(dialog.title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        return;
    }
    if (dialog.title == kOpen) {
        ImGui::TextColored(quietColour(), "a volume, a mesh, poses (.txt),\na transfer function or a session (.json)");
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::IsWindowAppearing()) {
        if (dialog.title == kOpen) {
            dialog.path.clear();
        }
        dialog.replaced.clear();
        state.entered = state.escaped = false; // pressed before it opened
        dialog.takesKeyboard = true;
    }
    if (std::exchange(dialog.takesKeyboard, false)) {
        ImGui::SetKeyboardFocusHere();
    }
    const bool isAsked = !dialog.replaced.empty() && dialog.replaced == dialog.path;
    const bool entered = ImGui::InputText("##path", &dialog.path,
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    // By the window's keys: Dear ImGui knows only keys that are down at a frame, and repeats held keys.
    bool done = state.entered || (entered && !isAsked);
    dialog.takesKeyboard = entered && isAsked;
    if (ImGui::IsItemActive()) {
        state.field = dialog.path;
    }
    if (dialog.title == kPicture) {
        drawPictureSize(state);
    }
    const Buttons buttons = drawButtons(dialog, isAsked);
    done |= buttons.goOn;
    if (buttons.cancel || state.escaped) {
        ImGui::CloseCurrentPopup();
    } else if (done && !dialog.path.empty()) {
        goOn(dialog, state);
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
        const bool open = dialog.title == kOpen;
        if (ImGui::MenuItem((std::string(dialog.title) + " ...").c_str(), keyOf(dialog.title), false,
                            open || !state.blank)) {
            asked() = dialog.title; // opened outside of the menu, which has an ID of its own
        }
    }
    if (ImGui::BeginMenu("Open recent", !state.recent.empty())) {
        for (const std::string& path : state.recent) {
            if (ImGui::MenuItem(path.c_str())) {
                state.dropped.push_back(path); // opened like dropped files, after the menu
            }
        }
        ImGui::EndMenu();
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) {
        state.quit = true;
    }
}

void askForFile() {
    asked() = kOpen;
}

void askForSession() {
    asked() = kSession;
}

void askForPicture() {
    asked() = kPicture;
}

void drawDialogs(State& state) {
    state.field.reset();
    drawQuestion(state);
    drawSaving(state);
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
