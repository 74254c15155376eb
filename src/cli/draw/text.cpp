// SPDX-License-Identifier: MIT
#include "cli/draw/text.h"

#include "cli/draw/font.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb_truetype.h>

namespace voxtact::app {

namespace {

constexpr char32_t kReplacement = 0xFFFD;
constexpr std::string_view kEllipsis = "\u2026";

const stbtt_fontinfo& font() {
    static const stbtt_fontinfo info = [] {
        stbtt_fontinfo made{};
        stbtt_InitFont(&made, kFont, 0);
        return made;
    }();
    return info;
}

float scaleOf(double size) {
    return stbtt_ScaleForMappingEmToPixels(&font(), static_cast<float>(size));
}

/// Returns the length of a UTF-8 sequence from its first byte; 0: not a first byte.
std::size_t sequenceLength(unsigned char first) {
    return first < 0x80                    ? 1
           : first >= 0xC2 && first < 0xE0 ? 2
           : first >= 0xE0 && first < 0xF0 ? 3
           : first >= 0xF0 && first < 0xF5 ? 4
                                           : 0;
}

/// Removes the next UTF-8 letter from the text and returns it.
char32_t takeLetter(std::string_view& text) {
    const auto first = static_cast<unsigned char>(text.front());
    const std::size_t length = sequenceLength(first);
    if (length == 0 || length > text.size()) {
        text.remove_prefix(1);
        return kReplacement;
    }
    constexpr unsigned kLead[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
    char32_t letter = first & kLead[length];
    for (std::size_t i = 1; i < length; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xC0U) != 0x80U) {
            text.remove_prefix(i);
            return kReplacement;
        }
        letter = letter << 6U | (next & 0x3FU);
    }
    text.remove_prefix(length);
    return letter;
}

/// Calls `place` with the glyph and position of each letter. Returns the end of the text.
template <class Place> double walk(std::string_view text, double size, Place place) {
    const double scale = static_cast<double>(scaleOf(size));
    double at = 0;
    int before = 0;
    while (!text.empty()) {
        const int glyph = stbtt_FindGlyphIndex(&font(), static_cast<int>(takeLetter(text)));
        at += before != 0 ? scale * stbtt_GetGlyphKernAdvance(&font(), before, glyph) : 0;
        place(glyph, at);
        int advance = 0;
        stbtt_GetGlyphHMetrics(&font(), glyph, &advance, nullptr);
        at += scale * advance;
        before = glyph;
    }
    return at;
}

void addGlyph(Mask& mask, int glyph, double size, const Point& at) {
    const float scale = scaleOf(size);
    const auto left = std::floor(at.x);
    const auto top = std::floor(at.y);
    const auto shiftX = static_cast<float>(at.x - left);
    const auto shiftY = static_cast<float>(at.y - top);
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&font(), glyph, scale, scale, shiftX, shiftY, &x0, &y0, &x1, &y1);
    const int width = x1 - x0;
    const int height = y1 - y0;
    if (width <= 0 || height <= 0) {
        return;
    }
    std::vector<unsigned char> bits(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    stbtt_MakeGlyphBitmapSubpixel(&font(), bits.data(), width, height, width, scale, scale, shiftX, shiftY, glyph);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int column = static_cast<int>(left) + x0 + x - mask.left;
            const int row = static_cast<int>(top) + y0 + y - mask.top;
            if (column < 0 || row < 0 || column >= mask.width || row >= mask.height) {
                continue;
            }
            float& cover = mask.cover[static_cast<std::size_t>(row) * static_cast<std::size_t>(mask.width) +
                                      static_cast<std::size_t>(column)];
            const std::size_t bit =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            cover = std::max(cover, static_cast<float>(bits[bit]) / 255.0F);
        }
    }
}

/// Returns the mask dilated by `radius` pixels, softer outwards.
Mask rimOf(const Mask& mask, double radius) {
    Mask rim = mask;
    const int reach = static_cast<int>(std::ceil(radius));
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            float max = 0;
            for (int dy = -reach; dy <= reach; ++dy) {
                for (int dx = -reach; dx <= reach; ++dx) {
                    const int column = x + dx;
                    const int row = y + dy;
                    if (column < 0 || row < 0 || column >= mask.width || row >= mask.height) {
                        continue;
                    }
                    const double away = std::hypot(dx, dy);
                    const auto weight = static_cast<float>(std::clamp(radius + 1 - away, 0.0, 1.0));
                    max = std::max(
                        max, weight * mask.cover[static_cast<std::size_t>(row) * static_cast<std::size_t>(mask.width) +
                                                 static_cast<std::size_t>(column)]);
                }
            }
            rim.cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                      static_cast<std::size_t>(x)] = max;
        }
    }
    return rim;
}

} // namespace

double textWidth(std::string_view text, double size) {
    return walk(text, size, [](int, double) {});
}

double capitalHeight(double size) {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
    stbtt_GetCodepointBox(&font(), 'H', &x0, &y0, &x1, &y1);
    return static_cast<double>(scaleOf(size)) * y1;
}

std::string shortened(std::string_view text, double size, double widest) {
    if (textWidth(text, size) <= widest) {
        return std::string(text);
    }
    std::string kept;
    std::string_view rest = text;
    while (!rest.empty()) {
        std::string_view next = rest;
        takeLetter(next);
        const std::string longer = kept + std::string(rest.substr(0, rest.size() - next.size()));
        if (textWidth(longer + std::string(kEllipsis), size) > widest) {
            break;
        }
        kept = longer;
        rest = next;
    }
    return kept.empty() ? std::string() : kept + std::string(kEllipsis);
}

Mask textMask(std::string_view text, double size, const Point& base) {
    const double room = std::ceil(size);
    Mask mask;
    mask.left = static_cast<int>(std::floor(base.x - room));
    mask.top = static_cast<int>(std::floor(base.y - 2 * room));
    mask.width = static_cast<int>(std::ceil(textWidth(text, size) + 2 * room)) + 2;
    mask.height = static_cast<int>(3 * room) + 2;
    mask.cover.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height), 0);
    walk(text, size, [&](int glyph, double at) { addGlyph(mask, glyph, size, {base.x + at, base.y}); });
    return mask;
}

Colour inkOn(double brightness) {
    return brightness < 0.5 ? Colour{1, 1, 1} : Colour{0, 0, 0};
}

void drawText(Canvas& canvas, std::string_view text, double size, const Point& base) {
    constexpr double kRim = 0.09; // of an em
    constexpr double kRimOpacity = 0.7;
    const Colour ink =
        inkOn(canvas.brightness({base.x, base.y - capitalHeight(size), base.x + textWidth(text, size), base.y}));
    const Mask mask = textMask(text, size, base);
    canvas.blend(rimOf(mask, std::max(1.0, kRim * size)), {1 - ink[0], 1 - ink[1], 1 - ink[2]}, kRimOpacity);
    canvas.blend(mask, ink);
}

} // namespace voxtact::app
