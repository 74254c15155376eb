// SPDX-License-Identifier: MIT
// Contact areas of random scenes against the oracle, which knows nothing of cells' faces and linear parts.
#include "cpu/area/area_held.h"

#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/clearance_cases.h"
#include "cpu/scenes/held_scene.h"
#include "cpu/scenes/random_labels.h"
#include "oracle/area_oracle.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

using oracle::OracleArea;

/// Like those of the certified tests; in half of them more is opaque than at the onset of contact.
CertifiedCase areaCase(std::uint64_t seed, std::uint64_t number) {
    CertifiedCase c = number % 2 == 0 ? makeCertifiedCase(seed, number) : makeClearanceCase(seed, number);
    c.scene.threshold *= number % 4 < 2 ? 0.5 : 1;
    return c;
}

/// Of the triangles in the world, mm^2; and what the oracle may round off of it.
struct Surface {
    double area = 0;
    double doubt = 0;
};

Surface surfaceWithDoubt(const OracleScene& scene) {
    Surface out{surfaceOf(scene.mesh, scene.world_from_object), 0};
    for (std::size_t i = 0; i < scene.mesh.indices.size(); i += 3) {
        std::array<Vec3, 3> t{};
        double largest = 0;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const double* at = &scene.mesh.positions[std::size_t{3} * scene.mesh.indices[i + corner]];
            t[corner] = transformPoint(scene.world_from_object, {at[0], at[1], at[2]});
            for (std::size_t axis = 0; axis < 3; ++axis) {
                largest = std::max({largest, std::abs(t[corner][axis]), std::abs(scene.world_from_object[12 + axis])});
            }
        }
        for (const Vec3& to : {t[1], t[2]}) {
            out.doubt += 1e-14 * largest * std::hypot(to[0] - t[0][0], to[1] - t[0][1], to[2] - t[0][2]);
        }
    }
    out.doubt += 1e-12 * out.area;
    return out;
}

void expectBetween(const Bounds& says, const OracleArea& truth, double doubt) {
    EXPECT_LE(says.lower, says.upper);
    EXPECT_LE(says.lower, truth.hi + doubt)
        << "not so much: " << says.lower << " to " << says.upper << ", truth " << truth.lo << " to " << truth.hi;
    EXPECT_GE(says.upper, truth.lo - doubt)
        << "more than that: " << says.lower << " to " << says.upper << ", truth " << truth.lo << " to " << truth.hi;
}

TEST(AreaOracle, TheTruthIsBetweenTheBounds) {
    const std::uint64_t seed = testSeed();
    cpu::Detector detector =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
    std::map<std::string, std::size_t> ends;
    std::size_t touching = 0;
    std::size_t sharp = 0; // the oracle's bounds are near to each other, too
    const std::size_t cases = randomCases(100000, 400);
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const CertifiedCase c = areaCase(seed, number);
        const HeldScene held(c.scene);
        const Surface surface = surfaceWithDoubt(c.scene);
        const double tolerance = std::max(1e-3 * surface.area, 1e-9);
        cpu::AreaMeter meter = take(cpu::AreaMeter::create({.threads = 1, .tolerance = tolerance}));
        const PairArea says = take(meter.measure(held.batch)).pairs.at(0);
        const OracleArea truth = take(oracle::areaOracle(c.scene.pair()));
        expectBetween(says.bounds, truth, surface.doubt);
        EXPECT_LE(says.bounds.lower, surface.area + surface.doubt);
        const PairAnswer touch = take(detector.detect(held.batch)).pairs.at(0);
        EXPECT_TRUE(touch.hit || touch.possible || says.bounds.upper == 0);
        EXPECT_TRUE(says.bounds.lower == 0 || touch.hit || touch.possible);
        EXPECT_EQ(says.end == StopReason::Closed, says.bounds.upper - says.bounds.lower <= tolerance);
        ++ends[toString(says.end)];
        touching += says.bounds.lower > 0 ? 1 : 0;
        sharp += says.bounds.lower > 0 && truth.hi - truth.lo < 0.1 * truth.hi ? 1 : 0;
        ASSERT_FALSE(HasFailure());
    }
    std::cout << touching << " have an area, " << sharp << " of these are known to a tenth; closed " << ends["closed"]
              << ", rounding " << ends["rounding"] << ", budget " << ends["budget"] << "\n";
    EXPECT_GT(touching, cases / 4);
    EXPECT_GT(sharp, cases / 10);
    EXPECT_GT(ends["closed"], cases * 3 / 4);
}

TEST(AreaOracle, TheTruthOfLabelsIsBetweenTheirBounds) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const std::vector<std::int32_t> asked{2, 0, 3, 1, 77, 2};
    std::size_t touching = 0;
    std::size_t closed = 0;
    const std::size_t cases = randomCases(20000, 200);
    for (std::uint64_t number = 0; number < cases; ++number) {
        const CertifiedCase c = areaCase(seed, number);
        const LabelData labels = randomLabels(random, c.scene.volume.grid);
        HeldScene held(c.scene);
        held.item.labels = &labels;
        const Surface surface = surfaceWithDoubt(c.scene);
        const double tolerance = std::max(1e-3 * surface.area, 1e-9);
        cpu::AreaMeter meter = take(cpu::AreaMeter::create({.threads = 1, .tolerance = tolerance}));
        const std::vector<LabelArea> says = take(meter.measureLabels(held.batch, asked)).labels;
        const Bounds whole = take(meter.measure(held.batch)).pairs.at(0).bounds;
        ASSERT_EQ(says.size(), asked.size());
        Bounds all;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            SCOPED_TRACE("case " + std::to_string(number) + ", label " + std::to_string(asked[i]));
            EXPECT_EQ(says[i].label, asked[i]);
            expectBetween(says[i].bounds, take(oracle::labelAreaOracle(c.scene.pair(), labels, asked[i])),
                          surface.doubt);
            touching += says[i].bounds.lower > 0 ? 1 : 0;
            closed += says[i].end == StopReason::Closed ? 1 : 0;
            if (i < 4) {
                all.lower += says[i].bounds.lower;
                all.upper += says[i].bounds.upper;
            }
        }
        EXPECT_EQ(says[4].bounds.upper, 0); // no voxel has it
        EXPECT_EQ(says[5].bounds.lower, says[0].bounds.lower);
        EXPECT_EQ(says[5].bounds.upper, says[0].bounds.upper);
        // Everything has one of the labels.
        EXPECT_LE(all.lower, whole.upper + surface.doubt);
        EXPECT_GE(all.upper, whole.lower - surface.doubt);
        ASSERT_FALSE(HasFailure());
    }
    std::cout << touching << " have an area, " << closed << " closed\n";
    EXPECT_GT(touching, cases / 10);
    EXPECT_GT(closed, cases * 6 * 19 / 20);
}

} // namespace
} // namespace voxtact::test
