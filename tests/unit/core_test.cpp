// SPDX-License-Identifier: MIT
// Spaces, grids, transfer functions, opaque ranges and the checks of host data.
#include "core/base/text_stream.h"
#include "core/geometry/pair_transform.h"
#include "core/transfer/opaque_ranges.h"
#include "core/volume/boundary.h"
#include "support/scenes.h"
#include "support/special.h"
#include "voxtact/results.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace voxtact::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(TextStream, ThrowsWhereAStreamWouldGoOn) {
    TextStream text;
    text << "a" << 1.5;
    EXPECT_EQ(text.str(), "a1.5");
    EXPECT_THROW(text.setstate(std::ios::badbit), std::ios::failure); // what a lack of memory sets
}

TEST(Spaces, ProductsReadFromRightToLeft) {
    Mat4 scale = identity();
    scale[0] = 2;
    const Mat4 moved = multiply(translation({1, 0, 0}), scale); // first scaled, then moved
    EXPECT_THAT(transformPoint(moved, {3, 0, 0}), ElementsAre(7, 0, 0));
    const float columns[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    EXPECT_THAT(transformPoint(fromFloats(columns), {0, 0, 0}), ElementsAre(5, 6, 7));
}

TEST(Spaces, InverseRefusesSingularAndNonFinite) {
    Mat4 matrix = identity();
    matrix[10] = 0;
    EXPECT_THAT(inverse(matrix).error().text, HasSubstr("singular"));
    matrix[10] = kNan;
    EXPECT_THAT(inverse(matrix).error().text, HasSubstr("not finite"));
    EXPECT_FALSE(inverse(Mat4{}).ok());
    // Small units are not singular.
    Mat4 tiny = identity();
    tiny[0] = tiny[5] = tiny[10] = 1e-9;
    ASSERT_TRUE(inverse(tiny).ok());
    EXPECT_NEAR(inverse(tiny).value()[0], 1e9, 1);
}

/// Rounding in the last row, which comes with scales, would have made a pose of it that is refused.
TEST(Spaces, TheInverseOfAPoseIsAPose) {
    std::mt19937_64 random(testSeed());
    for (int round = 0; round < 100000 && !HasFailure(); ++round) {
        Mat4 scale = identity();
        scale[0] = uniform(random, 0.3, 3);
        scale[5] = uniform(random, 0.3, 3);
        scale[10] = uniform(random, 0.3, 3);
        const Mat4 pose =
            multiply(translation({uniform(random, -300, 300), uniform(random, -300, 300), uniform(random, -300, 300)}),
                     multiply(randomRotation(random), scale));
        const Result<Mat4> back = inverse(pose);
        ASSERT_TRUE(back.ok());
        EXPECT_TRUE(checkAffine(*back, "the inverse").ok()) << checkAffine(*back, "the inverse").error().text;
        const Vec3 point = transformPoint(*back, transformPoint(pose, {1, -2, 3}));
        EXPECT_NEAR(point[0], 1, 1e-9);
        EXPECT_NEAR(point[1], -2, 1e-9);
        EXPECT_NEAR(point[2], 3, 1e-9);
    }
}

TEST(Spaces, AffineMatricesNameTheElement) {
    Mat4 matrix = identity();
    matrix[13] = kNan;
    EXPECT_THAT(checkAffine(matrix, "pose 3").error().text, HasSubstr("pose 3: row 2, column 4"));
    matrix = identity();
    matrix[7] = 0.25;
    EXPECT_THAT(checkAffine(matrix, "pose 3").error().text, HasSubstr("0 0.25 0 1"));
    EXPECT_TRUE(checkAffine(identity(), "x").ok());
}

Grid obliqueGrid() {
    Grid grid;
    grid.size = {10, 20, 30};
    grid.spacing = {0.5, 1, 2};
    grid.origin = {-3, 4, 5};
    grid.direction = {0, 1, 0, 0.6, 0, 0.8, 0.8, 0, -0.6};
    return grid;
}

TEST(Grids, VoxelCentresAreAtHalfSteps) {
    const Grid grid = obliqueGrid();
    const Mat4 texture_from_world = textureFromWorld(grid).value();
    const Mat4 world_from_index = worldFromIndex(grid);
    EXPECT_THAT(transformPoint(world_from_index, {0, 0, 0}), ElementsAre(-3, 4, 5));
    // One step along index x is 0.5 mm along the first column of the direction.
    EXPECT_THAT(transformPoint(world_from_index, {1, 0, 0}), ElementsAre(-3, 4.5, 5));
    for (const Vec3& index : {Vec3{0, 0, 0}, Vec3{9, 19, 29}, Vec3{3, 7, 11}}) {
        const Vec3 texture = transformPoint(texture_from_world, transformPoint(world_from_index, index));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(texture[axis], (index[axis] + 0.5) / grid.size[axis], 1e-12);
        }
    }
}

