// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/panels/panels.h"

#include <functional>
#include <string>

/// The window's panels without a window: they are drawn into nothing, and a mouse is played to them.
namespace voxtact::test {

/// A small scene: the builtin head and scalpel, a curve of two points.
[[nodiscard]] view::State smallState();

/// Panels of a window of so many points of the size `scale`. One at a time.
class ShownPanels {
  public:
    explicit ShownPanels(view::State& state, float scale = 1, const view::Extent& points = {1280, 800});
    ~ShownPanels();
    ShownPanels(const ShownPanels&) = delete;
    ShownPanels& operator=(const ShownPanels&) = delete;

    void frame();
    /// The lines of text that a frame shows, to the end of the first tooltip.
    [[nodiscard]] std::string shownText();
    /// The pointer is there in a frame.
    void moveTo(double x, double y);
    /// A button goes down or up, in a frame.
    void press(int button = 0);
    void release(int button = 0);
    void click(double x, double y);
    /// The pointer comes and a button goes down between one frame and the next.
    void pressAt(double x, double y, int button = 0);
    /// Pressed, moved by so many points in some frames, released.
    void drag(double x, double y, double right, double down, int button = 0);
    /// A letter a frame.
    void type(const std::string& text);
    /// A key of GLFW's goes down and up, for the window and for Dear ImGui.
    void tap(int key);
    /// A number's field is there, to be written in.
    void writeAt(double x, double y);
    void turnWheel(double x, double y, float notches);

  private:
    view::State* state_;
};

} // namespace voxtact::test
