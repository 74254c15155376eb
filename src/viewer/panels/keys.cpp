// SPDX-License-Identifier: MIT
#include "viewer/model/document/pose.h"
#include "viewer/panels/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <utility>

namespace voxtact::view {

namespace {

/// A key that moves or turns the instrument by a step; with shift ten, with control a tenth.
struct Nudge {
    int key;
    Vec3 mm{};      ///< in steps
    Vec3 degrees{}; ///< about its own axes, in steps
    Axes axes = Axes::World;
    const char* name;
    const char* does;
};

const std::array<Nudge, 14> kNudges{{
    {GLFW_KEY_LEFT, {-1, 0, 0}, {}, Axes::World, "left", "to the patient's right (-x)"},
    {GLFW_KEY_RIGHT, {1, 0, 0}, {}, Axes::World, "right", "to the patient's left (+x)"},
    {GLFW_KEY_UP, {0, -1, 0}, {}, Axes::World, "up", "to the front (-y)"},
    {GLFW_KEY_DOWN, {0, 1, 0}, {}, Axes::World, "down", "to the back (+y)"},
    {GLFW_KEY_PAGE_UP, {0, 0, 1}, {}, Axes::World, "page up", "upwards (+z)"},
    {GLFW_KEY_PAGE_DOWN, {0, 0, -1}, {}, Axes::World, "page down", "downwards (-z)"},
    {GLFW_KEY_I, {0, 0, -1}, {}, Axes::Own, "I", "insert along its own axis"},
    {GLFW_KEY_O, {0, 0, 1}, {}, Axes::Own, "O", "withdraw along its own axis"},
    {GLFW_KEY_W, {}, {1, 0, 0}, Axes::Own, "W", "turn about its own +x"},
    {GLFW_KEY_S, {}, {-1, 0, 0}, Axes::Own, "S", "turn back"},
    {GLFW_KEY_A, {}, {0, 1, 0}, Axes::Own, "A", "turn about its own +y"},
    {GLFW_KEY_D, {}, {0, -1, 0}, Axes::Own, "D", "turn back"},
    {GLFW_KEY_Q, {}, {0, 0, 1}, Axes::Own, "Q", "turn about its own +z"},
    {GLFW_KEY_E, {}, {0, 0, -1}, Axes::Own, "E", "turn back"},
}};

struct Direction {
    int key;
    const char* name;
    const char* view;
};
constexpr std::array<Direction, 6> kDirections{{{GLFW_KEY_1, "1", "front"},
                                                {GLFW_KEY_2, "2", "back"},
                                                {GLFW_KEY_3, "3", "left"},
                                                {GLFW_KEY_4, "4", "right"},
                                                {GLFW_KEY_5, "5", "top"},
                                                {GLFW_KEY_6, "6", "bottom"}}};

void nudge(State& state, const Nudge& how, const KeyPress& press) {
    const double factor = press.shift ? 10 : press.control ? 0.1 : 1;
    state.step(
        [&](Edit& edit) {
            Vec3 mm = how.mm;
            for (double& one : mm) {
                one *= factor * state.stepMillimetres;
            }
            edit.pose() = moved(edit.pose(), mm, how.axes);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (how.degrees[axis] != 0) {
                    edit.pose() = turned(edit.pose(), axis, factor * state.stepDegrees * how.degrees[axis], how.axes);
                }
            }
        },
        "nudge", press.held);
}

void takeControlKey(State& state, const KeyPress& press) {
    switch (press.key) {
    case GLFW_KEY_Z:
        press.shift ? state.redo() : state.undo();
        break;
    case GLFW_KEY_Y:
        state.redo();
        break;
    case GLFW_KEY_C:
        copyCommand(state);
        break;
    case GLFW_KEY_O:
        askForFile();
        break;
    case GLFW_KEY_S:
        askForSession();
        break;
    case GLFW_KEY_P:
        askForPicture();
        break;
    case GLFW_KEY_Q:
        state.quit = true;
        break;
    default:
        break;
    }
}

void takePlainKey(State& state, const KeyPress& press) {
    const std::size_t poses = state.document.poses.size();
    switch (press.key) {
    case GLFW_KEY_F:
        state.camera = framing(state.volume.grid, state.camera.direction);
        break;
    case GLFW_KEY_G:
        state.cursor = originOf(state.document.edit.pose());
        break;
    case GLFW_KEY_X:
        state.drill(originOf(state.document.edit.pose()));
        break;
    case GLFW_KEY_C:
        state.drill(state.cursor);
        break;
    case GLFW_KEY_H:
        state.showGizmo = !state.showGizmo;
        break;
    case GLFW_KEY_T:
        state.gizmoAxes = nextOf(state.gizmoAxes);
        break;
    case GLFW_KEY_K:
        state.comparing = !state.comparing;
        break;
    case GLFW_KEY_M:
        state.choose((state.document.edit.chosen + 1) % state.document.edit.instruments.size());
        break;
    case GLFW_KEY_V:
        state.command([](Edit& edit) { edit.instruments[edit.chosen].shown ^= true; });
        break;
    case GLFW_KEY_DELETE:
        state.remove(state.document.edit.chosen);
        break;
    case GLFW_KEY_ESCAPE:
        state.helpOpen = false;
        state.cancelLoading = state.loading.has_value();
        state.maximised = Maximised::None;
        break;
    case GLFW_KEY_SPACE:
        state.playing = !state.playing && poses > 0;
        break;
    case GLFW_KEY_LEFT_BRACKET:
        state.takePose(state.document.pose == 0 ? 0 : state.document.pose - 1, press.held);
        break;
    case GLFW_KEY_RIGHT_BRACKET:
        state.takePose(poses == 0 ? 0 : std::min(state.document.pose + 1, poses - 1), press.held);
        break;
    default:
        break;
    }
    const auto* direction =
        std::ranges::find_if(kDirections, [&press](const Direction& one) { return one.key == press.key; });
    if (direction != kDirections.end()) {
        state.camera.direction = directionNamed(direction->view).value_or(state.camera.direction);
    }
}

/// While there is nothing to move or edit.
void takeBlankKey(State& state, const KeyPress& press) {
    if (press.control && press.key == GLFW_KEY_O) {
        askForFile();
    } else if (press.control && press.key == GLFW_KEY_Q) {
        state.quit = true;
    } else if (press.key == GLFW_KEY_F1) {
        state.helpOpen = !state.helpOpen;
    } else if (press.key == GLFW_KEY_ESCAPE) {
        state.helpOpen = false;
    }
}

void takeKey(State& state, const KeyPress& press) {
    if (press.key == GLFW_KEY_F1) {
        state.helpOpen = !state.helpOpen;
    }
    const bool letter = press.key < GLFW_KEY_ESCAPE; // with control these are commands
    for (const Nudge& one : kNudges) {
        if (one.key == press.key && !(letter && press.control)) {
            nudge(state, one, press);
        }
    }
    press.control ? takeControlKey(state, press) : takePlainKey(state, press);
}

void answerQuestion(Question& question, const std::vector<KeyPress>& keys) {
    for (const KeyPress& press : keys) {
        if (press.held) { // it already had its effect
            continue;
        }
        if (press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER) {
            question.chosen = 0;
        } else if (press.key == GLFW_KEY_ESCAPE) {
            question.chosen = question.buttons.size() - 1;
        }
    }
}

/// While a picture is made for a file.
void takeSavingKeys(State& state, const std::vector<KeyPress>& keys) {
    for (const KeyPress& press : keys) {
        state.cancelSaving |= press.key == GLFW_KEY_ESCAPE;
        state.quit |= press.control && press.key == GLFW_KEY_Q;
    }
}

void row(const char* key, const char* does) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(key);
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, quietColour());
    ImGui::TextWrapped("%s", does);
    ImGui::PopStyleColor();
}

} // namespace