TEST(Grids, BadOnesAreRefused) {
    Grid grid = obliqueGrid();
    grid.size[1] = 0;
    EXPECT_THAT(checkGrid(grid).error().text, HasSubstr("0 voxels along y"));
    grid = obliqueGrid();
    for (const double spacing : {0.0, -1.0, 5e-324, 9e-10, 1.1e12, 1e308, kNan}) {
        grid.spacing[2] = spacing;
        EXPECT_THAT(checkGrid(grid).error().text, HasSubstr("spacing along z")) << spacing;
    }
    grid = obliqueGrid();
    grid.direction = {1, 0, 0, 0, 1, 0, 1, 1, 0};
    EXPECT_THAT(textureFromWorld(grid).error().text, HasSubstr("singular"));
    // Their determinants are infinite, no number, and 0.
    for (const double length : {1e110, 1e200, 1e-110}) {
        grid = obliqueGrid();
        for (double& element : grid.direction) {
            element *= length;
        }
        EXPECT_THAT(checkGrid(grid).error().text, HasSubstr("the voxels along x are")) << length;
    }
    grid = obliqueGrid();
    grid.direction[4] = kNan;
    EXPECT_THAT(checkGrid(grid).error().text, HasSubstr("direction"));
    grid = obliqueGrid();
    for (const double origin : {1.1e12, -1e300, kNan}) {
        grid.origin[0] = origin;
        EXPECT_THAT(checkGrid(grid).error().text, HasSubstr("origin")) << origin;
    }
}

/// At both ends of what a spacing may be the way to the world leads back.
TEST(Grids, TheFinestAndTheCoarsestCanBeInverted) {
    for (const double spacing : {kMinSpacing, kMaxSpacing}) {
        Grid grid = obliqueGrid();
        grid.spacing = {spacing, spacing, spacing};
        grid.origin = {};
        const Result<Mat4> texture_from_world = textureFromWorld(grid);
        ASSERT_TRUE(texture_from_world.ok());
        const Vec3 there = transformPoint(worldFromTexture(grid), {0.25, 0.5, 1});
        const Vec3 back = transformPoint(*texture_from_world, there);
        EXPECT_NEAR(back[0], 0.25, 1e-9);
        EXPECT_NEAR(back[1], 0.5, 1e-9);
        EXPECT_NEAR(back[2], 1, 1e-9);
    }
}

/// 2^64 bytes of voxels are 0 when counted in 64 bits.
TEST(Grids, MoreVoxelsThanCanBeCountedAreRefused) {
    constexpr std::uint32_t kHalf = 1U << 31U;
    for (const auto& [type, last] :
         {std::pair{ScalarType::UInt8, 4U}, {ScalarType::Int16, 2U}, {ScalarType::Float32, 1U}}) {
        const VolumeView view{.grid = {.size = {kHalf, kHalf, last}}, .type = type, .voxels = {}};
        EXPECT_THAT(checkVolume(view).error().text, HasSubstr("more than 2^56 voxels"));
        EXPECT_THAT(makeLabels(view).error().text, HasSubstr("more than 2^56 voxels"));
    }
    Grid grid;
    grid.size = {1U << 28U, 1U << 28U, 1};
    EXPECT_TRUE(checkGrid(grid).ok());
    ++grid.size[0];
    EXPECT_FALSE(checkGrid(grid).ok());
}

