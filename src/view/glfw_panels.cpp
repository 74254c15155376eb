// SPDX-License-Identifier: MIT
#include "view/glfw_panels.h"

#include "view/model/document/decimal_comma.h"
#include "view/panels/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace voxtact::view {

namespace {

void onKey(GLFWwindow* window, int key, int, int action, int modifiers) {
    if (action != GLFW_RELEASE) {
        static_cast<State*>(glfwGetWindowUserPointer(window))
            ->keys.push_back(
                {key, (modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0, action == GLFW_REPEAT});
    }
}

void onMove(GLFWwindow* window, double x, double y) {
    static_cast<State*>(glfwGetWindowUserPointer(window))->pointer.moveTo({x, y});
}

void onButton(GLFWwindow* window, int button, int action, int) {
    Pointer& pointer = static_cast<State*>(glfwGetWindowUserPointer(window))->pointer;
    if (action == GLFW_RELEASE) {
        pointer.release(static_cast<std::size_t>(button));
    } else {
        pointer.press(static_cast<std::size_t>(button), glfwGetTime(),
                      static_cast<double>(ImGui::GetIO().MouseDoubleClickMaxDist));
    }
}

void onDrop(GLFWwindow* window, int count, const char** paths) {
    static_cast<State*>(glfwGetWindowUserPointer(window))->drop(count, paths);
}

bool isInPath(GLFWwindow* window) {
    return static_cast<const State*>(glfwGetWindowUserPointer(window))->field.has_value();
}

void onCharacter(GLFWwindow* window, unsigned character) {
    ImGui_ImplGlfw_CharCallback(window, typedCharacter(character, isInPath(window)));
}

/// Dear ImGui's clipboard, `window` being the user's pointer. Valid until the next call.
const char* clipboard(void* window) {
    static std::string text;
    auto* const of = static_cast<GLFWwindow*>(window);
    const char* const copied = glfwGetClipboardString(of);
    if (copied == nullptr) {
        return nullptr;
    }
    text = pastedText(copied, isInPath(of));
    return text.c_str();
}

/// A key that came and went since the last frame is down in this one: fields would not see it. Returns those.
std::vector<int> pressTaps(const std::vector<KeyPress>& presses) {
    std::vector<int> taps;
    for (const KeyPress& press : presses) {
        const bool ends = press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER || press.key == GLFW_KEY_ESCAPE;
        if (ends && !ImGui::GetIO().KeysDown[press.key]) {
            ImGui::GetIO().KeysDown[press.key] = true;
            taps.push_back(press.key);
        }
    }
    return taps;
}

/// Dear ImGui counts them by when frames come.
void countClicks(const Pointer::Seen& seen) {
    ImGuiIO& io = ImGui::GetIO();
    for (std::size_t button = 0; button < Pointer::kButtons; ++button) {
        if (const int clicks = seen.clicks[button]; clicks > 0 && io.MouseClicked[button]) {
            io.MouseClickedCount[button] = io.MouseClickedLastCount[button] = static_cast<ImU16>(clicks);
            io.MouseDoubleClicked[button] = clicks == 2;
        }
    }
}

} // namespace

Panels::Panels(GLFWwindow* window, std::span<const unsigned char> font) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is written where it was started
    float x = 1;
    float y = 1;
    glfwGetWindowContentScale(window, &x, &y);
    applyTheme(std::max(x, 1.0F), font);
    // Dear ImGui calls it too. What it knows of keys is which are down at a frame, and a slow one sees none of
    // those that came and went.
    glfwSetKeyCallback(window, onKey);
    glfwSetDropCallback(window, onDrop);
    // For the same reason.
    glfwSetCursorPosCallback(window, onMove);
    glfwSetMouseButtonCallback(window, onButton);
    ImGui_ImplGlfw_InitForVulkan(window, true);
    glfwSetCharCallback(window, onCharacter);
    ImGui::GetIO().GetClipboardTextFn = clipboard;
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

Panels::~Panels() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

const ImDrawData& drawAllPanels(State& state) {
    ImGui_ImplGlfw_NewFrame();
    const Pointer::Seen seen = state.pointer.next(glfwGetTime());
    if (state.pointer.behind()) {
        glfwPostEmptyEvent(); // the next frame is soon
    }
    ImGuiIO& io = ImGui::GetIO();
    std::ranges::copy(seen.down, std::begin(io.MouseDown));
    if (seen.at) {
        io.MousePos = {static_cast<float>((*seen.at)[0]), static_cast<float>((*seen.at)[1])};
    }
    const std::vector<int> taps = pressTaps(state.keys);
    ImGui::NewFrame();
    for (const int key : taps) {
        io.KeysDown[key] = false;
    }
    countClicks(seen);
    drawPanels(state);
    state.update();
    ImGui::Render();
    return *ImGui::GetDrawData();
}

Result<VkSurfaceKHR> makeSurface(const device::Session& session, GLFWwindow* window) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(session.instance.handle(), window, nullptr, &surface);
    if (result != VK_SUCCESS) {
        return Error{ErrorCode::Unsupported, result,
                     "Vulkan cannot draw in a window of this display: " + windowSystemReason()};
    }
    return surface;
}

std::string windowSystemReason() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason is known";
}

} // namespace voxtact::view