void takeKeys(State& state) {
    const std::vector<KeyPress> keys = std::exchange(state.keys, {});
    // A held key has only its first effect.
    const auto pressed = [&keys](int key) {
        return std::ranges::any_of(keys, [key](const KeyPress& press) { return press.key == key && !press.held; });
    };
    state.entered = pressed(GLFW_KEY_ENTER) || pressed(GLFW_KEY_KP_ENTER);
    state.escaped = pressed(GLFW_KEY_ESCAPE);
    if (!state.error.empty()) {
        state.error = state.entered || state.escaped ? std::string() : state.error;
        state.entered = state.escaped = false;
        return;
    }
    if (state.question) {
        answerQuestion(*state.question, keys);
        return;
    }
    if (state.saving) {
        takeSavingKeys(state, keys);
        return;
    }
    if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId)) {
        if (state.escaped) {
            ImGui::ClosePopupsExceptModals(); // menus and lists: dialogs have a button that cancels
        }
        return;
    }
    if (ImGui::GetIO().WantTextInput) {
        return; // they are written into a field
    }
    for (const KeyPress& press : keys) {
        state.blank ? takeBlankKey(state, press) : takeKey(state, press);
    }
}

void drawHelp(State& state) {
    if (!state.helpOpen) {
        return;
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
    const float width = std::min(ImGui::GetFontSize() * 46, size.x - 2 * ImGui::GetFontSize());
    ImGui::SetNextWindowSize({width, size.y * 0.86F}, ImGuiCond_Appearing);
    if (ImGui::Begin("Keys and mouse", &state.helpOpen, ImGuiWindowFlags_NoCollapse) &&
        ImGui::BeginTable("keys", 2, ImGuiTableFlags_RowBg)) {
        ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed);
        ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch);
        for (const Nudge& one : kNudges) {
            row(one.name, one.does);
        }
        row("shift, control", "with these keys: ten steps, a tenth of a step (control: not with letters)");
        row("[  ]", "previous pose, next pose");
        row("space", "play the list of poses");
        for (const Direction& direction : kDirections) {
            row(direction.name, direction.view);
        }
        row("M, V, delete", "choose the next mesh; show or hide it; remove it");
        row("K", "the counts of all methods side by side");
        row("F", "frame the volume");
        row("G", "slices through the tip");
        row("H, T", "handles at the tip: show or hide; axes of the world, the view, the mesh");
        row("X, C", "drill a hole at the tip, at the cursor of the slices");
        row("control Z, control Y", "undo, redo");
        row("control C", "copy as command");
        row("control O", "open a file (or drop it on the window); escape: cancel loading");
        row("control S, control P", "save the session, a picture (escape cancels it)");
        row("control Q", "quit");
        row("escape", "close dialogs and menus; restore an enlarged picture or slice");
        row("handles", "drag: arrows move along an axis, squares in a plane, rings turn; control: in steps");
        row("picture", "left: turn; right or middle: move; wheel: zoom; double click: enlarge");
        row("cube", "click: view from that side of the patient");
        row("slices", "left: place the cursor; right: window and level; wheel: next slice; double click: enlarge");
        row("curve", "left: add or drag a point; right: remove it; wheel: zoom the values; middle: move them");
        ImGui::EndTable();
    }
    ImGui::End();
}

} // namespace voxtact::view
