// SPDX-License-Identifier: MIT
// voxtact render --show.
#include "cli/draw/viridis.h"
#include "cli/render/fine_mesh.h"
#include "render_fixture.h"
#include "voxtact/samples.h"

#include <cmath>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

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
        Arguments all{"count", "--volume", "builtin:head:32", "--size", "64x48", "--format", "csv"};
        const Arguments same = pair();
        all.insert(all.end(), same.begin(), same.end());
        all.insert(all.end(), more.begin(), more.end());
        const std::vector<std::string> lines = linesOf(output(all));
        const std::vector<std::string> header = fieldsOf(lines.at(0));
        const auto column = std::ranges::find(header, "count") - header.begin();
        return std::stoul(fieldsOf(lines.at(1)).at(static_cast<std::size_t>(column)));
    }
};

TEST_F(RenderShowTest, ContactsAreWhatDetectCounts) {
    for (const char* threshold : {"0.1", "0.4", "0.9"}) {
        const std::size_t counted = detected({"--method", "query", "--opacity-threshold", threshold});
        EXPECT_GT(counted, 20U);
        EXPECT_EQ(pixelsThat(shown({"--show", "contacts", "--opacity-threshold", threshold, "--validate"}), isRed),
                  counted);
    }
}

TEST_F(RenderShowTest, DiscardedIsTheRestOfTheMesh) {
    const std::size_t counted = detected({"--method", "query"});
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
    for (const char* what : {"contacts", "discarded", "triangles", "distance"}) {
        const Ran ran = run(render(path("a.png"), {"--mesh", path("plate.obj"), "--opacity", "0:0,255:0.3", "--show",
                                                   what, "--opacity-threshold", "0.4"}));
        EXPECT_EQ(ran.status, 0);
        EXPECT_THAT(ran.err, HasSubstr("no opacity of the transfer function reaches the threshold 0.4"));
        EXPECT_EQ(linesOf(ran.err).size(), 1U);
        EXPECT_EQ(pixelsThat(readPng(path("a.png")), isRed), 0U);
    }
}

/// A cube of 32 mm whose lower half is opaque, up to 0.4 mm above its middle.
constexpr const char* kHalf = "ObjectType = Image\nNDims = 3\nDimSize = 32 32 32\nOffset = -15.5 -15.5 -15.5\n"
                              "ElementSpacing = 1 1 1\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
                              "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
constexpr double kSurface = 0.4; // mm, at the threshold 0.1
constexpr int kSide = 64;

/// Seen along z, 32 mm from side to side.
class RenderClearanceTest : public CliDeviceTest {
  protected:
    void SetUp() override {
        CliDeviceTest::SetUp();
        std::string bytes(std::size_t{32} * 32 * 32, '\0');
        std::fill_n(bytes.begin(), bytes.size() / 2, '\xff');
        writeText(path("half.mha"), kHalf + bytes);
        writeText(path("camera.txt"), "0.0625 0 0 0\n0 0.0625 0 0\n0 0 0.01 0.5\n0 0 0 1\n");
    }
    /// A plate over all of the picture that rises with x, with nothing else to be seen. It is a hair lower at the
    /// picture's lower left, so that this is where it is nearest, and where the distance is written.
    PngPicture plate(double from, double to, const Arguments& more) {
        const std::string near = std::to_string(from);
        const std::string nearest = std::to_string(from - 0.02);
        const std::string far = std::to_string(to);
        writeText(path("plate.obj"), "v -16 -16 " + near + "\nv 16 -16 " + far + "\nv 16 16 " + far + "\nv -16 16 " +
                                         nearest + "\nf 1 2 3\nf 1 3 4\n");
        Arguments all{"render", "--volume", path("half.mha"), "--opacity", "0:0,255:1", "--mesh",     path("plate.obj"),
                      "--show", "distance", "--size",         "64x64",     "--output",  path("a.png")};
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_EQ(output(all), "");
        return readPng(path("a.png"));
    }
    [[nodiscard]] Arguments seenAlongZ() const {
        return {"--camera", path("camera.txt"), "--lighting", "none", "--through", "1", "--validate"};
    }
    /// The colour of a pixel for a plate between these heights, mm.
    static void expectClearance(const PngPicture& picture, int x, double from, double to, double maximum) {
        const double clearance = from + (to - from) * (x + 0.5) / kSide - kSurface;
        const app::Rgb colour = app::viridis(clearance / maximum);
        for (const int y : {10, 40}) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(pixel(picture, x, y)[channel], colour[channel], 3)
                    << clearance << " mm: " << x << ", " << y << ", " << channel;
            }
        }
    }
};

