// SPDX-License-Identifier: MIT
#pragma once

#include "cli/cli_fixture.h"
#include "support/read_png.h"

#include <algorithm>
#include <array>

/// What tests of voxtact render share.
namespace voxtact::test {

inline Arguments render(const std::string& output, const Arguments& more = {}) {
    Arguments all{"render", "--volume", "builtin:head:32", "--size", "64x48", "--output", output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

class RenderPictureTest : public CliDeviceTest {
  protected:
    PngPicture picture(const Arguments& more = {}) {
        EXPECT_EQ(output(render(path("a.png"), more)), "");
        EXPECT_EQ(filesInFolder(), 1U);
        PngPicture read = readPng(path("a.png"));
        EXPECT_EQ(read.width, 64);
        EXPECT_EQ(read.height, 48);
        return read;
    }
};

inline std::array<int, 3> pixel(const PngPicture& picture, int x, int y) {
    const auto at = static_cast<std::size_t>(4 * (picture.width * y + x));
    return {picture.rgba.at(at), picture.rgba.at(at + 1), picture.rgba.at(at + 2)};
}

inline std::size_t pixelsOf(const PngPicture& picture, const std::array<int, 3>& colour) {
    std::size_t count = 0;
    for (int i = 0; i < picture.width * picture.height; ++i) {
        count += pixel(picture, i % picture.width, i / picture.width) == colour ? 1U : 0U;
    }
    return count;
}

template <class Is> std::size_t pixelsThat(const PngPicture& picture, Is is) {
    std::size_t count = 0;
    for (int i = 0; i < picture.width * picture.height; ++i) {
        const auto [red, green, blue] = pixel(picture, i % picture.width, i / picture.width);
        count += is(red, green, blue) ? 1U : 0U;
    }
    return count;
}

inline bool isRed(int red, int green, int blue) {
    return red > 2 * green && red > 2 * blue;
}
inline bool isBlue(int red, int green, int blue) {
    return 2 * blue > 3 * red && 2 * blue > 3 * green;
}

} // namespace voxtact::test