TEST(Cameras, FramingShowsTheWholeBox) {
    const Grid grid = obliqueGrid();
    const Mat4 clip_from_texture = multiply(framingCamera(grid, 640, 480), worldFromTexture(grid));
    double most = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 clip =
            transformPoint(clip_from_texture, {static_cast<double>(corner & 1U), static_cast<double>(corner >> 1U & 1U),
                                               static_cast<double>(corner >> 2U & 1U)});
        EXPECT_LT(std::abs(clip[0]), 1);
        EXPECT_LT(std::abs(clip[1]), 1);
        EXPECT_GT(clip[2], 0);
        EXPECT_LT(clip[2], 1);
        most = std::max({most, std::abs(clip[0]), std::abs(clip[1])});
    }
    EXPECT_GT(most, 0.98);
    // From above: superior is nearer, left is left, posterior is down.
    const Mat4 clip_from_world = framingCamera(grid, 640, 480);
    const auto clip = [&](const Vec3& world) { return transformPoint(clip_from_world, world); };
    EXPECT_LT(clip({0, 0, 1})[2], clip({0, 0, 0})[2]);
    EXPECT_LT(clip({1, 0, 0})[0], clip({0, 0, 0})[0]);
    EXPECT_GT(clip({0, 1, 0})[1], clip({0, 0, 0})[1]);
    // Square pixels.
    EXPECT_NEAR(clip_from_world[0] * 640, -clip_from_world[5] * 480, 1e-12);
}

/// The side view of a camera has its view volume, with depth to the right and what was right in depth.
void expectSideView(const Mat4& clip_from_world) {
    const Mat4 world_from_clip = inverse(clip_from_world).value();
    const Mat4 side = sideView(clip_from_world);
    for (const double x : {-1.0, -0.5, 0.0, 0.25, 1.0}) {
        for (const double y : {-1.0, 0.125, 1.0}) {
            for (const double z : {0.0, 0.25, 0.5, 1.0}) {
                const Vec3 seen = transformPoint(side, transformPoint(world_from_clip, {x, y, z}));
                EXPECT_NEAR(seen[0], 2 * z - 1, 1e-9);
                EXPECT_NEAR(seen[1], y, 1e-9);
                EXPECT_NEAR(seen[2], (x + 1) / 2, 1e-9);
            }
        }
    }
    // A point behind the eye stays there: w is the same.
    for (std::size_t column = 0; column < 4; ++column) {
        EXPECT_EQ(side[4 * column + 3], clip_from_world[4 * column + 3]);
    }
}

TEST(Cameras, TheSideViewHasTheSameViewVolume) {
    const Grid grid = obliqueGrid();
    const Mat4 orthographic = framingCamera(grid, 640, 480);
    expectSideView(orthographic);
    Mat4 clip_from_eye{};
    clip_from_eye[0] = 1.5;
    clip_from_eye[5] = 2;
    clip_from_eye[10] = 100.0 / 99;
    clip_from_eye[11] = 1;
    clip_from_eye[14] = -100.0 / 99;
    const Mat4 perspective = multiply(clip_from_eye, multiply(translation({1, 2, 30}), orthographic));
    expectSideView(perspective);
    EXPECT_THAT(transformPoint(sideView(identity()), {0.5, 0.25, 0.125}), ElementsAre(-0.75, 0.25, 0.75));
}

TEST(TransferFunctions, TableEntriesAreAtTheMiddle) {
    constexpr ControlPoint kPoints[] = {{0, 0}, {4, 1}};
    EXPECT_THAT(sampleTable({kPoints, {0, 4}, 4}).value(), ElementsAre(0.125F, 0.375F, 0.625F, 0.875F));
    EXPECT_THAT(sampleTable({kPoints, {-4, 8}, 3}).value(), ElementsAre(0.0F, 0.5F, 1.0F));
}

