// SPDX-License-Identifier: MIT
// voxtact render.
#include "cli/render/inputs.h"
#include "render_fixture.h"

#include <cmath>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RenderCliTest : public CliTest {};

TEST(RenderLegendTest, HounsfieldUnitsAreThoseOfACt) {
    app::RenderOptions options;
    options.volumes = {"builtin:head:16"};
    options.preset = "ct-bone";
    app::RenderInputs inputs;
    inputs.values = {-1024, 3000};
    EXPECT_EQ(app::annotationOf(options, inputs, {}).legend->unit, "HU");
    inputs.values = {0, 255};
    EXPECT_EQ(app::annotationOf(options, inputs, {}).legend->unit, "value");
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

TEST_F(RenderPictureTest, ClippingTakesASideAway) {
    const std::array<int, 3> background{0, 0, 0};
    const auto seen = [&](const Arguments& more, int from, int to) {
        Arguments all{"--preset", "mr"};
        all.insert(all.end(), more.begin(), more.end());
        const PngPicture head = picture(all);
        std::size_t count = 0;
        for (int i = 0; i < 64 * 48; ++i) {
            count += i % 64 >= from && i % 64 < to && pixel(head, i % 64, i / 64) != background ? 1U : 0U;
        }
        return count;
    };
    // From the front the patient's left is at the right.
    ASSERT_GT(seen({}, 34, 64), 200U);
    EXPECT_EQ(seen({"--clip", "left"}, 34, 64), 0U);
    EXPECT_EQ(seen({"--clip", "left"}, 0, 30), seen({}, 0, 30));
    EXPECT_EQ(seen({"--clip", "right:0"}, 0, 30), 0U);
    EXPECT_GT(seen({"--clip", "right:0"}, 34, 64), 200U);
    // The same by its numbers, and both.
    EXPECT_EQ(picture({"--preset", "mr", "--clip", "left:10"}).rgba,
              picture({"--preset", "mr", "--clip", "1,0,0,10"}).rgba);
    EXPECT_EQ(seen({"--clip", "left:0", "--clip", "-1,0,0,0.5"}, 0, 64), 0U);
    // What is nearer goes, and the face of the cut is seen.
    EXPECT_EQ(picture({"--preset", "mr", "--clip", "near:20"}).rgba,
              picture({"--preset", "mr", "--clip", "0,-1,0,20"}).rgba);
    EXPECT_NE(picture({"--preset", "mr", "--clip", "near:20"}).rgba, picture({"--preset", "mr"}).rgba);
}

TEST_F(RenderPictureTest, ClippingThatTakesNothingIsSaid) {
    const Ran ran = run(render(path("a.png"), {"--clip", "top:900"}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, AllOf(HasSubstr("--clip top:900 removes nothing"), HasSubstr("mm")));
}

/// A square before the face.
std::string squareAt(double x, double y) {
    const auto vertex = [&](double dx, double dz) {
        return "v " + std::to_string(x + dx) + " " + std::to_string(y) + " " + std::to_string(dz) + "\n";
    };
    return vertex(-15, -15) + vertex(15, -15) + vertex(15, 15) + vertex(-15, 15) + "f 1 2 3\nf 1 3 4\n";
}

TEST_F(RenderPictureTest, SeveralMeshesAndPoses) {
    writeText(path("a.obj"), squareAt(-50, -150));
    writeText(path("b.obj"), squareAt(50, -150));
    writeText(path("poses.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n1 0 0 0  0 1 0 0  0 0 1 60  0 0 0 1\n"
                                 "1 0 0 0  0 1 0 0  0 0 1 -60  0 0 0 1\n");
    const auto coloured = [&](const Arguments& more) {
        Arguments all{"--preset",      "mr",     "--mesh",        path("a.obj"), "--mesh", path("b.obj"),
                      "--mesh-colour", "ff0000", "--mesh-colour", "0000ff"};
        all.insert(all.end(), more.begin(), more.end());
        output(render(path("a.png"), all));
        const PngPicture seen = readPng(path("a.png"));
        std::size_t red = 0;
        std::size_t blue = 0;
        for (int i = 0; i < 64 * 48; ++i) {
            const auto [r, g, b] = pixel(seen, i % 64, i / 64);
            red += r > 150 && g < 70 && b < 70 ? 1U : 0U;
            blue += b > 150 && g < 70 && r < 70 ? 1U : 0U;
        }
        return std::pair(red, blue);
    };
    const auto [red, blue] = coloured({});
    EXPECT_GT(red, 20U);
    EXPECT_EQ(blue, red);
    const Arguments poses{"--poses", path("poses.txt"), "--pose"};
    const auto at = [&](const char* which) {
        Arguments all = poses;
        all.emplace_back(which);
        return coloured(all);
    };
    EXPECT_EQ(at("0"), std::pair(red, blue));
    EXPECT_GT(at("0,2").first, 2 * red - 10);
    EXPECT_EQ(at("all"), at("0-2"));
    EXPECT_GT(at("all").second, at("0,2").second);
}

TEST_F(RenderPictureTest, PresetsAreDifferentPictures) {
    std::vector<std::vector<std::uint8_t>> pictures;
    const auto add = [&](const char* volume, const char* preset) {
        output({"render", "--volume", volume, "--size", "64x48", "--preset", preset, "--output", path("a.png")});
        pictures.push_back(readPng(path("a.png")).rgba);
    };
    for (const char* preset : {"mr", "mr-skin", "mr-brain"}) {
        add("builtin:head:30", preset);
    }
    for (const char* preset : {"ct", "ct-bone", "ct-soft", "ct-vessels", "ct-lung"}) {
        add("builtin:ct:32", preset);
    }
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_NE(pictures[i], pictures[j]) << i << " " << j;
        }
    }
}

TEST_F(RenderPictureTest, HounsfieldPresetOfOtherUnitsIsSaid) {
    const Ran ran = run(render(path("a.png"), {"--preset", "ct-bone"}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, HasSubstr("--preset ct-bone expects Hounsfield units"));
}

TEST_F(RenderPictureTest, LightingIsChosen) {
    EXPECT_EQ(picture({"--preset", "mr"}).rgba, picture({"--preset", "mr", "--lighting", "soft"}).rgba);
    EXPECT_NE(picture({"--preset", "mr", "--lighting", "eye"}).rgba, picture({"--preset", "mr"}).rgba);
    EXPECT_NE(picture({"--preset", "mr", "--lighting", "eye"}).rgba,
              picture({"--preset", "mr", "--lighting", "none"}).rgba);
}

TEST_F(RenderPictureTest, AnnotatedFrom320) {
    const auto written = [&](const char* size, const Arguments& more) {
        Arguments all{"render", "--volume", "builtin:head:30", "--opacity",  "0:0",
                      "--size", size,       "--output",        path("a.png")};
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_EQ(run(all).status, 0);
        const PngPicture seen = readPng(path("a.png"));
        return static_cast<std::size_t>(seen.width * seen.height) - pixelsOf(seen, {0, 0, 0});
    };
    EXPECT_EQ(written("319x400", {}), 0U);
    EXPECT_GT(written("320x320", {}), 500U);
    EXPECT_EQ(written("320x320", {"--no-annotate"}), 0U);
    EXPECT_GT(written("319x400", {"--annotate"}), 500U);
    EXPECT_GT(written("640x640", {"--title", "a"}), 2000U);
    // No picture is too small to ask.
    for (const char* size : {"1x1", "7x300", "300x7", "40x40", "100x100"}) {
        written(size, {"--annotate"});
    }
    // On light ground what is written is dark.
    const std::size_t onLight = written("320x320", {"--background", "ffffff"});
    EXPECT_GT(onLight, 320U * 320U - 2000);
    std::size_t dark = 0;
    const PngPicture light = readPng(path("a.png"));
    for (int i = 0; i < 320 * 320; ++i) {
        dark += pixel(light, i % 320, i / 320)[1] < 60 ? 1U : 0U;
    }
    EXPECT_GT(dark, 100U);
}

TEST_F(RenderPictureTest, SizeBeyondTheDevice) {
    EXPECT_THAT(refused(2, render(path("a.png"), {"--size", "1000000x10"})), HasSubstr("--size"));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(RenderCliTest, ArgumentsThatCannotBe) {
    const std::string png = path("a.png");
    EXPECT_THAT(refused(2, {"render", "--volume", "builtin:head:18"}), HasSubstr("--output"));
    EXPECT_THAT(refused(2, render(path("a.jpg"))), HasSubstr("a.jpg"));
    EXPECT_THAT(refused(2, render(png, {"--volume", "builtin:ct:16"})),
                HasSubstr("--volume: a picture needs exactly one"));
    EXPECT_THAT(refused(2, render(png, {"--view", "inside"})), HasSubstr("'inside' is unknown"));
    EXPECT_THAT(refused(2, render(png, {"--preset", "pet"})), HasSubstr("'pet' is unknown"));
    EXPECT_THAT(refused(2, render(png, {"--background", "blue"})), HasSubstr("RRGGBB"));
    EXPECT_THAT(refused(2, render(png, {"--mesh-colour", "00ff0g"})), HasSubstr("RRGGBB"));
    EXPECT_THAT(refused(2, render(png, {"--azimuth", "west"})), HasSubstr("--azimuth"));
    EXPECT_THAT(refused(2, render(png, {"--elevation", "1", "--view", "top"})), HasSubstr("--view"));
    EXPECT_THAT(refused(2, render(png, {"--pose", "1"})), HasSubstr("add --mesh"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--pose", "1"})),
                HasSubstr("numbered from 0 to 0"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--pose", "3-1"})),
                HasSubstr("'3-1' is neither"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--mesh-colour", "ff0000", "--mesh-colour",
                                        "00ff00"})),
                HasSubstr("--mesh-colour is given 2 times, --mesh 1 times"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "inside"})), HasSubstr("'inside' is neither SIDE[:MM]"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "0,0,0,5"})), HasSubstr("a normal of length 0"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "1,0,5"})), HasSubstr("neither"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "left:x"})), HasSubstr("no number (mm)"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "left:10", "--clip", "right:20"})),
                HasSubstr("--clip left:10, --clip right:20: together they remove the whole volume"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "1,1,0,0", "--clip", "-1,1,0,-20", "--clip", "0,-1,0,5"})),
                HasSubstr("together"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "top:5", "--clip", "bottom:5"})), HasSubstr("together"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--pose", "0", "--pose", "0"})),
                HasSubstr("--pose is given twice"));
    EXPECT_THAT(refused(2, render(png, {"--clip", "left:-500"})),
                AllOf(HasSubstr("--clip left:-500 removes the whole volume"), HasSubstr("mm")));
    Arguments seven;
    for (int i = 0; i < 7; ++i) {
        seven.insert(seven.end(), {"--clip", "left"});
    }
    EXPECT_THAT(refused(2, render(png, seven)), HasSubstr("--clip is given 7 times; the maximum is 6"));
    EXPECT_THAT(refused(2, render(png, {"--clip-mesh"})), HasSubstr("--clip-mesh requires --clip"));
    EXPECT_THAT(refused(2, render(png, {"--lighting", "dim"})), HasSubstr("'dim' is unknown"));
    EXPECT_THAT(refused(2, render(png, {"--annotate", "--no-annotate"})), HasSubstr("excludes"));
    EXPECT_THAT(refused(2, render(png, {"--show", "contacts"})), HasSubstr("--show requires --mesh"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--show", "all"})),
                HasSubstr("'all' is unknown"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--opacity-threshold", "0.2"})),
                HasSubstr("--opacity-threshold requires --show"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--through", "0.2"})),
                HasSubstr("--through requires --show"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--max-distance", "5"})),
                HasSubstr("--max-distance requires --show"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--show", "contacts", "--max-distance", "5"})),
                HasSubstr("--max-distance needs --show distance"));
    EXPECT_THAT(refused(2, render(png, {"--mesh", "builtin:scalpel:500", "--show", "distance", "--max-distance", "0"})),
                HasSubstr("'0' is not a number above 0"));
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
