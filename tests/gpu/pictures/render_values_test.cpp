// SPDX-License-Identifier: MIT
// What a picture shows is in the image's own units and in the world's: other types, other domains and other poses of
// the same thing are the same picture.
#include "render/render_impl.h"
#include "render_scene.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <random>

namespace voxtact::test {
namespace {

class RenderValuesTest : public RenderTest {
  protected:
    void SetUp() override {
        RenderTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure()) {
            look(kSides[0], {0, 0, 0});
        }
    }
    /// Largest difference of two pictures, in 8-bit steps.
    static int difference(const Picture& a, const Picture& b) {
        int most = 0;
        for (std::size_t i = 0; i < a.rgba.size(); ++i) {
            most = std::max(most, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
        }
        return most;
    }
};

TEST_F(RenderValuesTest, DomainsBeginAnywhere) {
    for (const double lo : {-2.0, -0.25, 0.2}) {
        scene_.function.opacity.domain = {lo, 1.5};
        expectSame(picture(0.02), kMean, kMost);
    }
}

template <class Voxel> VolumeData blobOf(ScalarType type, double from, double to) {
    const VolumeData floats = blob();
    const VolumeView view = floats.view();
    const auto* values = reinterpret_cast<const float*>(view.voxels.data());
    const Grid& grid = floats.grid;
    return makeVolume<Voxel>(grid, type, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const std::size_t at = x + std::size_t{grid.size[0]} * (y + std::size_t{grid.size[1]} * z);
        return std::round(from + (to - from) * static_cast<double>(values[at]));
    });
}

TEST_F(RenderValuesTest, BricksAreSkippedByTheImagesOwnUnits) {
    struct Kind {
        const char* name;
        VolumeData volume;
        double lo;
        double hi;
    };
    const Kind kinds[] = {{"uint8", blobOf<std::uint8_t>(ScalarType::UInt8, 3, 250), 3, 250},
                          {"int16", blobOf<std::int16_t>(ScalarType::Int16, -1000, 3000), -1000, 3000},
                          {"uint16", blobOf<std::uint16_t>(ScalarType::UInt16, 500, 60000), 500, 60000},
                          {"float", blobOf<float>(ScalarType::Float32, -40, 90), -40, 90}};
    scene_.function.colours = {};
    for (const Kind& kind : kinds) {
        place(kind.volume);
        // Only a band in the middle can be seen: not the air, and not the blob's core.
        const double width = kind.hi - kind.lo;
        const ControlPoint band[] = {{kind.lo + 0.3 * width, 0},
                                     {kind.lo + 0.4 * width, 0.6},
                                     {kind.lo + 0.5 * width, 0.6},
                                     {kind.lo + 0.6 * width, 0}};
        scene_.function.opacity = {band, {kind.lo, kind.hi}, 256};
        const Picture without = picture(0.05);
        // Interpolation rounds: next to a brick it may see a little of what the brick's own voxels do not reach.
        EXPECT_LE(difference(picture(0.05, true), without), 2) << kind.name;
        const ControlPoint nothing[] = {{kind.lo, 0}};
        scene_.function.opacity = {nothing, {kind.lo, kind.hi}, 256};
        EXPECT_GT(difference(without, picture(0.05)), 30) << kind.name << ": the band is not to be seen";
    }
}

/// Meshes in light, smooth, in a volume that is not to be seen.
class RenderPosesTest : public PictureTest {
  protected:
    Picture picture(const MeshData& data, const Mat4& world_from_object) {
        const ControlPoint nothing[] = {{0, 0}};
        const Volume volume = upload(blob());
        const RenderTransferFunction function =
            take(RenderTransferFunction::upload(renderer(), queue(), {.opacity = {nothing, {0, 1}, 4}, .step = 1}));
        const Mesh mesh = upload(data);
        const MeshNormals normals = take(MeshNormals::upload(renderer(), queue(), data.view()));
        Scene scene;
        scene.volume = &volume;
        scene.transferFunction = &function;
        scene.mesh = &mesh;
        scene.normals = &normals;
        scene.world_from_object = world_from_object;
        scene.clip_from_world = perspective({1, 30, 4}, {0, 0, 0}, 1, 60);
        scene.lighting.side = 0.5;
        return take(blocking().render(scene, kExtent));
    }
    /// The mesh with its vertices where the pose puts them.
    static MeshData baked(MeshData mesh, const Mat4& world_from_object) {
        for (std::size_t at = 0; at < mesh.positions.size(); at += 3) {
            const Vec3 world =
                transformPoint(world_from_object, {mesh.positions[at], mesh.positions[at + 1], mesh.positions[at + 2]});
            for (std::size_t axis = 0; axis < 3; ++axis) {
                mesh.positions[at + axis] = static_cast<float>(world[axis]);
            }
        }
        return mesh;
    }
    /// Pixels that differ by more than rounding; an outline may go by a pixel.
    void expectSame(const MeshData& mesh, const Mat4& pose, const char* what) {
        const Picture posed = picture(mesh, pose);
        const Picture expected = picture(baked(mesh, pose), identity());
        std::size_t others = 0;
        std::size_t seen = 0;
        for (std::size_t i = 0; i < posed.rgba.size(); i += 4) {
            others += std::abs(int{posed.rgba[i]} - int{expected.rgba[i]}) > 2 ? 1U : 0U;
            seen += expected.rgba[i] > 0 ? 1U : 0U;
        }
        EXPECT_LE(others, 5U) << what;
        seen_ += seen;
    }

