// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <imgui.h>

#include <initializer_list>
#include <span>
#include <string>

/// The window's panels: they read and write a State, without Vulkan.
namespace voxtact::view {

struct Onto;

/// Draws all panels, in the whole window. Between ImGui::NewFrame() and ImGui::Render().
void drawPanels(State& state);

/// Sets colours, spacing and the font, for a display with this number of pixels per point.
void applyTheme(float scale, std::span<const unsigned char> font);
void setColours(Theme theme);
/// Scales a length from a display with one pixel per point to the current one: for lengths that do not follow the text
/// size.
[[nodiscard]] float scaled(float length);
/// Green, red or yellow for a hitNumber(), on a card of the theme and on a picture.
[[nodiscard]] ImVec4 verdictColour(int hit);
[[nodiscard]] ImVec4 verdictOnPicture(int hit);
/// Colour of the closest points, and the line between them.
[[nodiscard]] ImU32 closestColour(float alpha);
/// Colour of a mesh in the picture, by its index in Sources::meshes.
[[nodiscard]] ImVec4 instrumentColour(std::size_t mesh);
/// Colour of secondary text.
[[nodiscard]] ImVec4 quietColour();
inline constexpr ImU32 kContactColour = IM_COL32(255, 90, 50, 255);

// Parts of the window, each inside a window or child that the layout has begun.
void drawAnswer(State& state);
void drawInstrument(State& state);
/// Draws the list of meshes with their answers; nothing for a single visible mesh.
void drawMeshes(State& state);
void drawCurve(State& state);
void drawPicture(State& state);
/// Draws the marks over the picture, except the handles.
void drawMarks(const State& state, const Onto& onto, ImDrawList& list);
/// Draws a dialog while a picture is made for a file, with a cancel button.
void drawSaving(State& state);
/// Draws the handles in the picture; returns true if they have the mouse. Call after the picture's item.
[[nodiscard]] bool takeGizmo(State& state, const ImVec2& corner, const ImVec2& size);
void drawGizmo(const State& state, const Onto& onto, ImDrawList& list);
/// Draws the cube of the patient's sides; returns true if it has the mouse. A click selects a view. After the picture's
/// item.
[[nodiscard]] bool takeCube(State& state, const ImVec2& corner, const ImVec2& size);
void drawCube(const State& state, const Onto& onto, ImDrawList& list);
/// Font of the letters of the patient's sides, which are large.
[[nodiscard]] const ImFont& letterFont();
/// Draws the choice of handles and axes.
void drawGizmoChoice(State& state);
void drawSlice(State& state, std::size_t slice);
void drawContacts(State& state);
/// Draws a window with each method's answer for the chosen mesh, while requested.
void drawComparison(State& state);
/// Dialogs of files, and their menu.
void drawFileMenu(State& state);
void drawDialogs(State& state);
/// Draws the progress of loading, and a button that cancels it.
void drawLoading(State& state);
/// Draws a pending dialog with a choice.
void drawQuestion(State& state);
/// Opens the dialog for a file to open.
void askForFile();
/// Opens the dialog for a session to save.
void askForSession();
/// Opens the dialog for a picture to save.
void askForPicture();
/// Handles keys.
void takeKeys(State& state);
void drawHelp(State& state);

/// A title with a line.
void heading(const char* text);
/// Adds text over a picture, with a dark rim: readable on bright backgrounds.
void addRimmed(ImDrawList& list, const ImVec2& at, ImU32 colour, const char* text);
/// Shortens a line to a width, with dots.
[[nodiscard]] std::string shortened(const std::string& text, float width);
/// Returns the first of some texts that fits a width, else the last.
[[nodiscard]] std::string fitting(std::initializer_list<std::string> texts, float width);
/// Draws a line, shortened if too long; complete in the tooltip.
void shortLine(const ImVec4& colour, const std::string& text);
/// Width of a button or checkbox with its text.
[[nodiscard]] float widthOfButton(const char* text);
[[nodiscard]] float widthOfCheckbox(const char* text);
/// Continues the line if an item of that width fits.
void sameLine(float width);
/// Clipboard and status line.
void copyCommand(State& state);
/// Like copyAsCommand(), for the contents.
[[nodiscard]] std::string commandOf(const State& state);
/// Distance of the drag since the previous frame; excludes motion before the press.
[[nodiscard]] ImVec2 draggedBy();
/// Position of the mouse in an item, 0..1 from its upper left corner.
[[nodiscard]] Point2 mouseIn(const ImVec2& corner, const ImVec2& size);

} // namespace voxtact::view
