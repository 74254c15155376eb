// SPDX-License-Identifier: MIT
// Overlaps of random scenes against the oracle and against random points.
#include "cpu/overlap/known_scenes.h"
#include "cpu/overlap/overlap_held.h"
#include "cpu/overlap/solids.h"
#include "cpu/scenes/certified_scenes.h"
#include "cpu/scenes/random_labels.h"
#include "cpu/scenes/random_scene.h"
#include "oracle/overlap_oracle.h"

#include <cmath>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

using oracle::OracleOverlap;

/// Whole numbers of a few values, so that there are plateaus, with limits at some of them.
void addPlateaus(std::mt19937_64& random, OracleScene& scene) {
    const Grid grid = randomSmallGrid(random);
    const std::size_t block = 1 + below(random, 5);
    const std::uint64_t key = random();
    scene.volume = makeVolume<std::int16_t>(grid, ScalarType::Int16, [&](auto x, auto y, auto z) {
        std::mt19937_64 local(key ^ (x / block + 1009ULL * (y / block) + 1000003ULL * (z / block)));
        return 10.0 * static_cast<double>(local() % 5) - 20;
    });
    const double from = 10.0 * static_cast<double>(below(random, 5)) - 20;
    scene.points = opaqueFrom(from);
    if (chance(random, 0.4)) { // a spike, or one value alone
        scene.points = {{from - uniform(random, 0, 8), 0}, {from, 1}, {from + uniform(random, 0, 8), 0}};
    }
    scene.threshold = chance(random, 0.5) ? 1 : 0.5;
}

struct OverlapCase {
    OracleScene scene;
    Overlap question;
    LabelData labels;
};

OverlapCase makeCase(std::uint64_t seed, std::uint64_t number) {
    std::mt19937_64 random(seed + 0x9e3779b97f4a7c15ULL * number);
    OverlapCase out;
    if (number % 2 == 0) {
        addPlateaus(random, out.scene);
    } else {
        RandomScene scene = makeRandomScene(random, 1);
        out.scene.volume = std::move(scene.volume);
        out.scene.points = std::move(scene.points);
        out.scene.domain = scene.domain;
        out.scene.tableSize = scene.tableSize;
        out.scene.threshold = scene.threshold;
    }
    const Grid& grid = out.scene.volume.grid;
    const double size = std::cbrt(std::abs(signedVolume(solidBox({0, 0, 0}, {1, 1, 1}), worldFromTexture(grid))));
    out.scene.mesh = randomSolid(random, 0.5 * size * std::pow(10, uniform(random, -1, 0.3)));
    out.scene.world_from_object = randomPoses(grid, 1, 1, random).front();
    const double whole = std::abs(signedVolume(out.scene.mesh)) + 1e-3 * size * size * size;
    out.question.tolerance = std::max(1e-9, whole * std::pow(10, uniform(random, -4, -1)));
    out.question.maxSteps = 1U << 14U;
    const ValueRange range = take(checkVolume(out.scene.volume.view()));
    for (double limit = range.lo; below(random, 3) != 0 && limit <= range.hi;) {
        out.question.bandLimits.push_back(limit);
        const double next = limit + uniform(random, 0.1, 0.5) * (range.hi - range.lo) + 1e-6 * range.hi;
        limit = out.scene.volume.type == ScalarType::Float32 ? next : std::floor(next) + 1;
        if (!(limit > out.question.bandLimits.back())) {
            break;
        }
    }
    if (chance(random, 0.5)) {
        out.labels = randomLabels(random, grid);
        out.question.labels = {2, 0, 77, 1, 3};
    }
    return out;
}

void expectBetween(const Bounds& says, const Bounds& truth, double doubt) {
    EXPECT_GE(says.lower, 0);
    EXPECT_LE(says.lower, says.upper);
    EXPECT_LE(says.lower, truth.upper + doubt)
        << "not so much: " << says.lower << " to " << says.upper << ", truth " << truth.lower << " to " << truth.upper;
    EXPECT_GE(says.upper, truth.lower - doubt) << "more than that: " << says.lower << " to " << says.upper << ", truth "
                                               << truth.lower << " to " << truth.upper;
}

/// Where the oracle has no bound above 0 it knows nothing.
void expectContainment(Containment says, const Bounds& inside, const Bounds& outside) {
    switch (says) {
    case Containment::None:
        EXPECT_EQ(inside.lower, 0);
        break;
    case Containment::All:
        EXPECT_EQ(outside.lower, 0);
        EXPECT_GT(inside.upper, 0);
        break;
    case Containment::Some:
        EXPECT_GT(inside.upper, 0);
        EXPECT_GT(outside.upper, 0);
        break;
    case Containment::Undecided:
        break;
    }
}

