// SPDX-License-Identifier: MIT
#include "viewer/panels/fields.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace voxtact::view {

namespace {

/// Text of an edited field, which Dear ImGui drops when another field gets the keyboard.
struct Typed {
    ImGuiID field = 0; ///< 0: none
    double began = 0;  ///< initial number
    double number = 0; ///< current number; `began` if it is incomplete
    int frame = 0;     ///< the last one that showed it

    [[nodiscard]] bool isOf(ImGuiID item) const { return field == item && frame + 1 == ImGui::GetFrameCount(); }
};

struct Typing {
    Typed now;
    Typed left; ///< of which another field, drawn before it in the frame, has taken the keyboard

    void begin(const Typed& typed) {
        if (now.field != typed.field && now.frame + 1 == ImGui::GetFrameCount()) {
            left = now;
        }
        now = typed;
    }
};

Typing& typing() {
    static Typing all;
    return all;
}

/// True if the text is a number; Dear ImGui keeps the previous number otherwise. An operator may precede it.
bool isNumberIn(ImGuiID item) {
    const ImGuiInputTextState* const state = ImGui::GetInputTextState(item);
    std::string_view text = state != nullptr && state->TextA.Data != nullptr ? state->TextA.Data : "";
    const auto trim = [&text] { text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size())); };
    trim();
    if (!text.empty() && std::string_view("+*/").find(text.front()) != std::string_view::npos) {
        text.remove_prefix(1);
        trim();
    }
    double number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    return fault == std::errc() &&
           std::string_view(end, text.data() + text.size()).find_first_not_of(" \t") == std::string_view::npos;
}

/// Draws an item with a number, by `draw`; returns true if the number changed. `isTyped`: tests by ID whether the user
/// types in it.
template <class Number, class Draw, class IsTyped>
bool takes(const char* label, Number& number, const Draw& draw, const IsTyped& isTyped) {
    const ImGuiID item = ImGui::GetID(label);
    const Number before = number;
    Typing& all = typing();
    const Typed typed = all.now.isOf(item) ? all.now : all.left.isOf(item) ? all.left : Typed{};
    const bool wasTyped = typed.field == item;
    // Each frame Dear ImGui compares the text with the formatted number and treats a difference as typed, so the field
    // keeps the typed number, whatever the value is now.
    number = wasTyped ? static_cast<Number>(typed.number) : before;
    const bool edited = draw(number);
    if (isTyped(item)) {
        const double began = wasTyped ? typed.began : static_cast<double>(before);
        all.begin({item, began, isNumberIn(item) ? static_cast<double>(number) : began, ImGui::GetFrameCount()});
        number = before;
        return false;
    }
    if (!wasTyped) {
        return edited;
    }
    // Left in this frame, or after the previous one.
    const bool restored = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    const bool written = static_cast<double>(number) != typed.began;
    number = written && !restored ? number : before;
    (all.now.field == item ? all.now : all.left) = {};
    return number != before;
}

bool isActive(ImGuiID item) {
    return ImGui::GetActiveID() == item;
}

} // namespace

bool typeNumber(const char* label, double& number, const char* format) {
    return takes(
        label, number, [&](double& shown) { return ImGui::InputDouble(label, &shown, 0, 0, format); }, isActive);
}

bool typeNumber(const char* label, int& number) {
    return takes(
        label, number, [&](int& shown) { return ImGui::InputInt(label, &shown, 0, 0); }, isActive);
}

bool dragNumbers(const char* label, Vec3& numbers, float speed, const char* format) {
    const auto drag = [&](double& shown) {
        return ImGui::DragScalar("", ImGuiDataType_Double, &shown, speed, nullptr, nullptr, format);
    };
    bool taken = false;
    ImGui::BeginGroup();
    ImGui::PushID(label);
    ImGui::PushMultiItemsWidths(3, ImGui::CalcItemWidth());
    for (std::size_t axis = 0; axis < numbers.size(); ++axis) {
        if (axis > 0) {
            ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
        }
        ImGui::PushID(static_cast<int>(axis));
        taken |= takes("", numbers[axis], drag, ImGui::TempInputIsActive);
        ImGui::PopID();
        ImGui::PopItemWidth();
    }
    ImGui::PopID();
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::TextUnformatted(label);
    ImGui::EndGroup();
    return taken;
}

bool slideNumber(const char* label, double& number, double least, double most, const char* format) {
    const auto slide = [&](double& shown) {
        return ImGui::SliderScalar(label, ImGuiDataType_Double, &shown, &least, &most, format);
    };
    return takes(label, number, slide, ImGui::TempInputIsActive);
}

bool slideNumber(const char* label, int& number, int least, int most, const char* format) {
    const auto slide = [&](int& shown) { return ImGui::SliderInt(label, &shown, least, most, format); };
    return takes(label, number, slide, ImGui::TempInputIsActive);
}

} // namespace voxtact::view
