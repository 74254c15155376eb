// SPDX-License-Identifier: MIT
// The certified oracle against scenes whose answer is known beforehand.
#include "cpu/scenes/certified_scenes.h"

#include "cpu/scenes/engine_fixture.h"
#include "oracle/certified_oracle.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace voxtact::test {
namespace {

using oracle::Certainty;
using oracle::certifiedCells;
using oracle::CertifiedOracle;
using oracle::certifiedOracle;
using oracle::JudgedCell;
using oracle::JudgedTriangle;
using testing::HasSubstr;

CertifiedOracle ask(const OracleScene& scene) {
    return take(certifiedOracle(scene.pair()));
}

Certainty verdict(const OracleScene& scene) {
    return ask(scene).certainty;
}

VolumeData opaqueImage() {
    return makeUnitImage(4, [](auto, auto, auto) { return 255; });
}

/// Values grow by 32 a voxel along x: the opacity is a half at 3.984375 in index space, a float in texture space.
constexpr double kIsoPlane = 3.984375;
constexpr double kIsoTexture = (kIsoPlane + 0.5) / 8;
VolumeData ramp() {
    return makeUnitImage(8, [](auto x, auto, auto) { return 32 * x; });
}

/// A step of so many voxels of an image of 8^3, along x.
Mat4 alongX(double voxels) {
    return translation({voxels / 8, 0, 0});
}

TEST(CertifiedOracle, PlateAcrossARamp) {
    OracleScene scene;
    scene.volume = ramp();
    addRectangle(scene.mesh, {kIsoTexture, 0.1, 0.2}, {kIsoTexture, 0.9, 0.2}, {kIsoTexture, 0.9, 0.8},
                 {kIsoTexture, 0.1, 0.8});
    EXPECT_NE(verdict(scene), Certainty::None);
    for (const double step : {1e-9, 1e-6, 1e-3, 0.3}) {
        scene.world_from_object = alongX(step);
        const CertifiedOracle above = ask(scene);
        EXPECT_EQ(above.certainty, Certainty::Certain) << step;
        for (const JudgedTriangle& triangle : above.triangles) {
            EXPECT_EQ(triangle.certainty, Certainty::Certain);
            EXPECT_NEAR(triangle.witness[0], kIsoTexture + step / 8, 1e-14);
        }
        scene.world_from_object = alongX(-step);
        EXPECT_EQ(verdict(scene), Certainty::None) << step;
    }
}

TEST(CertifiedOracle, OnlyACornerReachesThePlane) {
    OracleScene scene;
    scene.volume = ramp();
    addTriangle(scene.mesh, {kIsoTexture, 0.5, 0.5}, {0.25, 0.125, 0.25}, {0.125, 0.875, 0.75});
    EXPECT_NE(verdict(scene), Certainty::None);
    scene.world_from_object = alongX(1e-6);
    EXPECT_EQ(verdict(scene), Certainty::Certain);
    scene.world_from_object = alongX(-1e-6);
    EXPECT_EQ(verdict(scene), Certainty::None);
}

/// One voxel of an image of 9^3 is opaque: round it the opacity is a tent.
OracleScene tent() {
    OracleScene scene;
    scene.volume = makeUnitImage(9, [](auto x, auto y, auto z) { return x == 4 && y == 5 && z == 3 ? 255 : 0; });
    scene.threshold = 0.25;
    return scene;
}

TEST(CertifiedOracle, PlateOverATent) {
    OracleScene scene = tent();
    addRectangle(scene.mesh, {0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5});
    const auto raised = [&](double voxels) { // above the voxel, where the tent is 1 - voxels high
        scene.world_from_object = translation({0, 0, (3.5 + voxels) / 9 - 0.5});
        return ask(scene);
    };
    for (const double side : {-1.0, 1.0}) {
        EXPECT_EQ(raised(side * (0.75 - 1e-6)).certainty, Certainty::Certain);
        EXPECT_EQ(raised(side * (0.75 + 1e-6)).certainty, Certainty::None);
    }
    // Where the diagonal of the plate passes, the tent is at most a quarter of its height.
    const CertifiedOracle low = raised(0.2);
    EXPECT_EQ(low.triangles[0].certainty, Certainty::None);
    EXPECT_EQ(low.triangles[1].certainty, Certainty::Certain);
}

TEST(CertifiedOracle, CellsOfATent) {
    OracleScene scene = tent();
    addRectangle(scene.mesh, {0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5});
    scene.world_from_object = translation({0, 0, 3.7 / 9 - 0.5});
    EXPECT_TRUE(take(certifiedCells(scene.pair(), 0)).empty());
    std::set<std::array<std::int64_t, 3>> seen;
    for (const JudgedCell& cell : take(certifiedCells(scene.pair(), 1))) {
        EXPECT_EQ(cell.certainty, Certainty::Certain);
        seen.insert(cell.cell);
    }
    EXPECT_EQ(seen, (std::set<std::array<std::int64_t, 3>>{{3, 4, 3}, {4, 4, 3}, {3, 5, 3}, {4, 5, 3}}));
    // In the plane between two layers of cells it is in neither beyond doubt.
    scene.world_from_object = translation({0, 0, 3.5 / 9 - 0.5});
    const std::vector<JudgedCell> between = take(certifiedCells(scene.pair(), 1));
    EXPECT_EQ(between.size(), 8U);
    for (const JudgedCell& cell : between) {
        EXPECT_EQ(cell.certainty, Certainty::Undecided);
    }
}

TEST(CertifiedOracle, CellsAtTheDomainsBoundary) {
    OracleScene scene;
    scene.volume = makeUnitImage(2, [](auto, auto, auto) { return 255; });
    addTriangle(scene.mesh, {-1, -1, 0.3}, {3, -1, 0.3}, {-1, 3, 0.3});
    std::vector<JudgedCell> cells = take(certifiedCells(scene.pair(), 0));
    ASSERT_EQ(cells.size(), 9U); // three cells per axis, of half a voxel, one and half a voxel
    EXPECT_EQ(cells.front().cell, (std::array<std::int64_t, 3>{-1, -1, 0}));
    EXPECT_EQ(cells.back().cell, (std::array<std::int64_t, 3>{1, 1, 0}));
    // Within the margin of the cells above, and in the corner of the domain only up to rounding.
    scene.world_from_object = translation({0, 0, 0.45 - 1.0 / 2048});
    cells = take(certifiedCells(scene.pair(), 0));
    EXPECT_EQ(std::count_if(cells.begin(), cells.end(),
                            [](const JudgedCell& cell) { return cell.certainty == Certainty::Certain; }),
              9);
    EXPECT_EQ(cells.size(), 18U);
    scene.world_from_object = translation({0, 0, 0.75});
    EXPECT_TRUE(take(certifiedCells(scene.pair(), 0)).empty());
}

TEST(CertifiedOracle, OnlyTheDomainCounts) {
    OracleScene scene;
    scene.volume = opaqueImage();
    // A wall beside the domain, a tip that reaches into it, and a wall round it that surrounds it.
    addTriangle(scene.mesh, {1, 0.25, 0.25}, {1, 0.75, 0.25}, {1, 0.5, 0.75});
    addTriangle(scene.mesh, {1, 0.5, 0.5}, {2, 0.25, 0.5}, {2, 0.75, 0.75});
    const auto moved = [&](double voxels) {
        scene.world_from_object = translation({voxels / 4, 0, 0});
        return ask(scene);
    };
    for (const JudgedTriangle& triangle : moved(-1e-6).triangles) {
        EXPECT_EQ(triangle.certainty, Certainty::Certain);
        EXPECT_NEAR(triangle.witness[0], 1, 1e-6);
    }
    EXPECT_EQ(moved(0).certainty, Certainty::Undecided);
    EXPECT_EQ(moved(1e-6).certainty, Certainty::None);
    // Passes the corner of the domain at x + y = 2, none of its corners and edges in it.
    scene.mesh = {};
    addTriangle(scene.mesh, {-7, 9, -8}, {9, -7, -8}, {1, 1, 16});
    EXPECT_EQ(moved(-1e-5).certainty, Certainty::Certain);
    EXPECT_EQ(moved(1e-5).certainty, Certainty::None);
}

TEST(CertifiedOracle, EveryDirection) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        OracleScene scene = tent();
        const auto at = [&](double a, double b) { // in the plane across the axis through the voxel
            Vec3 out{4.5 / 9, 5.5 / 9, 3.5 / 9};
            out[(axis + 1) % 3] += a;
            out[(axis + 2) % 3] += b;
            return out;
        };
        addTriangle(scene.mesh, at(-0.5, -0.5), at(0.5, -0.5), at(0, 0.5)); // a plate
        addTriangle(scene.mesh, at(-0.5, 0), at(0.5, 0), at(0.5, 1e-7));    // a sliver
        addTriangle(scene.mesh, at(-0.5, 0), at(0.5, 0), at(0.25, 0));      // a segment
        addTriangle(scene.mesh, at(0, 0.02), at(0, 0.02), at(0, 0.02));     // a point
        addTriangle(scene.mesh, at(0, 0.2), at(0, 0.2), at(0, 0.2));
        addTriangle(scene.mesh, at(-0.5, 0.2), at(0.5, 0.2), at(0.25, 0.2));
        const CertifiedOracle oracle = ask(scene);
        for (std::size_t triangle = 0; triangle < 6; ++triangle) {
            EXPECT_EQ(oracle.triangles[triangle].certainty, triangle < 4 ? Certainty::Certain : Certainty::None)
                << axis << ", " << triangle;
        }
    }
}