/// What the counts of a run are printed as.
struct Tally {
    std::map<std::string, std::size_t> ends;
    std::map<std::string, std::size_t> containments;
    std::size_t parts = 0;  ///< some of the solid is opaque, and some is not
    std::size_t sharp = 0;  ///< the oracle knows that to a half
    std::size_t bands = 0;  ///< with some volume
    std::size_t labels = 0; ///< likewise
};

void judge(const OverlapCase& c, Tally& tally) {
    const bool labelled = !c.question.labels.empty();
    const OverlapAnswer says = overlaps(c.scene, c.question, labelled ? &c.labels : nullptr);
    const OracleOverlap truth =
        take(oracle::overlapOracle(c.scene.pair(), c.question, labelled ? &c.labels : nullptr, 40000));
    const Bounds solid = take(oracle::solidOracle(c.scene.pair(), 5000));
    const double doubt = 1e-10 * solid.upper;
    const PairOverlap& pair = says.pairs.at(0);
    expectBetween(pair.bounds, truth.inside, doubt);
    expectBetween(pair.solid, solid, doubt);
    expectContainment(pair.inside, truth.inside, truth.outside);
    EXPECT_EQ(pair.end == StopReason::Closed, pair.bounds.upper - pair.bounds.lower <= c.question.tolerance);
    Bounds sum;
    ASSERT_EQ(says.bands.size(), truth.bands.size());
    for (std::size_t i = 0; i < says.bands.size(); ++i) {
        SCOPED_TRACE("band " + std::to_string(i));
        const BandOverlap& band = says.bands[i];
        EXPECT_EQ(band.band, i);
        expectBetween(band.bounds, truth.bands[i], doubt);
        EXPECT_EQ(band.end == StopReason::Closed, band.bounds.upper - band.bounds.lower <= c.question.tolerance);
        sum = {sum.lower + band.bounds.lower, sum.upper + band.bounds.upper};
        tally.bands += band.bounds.lower > 0 ? 1 : 0;
    }
    if (!says.bands.empty()) {
        expectBetween(sum, truth.solid, doubt);
    }
    sum = {};
    ASSERT_EQ(says.labels.size(), c.question.labels.size());
    for (std::size_t i = 0; i < says.labels.size(); ++i) {
        SCOPED_TRACE("label " + std::to_string(i));
        const LabelOverlap& label = says.labels[i];
        EXPECT_EQ(label.label, c.question.labels[i]);
        expectBetween(label.bounds, truth.labels[i].inside, doubt);
        expectContainment(label.inside, truth.labels[i].inside, truth.labels[i].outside);
        EXPECT_EQ(label.end == StopReason::Closed, label.bounds.upper - label.bounds.lower <= c.question.tolerance);
        sum = {sum.lower + label.bounds.lower, sum.upper + label.bounds.upper};
        tally.labels += label.bounds.lower > 0 ? 1 : 0;
    }
    if (!says.labels.empty()) {
        expectBetween(sum, truth.inside, doubt); // every voxel has one of them
        EXPECT_EQ(says.labels[2].bounds.upper, 0);
    }
    const bool isPart = pair.bounds.lower > 0 && pair.bounds.upper < 0.99 * pair.solid.lower;
    ++tally.ends[toString(pair.end)];
    ++tally.containments[toString(pair.inside)];
    tally.parts += isPart ? 1 : 0;
    tally.sharp += isPart && truth.inside.upper - truth.inside.lower < 0.5 * truth.inside.upper ? 1 : 0;
}

TEST(OverlapOracle, TheTruthIsBetweenTheBounds) {
    const std::uint64_t seed = testSeed();
    const std::size_t cases = randomCases(40000, 500);
    Tally tally;
    for (std::uint64_t number = 0; number < cases; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        judge(makeCase(seed, number), tally);
        ASSERT_FALSE(HasFailure());
    }
    for (const auto& [name, count] : tally.ends) {
        std::cout << name << " " << count << ", ";
    }
    for (const auto& [name, count] : tally.containments) {
        std::cout << name << " " << count << ", ";
    }
    std::cout << tally.parts << " in part, " << tally.sharp << " of these known to a half, " << tally.bands
              << " bands, " << tally.labels << " labels\n";
    EXPECT_GT(tally.parts, cases / 5);
    EXPECT_GT(tally.sharp, cases / 20);
    EXPECT_GT(tally.bands, cases / 5);
    EXPECT_GT(tally.labels, cases / 5);
    EXPECT_GT(tally.ends["closed"], cases * 3 / 4);
    EXPECT_LT(tally.containments["undecided"], cases / 4);
}

