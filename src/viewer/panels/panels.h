// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/state.h"

#include <imgui.h>

#include <initializer_list>
#include <span>
#include <string>

/// The window's panels: they read and write a State, and know no Vulkan.
namespace voxtact::view {

struct Onto;

/// All of them, of the window's whole size. Between ImGui::NewFrame() and ImGui::Render().
void drawPanels(State& state);

/// Colours, spaces and the font, for a display where a point is so many pixels.
void applyTheme(float scale, std::span<const unsigned char> font);
void setColours(Theme theme);
/// A length on a display where a point is a pixel, on the one that there is: for all that is not as large as text.
[[nodiscard]] float scaled(float length);
/// Green, red or yellow for a hitNumber(), on a card of the theme and on a picture.
[[nodiscard]] ImVec4 verdictColour(int hit);
[[nodiscard]] ImVec4 verdictOnPicture(int hit);
/// Of the closest points, and the line between them.
[[nodiscard]] ImU32 closestColour(float alpha);
/// Of a mesh by its number in Sources::meshes: the colour that it has in the picture.
[[nodiscard]] ImVec4 instrumentColour(std::size_t mesh);
/// Of what is secondary.
[[nodiscard]] ImVec4 quietColour();
inline constexpr ImU32 kContactColour = IM_COL32(255, 90, 50, 255);

// The parts; each inside of a window or child that the layout has begun.
void drawAnswer(State& state);
void drawInstrument(State& state);
/// The list of meshes, with what is said of each; nothing where there is one, which is shown.
void drawMeshes(State& state);
void drawCurve(State& state);
void drawPicture(State& state);
/// What lies over the picture, but for the handles.
void drawMarks(const State& state, const Onto& onto, ImDrawList& list);
/// A dialog while a picture is made for a file, with a button that cancels it.
void drawSaving(State& state);
/// Handles in the picture: whether they have the mouse. After the picture's item.
[[nodiscard]] bool takeGizmo(State& state, const ImVec2& corner, const ImVec2& size);
void drawGizmo(const State& state, const Onto& onto, ImDrawList& list);
/// The cube of the patient's sides: whether it has the mouse. A click looks at a side of it. After the picture's item.
[[nodiscard]] bool takeCube(State& state, const ImVec2& corner, const ImVec2& size);
void drawCube(const State& state, const Onto& onto, ImDrawList& list);
/// Of the letters of the patient's sides, which are large.
[[nodiscard]] const ImFont& letterFont();
/// Whether there are handles, and along whose axes.
void drawGizmoChoice(State& state);
void drawSlice(State& state, std::size_t slice);
void drawContacts(State& state);
/// A window with what each method says of the chosen mesh, while it is asked for.
void drawComparison(State& state);
/// Dialogs of files, and their menu.
void drawFileMenu(State& state);
void drawDialogs(State& state);
/// How far it is what is being loaded, and a button that cancels it.
void drawLoading(State& state);
/// A dialog with a choice, where there is one to make.
void drawQuestion(State& state);
/// Opens the dialog for a file to open.
void askForFile();
/// Opens the dialog for a session to save.
void askForSession();
/// Opens the dialog for a picture to save.
void askForPicture();
/// What is pressed.
void takeKeys(State& state);
void drawHelp(State& state);

/// A title with a line.
void heading(const char* text);
/// A line of text over a picture, with a dark rim: it can be read on what is bright, too.
void addRimmed(ImDrawList& list, const ImVec2& at, ImU32 colour, const char* text);
/// As much of a line as a width has room for, with dots for what is missing.
[[nodiscard]] std::string shortened(const std::string& text, float width);
/// The first of some texts that a width has room for; where there is none, the last.
[[nodiscard]] std::string fitting(std::initializer_list<std::string> texts, float width);
/// A line that is shortened where it is too long: all of it is under the mouse then.
void shortLine(const ImVec4& colour, const std::string& text);
/// How wide a button is, or a box to check, with its text.
[[nodiscard]] float widthOfButton(const char* text);
[[nodiscard]] float widthOfCheckbox(const char* text);
/// On with the line where it has room for an item of that width.
void sameLine(float width);
/// Clipboard and status line.
void copyCommand(State& state);
/// As copyAsCommand() for what is shown.
[[nodiscard]] std::string commandOf(const State& state);
/// How far the mouse was dragged since the frame before: the way to where a button is pressed is no part of it.
[[nodiscard]] ImVec2 draggedBy();
/// Where the mouse is in an item, 0..1 from its upper left corner.
[[nodiscard]] Point2 mouseIn(const ImVec2& corner, const ImVec2& size);

} // namespace voxtact::view
