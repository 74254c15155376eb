// SPDX-License-Identifier: MIT
#include "view/glfw_panels.h"

#include "view/panels/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <algorithm>

namespace voxtact::view {

namespace {

void onKey(GLFWwindow* window, int key, int, int action, int modifiers) {
    if (action != GLFW_RELEASE) {
        static_cast<State*>(glfwGetWindowUserPointer(window))
            ->keys.push_back({key, (modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0});
    }
}

void onDrop(GLFWwindow* window, int count, const char** paths) {
    static_cast<State*>(glfwGetWindowUserPointer(window))->drop(count, paths);
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
    ImGui_ImplGlfw_InitForVulkan(window, true);
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

Panels::~Panels() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

const ImDrawData& drawAllPanels(State& state) {
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
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