/// The crossings of a ray from a point along +x: how often it leaves, less how often it enters.
int crossings(const MeshData& mesh, const Vec3& from) {
    int sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const double* corners[3];
        for (std::size_t j = 0; j < 3; ++j) {
            corners[j] = &mesh.positions[std::size_t{3} * mesh.indices[i + j]];
        }
        std::array<double, 3> areas{};
        for (std::size_t j = 0; j < 3; ++j) {
            const double* a = corners[(j + 1) % 3];
            const double* b = corners[(j + 2) % 3];
            areas[j] = (a[1] - from[1]) * (b[2] - from[2]) - (a[2] - from[2]) * (b[1] - from[1]);
        }
        const bool up = areas[0] >= 0 && areas[1] >= 0 && areas[2] >= 0;
        const bool down = areas[0] <= 0 && areas[1] <= 0 && areas[2] <= 0;
        const double all = areas[0] + areas[1] + areas[2];
        if (up == down) {
            continue;
        }
        const double x = (areas[0] * corners[0][0] + areas[1] * corners[1][0] + areas[2] * corners[2][0]) / all;
        sum += x > from[0] ? (up ? 1 : -1) : 0;
    }
    return sum;
}

/// Random points are inside as often as the bounds say.
TEST(OverlapOracle, SoDoRandomPointsSay) {
    std::mt19937_64 random(testSeed());
    constexpr double kPoints = 1e6;
    double sharpest = 1;
    for (std::size_t round = 0; round < randomCases(60, 20); ++round) {
        SCOPED_TRACE(round);
        OracleScene scene;
        addPlateaus(random, scene);
        const Grid& grid = scene.volume.grid;
        const LabelData labels = randomLabels(random, grid);
        scene.mesh = randomSolid(random, 0.7 * linearRadius(grid));
        scene.world_from_object = multiply(translation(middleOf(grid)), randomRotation(random));
        const double image = std::abs(signedVolume(solidBox({0, 0, 0}, {1, 1, 1}), worldFromTexture(grid)));
        const Overlap question{.tolerance = 1e-3 * image, .bandLimits = {-10, 5.5, 10}, .labels = {0, 2}};
        const OverlapAnswer found = overlaps(scene, question, &labels);
        const Mat4 object_from_index = multiply(take(inverse(scene.world_from_object)), worldFromIndex(grid));
        std::size_t hits = 0;
        std::array<std::size_t, 4> inBands{};
        std::array<std::size_t, 4> inLabels{};
        for (int i = 0; i < static_cast<int>(kPoints); ++i) {
            Vec3 index{};
            std::array<std::size_t, 3> voxel{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                index[axis] = uniform(random, -0.5, grid.size[axis] - 0.5);
                voxel[axis] = static_cast<std::size_t>(index[axis] + 0.5);
            }
            if (crossings(scene.mesh, transformPoint(object_from_index, index)) == 0) {
                continue;
            }
            const double value = valueAt(scene.volume, index);
            ++inBands[(value >= -10 ? 1U : 0U) + (value >= 5.5 ? 1U : 0U) + (value >= 10 ? 1U : 0U)];
            if (opacityOfValue(scene.points, value) >= scene.threshold) {
                ++hits;
                ++inLabels[labels.indices[(voxel[2] * grid.size[1] + voxel[1]) * grid.size[0] + voxel[0]]];
            }
        }
        const auto expectShare = [&](const Bounds& bounds, std::size_t count) {
            const double share = static_cast<double>(count) / kPoints;
            const double slack = image * (6 * std::sqrt(share * (1 - share) / kPoints) + 20 / kPoints);
            expectBetween(bounds, {share * image, share * image}, slack);
            return count > 0 ? slack / (share * image) : 1;
        };
        expectShare(found.pairs.at(0).bounds, hits);
        for (std::size_t band = 0; band < inBands.size(); ++band) {
            sharpest = std::min(sharpest, expectShare(found.bands.at(band).bounds, inBands[band]));
        }
        for (std::size_t i = 0; i < question.labels.size(); ++i) {
            const auto at = std::find(labels.values.begin(), labels.values.end(), question.labels[i]);
            expectShare(found.labels.at(i).bounds,
                        at == labels.values.end() ? 0 : inLabels[static_cast<std::size_t>(at - labels.values.begin())]);
        }
    }
    std::cout << "known to " << sharpest << " of it at best\n";
    EXPECT_LT(sharpest, 0.2);
}

} // namespace
} // namespace voxtact::test