/// Opaque at a single value, that of an entry of the table.
OracleScene peak(double& value) {
    OracleScene scene;
    scene.volume = ramp();
    value = 100.5 / 256 * 255;
    scene.points = {{value - 1e-3, 0}, {value, 1}, {value + 1e-3, 0}};
    scene.threshold = 1;
    return scene;
}

TEST(CertifiedOracle, ANarrowPeakIsProvenByCrossingIt) {
    double value = 0;
    OracleScene scene = peak(value);
    addTriangle(scene.mesh, {0.1, 0.1, 0.3}, {0.9, 0.2, 0.4}, {0.3, 0.9, 0.5});
    const JudgedTriangle triangle = ask(scene).triangles.front();
    EXPECT_EQ(triangle.certainty, Certainty::Certain);
    EXPECT_TRUE(triangle.crossing);
    EXPECT_NEAR(triangle.witness[0], (value / 32 + 0.5) / 8, 1e-12);
    const std::vector<JudgedCell> cells = take(certifiedCells(scene.pair(), 0));
    EXPECT_FALSE(cells.empty());
    for (const JudgedCell& cell : cells) {
        EXPECT_EQ(cell.cell[0], 3);
        EXPECT_EQ(cell.certainty, Certainty::Certain);
    }
    // On either side of it, and in the plane of the peak.
    scene.mesh = {};
    addTriangle(scene.mesh, {0.5, 0.1, 0.3}, {0.5, 0.2, 0.4}, {0.5, 0.9, 0.5});
    const double there = (value / 32 + 0.5) / 8 - 0.5;
    for (const double side : {-1e-6, 1e-6}) {
        scene.world_from_object = translation({there + side, 0, 0});
        EXPECT_EQ(verdict(scene), Certainty::None);
    }
    scene.world_from_object = translation({there, 0, 0});
    EXPECT_EQ(verdict(scene), Certainty::Undecided);
}

