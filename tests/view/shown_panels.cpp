// SPDX-License-Identifier: MIT
#include "shown_panels.h"

#include "voxtact/samples.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <tuple>
#include <utility>

namespace voxtact::test {

using namespace voxtact::view;

State smallState() {
    Given given;
    given.volume = makeBuiltinVolume("head:16").value();
    given.meshes.push_back(makeBuiltinMesh("scalpel:300").value());
    given.values = checkVolume(given.volume.view()).value();
    given.document.sources = {"builtin:head:16", {{"builtin:scalpel:300", "lps", 1}}, "", "", 1};
    given.document.edit.curve = {{40, 0}, {80, 1}};
    return State(std::move(given));
}

namespace {

/// As long as the atlas needs it.
const std::vector<unsigned char>& fontBytes() {
    static const std::vector<unsigned char> bytes = [] {
        std::ifstream file(VOXTACT_TEST_FONT, std::ios::binary);
        return std::vector<unsigned char>(std::istreambuf_iterator<char>(file), {});
    }();
    return bytes;
}

} // namespace

ShownPanels::ShownPanels(State& state, float scale, const Extent& points) : state_(&state) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {static_cast<float>(points.width) * scale, static_cast<float>(points.height) * scale};
    io.DeltaTime = 0.02F; // two clicks are soon after another
    io.MousePos = {1, 1};
    for (const auto& [key, number] :
         {std::pair(ImGuiKey_Tab, GLFW_KEY_TAB), std::pair(ImGuiKey_Enter, GLFW_KEY_ENTER),
          std::pair(ImGuiKey_Escape, GLFW_KEY_ESCAPE), std::pair(ImGuiKey_Backspace, GLFW_KEY_BACKSPACE)}) {
        io.KeyMap[key] = number;
    }
    applyTheme(scale, fontBytes());
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    // Heights of parts are known from the frame before, and what has room beside their scroll bars from those.
    constexpr int kSettled = 5;
    for (int i = 0; i < kSettled; ++i) {
        frame();
    }
}

ShownPanels::~ShownPanels() {
    ImGui::DestroyContext();
}

void ShownPanels::frame() {
    ImGui::NewFrame();
    drawPanels(*state_);
    state_->update();
    ImGui::Render();
}

std::string ShownPanels::shownText() {
    std::string text;
    ImGuiIO& io = ImGui::GetIO();
    const auto before = std::pair(io.ClipboardUserData, io.SetClipboardTextFn);
    io.ClipboardUserData = &text;
    io.SetClipboardTextFn = [](void* to, const char* copied) { *static_cast<std::string*>(to) = copied; };
    ImGui::NewFrame();
    ImGui::LogToClipboard(); // until the end of a window
    drawPanels(*state_);
    state_->update();
    ImGui::Render();
    std::tie(io.ClipboardUserData, io.SetClipboardTextFn) = before;
    return text;
}

void ShownPanels::moveTo(double x, double y) {
    ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
    frame();
}

void ShownPanels::press(int button) {
    ImGui::GetIO().MouseDown[button] = true;
    frame();
}

void ShownPanels::release(int button) {
    ImGui::GetIO().MouseDown[button] = false;
    frame();
}

void ShownPanels::click(double x, double y) {
    moveTo(x, y);
    press();
    release();
}

void ShownPanels::pressAt(double x, double y, int button) {
    ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
    press(button);
}

void ShownPanels::drag(double x, double y, double right, double down, int button) {
    constexpr int kSteps = 4;
    moveTo(x, y);
    press(button);
    for (int step = 1; step <= kSteps; ++step) {
        moveTo(x + right * step / kSteps, y + down * step / kSteps);
    }
    release(button);
}

void ShownPanels::type(const std::string& text) {
    for (const char letter : text) {
        ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
        frame();
    }
}

void ShownPanels::tap(int key) {
    state_->keys.push_back({key});
    ImGui::GetIO().KeysDown[key] = true;
    frame();
    ImGui::GetIO().KeysDown[key] = false;
    frame();
}

void ShownPanels::writeAt(double x, double y) {
    ImGui::GetIO().KeyCtrl = true;
    ImGui::GetIO().KeyMods = ImGuiKeyModFlags_Ctrl;
    click(x, y);
    ImGui::GetIO().KeyCtrl = false;
    ImGui::GetIO().KeyMods = ImGuiKeyModFlags_None;
    frame();
}

void ShownPanels::turnWheel(double x, double y, float notches) {
    moveTo(x, y);
    ImGui::GetIO().MouseWheel = notches; // for a frame
    frame();
}

} // namespace voxtact::test
