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

TEST(WritePng, TellsHowFarItIsAndEndsWhereItIsTold) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> rgba = pattern(300, 20);
    std::uint32_t last = 0;
    const auto until = [&last](std::uint32_t end) {
        return [&last, end](std::uint32_t done, std::uint32_t rows) {
            EXPECT_EQ(rows, 20U);
            EXPECT_EQ(done, last + 1);
            last = done;
            return done < end;
        };
    };
    ASSERT_TRUE(isOk(io::writePng(folder / "a.png", 300, 20, rgba, until(100))));
    EXPECT_EQ(last, 20U);
    EXPECT_EQ(readPng(folder / "a.png").rgba, rgba);
    // A file that is there stays what it was.
    last = 0;
    const std::vector<std::uint8_t> other(rgba.size(), 7);
    const Result<void> cancelled = io::writePng(folder / "a.png", 300, 20, other, until(12));
    ASSERT_FALSE(cancelled.ok());
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
    EXPECT_EQ(last, 12U);
    EXPECT_EQ(readPng(folder / "a.png").rgba, rgba);
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(WritePng, EveryWayToFilterARowIsReadBack) {
    // Rows that one way suits best: noise, slopes along and across and both, and none.
    const TemporaryFolder folder;
    constexpr std::uint32_t kSide = 64;
    std::vector<std::uint8_t> rgba(4 * kSide * kSide);
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        const std::size_t x = i / 4 % kSide;
        const std::size_t y = i / 4 / kSide;
        rgba[i] = static_cast<std::uint8_t>(y < 12   ? (i * i * 7919 + i) >> 3U
                                            : y < 24 ? 3 * x + 40 * (i % 4)
                                            : y < 36 ? 200 - 2 * y + (x * 97) % 31
                                            : y < 48 ? 2 * x + 3 * y
                                                     : 9);
    }
    ASSERT_TRUE(isOk(io::writePng(folder / "a.png", kSide, kSide, rgba)));
    EXPECT_EQ(readPng(folder / "a.png").rgba, rgba);
}

} // namespace
} // namespace voxtact::test
