// SPDX-License-Identifier: MIT
#include "viewer/panels/marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace voxtact::test {

using namespace voxtact::view;
using testing::ElementsAre;

namespace {

/// A font that is white all over.
std::shared_ptr<const Marks::Font> white() {
    auto font = std::make_shared<Marks::Font>();
    font->width = font->height = 2;
    font->rgba.assign(16, 255);
    return font;
}

Picture black(std::uint32_t width, std::uint32_t height) {
    Picture out;
    out.width = width;
    out.height = height;
    for (std::size_t i = 0; i < std::size_t{width} * height; ++i) {
        out.rgba.insert(out.rgba.end(), {0, 0, 0, 255});
    }
    return out;
}

/// Two triangles that share an edge.
Marks rectangle(const ImVec2& from, const ImVec2& to, ImU32 colour) {
    Marks out;
    out.font = white();
    for (const ImVec2& at : {from, ImVec2{to.x, from.y}, to, ImVec2{from.x, to.y}}) {
        out.vertices.push_back({at, {0.5F, 0.5F}, colour});
    }
    out.indices = {0, 1, 2, 0, 2, 3};
    return out;
}

std::vector<int> redOf(const Picture& picture) {
    std::vector<int> out;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        out.push_back(picture.rgba[i]);
    }
    return out;
}

} // namespace

TEST(ViewMarks, HaveThePixelsWhoseCentresTheyCoverEachOnce) {
    Picture picture = black(4, 3);
    // The diagonal goes through centres of pixels: half a colour twice would be more than half.
    paint(rectangle({1, 0}, {4, 3}, IM_COL32(255, 0, 0, 128)), picture);
    EXPECT_THAT(redOf(picture), ElementsAre(0, 128, 128, 128, 0, 128, 128, 128, 0, 128, 128, 128));
    EXPECT_EQ(picture.rgba[4 * 1 + 1], 0);
    EXPECT_EQ(picture.rgba[4 * 1 + 3], 255);
}

TEST(ViewMarks, MayReachOverThePicture) {
    Picture picture = black(2, 2);
    paint(rectangle({-1000, -7.5F}, {1.2F, 1e6F}, IM_COL32(255, 255, 255, 255)), picture);
    EXPECT_THAT(redOf(picture), ElementsAre(255, 0, 255, 0));
    picture = black(2, 2);
    paint(rectangle({5, 5}, {9, 9}, IM_COL32(255, 255, 255, 255)), picture);
    paint(rectangle({-5, -5}, {-1, -1}, IM_COL32(255, 255, 255, 255)), picture);
    paint(rectangle({0, 0}, {0, 2}, IM_COL32(255, 255, 255, 255)), picture);
    EXPECT_THAT(redOf(picture), ElementsAre(0, 0, 0, 0));
}

TEST(ViewMarks, ColoursGoFromCornerToCornerAndTurnsDoNotMatter) {
    Marks marks = rectangle({0, 0}, {4, 1}, IM_COL32(0, 0, 0, 255));
    marks.vertices[1].col = marks.vertices[2].col = IM_COL32(255, 0, 0, 255);
    Picture picture = black(4, 1);
    paint(marks, picture);
    const std::vector<int> colours = redOf(picture);
    EXPECT_THAT(colours, ElementsAre(32, 96, 159, 223));
    std::ranges::reverse(marks.indices);
    Picture other = black(4, 1);
    paint(marks, other);
    EXPECT_EQ(redOf(other), colours);
}

} // namespace voxtact::test