TEST(TransferFunctions, StepsAndConstants) {
    constexpr ControlPoint kStep[] = {{2, 0.25}, {2, 0.75}};
    EXPECT_THAT(sampleTable({kStep, {0, 4}, 4}).value(), ElementsAre(0.25F, 0.25F, 0.75F, 0.75F));
    // At the step itself its upper side holds.
    EXPECT_THAT(sampleTable({kStep, {0, 4}, 3}).value(), ElementsAre(0.25F, 0.75F, 0.75F));
    constexpr ControlPoint kConstant[] = {{100, 0.5}};
    EXPECT_THAT(sampleTable({kConstant, {0, 4}, 2}).value(), ElementsAre(0.5F, 0.5F));
}

TEST(TransferFunctions, BadOnesAreRefused) {
    const auto text = [](std::span<const ControlPoint> points, ValueRange domain = {0, 255}, std::uint32_t size = 256) {
        return sampleTable({points, domain, size}).error().text;
    };
    EXPECT_THAT(text({}), HasSubstr("no control points"));
    constexpr ControlPoint kOutside[] = {{0, 0}, {1, 1.5}};
    EXPECT_THAT(text(kOutside), HasSubstr("control point 2"));
    EXPECT_THAT(text(kOutside), HasSubstr("1.5 is outside [0, 1]"));
    constexpr ControlPoint kUnsorted[] = {{5, 0}, {1, 1}};
    EXPECT_THAT(text(kUnsorted), HasSubstr("1 comes after 5"));
    constexpr ControlPoint kNanOpacity[] = {{5, kNan}};
    EXPECT_THAT(text(kNanOpacity), HasSubstr("outside"));
    constexpr ControlPoint kGood[] = {{0, 0}};
    EXPECT_THAT(text(kGood, {3, 3}), HasSubstr("3:3 is empty"));
    EXPECT_THAT(text(kGood, {-1e308, 1e308}), HasSubstr("-1e+308:1e+308 is too wide"));
    constexpr ControlPoint kFarApart[] = {{-1e308, 0}, {1e308, 1}};
    EXPECT_THAT(text(kFarApart), HasSubstr("1e+308 is too far from -1e+308"));
    EXPECT_THAT(text(kGood, {0, 255}, 1), HasSubstr("at least 2"));
}

/// What a sampler would look up, in double.
double lookUp(std::span<const float> table, const ValueRange& domain, double value) {
    const double at = (value - domain.lo) / (domain.hi - domain.lo) * static_cast<double>(table.size()) - 0.5;
    const double clamped = std::clamp(at, 0.0, static_cast<double>(table.size() - 1));
    const auto below = static_cast<std::size_t>(clamped);
    const std::size_t above = std::min(below + 1, table.size() - 1);
    const double weight = clamped - static_cast<double>(below);
    return static_cast<double>(table[below]) * (1 - weight) + static_cast<double>(table[above]) * weight;
}

TEST(OpaqueRangesTest, NeverCallsAnOpaqueScalarTransparent) {
    const std::uint64_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::size_t proven = 0;
    for (int round = 0; round < 200; ++round) {
        const ValueRange domain{-1000 * unit(random), 1000 * unit(random) + 1};
        std::vector<float> table(static_cast<std::size_t>(2 + 300 * unit(random)));
        for (float& entry : table) {
            entry = unit(random) < 0.9 ? 0.0F : static_cast<float>(unit(random));
        }
        const double threshold = unit(random);
        const OpaqueRanges opaque(table, domain, threshold);
        for (int i = 0; i < 50; ++i) {
            const double lo = domain.lo - 100 + (domain.hi - domain.lo + 200) * unit(random);
            const ValueRange range{lo, lo + 50 * unit(random) * unit(random)};
            if (opaque.mayBeOpaque(range)) {
                continue;
            }
            ++proven;
            for (int j = 0; j <= 20; ++j) {
                const double value = range.lo + (range.hi - range.lo) * j / 20;
                ASSERT_LT(lookUp(table, domain, value), threshold);
            }
        }
    }
    EXPECT_GT(proven, 100U) << "a test that proves nothing cannot fail";
}