    std::size_t seen_ = 0; ///< pixels of meshes
};

TEST_F(RenderPosesTest, LightFallsOnAPosedMeshAsOnTheSameMeshThere) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    for (int round = 0; round < 4; ++round) {
        const Mat4 turned = randomRotation(random);
        expectSame(take(makeEllipsoid(500)), turned, "turned");
        // Normals of a plane are not turned as its points are, where one axis is stretched.
        const Mat4 stretch{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 6, 0, 0, 0, 0, 1};
        MeshData plane;
        plane.positions = {-5, -5, -1, 5, -5, 1, 0, 6, 0.5F};
        plane.indices = {0, 1, 2};
        expectSame(plane, multiply(turned, stretch), "turned and stretched");
    }
    EXPECT_GT(seen_, 1000U);
}

TEST(ExtinctionIntegrals, AreThoseOfTheOpacityBetweenTheEntries) {
    // Extinction is -ln(1 - a), where opacity a is linear from entry to entry: the integral is known.
    constexpr double kUnit = 2;
    const std::vector<float> opacity{0, 0.25F, 0.25F, 0.875F, 0.5F};
    const std::vector<float> white(opacity.size(), 1);
    const std::vector<float> half(opacity.size(), 0.5F);
    const std::vector<float> found = extinctionIntegrals({white, half, white, opacity}, kUnit);
    ASSERT_EQ(found.size(), 8 * opacity.size());
    double sum = 0;
    for (std::size_t entry = 0; entry < opacity.size(); ++entry) {
        EXPECT_NEAR(found[4 * entry + 3], sum, 2e-3) << entry;
        EXPECT_NEAR(found[4 * entry], sum, 2e-3) << entry;
        EXPECT_NEAR(found[4 * entry + 1], sum / 2, 1e-3) << entry;
        EXPECT_NEAR(found[4 * (opacity.size() + entry) + 3], -std::log1p(-opacity[entry]) / kUnit, 1e-6) << entry;
        if (entry + 1 < opacity.size()) {
            const double from = 1 - static_cast<double>(opacity[entry]);
            const double to = 1 - static_cast<double>(opacity[entry + 1]);
            const auto antiderivative = [](double u) { return u * std::log(u) - u; };
            const double mean =
                from == to ? -std::log(from) : (antiderivative(to) - antiderivative(from)) / (from - to);
            sum += mean / kUnit;
        }
    }
}

} // namespace
} // namespace voxtact::test
