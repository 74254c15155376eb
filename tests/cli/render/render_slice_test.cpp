// SPDX-License-Identifier: MIT
// voxtact render --slice: needs no device.
#include "cli/child.h"
#include "render_fixture.h"

#include <unistd.h>

#include <cmath>
#include <csignal>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class RenderSliceTest : public CliTest {
  protected:
    PngPicture slice(const Arguments& more) {
        EXPECT_EQ(output(render(path("a.png"), more)), "");
        return readPng(path("a.png"));
    }
    static bool isGray(const PngPicture& picture) {
        for (int i = 0; i < picture.width * picture.height; ++i) {
            const auto [r, g, b] = pixel(picture, i % picture.width, i / picture.width);
            if (r != g || g != b) {
                return false;
            }
        }
        return true;
    }
    /// The middle of what is green, left to right and top to bottom.
    static std::pair<double, double> middleOfGreen(const PngPicture& picture) {
        double x = 0;
        double y = 0;
        double count = 0;
        for (int i = 0; i < picture.width * picture.height; ++i) {
            const auto [r, g, b] = pixel(picture, i % picture.width, i / picture.width);
            if (g > 2 * r && g > 2 * b) {
                const int row = i / picture.width;
                x += i % picture.width;
                y += row;
                ++count;
            }
        }
        EXPECT_GT(count, 0) << "nothing is green";
        return {x / count, y / count};
    }
};

TEST_F(RenderSliceTest, GrayPlanesOfTheVolume) {
    for (const char* name : {"axial", "coronal:10", "sagittal", "view:5"}) {
        const PngPicture gray = slice({"--slice", name});
        EXPECT_TRUE(isGray(gray)) << name;
        EXPECT_GT(pixelsOf(gray, {0, 0, 0}), 300U) << name;
        EXPECT_LT(pixelsOf(gray, {0, 0, 0}), 2900U) << name;
    }
    EXPECT_EQ(slice({"--slice", "view:-20", "--view", "front"}).rgba, slice({"--slice", "coronal:20"}).rgba);
    EXPECT_NE(slice({"--slice", "axial:0"}).rgba, slice({"--slice", "axial:30"}).rgba);
    EXPECT_EQ(pixelsOf(slice({"--slice", "axial", "--window", "-2:-1"}), {255, 255, 255}) > 0, true);
}

TEST_F(RenderSliceTest, ValuesAreTheVolumes) {
    // Values rise along x, from 0 to 100, 40 mm in 4 voxels; the window is 0 to 100.
    writeText(path("v.mhd"), "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementSpacing = 10 10 10\n"
                             "TransformMatrix = 1 0 0 0 1 0 0 0 1\n"
                             "Offset = -15 -15 -15\nElementType = MET_UCHAR\nElementDataFile = v.raw\n");
    std::string voxels;
    for (int i = 0; i < 64; ++i) {
        voxels += static_cast<char>(20 + 20 * (i % 4));
    }
    writeText(path("v.raw"), voxels);
    output({"render", "--volume", path("v.mhd"), "--slice", "axial:0", "--window", "0:100", "--size", "102x102",
            "--output", path("a.png")});
    const PngPicture seen = readPng(path("a.png"));
    // 0.4 mm per pixel, the middle of the picture at x = 0: the value is 50 + 2 x.
    for (const int x : {20, 35, 51, 70, 80}) {
        const double mm = (x + 0.5 - 51) * 0.4 * 1.02 * 100 / 102;
        EXPECT_NEAR(pixel(seen, x, 51)[0], 2.55 * (50 + 2 * mm), 3) << x;
    }
}

TEST_F(RenderSliceTest, SidesAreWhereRadiologistsHaveThem) {
    // A pyramid at the patient's left, front and top.
    writeText(path("p.obj"), "v 20 -60 20\nv 60 -60 20\nv 60 -20 20\nv 20 -20 20\nv 40 -40 60\n"
                             "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 2 3\nf 1 3 4\n");
    const auto at = [&](const char* name) {
        return middleOfGreen(slice({"--slice", name, "--mesh", path("p.obj"), "--mesh-colour", "00ff00"}));
    };
    // Seen from the feet, the face above: the left is at the right. No place given: through the mesh.
    EXPECT_GT(at("axial").first, 32);
    EXPECT_LT(at("axial").second, 24);
    EXPECT_GT(at("coronal").first, 32);
    EXPECT_LT(at("coronal").second, 24);
    EXPECT_LT(at("sagittal").first, 32);
    EXPECT_LT(at("sagittal").second, 24);
}