TEST(OpaqueRangesTest, ANarrowDomainIsRoundedByMoreThanAnEntry) {
    // uint16 values around 60,000 in a domain 20 wide with 16,384 entries: an entry is 0.0012 wide, and normalising
    // 60,000 in single precision is off by more than that.
    constexpr ValueRange kDomain{59990, 60010};
    std::vector<float> table(16384, 0.0F);
    table[8192] = 1;
    const double width = (kDomain.hi - kDomain.lo) / static_cast<double>(table.size());
    const double value = kDomain.lo + (8192.5 + 4) * width;
    const auto scale = static_cast<float>(65535 / (kDomain.hi - kDomain.lo));
    const auto bias = static_cast<float>(-kDomain.lo / (kDomain.hi - kDomain.lo));
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const double exact = value + i * width;
        const float scalar = static_cast<float>(exact / 65535) * scale + bias;
        const double ideal = (exact - kDomain.lo) / (kDomain.hi - kDomain.lo);
        worst = std::max(worst, std::abs(static_cast<double>(scalar) - ideal) * static_cast<double>(table.size()));
    }
    EXPECT_GT(worst, 3) << "no reason for a wider margin";
    EXPECT_FALSE(OpaqueRanges(table, kDomain, 0.5).mayBeOpaque({value, value}));
    EXPECT_TRUE(OpaqueRanges(table, kDomain, 0.5, 65535).mayBeOpaque({value, value}));
    EXPECT_FALSE(OpaqueRanges(table, kDomain, 0.5, 65535).mayBeOpaque({kDomain.lo, kDomain.lo + 1}));
}

TEST(OpaqueRangesTest, KnownRanges) {
    std::vector<float> table(256, 0.0F);
    table[100] = 1;
    const OpaqueRanges opaque(table, {0, 256}, 0.5);
    EXPECT_TRUE(opaque.mayBeOpaque({100.5, 100.5}));
    EXPECT_TRUE(opaque.mayBeOpaque({0, 255}));
    EXPECT_FALSE(opaque.mayBeOpaque({0, 96}));
    EXPECT_FALSE(opaque.mayBeOpaque({105, 300}));
    EXPECT_FALSE(opaque.nothingOpaque());
    EXPECT_TRUE(OpaqueRanges(std::vector<float>(4, 0.0F), {0, 1}, 0.5).nothingOpaque());
    EXPECT_TRUE(OpaqueRanges(std::vector<float>(4, 0.0F), {0, 1}, 0.0).mayBeOpaque({0, 0}));
}

VolumeView bytesView(const Grid& grid, const std::vector<std::uint8_t>& voxels) {
    return {grid, ScalarType::UInt8, std::as_bytes(std::span(voxels))};
}

TEST(ItemConstants, TakeAValueToTheTransferFunctionsDomain) {
    const shader::ItemConstants constants = itemConstants(2, 10, {4, 12}, 0.25);
    EXPECT_EQ(constants.scalarScale, 0.25F);
    EXPECT_EQ(constants.scalarBias, 0.75F);
    EXPECT_EQ(constants.threshold, 0.25F);
}

TEST(ItemConstants, AreSingleWhereFloatsHoldThem) {
    EXPECT_TRUE(areSingle(itemConstants(1, 0, {0, 255}, 0.5)));
    EXPECT_TRUE(areSingle(itemConstants(-1e30, 1e38, {-1e37, 1e37}, 0.5)));
    EXPECT_TRUE(areSingle(itemConstants(1, 0, {-3e38, 3e38}, 0.5))) << "denormal";
    EXPECT_FALSE(areSingle(itemConstants(1e39, 0, {0, 1}, 0.5))) << "infinite";
    EXPECT_FALSE(areSingle(itemConstants(1, 1e39, {0, 1}, 0.5))) << "infinite for all";
    EXPECT_FALSE(areSingle(itemConstants(1, 0, {0, 1e300}, 0.5))) << "all values are one";
}