TEST(CertifiedOracle, ThresholdZeroIsTheWholeDomain) {
    OracleScene scene;
    scene.volume = ramp();
    scene.points = {{0, 0}};
    scene.threshold = 0;
    addTriangle(scene.mesh, {0.1, 0.1, 0.01}, {0.2, 0.1, 0.01}, {0.1, 0.2, 0.01});
    EXPECT_EQ(verdict(scene), Certainty::Certain);
    scene.world_from_object = translation({0, 0, -0.02});
    EXPECT_EQ(verdict(scene), Certainty::None);
    scene.world_from_object = identity();
    scene.threshold = 1e-30;
    EXPECT_EQ(verdict(scene), Certainty::None);
}

TEST(CertifiedOracle, APlateauAtTheThresholdIsOpaque) {
    OracleScene scene;
    scene.volume = makeUnitImage(5, [](auto x, auto y, auto z) { return 40 + 3 * x + 5 * y + 7 * z; });
    addTriangle(scene.mesh, {0.1, 0.1, 0.3}, {0.9, 0.2, 0.4}, {0.3, 0.9, 0.5});
    scene.points = {{20, 0}, {30, 0.3}, {200, 0.3}, {210, 0}};
    scene.threshold = 0.3;
    EXPECT_EQ(verdict(scene), Certainty::Certain);
    scene.threshold = static_cast<double>(std::nextafter(0.3F, 1.0F));
    EXPECT_EQ(verdict(scene), Certainty::None);
    // Values beyond the table have its first entry's opacity, whatever the next one is.
    scene.domain = {150, 250};
    scene.tableSize = 2;
    scene.points = {{175, 0.3}, {200, 0}};
    scene.threshold = 0.3;
    EXPECT_EQ(verdict(scene), Certainty::Certain);
}

