// SPDX-License-Identifier: MIT
#include "viewer/panels/panels.h"

#include "voxtact/render.h"

#include <algorithm>
#include <array>
#include <vector>

namespace voxtact::view {

namespace {

constexpr float kFontSize = 15;
constexpr float kLetterSize = 32; // of the letters of the patient's sides

ImVec4 rgb(int red, int green, int blue, float alpha = 1) {
    constexpr float kMost = 255;
    return {static_cast<float>(red) / kMost, static_cast<float>(green) / kMost, static_cast<float>(blue) / kMost,
            alpha};
}

void darkColours(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    const auto set = [&style](std::initializer_list<ImGuiCol> which, const ImVec4& colour) {
        for (const ImGuiCol one : which) {
            style.Colors[one] = colour;
        }
    };
    set({ImGuiCol_WindowBg, ImGuiCol_MenuBarBg}, rgb(24, 27, 32));
    set({ImGuiCol_ChildBg}, rgb(31, 35, 41));
    set({ImGuiCol_PopupBg}, rgb(36, 40, 47));
    set({ImGuiCol_Border}, rgb(52, 58, 67));
    set({ImGuiCol_Text}, rgb(222, 226, 232));
    set({ImGuiCol_TextDisabled}, rgb(134, 143, 155));
    set({ImGuiCol_FrameBg}, rgb(43, 48, 56));
    set({ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered}, rgb(62, 76, 96));
    set({ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive}, rgb(70, 98, 138));
    set({ImGuiCol_Button}, rgb(50, 57, 67));
    set({ImGuiCol_Header}, rgb(50, 66, 90));
    set({ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive}, rgb(62, 86, 122));
    set({ImGuiCol_SliderGrab, ImGuiCol_CheckMark}, rgb(96, 160, 240));
    set({ImGuiCol_SliderGrabActive}, rgb(130, 184, 250));
    set({ImGuiCol_Separator}, rgb(52, 58, 67));
    set({ImGuiCol_ScrollbarBg}, rgb(28, 31, 37));
    set({ImGuiCol_TableHeaderBg}, rgb(43, 48, 56));
    set({ImGuiCol_TitleBgActive}, rgb(42, 56, 78));
}

} // namespace

ImVec4 instrumentColour(std::size_t mesh) {
    const Colour colour = meshColour(mesh);
    return {static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2]), 1};
}

void setColours(Theme theme) {
    ImGuiStyle& style = ImGui::GetStyle();
    if (theme == Theme::Dark) {
        darkColours(style);
    } else {
        ImGui::StyleColorsLight(&style);
        style.Colors[ImGuiCol_ChildBg] = rgb(250, 250, 251);
        style.Colors[ImGuiCol_WindowBg] = rgb(233, 236, 240);
        style.Colors[ImGuiCol_TextDisabled] = rgb(92, 98, 106);
        style.Colors[ImGuiCol_SliderGrab] = style.Colors[ImGuiCol_CheckMark] = rgb(24, 96, 190); // headings, too
    }
}

void applyTheme(float scale, std::span<const unsigned char> font) {
    ImGuiStyle& style = ImGui::GetStyle();
    setColours(Theme::Dark);
    style.WindowPadding = {8, 8};
    style.FramePadding = {7, 3};
    style.ItemSpacing = {7, 5};
    style.ItemInnerSpacing = {6, 4};
    style.WindowRounding = 5;
    style.ChildRounding = 5;
    style.FrameRounding = 4;
    style.GrabRounding = 4;
    style.PopupRounding = 5;
    style.WindowBorderSize = 0;
    style.ScaleAllSizes(scale);
    // Tolerance for small motions of a click.
    ImGui::GetIO().MouseDragThreshold *= scale;
    ImGui::GetIO().MouseDoubleClickMaxDist *= scale;
    // Pairs of the first and the last, ended by a zero; the atlas reads them later.
    static constexpr std::array<ImWchar, 3> kLetters{'A', 'Z', 0};
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    // Dear ImGui only reads it.
    ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(font.data()), static_cast<int>(font.size()),
                                               kFontSize * scale, &config);
    ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(font.data()), static_cast<int>(font.size()),
                                               kLetterSize * scale, &config, kLetters.data());
}

float scaled(float length) {
    return length * ImGui::GetFontSize() / kFontSize;
}

const ImFont& letterFont() {
    return *ImGui::GetIO().Fonts->Fonts.back();
}

ImVec4 verdictOnPicture(int hit) {
    return hit == 0 ? rgb(92, 200, 130) : hit == 1 ? rgb(255, 104, 74) : rgb(245, 196, 66);
}

ImVec4 verdictColour(int hit) {
    const ImVec4& card = ImGui::GetStyle().Colors[ImGuiCol_ChildBg];
    constexpr float kHalf = 1.5F; // of three channels
    if (card.x + card.y + card.z < kHalf) {
        return verdictOnPicture(hit);
    }
    return hit == 0 ? rgb(22, 128, 61) : hit == 1 ? rgb(204, 42, 18) : rgb(158, 104, 0);
}

ImU32 closestColour(float alpha) {
    return ImGui::GetColorU32(rgb(130, 235, 165, alpha));
}

ImVec4 quietColour() {
    return ImGui::GetStyle().Colors[ImGuiCol_TextDisabled];
}

void heading(const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_SliderGrab]);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
}

void addRimmed(ImDrawList& list, const ImVec2& at, ImU32 colour, const char* text) {
    const float by = scaled(1);
    for (const ImVec2& side : {ImVec2{-by, 0}, ImVec2{by, 0}, ImVec2{0, -by}, ImVec2{0, by}, ImVec2{by, by}}) {
        list.AddText({at.x + side.x, at.y + side.y}, IM_COL32(0, 0, 0, 190), text);
    }
    list.AddText(at, colour, text);
}

std::string shortened(const std::string& text, float width) {
    if (text.empty() || ImGui::CalcTextSize(text.c_str()).x <= width) {
        return text;
    }
    constexpr const char* kDots = "...";
    const float room = std::max(width - ImGui::CalcTextSize(kDots).x, 0.0F);
    const char* end = nullptr;
    ImGui::GetFont()->CalcTextSizeA(ImGui::GetFontSize(), room, 0, text.data(), text.data() + text.size(), &end);
    return std::string(text.data(), end) + kDots;
}

std::string fitting(std::initializer_list<std::string> texts, float width) {
    const auto* const fits = std::ranges::find_if(
        texts, [width](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x <= width; });
    return fits != texts.end() ? *fits : *(texts.end() - 1);
}

void shortLine(const ImVec4& colour, const std::string& text) {
    const std::string line = shortened(text, ImGui::GetContentRegionAvail().x);
    ImGui::TextColored(colour, "%s", line.c_str());
    if (line != text && ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", text.c_str());
    }
}

float widthOfButton(const char* text) {
    return ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
}

float widthOfCheckbox(const char* text) {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(text).x;
}

void sameLine(float width) {
    const float right = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width;
    if (right <= ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x) {
        ImGui::SameLine();
    }
}

ImVec2 draggedBy() {
    const ImGuiIO& io = ImGui::GetIO();
    const bool pressed = std::ranges::any_of(io.MouseClicked, [](bool one) { return one; });
    return pressed ? ImVec2{0, 0} : io.MouseDelta;
}

Point2 mouseIn(const ImVec2& corner, const ImVec2& size) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return {static_cast<double>((mouse.x - corner.x) / size.x), static_cast<double>((mouse.y - corner.y) / size.y)};
}

} // namespace voxtact::view
