// SPDX-License-Identifier: MIT
// Certain answers of adversarial cases against a judge of its own (quad_judge.h). A million of them:
// voxtact_extreme_bench.
#include "cpu/judges/extreme_cases.h"

#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

namespace voxtact::test {
namespace {

/// "touches", "possible" or "none" for a triangle of world space and an image that is opaque everywhere.
std::string verdictOf(const Grid& grid, const std::array<Vec3, 3>& corners) {
    MeshData mesh;
    for (const Vec3& corner : corners) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
        for (const double coordinate : corner) {
            mesh.positions.push_back(static_cast<float>(coordinate));
        }
    }
    const VolumeData image = makeBytes(grid, [](auto...) { return 255; });
    const cpu::Mesh meshOn = take(cpu::Mesh::create(mesh.view()));
    const cpu::Volume volume = take(cpu::Volume::create(image.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), {0, 255}}));
    const Mat4 pose = identity();
    const cpu::BatchItem item{&meshOn, &volume, &function, {&pose, 1}};
    cpu::DetectorDesc desc;
    desc.projection = Projection::Certified;
    cpu::Detector detector = take(cpu::Detector::create(desc));
    const PairAnswer pair = take(detector.detect({{&item, 1}, {}, 0.5})).pairs.at(0);
    return pair.hit ? "touches" : pair.possible ? "possible" : "none";
}

/// Sides of three quarters, which have no exact reciprocal.
Grid niceGrid() {
    Grid grid;
    grid.size = {5, 6, 7};
    grid.spacing = {0.75, 1, 3};
    grid.origin = {0.5, -8, 1024};
    return grid;
}

/// In the plane of world space, across an axis.
std::array<Vec3, 3> across(const Grid& grid, std::size_t axis, double plane) {
    std::array<Vec3, 3> out{grid.origin, grid.origin, grid.origin};
    out[1][(axis + 1) % 3] += 1;
    out[2][(axis + 2) % 3] += 1;
    for (Vec3& corner : out) {
        corner[axis] = plane;
    }
    return out;
}

TEST(Extreme, ATriangleInAFaceOfTheDomainIsInIt) {
    const Grid grid = niceGrid();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double near = grid.origin[axis] - grid.spacing[axis] / 2;
        const double far = near + grid.size[axis] * grid.spacing[axis];
        const auto beside = [](double place, float towards) {
            return static_cast<double>(std::nextafter(static_cast<float>(place), towards));
        };
        EXPECT_EQ(verdictOf(grid, across(grid, axis, near)), "touches") << axis;
        EXPECT_EQ(verdictOf(grid, across(grid, axis, far)), "touches") << axis;
        EXPECT_EQ(verdictOf(grid, across(grid, axis, beside(near, 1e9F))), "touches") << axis;
        EXPECT_EQ(verdictOf(grid, across(grid, axis, beside(far, -1e9F))), "touches") << axis;
        EXPECT_EQ(verdictOf(grid, across(grid, axis, beside(near, -1e9F))), "none") << axis;
        EXPECT_EQ(verdictOf(grid, across(grid, axis, beside(far, 1e9F))), "none") << axis;
    }
}

TEST(Extreme, AnEdgeOrACornerInAFaceIsInIt) {
    const Grid grid = niceGrid();
    const double near = grid.origin[0] - grid.spacing[0] / 2;
    std::array<Vec3, 3> corners = across(grid, 0, near);
    corners[0][0] = near - 2;
    EXPECT_EQ(verdictOf(grid, corners), "touches");
    corners[1][0] = near - 1;
    EXPECT_EQ(verdictOf(grid, corners), "touches");
    corners[2][0] = near - 0.125;
    EXPECT_EQ(verdictOf(grid, corners), "none");
}

TEST(Extreme, TrianglesOfManyVoxelsAreDecided) {
    const Grid grid = niceGrid();
    const Vec3 centre = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    for (const double side : {1e5, 1e7, 1e9}) {
        // All of them in the plane of the centre and (1, 1, 1), and in another beside the image.
        const std::array<Vec3, 3> through{Vec3{centre[0] + side, centre[1] - side, centre[2]},
                                          Vec3{centre[0], centre[1] + side, centre[2] - side},
                                          Vec3{centre[0] - side, centre[1], centre[2] + side}};
        EXPECT_EQ(verdictOf(grid, through), "touches") << side;
        std::array<Vec3, 3> beside = through;
        for (Vec3& corner : beside) {
            corner[0] += 1e-4 * side + 40;
        }
        EXPECT_EQ(verdictOf(grid, beside), "none") << side;
    }
}

TEST(Extreme, NoCertainAnswerIsWrong) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint64_t kCases = 10000;
    ExtremeTrial trial;
    std::uint64_t first = 0;
    std::uint64_t last = kCases;
    if (const char* one = std::getenv("VOXTACT_TEST_CASE"); one != nullptr) {
        first = std::strtoull(one, nullptr, 10);
        last = first + 1;
    }
    for (std::uint64_t number = first; number < last; ++number) {
        trial.run(seed, number);
    }
    const ExtremeTally& tally = trial.tally();
    std::cout << tally.touches << " touch, " << tally.none << " do not, " << tally.possible << " possible, "
              << tally.unjudged << " that the judge does not know, " << tally.wrong << " wrong\n";
    for (const std::string& complaint : tally.complaints) {
        ADD_FAILURE() << complaint;
    }
    EXPECT_EQ(tally.wrong, 0U);
    if (last - first == kCases) {
        // Else the cases are not what they are meant to be.
        EXPECT_GT(tally.touches, kCases / 5);
        EXPECT_GT(tally.none, kCases / 5);
        EXPECT_LT(tally.possible, kCases / 10);
        EXPECT_LT(tally.unjudged, kCases / 20);
    }
}

} // namespace
} // namespace voxtact::test
