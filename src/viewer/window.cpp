// SPDX-License-Identifier: MIT
#include "viewer/window.h"

#include "core/base/try.h"
#include "viewer/glfw_panels.h"
#include "viewer/main_loop.h"
#include "viewer/model/files/session_file.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace voxtact::view {

namespace {

struct WindowEnd {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, WindowEnd>;

/// Scaled for a high-resolution display.
void limitSize(GLFWwindow* window) {
    float x = 1;
    float y = 1;
    glfwGetWindowContentScale(window, &x, &y);
    const auto least = [](std::uint32_t points, float scale) {
        return static_cast<int>(std::lround(static_cast<float>(points) * std::max(scale, 1.0F)));
    };
    glfwSetWindowSizeLimits(window, least(kLeastWindow.width, x), least(kLeastWindow.height, y), GLFW_DONT_CARE,
                            GLFW_DONT_CARE);
}

/// Question after a lost device.
Question lostQuestion(const std::string& device, const Error& error) {
    Question question;
    question.kind = Question::Kind::Lost;
    question.title = "The device was lost";
    question.text =
        "'" + device + "' was lost: " + error.text +
        ".\n\nThe device was restarted. Scene, poses and transfer function are unchanged. The host (cpu) answers "
        "now.";
    question.buttons = {"continue with the host", "use the device again"};
    return question;
}

/// Returns the error with the path of the saved session.
Error rescued(const Error& error, const Document& document) {
    Error out = error;
    const std::filesystem::path path = stateFolder() / "rescued-session.json";
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (!stateFolder().empty() && writeSession(path, document).ok()) {
        out.text += "; to restore the contents: voxtact view --session " + path.string();
    }
    return out;
}

/// A window's devices, one after the other.
class Devices {
  public:
    Devices(GLFWwindow* window, State& state, const WindowDesc& desc) : window_(window), state_(&state), desc_(&desc) {}

    [[nodiscard]] Result<void> run() {
        while (true) {
            const Result<std::unique_ptr<device::Session>> session = desc_->session();
            if (!session.ok()) {
                return kept_ ? rescued(session.error(), *kept_) : session.error();
            }
            Result<void> ended =
                MainLoop(window_, **session, *state_, *desc_).run(given_ ? again() : firstOf(**session));
            if (ended.ok() || ended.error().code != ErrorCode::DeviceLost) {
                return ended;
            }
            if (!state_->blank) {
                kept_ = state_->saved();
            }
            // A second loss before the user has answered would repeat forever.
            if (state_->blank || (state_->question && state_->question->kind == Question::Kind::Lost)) {
                return kept_ ? rescued(ended.error(), *kept_) : ended.error();
            }
            take((*session)->device.physical().name, ended.error());
        }
    }

  private:
    [[nodiscard]] std::function<Result<Given>(Progress&)> firstOf(const device::Session& session) const {
        if (!desc_->first) {
            return {};
        }
        return [this, &session](Progress& progress) { return desc_->first(session, progress); };
    }
    /// Returns the contents before the device was lost.
    [[nodiscard]] std::function<Result<Given>(Progress&)> again() const {
        return [given = given_](Progress&) -> Result<Given> { return std::move(*given); };
    }
    void take(const std::string& device, const Error& error) {
        given_ = std::make_shared<Given>(state_->giveBack());
        const Projection projection = given_->document.method.value_or(MethodChoice{}).projection;
        given_->document.method = MethodChoice{CountingMethod::Cpu, projection};
        state_->question = lostQuestion(device, error);
    }

    GLFWwindow* window_;
    State* state_;
    const WindowDesc* desc_;
    std::shared_ptr<Given> given_;
    std::optional<Document> kept_; ///< last document
};

} // namespace

Result<std::unique_ptr<Display>> Display::open() {
    if (glfwInit() != GLFW_TRUE) {
        return Error{ErrorCode::Unsupported, 0,
                     "no display for a window (" + windowSystemReason() +
                         "); voxtact render makes pictures without one"};
    }
    std::unique_ptr<Display> display(new Display);
    if (glfwVulkanSupported() != GLFW_TRUE) {
        return Error{ErrorCode::Unsupported, 0,
                     "Vulkan cannot draw in a window of this display (" + windowSystemReason() +
                         "); see voxtact devices"};
    }
    return display;
}

Display::~Display() {
    glfwTerminate();
}

std::vector<const char*> Display::instanceExtensions() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, names + count};
}

std::vector<const char*> Display::deviceExtensions() const {
    return {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
}

Result<void> runWindow(const Display&, const WindowDesc& desc) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    const WindowHandle window(glfwCreateWindow(static_cast<int>(desc.size.width), static_cast<int>(desc.size.height),
                                               "voxtact", nullptr, nullptr));
    if (window == nullptr) {
        return Error{ErrorCode::Unsupported, 0, "the window cannot be opened: " + windowSystemReason()};
    }
    limitSize(window.get());
    State state;
    state.wanted = desc.opened;
    glfwSetWindowUserPointer(window.get(), &state);
    const Panels panels(window.get(), desc.font);
    return Devices(window.get(), state, desc).run();
}

} // namespace voxtact::view
