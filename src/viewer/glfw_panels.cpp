// SPDX-License-Identifier: MIT
#include "viewer/glfw_panels.h"

#include "viewer/model/document/decimal_comma.h"
#include "viewer/panels/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

namespace voxtact::view {

namespace {

/// Keys that edit a text, or end its field.
constexpr std::array kEditing{GLFW_KEY_ENTER,     GLFW_KEY_KP_ENTER, GLFW_KEY_ESCAPE, GLFW_KEY_TAB,
                              GLFW_KEY_BACKSPACE, GLFW_KEY_DELETE,   GLFW_KEY_LEFT,   GLFW_KEY_RIGHT,
                              GLFW_KEY_UP,        GLFW_KEY_DOWN,     GLFW_KEY_HOME,   GLFW_KEY_END};

void onKey(GLFWwindow* window, int key, int, int action, int modifiers) {
    if (action == GLFW_PRESS && std::ranges::find(kEditing, key) != kEditing.end()) {
        static_cast<State*>(glfwGetWindowUserPointer(window))->keystrokes.addKey(key);
    }
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
    static_cast<State*>(glfwGetWindowUserPointer(window))
        ->keystrokes.addLetter(typedCharacter(character, isInPath(window)));
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

/// Begins Dear ImGui's frame with the keystrokes in their order. Dear ImGui knows only the keys that are down at a
/// frame: a key pressed and released between two frames is down in one, and a waiting key is up.
void beginFrame(Keystrokes& strokes) {
    ImGuiIO& io = ImGui::GetIO();
    const Keystrokes::Frame typed = strokes.next();
    for (const unsigned letter : typed.letters) {
        io.AddInputCharacter(letter);
    }
    std::array<bool, kEditing.size()> held{};
    for (std::size_t i = 0; i < kEditing.size(); ++i) {
        const int key = kEditing[i];
        held[i] = io.KeysDown[key];
        io.KeysDown[key] = typed.key == key || (held[i] && !strokes.waits(key));
        io.KeysDownDuration[key] = typed.key == key ? -1 : io.KeysDownDuration[key]; // it goes down, whatever it was
    }
    ImGui::NewFrame();
    for (std::size_t i = 0; i < kEditing.size(); ++i) {
        io.KeysDown[kEditing[i]] = held[i];
    }
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
    // Replaces Dear ImGui's callback, which sees only keys that are down at a frame: a slow frame would miss short
    // keystrokes.
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
    if (state.pointer.behind() || state.keystrokes.behind()) {
        glfwPostEmptyEvent(); // the next frame is soon
    }
    ImGuiIO& io = ImGui::GetIO();
    std::ranges::copy(seen.down, std::begin(io.MouseDown));
    if (seen.at) {
        io.MousePos = {static_cast<float>((*seen.at)[0]), static_cast<float>((*seen.at)[1])};
    }
    beginFrame(state.keystrokes);
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
    return text != nullptr ? text : "unknown reason";
}

} // namespace voxtact::view
