// SPDX-License-Identifier: MIT
// voxtact render.
#include "cli_fixture.h"
#include "support/read_png.h"

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Arguments render(const std::string& output, const Arguments& more = {}) {
    Arguments all{"render", "--volume", "builtin:head:32", "--size", "64x48", "--output", output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

class RenderCliTest : public CliTest {};

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

std::array<int, 3> pixel(const PngPicture& picture, int x, int y) {
    const auto at = static_cast<std::size_t>(4 * (picture.width * y + x));
    return {picture.rgba.at(at), picture.rgba.at(at + 1), picture.rgba.at(at + 2)};
}

std::size_t pixelsOf(const PngPicture& picture, const std::array<int, 3>& colour) {
    std::size_t count = 0;
    for (int i = 0; i < picture.width * picture.height; ++i) {
        count += pixel(picture, i % picture.width, i / picture.width) == colour ? 1U : 0U;
    }
    return count;
}

TEST_F(RenderPictureTest, VolumeBeforeTheBackground) {
    const PngPicture head = picture({"--preset", "mr", "--background", "0a141e", "--validate"});
    const std::array<int, 3> background{10, 20, 30};
    EXPECT_EQ(pixel(head, 0, 0), background);
    EXPECT_NE(pixel(head, 32, 24), background);
    EXPECT_GT(pixelsOf(head, background), 500U);
}

TEST_F(RenderPictureTest, MeshIsSolidAndWhereThePosePutsIt) {
    // Before the face, where nothing hides it, and behind the head.
    writeText(path("cube.obj"), "v -20 -20 -20\nv 20 -20 -20\nv 20 -20 20\nv -20 -20 20\nf 1 2 3\nf 1 3 4\n");
    const std::string poses = path("poses.txt");
    writeText(poses, "1 0 0 0  0 1 0 -300  0 0 1 0  0 0 0 1\n1 0 0 0  0 1 0 300  0 0 1 0  0 0 0 1\n");
    const auto red = [&](const char* pose, const char* view) {
        output(render(path("b.png"), {"--preset", "mr", "--mesh", path("cube.obj"), "--poses", poses, "--pose", pose,
                                      "--mesh-colour", "ff0000", "--view", view}));
        const PngPicture seen = readPng(path("b.png"));
        const auto colour = pixel(seen, 32, 24);
        return colour[0] > 200 && colour[0] > 2 * colour[1];
    };
    EXPECT_TRUE(red("0", "front"));
    EXPECT_FALSE(red("1", "front"));
    EXPECT_FALSE(red("0", "back"));
    EXPECT_TRUE(red("1", "back"));
}

TEST_F(RenderPictureTest, NamedViewsAreDirections) {
    const auto from = [&](const Arguments& where) { return picture(where).rgba; };
    EXPECT_EQ(from({"--view", "left"}), from({"--azimuth", "90"}));
    EXPECT_EQ(from({"--view", "back"}), from({"--azimuth", "180"}));
    EXPECT_EQ(from({"--view", "bottom"}), from({"--elevation", "-90"}));
    EXPECT_EQ(from({"--view", "front"}), from({}));
    EXPECT_NE(from({"--view", "front"}), from({"--view", "back"}));
    EXPECT_NE(from({"--view", "left"}), from({"--view", "right"}));
    EXPECT_NE(from({"--view", "top"}), from({"--view", "bottom"}));
}

TEST_F(RenderPictureTest, CameraFromAFile) {
    // What --view front makes of a head of 200 mm in 64x48 pixels, nearly: the same head, in another place.
    writeText(path("camera.txt"), "0.0075 0 0 0\n0 0 -0.01 0\n0 0.002 0 0.5\n0 0 0 1\n");
    output(render(path("b.png"), {"--preset", "mr", "--camera", path("camera.txt")}));
    EXPECT_GT(pixelsOf(readPng(path("b.png")), {0, 0, 0}), 500U);
    EXPECT_NE(pixel(readPng(path("b.png")), 32, 24), (std::array<int, 3>{0, 0, 0}));
}

TEST_F(RenderPictureTest, NothingOpaqueIsSaidAndDrawn) {
    const Ran ran = run(render(path("a.png"), {"--opacity", "0:0", "--background", "ffffff"}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("no opacity above 0"));
    EXPECT_EQ(linesOf(ran.err).size(), 1U);
    EXPECT_EQ(pixelsOf(readPng(path("a.png")), {255, 255, 255}), 64U * 48U);
}

TEST_F(RenderPictureTest, ColoursFromTheTransferFunction) {
    writeText(path("blue.json"), R"({"points": [[0, 0], [200, 1]], "colours": [[0, 0, 0, 1], [255, 0, 0, 1]]})");
    output(render(path("b.png"), {"--transfer-function", path("blue.json")}));
    const auto colour = pixel(readPng(path("b.png")), 32, 24);
    EXPECT_GT(colour[2], 60);
    EXPECT_LT(colour[0], colour[2] / 2);
    EXPECT_EQ(colour[0], colour[1]);
}

/// Half in the head and half in the air before the face, 30 degrees from facing the eye.
constexpr const char* kPlate = "v -40 0 -50\nv 40 -46 -50\nv 40 -46 60\nv -40 0 60\nf 1 2 3\nf 1 3 4\n";
constexpr const char* kPlatePose = "1 0 0 0  0 1 0 -50  0 0 1 0  0 0 0 1\n";
/// The same in the picture, but all in the air.
constexpr const char* kAwayPose = "1 0 0 0  0 1 0 -150  0 0 1 0  0 0 0 1\n";

class RenderShowTest : public RenderPictureTest {
  protected:
    void SetUp() override {
        RenderPictureTest::SetUp();
        writeText(path("plate.obj"), kPlate);
        writeText(path("pose.txt"), kPlatePose);
        writeText(path("camera.txt"), "0.0075 0 0 0\n0 0 -0.01 0\n0 0.002 0 0.5\n0 0 0 1\n");
    }
    [[nodiscard]] Arguments pair() const {
        return {"--opacity", "50:0,200:1",     "--mesh",   path("plate.obj"),
                "--poses",   path("pose.txt"), "--camera", path("camera.txt")};
    }
    PngPicture shown(const Arguments& more, const char* through = "1") {
        Arguments all = pair();
        all.insert(all.end(), {"--mesh-colour", "00ff00", "--through", through});
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_EQ(output(render(path("a.png"), all)), "");
        return readPng(path("a.png"));
    }
    /// The count that detect prints for the same pair, camera and size.
    std::size_t detected(const Arguments& more) {
        Arguments all{"detect", "--volume", "builtin:head:32", "--size", "64x48", "--format", "csv"};
        const Arguments same = pair();
        all.insert(all.end(), same.begin(), same.end());
        all.insert(all.end(), more.begin(), more.end());
        const std::vector<std::string> lines = linesOf(output(all));
        const std::vector<std::string> header = fieldsOf(lines.at(0));
        const auto column = std::ranges::find(header, "count") - header.begin();
        return std::stoul(fieldsOf(lines.at(1)).at(static_cast<std::size_t>(column)));
    }
};

template <class Is> std::size_t pixelsThat(const PngPicture& picture, Is is) {
    std::size_t count = 0;
    for (int i = 0; i < picture.width * picture.height; ++i) {
        const auto [red, green, blue] = pixel(picture, i % picture.width, i / picture.width);
        count += is(red, green, blue) ? 1U : 0U;
    }
    return count;
}

bool isRed(int red, int green, int blue) {
    return red > 2 * green && red > 2 * blue;
}
bool isBlue(int red, int green, int blue) {
    return 2 * blue > 3 * red && 2 * blue > 3 * green;
}

TEST_F(RenderShowTest, ContactsAreWhatDetectCounts) {
    for (const char* threshold : {"0.1", "0.4", "0.9"}) {
        const std::size_t counted = detected({"--count", "query", "--threshold", threshold});
        EXPECT_GT(counted, 20U);
        EXPECT_EQ(pixelsThat(shown({"--show", "contacts", "--threshold", threshold, "--validate"}), isRed), counted);
    }
}

TEST_F(RenderShowTest, DiscardedIsTheRestOfTheMesh) {
    const std::size_t counted = detected({"--count", "query"});
    writeText(path("pose.txt"), kAwayPose);
    const std::size_t covered = pixelsThat(shown({"--show", "discarded"}), isBlue);
    EXPECT_GT(covered, counted + 20);
    writeText(path("pose.txt"), kPlatePose);
    EXPECT_EQ(pixelsThat(shown({"--show", "discarded"}), isBlue), covered - counted);
}

TEST_F(RenderShowTest, TrianglesAreThoseThatTouchForCertain) {
    // Both triangles touch, and are painted where they are in the air, too.
    const std::size_t painted = pixelsThat(shown({"--show", "triangles", "--validate"}), isRed);
    writeText(path("pose.txt"), kAwayPose);
    EXPECT_EQ(pixelsThat(shown({"--show", "discarded"}), isBlue), painted);
    EXPECT_EQ(pixelsThat(shown({"--show", "triangles"}), isRed), 0U);
}

TEST_F(RenderShowTest, TissueBeforeWhatIsPainted) {
    const std::size_t bare = pixelsThat(shown({"--show", "contacts"}), isRed);
    EXPECT_LT(pixelsThat(shown({"--show", "contacts"}, "0"), isRed), bare / 2);
}

TEST_F(RenderShowTest, ThresholdThatNothingReachesIsSaidAndDrawn) {
    for (const char* what : {"contacts", "discarded", "triangles"}) {
        const Ran ran = run(render(path("a.png"), {"--mesh", path("plate.obj"), "--opacity", "0:0,255:0.3", "--show",
                                                   what, "--threshold", "0.4"}));
        EXPECT_EQ(ran.status, 0);
        EXPECT_THAT(ran.err, HasSubstr("no opacity of the transfer function reaches the threshold 0.4"));
        EXPECT_EQ(linesOf(ran.err).size(), 1U);
        EXPECT_EQ(pixelsThat(readPng(path("a.png")), isRed), 0U);
    }
}

TEST_F(RenderPictureTest, SizeBeyondTheDevice) {
    EXPECT_THAT(refused(2, render(path("a.png"), {"--size", "1000000x10"})), HasSubstr("--size"));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(RenderCliTest, ArgumentsThatCannotBe) {
    const std::string png = path("a.png");
    EXPECT_THAT(refused(2, {"render", "--volume", "builtin:head:16"}), HasSubstr("--output"));
    EXPECT_THAT(refused(2, render(path("a.jpg"))), HasSubstr("a.jpg"));
    EXPECT_THAT(refused(2, render(png, {"--volume", "builtin:ct:16"})), HasSubstr("one --volume"));
    EXPECT_THAT(refused(2, render(png, {"--view", "inside"})), HasSubstr("'inside' is not known"));
    EXPECT_THAT(refused(2, render(png, {"--preset", "pet"})), HasSubstr("'pet' is not known"));
    EXPECT_THAT(refused(2, render(png, {"--background", "blue"})), HasSubstr("RRGGBB"));
    EXPECT_THAT(refused(2, render(png, {"--mesh-colour", "00ff0g"})), HasSubstr("RRGGBB"));
    EXPECT_THAT(refused(2, render(png, {"--azimuth", "west"})), HasSubstr("--azimuth"));
    EXPECT_THAT(refused(2, render(png, {"--elevation", "1", "--view", "top"})), HasSubstr("--view"));
    EXPECT_THAT(refused(2, render(png, {"--pose", "1"})), HasSubstr("--mesh is missing"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--pose", "1"})),
                HasSubstr("numbered from 0 to 0"));
    EXPECT_THAT(refused(2, render(png, {"--show", "contacts"})), HasSubstr("--show requires --mesh"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--show", "all"})),
                HasSubstr("'all' is not known"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--threshold", "0.2"})),
                HasSubstr("--threshold requires --show"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--through", "0.2"})),
                HasSubstr("--through requires --show"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--show", "triangles", "--through", "1.2"})),
                HasSubstr("from 0 to 1"));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(RenderCliTest, FilesThatCannotBe) {
    writeText(path("camera.txt"), "1 0 0 0\n0 0 0 0\n0 0 1 0\n0 0 0 1\n");
    EXPECT_THAT(refused(1, render(path("a.png"), {"--camera", path("camera.txt")})), HasSubstr("camera.txt"));
    EXPECT_THAT(refused(2, render(path("a.png"), {"--camera", path("camera.txt"), "--view", "top"})),
                HasSubstr("--camera"));
    EXPECT_THAT(refused(1, render(path("absent/a.png"))), HasSubstr("absent"));
    EXPECT_THAT(refused(1, render(path("a.png"), {"--transfer-function", path("absent.tf")})), HasSubstr("absent.tf"));
    writeText(path("bad.json"), R"({"points": [[0, 0]], "colours": [[0, 0, 2, 1]]})");
    EXPECT_THAT(refused(1, render(path("a.png"), {"--transfer-function", path("bad.json")})),
                AllOf(HasSubstr("bad.json"), HasSubstr("colours[0]: the channel 2 is outside 0..1")));
    EXPECT_EQ(filesInFolder(), 2U);
}

} // namespace
} // namespace voxtact::test
