// SPDX-License-Identifier: MIT
#include "view/panels/fields.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace voxtact::view {

namespace {

/// What stands in the field that is typed in, which Dear ImGui forgets when another one gets the keyboard.
struct Typing {
    ImGuiID field = 0; ///< 0: none
    double began = 0;  ///< what stood there at first
    double number = 0; ///< what stands there now
    int frame = 0;     ///< the last one that showed it
};

Typing& typing() {
    static Typing now;
    return now;
}

/// An item that is `draw`n with a number and says whether that is another one. `isTyped`: by its ID, whether it is
/// written in now.
template <class Number, class Draw, class IsTyped>
bool takes(const char* label, Number& number, const Draw& draw, const IsTyped& isTyped) {
    Typing& now = typing();
    const ImGuiID item = ImGui::GetID(label);
    const Number before = number;
    const bool wasTyped = now.field == item && now.frame + 1 == ImGui::GetFrameCount();
    // Whatever has become of `before`: to Dear ImGui a number other than that in the field is one that was written.
    number = wasTyped ? static_cast<Number>(now.number) : before;
    const bool edited = draw(number);
    if (isTyped(item)) {
        now = {item, wasTyped ? now.began : static_cast<double>(before), static_cast<double>(number),
               ImGui::GetFrameCount()};
        number = before;
        return false;
    }
    if (!wasTyped) {
        return edited;
    }
    // It was left in this frame, or after the one before.
    const bool restored = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    const bool written = static_cast<double>(number) != now.began;
    number = written && !restored ? number : before;
    now = {};
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
