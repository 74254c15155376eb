// SPDX-License-Identifier: MIT
#include "viewer/panels/marks.h"

#include "viewer/panels/onto.h"
#include "viewer/panels/panels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::view {

namespace {

/// Red, green, blue and alpha, 0..1.
using Pixel = std::array<float, 4>;

constexpr float kMost = 255;

Pixel pixelOf(const unsigned char* bytes) {
    Pixel out{};
    std::transform(bytes, bytes + 4, out.begin(), [](unsigned char byte) { return static_cast<float>(byte) / kMost; });
    return out;
}

Pixel pixelOf(ImU32 colour) {
    const ImVec4 value = ImGui::ColorConvertU32ToFloat4(colour);
    return {value.x, value.y, value.z, value.w};
}

/// Samples the font bilinearly at a position, 0..1.
Pixel sample(const Marks::Font& font, float u, float v) {
    const float x = std::clamp(u * static_cast<float>(font.width) - 0.5F, 0.0F, static_cast<float>(font.width - 1));
    const float y = std::clamp(v * static_cast<float>(font.height) - 0.5F, 0.0F, static_cast<float>(font.height - 1));
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    Pixel out{};
    for (int corner = 0; corner < 4; ++corner) {
        const int column = std::min(left + corner % 2, font.width - 1);
        const int row = std::min(top + corner / 2, font.height - 1);
        const float alongX = x - static_cast<float>(left);
        const float alongY = y - static_cast<float>(top);
        const float weight = (corner % 2 == 1 ? alongX : 1 - alongX) * (corner / 2 == 1 ? alongY : 1 - alongY);
        const std::size_t texel =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(font.width) + static_cast<std::size_t>(column);
        const Pixel of = pixelOf(font.rgba.data() + 4 * texel);
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] += weight * of[i];
        }
    }
    return out;
}

void blend(unsigned char* pixel, const Pixel& colour) {
    const Pixel under = pixelOf(pixel);
    const float alpha = colour[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const float mixed = under[i] * (1 - alpha) + colour[i] * alpha;
        pixel[i] = static_cast<unsigned char>(std::lround(std::clamp(mixed, 0.0F, 1.0F) * kMost));
    }
}

/// Twice the area to the left of the way from a to b, as seen from p.
float side(const ImVec2& a, const ImVec2& b, const ImVec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// One of two adjacent triangles owns the pixels on their edge.
bool owns(const ImVec2& a, const ImVec2& b) {
    return a.y == b.y ? b.x > a.x : b.y < a.y;
}

class Triangle {
  public:
    Triangle(const ImDrawVert& a, ImDrawVert b, ImDrawVert c) : corners_{a, b, c} {
        area_ = side(a.pos, b.pos, c.pos);
        if (area_ < 0) {
            std::swap(corners_[1], corners_[2]);
            area_ = -area_;
        }
    }

    void paint(const Marks::Font& font, Picture& picture) const {
        if (!(area_ > 0)) {
            return;
        }
        const auto [left, right] = reach(&ImVec2::x, picture.width);
        const auto [top, bottom] = reach(&ImVec2::y, picture.height);
        for (std::uint32_t y = top; y < bottom; ++y) {
            for (std::uint32_t x = left; x < right; ++x) {
                paintPixel(font, {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F},
                           picture.rgba.data() + 4 * (std::size_t{y} * picture.width + x));
            }
        }
    }

  private:
    /// The pixels between which it lies along an axis.
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> reach(float ImVec2::*axis, std::uint32_t most) const {
        const auto [least, greatest] =
            std::minmax({corners_[0].pos.*axis, corners_[1].pos.*axis, corners_[2].pos.*axis});
        const auto within = [most](float at) {
            return static_cast<std::uint32_t>(std::clamp(at, 0.0F, static_cast<float>(most)));
        };
        return {within(std::floor(least)), within(std::ceil(greatest))};
    }

    void paintPixel(const Marks::Font& font, const ImVec2& at, unsigned char* pixel) const {
        std::array<float, 3> weights{};
        for (std::size_t i = 0; i < 3; ++i) {
            const ImVec2& from = corners_[(i + 1) % 3].pos;
            const ImVec2& to = corners_[(i + 2) % 3].pos;
            const float inside = side(from, to, at);
            if (inside < 0 || (inside == 0 && !owns(from, to))) {
                return;
            }
            weights[i] = inside / area_;
        }
        Pixel colour{};
        ImVec2 uv{0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
            const Pixel corner = pixelOf(corners_[i].col);
            for (std::size_t channel = 0; channel < 4; ++channel) {
                colour[channel] += weights[i] * corner[channel];
            }
            uv.x += weights[i] * corners_[i].uv.x;
            uv.y += weights[i] * corners_[i].uv.y;
        }
        const Pixel texel = sample(font, uv.x, uv.y);
        for (std::size_t channel = 0; channel < 4; ++channel) {
            colour[channel] *= texel[channel];
        }
        blend(pixel, colour);
    }

    std::array<ImDrawVert, 3> corners_;
    float area_ = 0; ///< twice
};

std::shared_ptr<const Marks::Font> fontOf() {
    unsigned char* pixels = nullptr;
    auto font = std::make_shared<Marks::Font>();
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &font->width, &font->height);
    font->rgba.assign(pixels, pixels + std::size_t{4} * static_cast<std::size_t>(font->width) *
                                           static_cast<std::size_t>(font->height));
    return font;
}

} // namespace

Marks marksOf(const State& state, const Extent& extent) {
    constexpr float kLeast = 0.5F;
    const auto height = static_cast<float>(extent.height);
    const float scale = std::max(height / static_cast<float>(std::max(state.picture.size[1], 1.0)), kLeast);
    const ImVec2 size{static_cast<float>(extent.width) / scale, height / scale};
    ImDrawList list(ImGui::GetDrawListSharedData());
    list._ResetForNewFrame();
    list.PushTextureID(ImGui::GetIO().Fonts->TexID);
    list.PushClipRect({0, 0}, size);
    drawMarks(state, Onto{clipFromWorld(state.camera, extent, 1), {0, 0}, size}, list);
    Marks out;
    out.font = fontOf();
    out.vertices.assign(list.VtxBuffer.begin(), list.VtxBuffer.end());
    for (ImDrawVert& vertex : out.vertices) {
        vertex.pos = {vertex.pos.x * scale, vertex.pos.y * scale};
    }
    for (const ImDrawCmd& draw : list.CmdBuffer) {
        for (unsigned i = 0; i < draw.ElemCount; ++i) {
            const int at = static_cast<int>(draw.IdxOffset + i);
            out.indices.push_back(draw.VtxOffset + list.IdxBuffer[at]);
        }
    }
    return out;
}

void paint(const Marks& marks, Picture& picture) {
    for (std::size_t i = 0; i + 2 < marks.indices.size(); i += 3) {
        Triangle(marks.vertices[marks.indices[i]], marks.vertices[marks.indices[i + 1]],
                 marks.vertices[marks.indices[i + 2]])
            .paint(*marks.font, picture);
    }
}

} // namespace voxtact::view