TEST_F(RenderClearanceTest, EveryPlaceHasTheColourOfItsDistance) {
    for (const char* maximum : {"20", "10", "33"}) {
        Arguments more = seenAlongZ();
        more.insert(more.end(), {"--max-distance", maximum});
        const PngPicture seen = plate(0.5, 20.5, more);
        for (int x = 2; x < kSide; x += 3) {
            expectClearance(seen, x, 0.5, 20.5, std::stod(maximum));
        }
    }
    // viridis itself, as matplotlib has it: in the middle of 20 mm.
    const PngPicture middle = plate(10.4, 10.4, seenAlongZ());
    EXPECT_EQ(pixel(middle, 50, 10), (std::array<int, 3>{33, 144, 141}));
}

TEST_F(RenderClearanceTest, WhatTouchesIsRed) {
    const PngPicture seen = plate(-10, 10, seenAlongZ());
    for (const int x : {4, 16, 28}) {
        EXPECT_EQ(pixel(seen, x, 10), (std::array<int, 3>{255, 59, 20})) << x;
    }
    for (const int x : {38, 50, 60}) {
        expectClearance(seen, x, -10, 10, 20);
    }
}

TEST_F(RenderClearanceTest, TheClosestPointsAreDrawnFromBeside) {
    const auto white = [](const PngPicture& picture) {
        return pixelsThat(picture, [](int red, int green, int blue) { return red + green + blue > 3 * 240; });
    };
    const Arguments beside{"--view", "left", "--lighting", "none", "--no-annotate"};
    EXPECT_GT(white(plate(6, 14, beside)), 8U);
    // What touches has none.
    EXPECT_EQ(white(plate(-4, 4, beside)), 0U);
}

TEST_F(RenderClearanceTest, SlicesHaveTheSameColours) {
    const PngPicture seen = plate(0.4 + 0.1, 0.4 + 20.1, {"--slice", "coronal:0", "--no-annotate"});
    EXPECT_GT(pixelsThat(seen, [](int red, int green, int blue) { return green > 2 * blue && green > red; }), 5U);
    EXPECT_GT(pixelsThat(seen, [](int red, int green, int blue) { return blue > red + 30 && blue > green + 30; }), 2U);
}

TEST(FineMesh, EdgesAreShortAndTheSurfaceIsTheSame) {
    const MeshData sphere = *makeEllipsoid(500);
    const auto area = [](const MeshData& mesh) {
        double sum = 0;
        for (std::size_t at = 0; at < mesh.indices.size(); at += 3) {
            std::array<Vec3, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    corners[i][axis] = static_cast<double>(mesh.positions[3 * mesh.indices[at + i] + axis]);
                }
            }
            Vec3 u{};
            Vec3 v{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                u[axis] = corners[1][axis] - corners[0][axis];
                v[axis] = corners[2][axis] - corners[0][axis];
            }
            sum += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
        }
        return sum;
    };
    const auto longest = [](const MeshData& mesh) {
        double most = 0;
        for (std::size_t at = 0; at < mesh.indices.size(); ++at) {
            const std::size_t next = at % 3 == 2 ? at - 2 : at + 1;
            double squares = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                squares += std::pow(static_cast<double>(mesh.positions[3 * mesh.indices[at] + axis]) -
                                        static_cast<double>(mesh.positions[3 * mesh.indices[next] + axis]),
                                    2);
            }
            most = std::max(most, std::sqrt(squares));
        }
        return most;
    };
    const double before = longest(sphere);
    const MeshData fine = app::halveLongEdges(sphere, before / 5, 1'000'000);
    EXPECT_LE(longest(fine), before / 5);
    EXPECT_GT(fine.indices.size(), 4 * sphere.indices.size());
    EXPECT_NEAR(area(fine) / area(sphere), 1, 1e-5);
    // A closed surface stays closed: every edge has two triangles, the other way round.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t at = 0; at < fine.indices.size(); ++at) {
        const std::size_t next = at % 3 == 2 ? at - 2 : at + 1;
        ++edges[{fine.indices[at], fine.indices[next]}];
    }
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
    // Too many triangles: as it was before that turn, without vertices that nobody uses.
    const MeshData few = app::halveLongEdges(sphere, before / 5, sphere.indices.size() / 3);
    EXPECT_EQ(few.indices, sphere.indices);
    EXPECT_EQ(few.positions, sphere.positions);
}

} // namespace
} // namespace voxtact::test