TEST(CertifiedOracle, ObliqueGrid) {
    std::mt19937_64 random(5);
    const Mat4 turn = randomRotation(random);
    OracleScene scene;
    scene.volume = ramp();
    Grid& grid = scene.volume.grid;
    grid.spacing = {0.4, 1.7, 3.1};
    grid.origin = {-120, 33, 71};
    for (std::size_t i = 0; i < 9; ++i) {
        grid.direction[i] = turn[4 * (i / 3) + i % 3];
    }
    // Object space is index space.
    addTriangle(scene.mesh, {kIsoPlane, 1.5, 1.25}, {kIsoPlane, 5, 2}, {kIsoPlane, 2, 6});
    const auto shifted = [&](double voxels) {
        scene.world_from_object = multiply(worldFromIndex(grid), translation({voxels, 0, 0}));
        return ask(scene);
    };
    EXPECT_EQ(shifted(-1e-6).certainty, Certainty::None);
    const CertifiedOracle above = shifted(1e-6);
    ASSERT_EQ(above.certainty, Certainty::Certain);
    EXPECT_NEAR(above.triangles[0].witness[0], (kIsoPlane + 1e-6 + 0.5) / 8, 1e-12);
    for (const JudgedCell& cell : take(certifiedCells(scene.pair(), 0))) {
        EXPECT_EQ(cell.cell[0], 3);
    }
}

TEST(CertifiedOracle, ASaddleIsFoundBetweenItsVoxels) {
    // In the middle of a cell with voxels 0 and 200 in turn the value is 100, along one diagonal up to 200.
    OracleScene scene;
    scene.volume = makeUnitImage(2, [](auto x, auto y, auto) { return x == y ? 0 : 200; });
    scene.threshold = 0.5;                                     // 127.5
    const double reach = 0.5 - std::sqrt((127.5 - 100) / 400); // from the middle of the cell on the falling diagonal
    const auto onDiagonal = [](double from, double to) {
        MeshData mesh;
        addTriangle(mesh, {0.5 + from / 2, 0.5 - from / 2, 0.4}, {0.5 + to / 2, 0.5 - to / 2, 0.4},
                    {0.5 + to / 2, 0.5 - to / 2, 0.6});
        return mesh;
    };
    const double opaqueFrom = 0.5 - reach; // the value there is 100 + 400 t^2
    scene.mesh = onDiagonal(-opaqueFrom + 1e-6, opaqueFrom - 1e-6);
    EXPECT_EQ(verdict(scene), Certainty::None);
    scene.mesh = onDiagonal(-opaqueFrom + 1e-6, opaqueFrom + 1e-6);
    EXPECT_EQ(verdict(scene), Certainty::Certain);
}