TEST_F(RenderSliceTest, InterruptedItLeavesNoFile) {
    writeText(path("a.png"), "as it was");
    // As large as a picture may be: it is written for a while.
    Child child({"render", "--volume", "builtin:head:18", "--slice", "axial:0", "--size", "6000x6000", "--output",
                 path("a.png")});
    for (int i = 0; i < 1200 && filesInFolder() < 2; ++i) {
        ::usleep(50000);
    }
    EXPECT_EQ(filesInFolder(), 2U); // the temporary one
    child.signal(SIGINT);
    const Ran ran = child.end();
    EXPECT_EQ(ran.status, 128 + SIGINT);
    EXPECT_EQ(ran.err, "voxtact render: interrupted by SIGINT: nothing is written\n");
    EXPECT_EQ(readText(path("a.png")), "as it was");
    EXPECT_EQ(filesInFolder(), 1U);
}

TEST_F(RenderSliceTest, OutlinesSayWhereItTouches) {
    // Half in the head, half in the air before it.
    writeText(path("plate.obj"), "v -30 -40 -20\nv 30 -40 -20\nv 30 -150 20\nv -30 -150 20\nf 1 2 3\nf 1 3 4\n");
    const Arguments pair{"--slice", "axial:0", "--mesh", path("plate.obj"), "--mesh-colour", "00ff00"};
    const auto with = [&](const Arguments& more) {
        Arguments all = pair;
        all.insert(all.end(), more.begin(), more.end());
        return slice(all);
    };
    const auto red = [](int r, int g, int b) { return r > 2 * g && r > 2 * b; };
    const auto green = [](int r, int g, int b) { return g > 2 * r && g > 2 * b; };
    const auto blue = [](int r, int g, int b) { return 2 * b > 3 * r && 2 * b > 3 * g; };
    EXPECT_EQ(pixelsThat(with({}), red), 0U);
    EXPECT_GT(pixelsThat(with({}), green), 10U);
    writeText(path("slant.txt"), "1 0 0 0  0 0 -1 -60  0 1 0 60  0 0 0 1\n");
    const Arguments slanted{"--opacity", "50:0,200:1", "--poses", path("slant.txt"), "--show"};
    const auto shown = [&](const char* what) {
        Arguments all = slanted;
        all.emplace_back(what);
        return with(all);
    };
    EXPECT_EQ(pixelsThat(shown("contacts"), blue), 0U);
    EXPECT_GT(pixelsThat(shown("discarded"), blue) + pixelsThat(shown("discarded"), red), 5U);
    EXPECT_EQ(pixelsThat(shown("discarded"), green), 0U);
    EXPECT_GT(pixelsThat(shown("triangles"), red) + pixelsThat(shown("triangles"), green), 2U);
}

/// What is given for nothing is said.
TEST_F(RenderSliceTest, WhatASliceDoesNotAsk) {
    const std::string png = path("a.png");
    EXPECT_THAT(refused(2, render(png, {"--slice", "axial", "--validate"})), HasSubstr("a slice uses no Vulkan"));
    EXPECT_EQ(filesInFolder(), 0U);
    output(render(png, {"--slice", "axial", "--device", "no such device"}), {.note = "--device is not used"});
    output(render(png, {"--slice", "axial", "--opacity", "40:0,80:1"}), {.note = "are not used"});
    output({"render", "--volume", "builtin:head:18", "--slice", "axial", "--title", "Head", "--size", "64x64",
            "--output", png},
           {.note = "--title is not used: pictures below 320x320"});
}

TEST_F(RenderSliceTest, WhatCannotBe) {
    const std::string png = path("a.png");
    EXPECT_THAT(refused(2, {"render", "--volume", "builtin:head:18", "--mesh-colour", "ff0000", "--output", png}),
                HasSubstr("add --mesh"));
    EXPECT_THAT(refused(2, render(png, {"--slice", "axial:500"})),
                AllOf(HasSubstr("--slice axial:500 is outside the volume"), HasSubstr("to"), HasSubstr("mm")));
    EXPECT_THAT(refused(2, render(png, {"--slice", "view:-400"})), HasSubstr("outside the volume"));
    EXPECT_THAT(refused(2, render(png, {"--slice", "oblique"})), HasSubstr("axial, coronal, sagittal or view"));
    EXPECT_THAT(refused(2, render(png, {"--slice", "axial:top"})), HasSubstr("no number (mm)"));
    EXPECT_THAT(refused(2, render(png, {"--slice", "axial", "--view", "left"})), HasSubstr("leave out --view"));
    EXPECT_THAT(refused(2, render(png, {"--slice", "axial", "--clip", "left"})), HasSubstr("excludes"));
    EXPECT_THAT(refused(2, render(png, {"--window", "0:1"})), HasSubstr("--window requires --slice"));
    EXPECT_THAT(refused(2, render(png, {"--slice", "axial", "--window", "3:1"})), HasSubstr("LO below HI"));
    EXPECT_THAT(refused(2, {"render", "--volume", "builtin:head:18", "--slice", "axial", "--size", "100000x10",
                            "--output", png}),
                HasSubstr("exceeds the limit"));
    EXPECT_EQ(filesInFolder(), 0U);
}

} // namespace
} // namespace voxtact::test