TEST(Boundaries, MergedRangesOfTheFaces) {
    Grid grid;
    grid.size = {4, 4, 4};
    std::vector<std::uint8_t> voxels(64, 10);
    voxels[1 + 4 * (1 + 4 * 1)] = 200; // inside: not on a face
    const auto inside = boundaryRanges(bytesView(grid, voxels));
    ASSERT_EQ(inside.size(), 1U);
    EXPECT_EQ(inside[0].lo, 10);
    EXPECT_EQ(inside[0].hi, 10);
    voxels[0] = 50; // a corner: the cells around it range from 10 to 50
    EXPECT_EQ(boundaryRanges(bytesView(grid, voxels))[0].hi, 50);
    grid.size = {1, 1, 64};
    EXPECT_EQ(boundaryRanges(bytesView(grid, voxels))[0].hi, 200) << "everything is boundary";
    grid.size = {2, 2, 2};
    voxels.assign(8, 10);
    voxels[7] = 90; // the far corner of every cell that it is in
    EXPECT_EQ(boundaryRanges(bytesView(grid, voxels))[0].hi, 90);
}

TEST(VolumeChecks, BadOnesAreRefused) {
    Grid grid;
    grid.size = {2, 2, 2};
    const std::vector<std::uint8_t> seven(7);
    EXPECT_THAT(checkVolume(bytesView(grid, seven)).error().text, HasSubstr("7 bytes"));
    std::vector<float> floats(8, 1.0F);
    floats[5] = std::numeric_limits<float>::infinity();
    EXPECT_THAT(checkVolume({grid, ScalarType::Float32, std::as_bytes(std::span(floats))}).error().text,
                HasSubstr("voxel (1, 0, 1) is infinite"));
    const std::vector<std::int16_t> ct{-1024, 3, 3071, 0, 0, 0, 0, 0};
    const ValueRange range = checkVolume({grid, ScalarType::Int16, std::as_bytes(std::span(ct))}).value();
    EXPECT_EQ(range.lo, -1024);
    EXPECT_EQ(range.hi, 3071);
}

TEST(MeshChecks, BadOnesAreRefused) {
    std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    EXPECT_EQ(checkMesh({positions, indices}).value().degenerate, 0U);
    EXPECT_THAT(checkMesh({positions, {}}).error().text, HasSubstr("no triangles"));
    const std::vector<std::uint32_t> outside{0, 1, 3};
    EXPECT_THAT(checkMesh({positions, outside}).error().text, HasSubstr("triangle 0 of the mesh uses vertex 3"));
    const std::vector<std::uint32_t> four{0, 1, 2, 0};
    EXPECT_THAT(checkMesh({positions, four}).error().text, HasSubstr("4 indices"));
    positions[4] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(checkMesh({positions, indices}).error().text, HasSubstr("vertex 1"));
}

TEST(MeshChecks, DegenerateTrianglesAreCounted) {
    const std::vector<double> positions{0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 1, 0};
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 0, 3, 0, 1, 3};
    const MeshFacts facts = checkMesh({positions, indices}).value();
    EXPECT_EQ(facts.degenerate, 2U);
    EXPECT_EQ(facts.triangles, 3U);
    EXPECT_THAT(facts.bounds.hi, ElementsAre(2, 2, 2));
}

TEST(Methods, NamesGoBothWays) {
    for (const CountingMethod method : countingMethods()) {
        EXPECT_EQ(countingMethodFromName(toString(method)), method);
    }
    EXPECT_FALSE(countingMethodFromName("quary").has_value());
    EXPECT_EQ(exactness(CountingMethod::QueryAny), Exactness::LowerBound);
}

TEST(PairResults, AreUnpacked) {
    const PairResult result{5, 1, 7, 2, 3, static_cast<std::uint32_t>(CountingMethod::Atomic)};
    const PairAnswer answer = unpack(result);
    EXPECT_EQ(answer.count, (std::uint64_t{1} << 32U) + 5);
    EXPECT_EQ(answer.pair, 7U);
    EXPECT_EQ(answer.item, 2U);
    EXPECT_EQ(answer.pose, 3U);
    EXPECT_EQ(answer.method, CountingMethod::Atomic);
    EXPECT_EQ(unpack({9, 0, 0, 0, 0, 1U | (1U << 16U)}).count, 1U) << "a boolean query's number means nothing";
}

} // namespace
} // namespace voxtact::test
