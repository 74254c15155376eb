// SPDX-License-Identifier: MIT
#include "io_test_support.h"
#include "support/read_png.h"

namespace voxtact::test {
namespace {

/// Every byte different from its neighbours.
std::vector<std::uint8_t> pattern(std::size_t width, std::size_t height) {
    std::vector<std::uint8_t> rgba(4 * width * height);
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        rgba[i] = static_cast<std::uint8_t>(37 * i + i / 11);
    }
    return rgba;
}

TEST(WritePng, IsReadBack) {
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair{1U, 1U}, {7U, 5U}, {300U, 2U}}) {
        const std::vector<std::uint8_t> rgba = pattern(width, height);
        ASSERT_TRUE(isOk(io::writePng(folder / "a.PNG", width, height, rgba)));
        const PngPicture picture = readPng(folder / "a.PNG");
        EXPECT_EQ(picture.width, static_cast<int>(width));
        EXPECT_EQ(picture.height, static_cast<int>(height));
        EXPECT_EQ(picture.rgba, rgba);
    }
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(WritePng, RefusesWhatIsNone) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> rgba = pattern(2, 2);
    expectRefused(io::writePng(folder / "a.jpg", 2, 2, rgba), "the ending of a picture is .png", folder / "a.jpg");
    expectRefused(io::writePng(folder / "a.png", 2, 3, rgba), "four a pixel");
    expectRefused(io::writePng(folder / "a.png", 0, 0, {}), "four a pixel");
    expectRefused(io::writePng(folder / "absent" / "a.png", 2, 2, rgba), "does not exist");
    EXPECT_EQ(folder.entries(), 0U);
}

} // namespace
} // namespace voxtact::test
