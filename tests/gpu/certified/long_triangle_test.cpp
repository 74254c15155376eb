// SPDX-License-Identifier: MIT
// Triangles through all of a volume, most of them thin, on the device: the answers are the host's, and few of the
// bricks of a triangle's box are examined.
#include "certified/counted_fixture.h"
#include "certified/sides.h"
#include "cpu/scenes/oracle_scenes.h"
#include "support/host_meters.h"

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

class LongTrianglesTest : public CertifiedTest {
  protected:
    /// Through the middle of a volume of so many voxels along each axis, and 1 mm each; the first is as wide as long.
    static MeshData across(std::mt19937_64& random, double side, int number) {
        MeshData mesh;
        for (int i = 0; i < number; ++i) {
            const double width = i == 0 ? side / 2 : std::pow(10, uniform(random, -3, 0));
            Vec3 from{};
            Vec3 to{};
            Vec3 third{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                from[axis] = uniform(random, -side / 2, side / 2);
                to[axis] = -from[axis] + uniform(random, -5, 5);
                third[axis] = to[axis] + width * uniform(random, -1, 1);
            }
            addTriangle(mesh, from, to, third);
        }
        return mesh;
    }
};

TEST_F(LongTrianglesTest, AreCountedAsOnTheHost) {
    const std::uint64_t seed = testSeed();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    constexpr std::uint32_t kSide = 140;
    constexpr int kTriangles = 24;
    Grid grid;
    grid.size = {kSide, kSide, kSide};
    grid.origin = {0.5 - kSide / 2.0, 0.5 - kSide / 2.0, 0.5 - kSide / 2.0};
    const VolumeData volume =
        makeVolume<std::uint8_t>(grid, ScalarType::UInt8, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const double middle = kSide / 2.0;
            return std::clamp(350 - 5 * std::hypot(x - middle, y - middle, z - middle), 0.0, 255.0);
        });
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const MeshData mesh = across(random, kSide, kTriangles);
    const std::array poses{identity(), translation({20, -10, 5}), translation({70, 60, -65})};
    AnyDesc desc{.method = CountingMethod::Compute, .projection = Projection::Certified, .counters = true};
    for (const bool clusters : {true, false}) {
        const Sides sides(context(), queue(), volume.view(), {points, {0, 255}, kDefaultTableSize}, mesh.view(),
                          clusters);
        cpu::Detector host = take(cpu::Detector::create({.threads = 1, .projection = Projection::Certified}));
        const cpu::BatchItem hostItem = sides.hostItem(poses);
        const std::vector<PairAnswer> wanted = take(host.detect({{&hostItem, 1}, {}, 0.5})).pairs;
        const BatchItem item = sides.item(poses);
        for (const bool first : {false, true}) {
            desc.stopAtFirst = first;
            for (const std::uint32_t room : {16U, 2048U}) { // what has no room is counted nevertheless
                SCOPED_TRACE(std::to_string(clusters) + " " + std::to_string(first) + " " + std::to_string(room));
                const Answered found = detect(desc, {{&item, 1}, {}, 0.5}, poses.size(), room);
                for (std::size_t i = 0; i < poses.size(); ++i) {
                    EXPECT_EQ(found.pairs[i].hit, wanted[i].hit);
                    EXPECT_EQ(found.pairs[i].possible && !found.pairs[i].hit, wanted[i].possible && !wanted[i].hit);
                    EXPECT_TRUE(first || found.pairs[i].count == wanted[i].count)
                        << found.pairs[i].count << ", " << wanted[i].count;
                }
                if (room == 2048 && !first) {
                    constexpr std::uint64_t kBricks = 18 * 18 * 18;
                    EXPECT_EQ(found.counters.bricksLeft, 0U);
                    EXPECT_LT(found.counters.bricksSeen, kBricks * kTriangles * poses.size() / 4);
                }
            }
        }
        EXPECT_GT(wanted[0].count, 500U);
    }
}

} // namespace
} // namespace voxtact::test
