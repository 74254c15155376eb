// SPDX-License-Identifier: MIT
#include "view/panels/fonts.h"

#include "view/model/shown/letters.h"
#include "view/panels/panels.h"
#include "view/panels/system_fonts.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <deque>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

namespace voxtact::view {

namespace {

constexpr float kFontSize = 15;
constexpr float kLetterSize = 32;          // of the letters of the patient's sides
constexpr std::size_t kMostLetters = 8000; // what has room in a texture of any device

/// What the fonts are made of.
struct FontMaker {
    float scale = 1;
    std::span<const unsigned char> font;
    Letters letters; ///< that were asked for, whether there is a font that has them
};

FontMaker& maker() {
    static FontMaker all;
    return all;
}

ImVector<ImWchar> rangesOf(const Letters& letters) {
    ImFontGlyphRangesBuilder builder;
    for (const char32_t letter : letters) {
        builder.AddChar(static_cast<ImWchar>(letter));
    }
    ImVector<ImWchar> ranges;
    builder.BuildRanges(&ranges);
    return ranges;
}

void addFont(std::span<const unsigned char> bytes, float size, const ImWchar* ranges, int number, bool more) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.FontNo = number;
    config.MergeMode = more;
    // Dear ImGui only reads it.
    ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(bytes.data()), static_cast<int>(bytes.size()),
                                               size * maker().scale, &config, ranges);
}

std::vector<unsigned char> bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Whether all that is asked for could be made: a file of the system may be broken.
bool build(const std::vector<SystemFont>& others) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    // Until it is built it reads all of these, where they are.
    std::deque<ImVector<ImWchar>> ranges{rangesOf(maker().letters)};
    std::deque<std::vector<unsigned char>> files;
    addFont(maker().font, kFontSize, atlas.GetGlyphRangesDefault(), 0, false);
    if (!maker().letters.empty()) {
        addFont(maker().font, kFontSize, ranges.front().Data, 0, true);
    }
    for (const SystemFont& other : others) {
        files.push_back(bytesOf(other.file));
        ranges.push_back(rangesOf(other.letters));
        if (!files.back().empty()) {
            addFont(files.back(), kFontSize, ranges.back().Data, other.number, true);
        }
    }
    // Pairs of the first and the last, ended by a zero.
    constexpr std::array<ImWchar, 3> kLetters{'A', 'Z', 0};
    addFont(maker().font, kLetterSize, kLetters.data(), 0, false);
    const bool built = atlas.Build();
    atlas.ClearInputData();
    return built;
}

Letters missing() {
    const ImFont& font = *ImGui::GetIO().Fonts->Fonts.front();
    Letters out = maker().letters;
    std::erase_if(
        out, [&font](char32_t letter) { return font.FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr; });
    return out;
}

void makeAnew() {
    static_cast<void>(build({}));
    const Letters others = missing();
    if (!others.empty() && !build(systemFontsFor(others))) {
        static_cast<void>(build({}));
    }
}

} // namespace

void makeFonts(float scale, std::span<const unsigned char> font) {
    maker() = {scale, font, {}};
    makeAnew();
}

bool fitFonts(const State& state) {
    Letters& known = maker().letters;
    const std::size_t before = known.size();
    for (const char32_t letter : lettersOf(state)) {
        if (letter <= std::numeric_limits<ImWchar>::max() && known.size() < kMostLetters) {
            known.insert(letter);
        }
    }
    if (known.size() == before) {
        return false;
    }
    makeAnew();
    return true;
}

float scaled(float length) {
    return length * ImGui::GetFontSize() / kFontSize;
}

const ImFont& letterFont() {
    return *ImGui::GetIO().Fonts->Fonts.back();
}

} // namespace voxtact::view
