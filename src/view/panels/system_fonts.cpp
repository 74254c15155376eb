// SPDX-License-Identifier: MIT
#include "view/panels/system_fonts.h"

#include <fontconfig/fontconfig.h>

#include <memory>

namespace voxtact::view {

namespace {

struct PatternEnd {
    void operator()(FcPattern* pattern) const { FcPatternDestroy(pattern); }
};
struct CharSetEnd {
    void operator()(FcCharSet* letters) const { FcCharSetDestroy(letters); }
};
struct FontSetEnd {
    void operator()(FcFontSet* fonts) const { FcFontSetDestroy(fonts); }
};

/// All fonts of outlines, the nearest first; null where there is no memory.
std::unique_ptr<FcFontSet, FontSetEnd> fontsNearest(const Letters& letters) {
    const std::unique_ptr<FcCharSet, CharSetEnd> wanted(FcCharSetCreate());
    for (const char32_t letter : letters) {
        FcCharSetAddChar(wanted.get(), letter);
    }
    const std::unique_ptr<FcPattern, PatternEnd> pattern(FcPatternCreate());
    FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
    FcPatternAddCharSet(pattern.get(), FC_CHARSET, wanted.get());
    FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
    FcConfigSubstitute(nullptr, pattern.get(), FcMatchPattern);
    FcDefaultSubstitute(pattern.get());
    FcResult result = FcResultMatch;
    return std::unique_ptr<FcFontSet, FontSetEnd>(FcFontSort(nullptr, pattern.get(), FcTrue, nullptr, &result));
}

/// What a font has of the letters, which are taken from them; no file where it has none, or is one of bitmaps.
SystemFont taken(const FcPattern& font, Letters& letters) {
    FcChar8* file = nullptr;
    FcCharSet* has = nullptr;
    FcBool isOutline = FcFalse;
    SystemFont out;
    const bool known = FcPatternGetString(&font, FC_FILE, 0, &file) == FcResultMatch &&
                       FcPatternGetCharSet(&font, FC_CHARSET, 0, &has) == FcResultMatch &&
                       FcPatternGetBool(&font, FC_OUTLINE, 0, &isOutline) == FcResultMatch && isOutline == FcTrue;
    if (!known) {
        return out;
    }
    FcPatternGetInteger(&font, FC_INDEX, 0, &out.number);
    std::erase_if(letters, [&out, has](char32_t letter) {
        const bool mine = FcCharSetHasChar(has, letter) == FcTrue;
        if (mine) {
            out.letters.insert(letter);
        }
        return mine;
    });
    out.file = out.letters.empty() ? "" : reinterpret_cast<const char*>(file);
    return out;
}

} // namespace

std::vector<SystemFont> systemFontsFor(Letters letters) {
    std::vector<SystemFont> out;
    const std::unique_ptr<FcFontSet, FontSetEnd> fonts = fontsNearest(letters);
    for (int i = 0; fonts && i < fonts->nfont && !letters.empty(); ++i) {
        if (SystemFont font = taken(*fonts->fonts[i], letters); !font.file.empty()) {
            out.push_back(std::move(font));
        }
    }
    return out;
}

} // namespace voxtact::view
