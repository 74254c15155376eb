// SPDX-License-Identifier: MIT
#include "shown_panels.h"
#include "view/panels/fonts.h"
#include "view/panels/system_fonts.h"

#include <gtest/gtest.h>

namespace voxtact::test {

using namespace voxtact::view;

namespace {

bool hasGlyph(char32_t letter) {
    return ImGui::GetIO().Fonts->Fonts.front()->FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr;
}

constexpr char32_t kOmega = 0x3C9;   // in the program's font
constexpr char32_t kBrain = 0x8111;  // a Chinese letter, which is not
constexpr char32_t kNobody = 0xE123; // of private use

} // namespace

TEST(ViewFonts, HaveTheLettersOfTheTextsThatThereAre) {
    State state = smallState();
    ShownPanels panels(state);
    EXPECT_FALSE(fitFonts(state));
    EXPECT_FALSE(hasGlyph(kOmega));
    const float before = ImGui::GetFontSize();
    state.labels = Labels{{}, {{1, "\xCF\x89"}, {2, "\xE8\x84\x91"}, {3, "\xEE\x84\xA3"}}};
    EXPECT_TRUE(fitFonts(state));
    EXPECT_TRUE(hasGlyph('a'));
    EXPECT_TRUE(hasGlyph(kOmega));
    EXPECT_TRUE(hasGlyph(kBrain));
    EXPECT_FALSE(hasGlyph(kNobody));
    // Once: also for those that nobody has.
    EXPECT_FALSE(fitFonts(state));
    panels.frame();
    EXPECT_EQ(ImGui::GetFontSize(), before);
    EXPECT_NE(letterFont().FindGlyphNoFallback('A'), nullptr);
    EXPECT_EQ(letterFont().FindGlyphNoFallback('a'), nullptr);
}

TEST(ViewFonts, EachLetterIsOfOneFontOfTheSystem) {
    const std::vector<SystemFont> fonts = systemFontsFor({kBrain, kBrain + 1, kNobody});
    Letters all;
    for (const SystemFont& font : fonts) {
        EXPECT_FALSE(font.file.empty());
        for (const char32_t letter : font.letters) {
            EXPECT_TRUE(all.insert(letter).second);
        }
    }
    EXPECT_TRUE(all.contains(kBrain) && all.contains(kBrain + 1));
    EXPECT_FALSE(all.contains(kNobody));
    EXPECT_TRUE(systemFontsFor({kNobody}).empty());
}

} // namespace voxtact::test
