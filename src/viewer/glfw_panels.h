// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"
#include "vulkan/own/session.h"

#include <span>

struct GLFWwindow;
struct ImDrawData;

/// Connects panels and frames to a GLFW window.
namespace voxtact::view {

/// Dear ImGui's context, with the window's input. One at a time.
class Panels {
  public:
    /// The window's user pointer is the State that receives keys and dropped files. `font` outlives this.
    Panels(GLFWwindow* window, std::span<const unsigned char> font);
    Panels(const Panels&) = delete;
    Panels& operator=(const Panels&) = delete;
    ~Panels();
};

/// Returns the draw data of the panels. Valid until the next call.
[[nodiscard]] const ImDrawData& drawAllPanels(State& state);

/// Creates the window's surface, one at a time; the caller destroys it.
[[nodiscard]] Result<VkSurfaceKHR> makeSurface(const device::Session& session, GLFWwindow* window);

/// Returns the reason of the window system's last refusal.
[[nodiscard]] std::string windowSystemReason();

} // namespace voxtact::view
