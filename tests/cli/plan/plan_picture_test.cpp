// SPDX-License-Identifier: MIT
// voxtact plan --picture.
#include "cli/cli_fixture.h"
#include "support/read_png.h"

#include <algorithm>
#include <functional>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class PlanPictureTest : public CliDeviceTest {
  protected:
    void SetUp() override {
        CliDeviceTest::SetUp();
        output({"make", "volume", "builtin:head:32", path("labels.nii.gz")});
    }
    [[nodiscard]] Arguments asked(const Arguments& more) const {
        Arguments all{"plan",
                      "--volume",
                      "builtin:head:32",
                      "--labels",
                      path("labels.nii.gz"),
                      "--target",
                      "20,0,30",
                      "--avoid",
                      "120",
                      "--entries",
                      "642",
                      "--max",
                      "20",
                      "--output",
                      path("rows.csv")};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    using Colour = std::array<int, 3>;
    /// Pixels in the columns from `from` to before `to`.
    static std::size_t count(const PngPicture& picture, int from, int to, const std::function<bool(Colour)>& is) {
        std::size_t found = 0;
        for (int y = 0; y < picture.height; ++y) {
            for (int x = from; x < to; ++x) {
                const auto* at = &picture.rgba.at(static_cast<std::size_t>(4 * (y * picture.width + x)));
                found += is({at[0], at[1], at[2]}) ? 1 : 0;
            }
        }
        return found;
    }
    static std::string decoded(const std::string& text) {
        const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out;
        unsigned bits = 0;
        int have = 0;
        for (const char one : text.substr(0, text.find('='))) {
            bits = bits << 6U | static_cast<unsigned>(digits.find(one));
            have += 6;
            if (have >= 8) {
                have -= 8;
                out += static_cast<char>(bits >> have & 255U);
            }
        }
        return out;
    }
};

TEST_F(PlanPictureTest, WithoutAnythingToShowOfTheEntries) {
    // Two paths, none of them safe, and no triangle between neighbours: neither entries nor an instrument to draw.
    output({"plan", "--volume", "builtin:head:32", "--target", "20,0,30", "--avoid-opacity", "100:0,160:1", "--entries",
            "42", "--max-angle", "5", "--output", path("rows.csv"), "--picture", path("none.png"), "--size", "96x64"});
    const PngPicture seen = readPng(path("none.png"));
    EXPECT_EQ(seen.width, 96); // one half: there is no path to cut along
    EXPECT_EQ(seen.height, 64);
}

TEST_F(PlanPictureTest, ShowsEntriesAndTheBestPath) {
    output(asked({"--picture", path("best.png"), "--size", "400x360", "--report", path("page.html"), "--validate"}));
    const PngPicture seen = readPng(path("best.png"));
    ASSERT_EQ(seen.width, 800); // two halves
    ASSERT_EQ(seen.height, 360);
    const auto isRed = [](Colour c) { return c[0] > 120 && c[1] < 70 && c[2] < 70; };
    const auto isSafe = [](Colour c) { return c[1] > c[0] + 30 || c[2] > c[0] + 30; };
    EXPECT_GT(count(seen, 0, 400, isRed), 300U) << "unsafe entries";
    EXPECT_GT(count(seen, 0, 400, isSafe), 300U) << "safe ones";
    // The needle has its tip in the middle of what is cut, where nothing else is as light.
    const auto isLight = [](Colour c) { return c[0] > 225 && c[1] > 225 && c[2] > 225; };
    EXPECT_GT(count(seen, 520, 600, isLight), 20U);
    // The same is in the page, which needs no network.
    const std::string html = readText(path("page.html"));
    const std::string before = "src=\"data:image/png;base64,";
    const std::size_t at = html.find(before);
    ASSERT_NE(at, std::string::npos);
    const std::size_t first = at + before.size();
    EXPECT_EQ(decoded(html.substr(first, html.find('"', first) - first)), readText(path("best.png")));
    EXPECT_THAT(html, testing::Not(HasSubstr("http")));
}

TEST_F(PlanPictureTest, ShowsWhatIsAvoidedAtTheCut) {
    const auto isOrange = [](Colour c) { return c[0] > 190 && c[1] > 90 && c[1] < 180 && c[2] < 70; };
    const auto orange = [&](const std::string& label) {
        Arguments all = asked({"--picture", path("cut.png"), "--size", "400x360"});
        std::replace(all.begin(), all.end(), std::string("120"), label);
        output(all);
        const PngPicture seen = readPng(path("cut.png"));
        return count(seen, 400, seen.width, isOrange);
    };
    // 478 voxels all over the cut, and 42 of which hardly any is there.
    EXPECT_GT(orange("225"), orange("120") + 150);
}

TEST_F(PlanPictureTest, ShowsEntriesWhereNoPathIsSafe) {
    const std::string picture = path("none.png");
    output(asked({"--picture", picture, "--size", "200x160", "--margin", "60"}));
    const PngPicture seen = readPng(picture);
    EXPECT_EQ(seen.width, 200);
    EXPECT_GT(count(seen, 0, 200, [](Colour c) { return c[0] > 120 && c[1] < 70 && c[2] < 70; }), 2000U);
}

TEST_F(PlanPictureTest, AMeshIsShownWhereItIsHeld) {
    output({"make", "mesh", "builtin:needle:6:70", path("tool.stl")});
    output(asked({"--picture", path("mesh.png"), "--size", "400x360", "--mesh", path("tool.stl"), "--tip", "0,0,0",
                  "--axis", "0,0,1"}));
    const auto isLight = [](Colour c) { return c[0] > 225 && c[1] > 225 && c[2] > 225; };
    EXPECT_GT(count(readPng(path("mesh.png")), 500, 640, isLight), 100U);
}

class PlanPictureRefusals : public CliTest {};

TEST_F(PlanPictureRefusals, AreOneLine) {
    const auto line = [&](int status, const Arguments& more) {
        Arguments all{"plan", "--volume", "builtin:head:32", "--target", "20,0,30", "--avoid-opacity", "200:0,201:1"};
        all.insert(all.end(), more.begin(), more.end());
        return refused(status, all);
    };
    EXPECT_THAT(line(2, {"--picture", path("a.jpg")}), HasSubstr("--picture: the ending of"));
    EXPECT_THAT(line(2, {"--size", "64x64"}), HasSubstr("--size: it applies to a picture"));
    EXPECT_THAT(line(2, {"--device", "0"}), HasSubstr("--device: it applies to a picture"));
    EXPECT_THAT(line(2, {"--picture", path("a.png"), "--device", "no such device"}), HasSubstr("'no such device'"));
    const RunOptions none{.environment = {{"VK_ICD_FILENAMES", "/nonexistent"}, {"VK_DRIVER_FILES", "/nonexistent"}}};
    EXPECT_THAT(refused(1,
                        {"plan", "--volume", "builtin:head:32", "--target", "20,0,30", "--avoid-opacity", "200:0,201:1",
                         "--picture", path("a.png")},
                        none),
                HasSubstr("--picture needs a Vulkan device: "));
    EXPECT_EQ(filesInFolder(), 0U);
}

} // namespace
} // namespace voxtact::test