TEST(CertifiedOracle, HugeCoordinatesAreUndecidedOrOutside) {
    OracleScene scene;
    scene.volume = opaqueImage();
    constexpr double kHuge = 3e38;
    addTriangle(scene.mesh, {-kHuge, -kHuge, 0.5}, {kHuge, -kHuge, 0.5}, {0, kHuge, 0.5});
    addTriangle(scene.mesh, {kHuge, kHuge, 0.5}, {kHuge, kHuge / 2, 0.5}, {kHuge, kHuge, 1});
    CertifiedOracle oracle = ask(scene);
    EXPECT_EQ(oracle.triangles[0].certainty, Certainty::Undecided);
    EXPECT_EQ(oracle.triangles[1].certainty, Certainty::None);
    scene.world_from_object[0] = std::numeric_limits<double>::max();
    scene.world_from_object[4] = -std::numeric_limits<double>::max();
    for (const JudgedTriangle& triangle : ask(scene).triangles) {
        EXPECT_EQ(triangle.certainty, Certainty::Undecided);
    }
    EXPECT_EQ(take(certifiedCells(scene.pair(), 0)).size(), 125U);
}

TEST(CertifiedOracle, CancellingCoordinatesCostCertainty) {
    OracleScene scene;
    scene.volume = ramp();
    constexpr double kFar = 16777216; // a float, and the doubles there are 4e-9 apart
    addTriangle(scene.mesh, {kFar, 0.25, 0.25}, {kFar, 0.75, 0.25}, {kFar, 0.5, 0.75});
    const auto at = [&](double voxels) {
        scene.world_from_object = translation({kIsoTexture + voxels / 8 - kFar, 0, 0});
        return verdict(scene);
    };
    EXPECT_EQ(at(1e-3), Certainty::Certain);
    EXPECT_EQ(at(-1e-3), Certainty::None);
    EXPECT_EQ(at(1e-8), Certainty::Undecided);
    EXPECT_EQ(at(-1e-8), Certainty::Undecided);
}

TEST(CertifiedOracle, RefusesWhatTheOtherRefuses) {
    OracleScene good;
    good.volume = opaqueImage();
    addTriangle(good.mesh, {0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5});
    const auto refusal = [](const OracleScene& scene) {
        const Result<CertifiedOracle> oracle = certifiedOracle(scene.pair());
        EXPECT_EQ(oracle.ok(), certifiedCells(scene.pair(), 0).ok());
        return oracle.ok() ? std::string() : oracle.error().text;
    };
    EXPECT_EQ(refusal(good), "");
    OracleScene bad = good;
    bad.threshold = 1.5;
    EXPECT_THAT(refusal(bad), HasSubstr("threshold"));
    bad = good;
    bad.world_from_object[3] = 1;
    EXPECT_THAT(refusal(bad), HasSubstr("last row"));
    bad = good;
    bad.mesh.indices[1] = 7;
    EXPECT_THAT(refusal(bad), HasSubstr("vertex 7"));
    bad = good;
    bad.volume.voxels.pop_back();
    EXPECT_THAT(refusal(bad), HasSubstr("63 bytes"));
    bad = good;
    bad.points.clear();
    EXPECT_THAT(refusal(bad), HasSubstr("control points"));
    EXPECT_THAT(certifiedCells(good.pair(), 1).error().text, HasSubstr("triangle 1"));
    for (const double resolution : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        EXPECT_THAT(certifiedOracle(good.pair(), resolution).error().text, HasSubstr("resolution"));
    }
}

} // namespace
} // namespace voxtact::test
