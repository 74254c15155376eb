// SPDX-License-Identifier: MIT
#include "view/window.h"

#include "core/base/try.h"
#include "view/frame/frame.h"
#include "view/model/report.h"
#include "view/panels/panels.h"
#include "voxtact/io.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <ostream>
#include <string>

namespace voxtact::view {

namespace {

using Clock = State::Clock;

std::string windowSystemReason() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason is known";
}

double millisecondsSince(Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

struct WindowEnd {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, WindowEnd>;

void onKey(GLFWwindow* window, int key, int, int action, int modifiers) {
    if (action != GLFW_RELEASE) {
        static_cast<State*>(glfwGetWindowUserPointer(window))
            ->keys.push_back({key, (modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0});
    }
}

void onDrop(GLFWwindow* window, int count, const char** paths) {
    auto& dropped = static_cast<State*>(glfwGetWindowUserPointer(window))->dropped;
    dropped.insert(dropped.end(), paths, paths + count);
}

/// Dear ImGui's context and what it gets of the window's input.
class Panels {
  public:
    Panels(GLFWwindow* window, std::span<const unsigned char> font) {
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
    Panels(const Panels&) = delete;
    Panels& operator=(const Panels&) = delete;
    ~Panels() {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }

    /// What the panels draw of a state.
    static const ImDrawData& draw(State& state) {
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        drawPanels(state);
        state.update();
        ImGui::Render();
        return *ImGui::GetDrawData();
    }
};

/// Writes --report-state when there is something new.
class Reporter {
  public:
    explicit Reporter(std::filesystem::path path) : path_(std::move(path)) {}

    [[nodiscard]] Result<void> write(const State& state) {
        const bool settled = state.settled();
        const std::uint64_t measured = state.clearance ? state.clearance->revision : 0;
        if (path_.empty() || !state.answer ||
            (state.answer->revision == revision_ && settled == settled_ && measured == measured_ &&
             state.error == error_)) {
            return {};
        }
        revision_ = state.answer->revision;
        settled_ = settled;
        measured_ = measured;
        error_ = state.error;
        StateReport report;
        report.answer = &*state.answer;
        report.times = &state.times;
        report.document = &state.document;
        report.clearance = state.clearance ? &*state.clearance : nullptr;
        report.labels = state.labelsOrNull();
        report.device = state.answeredBy;
        report.command = commandOf(state);
        const Pane& pane = state.picture;
        report.picture = {pane.corner[0], pane.corner[1], pane.size[0], pane.size[1]};
        report.error = state.error;
        report.frame = state.frame;
        report.frameMilliseconds = state.frameTimes.percentile(0.5);
        report.settled = settled;
        return io::writeFile(path_, [&](std::ostream& out) -> Result<void> {
            out << reportText(report);
            return {};
        });
    }

  private:
    std::filesystem::path path_;
    std::uint64_t revision_ = 0;
    std::uint64_t measured_ = 0; ///< the clearance's revision
    std::string error_;
    bool settled_ = false;
};

/// The next pose of the list, some a second; the last one ends it.
void play(State& state, Clock::time_point& last) {
    constexpr double kMilliseconds = 100;
    if (!state.playing || millisecondsSince(last) < kMilliseconds) {
        return;
    }
    last = Clock::now();
    if (state.document.pose + 1 >= state.document.poses.size()) {
        state.playing = false;
        state.history.end();
        return;
    }
    state.takePose(state.document.pose + 1);
}

void takeScreenshot(Frames& frames, State& state) {
    if (state.screenshot.empty()) {
        return;
    }
    const std::string path = std::exchange(state.screenshot, {});
    const Result<Picture> picture = frames.screenshot(state, state.picture.extent);
    const Result<void> written =
        picture.ok() ? io::writePng(path, picture->width, picture->height, picture->rgba) : picture.error();
    written.ok() ? state.say("the picture is in " + path) : state.complain(written.error().text);
}

VkExtent2D pixelsOf(GLFWwindow* window) {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
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

Result<std::unique_ptr<Frames>> makeFrames(const device::Session& session, GLFWwindow* window, State& state,
                                           const WindowDesc& desc) {
    const Result<VkSurfaceKHR> surface = makeSurface(session, window);
    VOXTACT_TRY(surface);
    return Frames::create(session, *surface, state, desc.light, [] { glfwPostEmptyEvent(); });
}

/// What is wanted instead of what is shown; nothing where it cannot be read.
std::optional<Given> opened(State& state, const WindowDesc& desc) {
    if (!state.wanted) {
        return std::nullopt;
    }
    Result<Given> given = desc.open(*std::exchange(state.wanted, std::nullopt));
    if (!given.ok()) {
        state.say({}); // that it is opened
        state.complain(given.error().text);
        return std::nullopt;
    }
    return std::move(*given);
}

/// One turn of the loop after another, until the window is to close, or to show what is then in `next`.
Result<void> loop(GLFWwindow* window, Frames& frames, State& state, const WindowDesc& desc,
                  std::optional<Given>& next) {
    Reporter reporter(desc.reportState);
    Clock::time_point played = Clock::now();
    Clock::time_point shown = Clock::now();
    bool idle = false;
    while (glfwWindowShouldClose(window) == GLFW_FALSE && !state.quit && (!desc.frames || state.frame < *desc.frames)) {
        constexpr double kIdle = 0.15; // s
        constexpr double kBusy = 0.002;
        idle = state.settled() && !state.playing && !desc.frames;
        idle ? glfwWaitEventsTimeout(kIdle) : glfwPollEvents();
        const VkExtent2D pixels = pixelsOf(window);
        if (pixels.width == 0 || pixels.height == 0) {
            glfwWaitEvents(); // it is not to be seen
            continue;
        }
        if (!frames.ready()) {
            glfwWaitEventsTimeout(kBusy);
            continue;
        }
        VOXTACT_TRY(frames.collect(state));
        play(state, played);
        const ImDrawData& panels = Panels::draw(state);
        VOXTACT_TRY(frames.show(state, panels, pixels));
        ++state.frame;
        if (!idle) {
            state.frameTimes.add(millisecondsSince(shown));
        }
        shown = Clock::now();
        takeScreenshot(frames, state);
        VOXTACT_TRY(reporter.write(state));
        if (next = opened(state, desc); next) {
            return {};
        }
    }
    return {};
}

} // namespace

Result<std::unique_ptr<Display>> Display::open() {
    if (glfwInit() != GLFW_TRUE) {
        return Error{ErrorCode::Unsupported, 0,
                     "there is no display to open a window on (" + windowSystemReason() +
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

Result<void> runWindow(const Display&, const device::Session& session, State& state, const WindowDesc& desc) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    const WindowHandle window(glfwCreateWindow(static_cast<int>(desc.size.width), static_cast<int>(desc.size.height),
                                               "voxtact", nullptr, nullptr));
    if (window == nullptr) {
        return Error{ErrorCode::Unsupported, 0, "the window cannot be opened: " + windowSystemReason()};
    }
    glfwSetWindowUserPointer(window.get(), &state);
    const Panels panels(window.get(), desc.font);
    std::optional<State> before; // until what is shown instead of it is there
    while (true) {
        Result<std::unique_ptr<Frames>> frames = makeFrames(session, window.get(), state, desc);
        if (!frames.ok() && before && frames.error().code != ErrorCode::DeviceLost) {
            state = std::move(*std::exchange(before, std::nullopt));
            state.complain(frames.error().text);
            continue;
        }
        VOXTACT_TRY(frames);
        std::optional<Given> next;
        VOXTACT_TRY(loop(window.get(), **frames, state, desc, next));
        if (!next) {
            return {};
        }
        frames->reset(); // with the surface, of which a window has one at a time
        const std::uint64_t frame = state.frame;
        before = std::move(state);
        state = State(std::move(*next));
        state.frame = frame;
    }
}

} // namespace voxtact::view
