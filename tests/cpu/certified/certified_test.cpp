// SPDX-License-Identifier: MIT
// The host engine's projection `certified` against the certified oracle, over random small cases; and the judge
// itself, against answers that are wrong on purpose.
//
// A failure names its case. To run that one alone: VOXTACT_TEST_SEED=<seed> VOXTACT_TEST_CASE=<number>
// voxtact_cpu_tests --gtest_filter='*AgainstTheOracle/0'
#include "cpu/judges/certified_judge.h"
#include "cpu/scenes/denormal_scenes.h"
#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <optional>

namespace voxtact::test {
namespace {

using oracle::Certainty;
using testing::HasSubstr;

/// Triangles against volumes, in all parts together.
constexpr std::size_t kTriangles = 100000;
constexpr std::size_t kParts = 8;
constexpr std::uint64_t kMostCasesInPart = 1000000;
constexpr double kMostPossible = 0.01;

std::optional<std::uint64_t> wantedCase() {
    const char* given = std::getenv("VOXTACT_TEST_CASE");
    return given == nullptr ? std::nullopt : std::optional<std::uint64_t>(std::strtoull(given, nullptr, 10));
}

struct Share {
    std::size_t cases = 0;
    std::size_t hits = 0;
    std::size_t possible = 0;
    std::size_t undecided = 0;

    void add(const EngineSays& engine, const oracle::CertifiedOracle& oracle) {
        ++cases;
        hits += engine.pair.hit ? 1U : 0U;
        possible += engine.pair.possible ? 1U : 0U;
        undecided += oracle.certainty == Certainty::Undecided ? 1U : 0U;
    }
};

std::ostream& operator<<(std::ostream& out, const Share& share) {
    return out << std::setw(6) << share.cases << " pairs, " << std::setw(6) << share.hits << " hits, " << std::setw(4)
               << share.possible << " possible, " << std::setw(4) << share.undecided << " undecided by the oracle";
}

/// A mesh in a face of the domain is in it or not by rounding alone, and no engine can say.
class Shares {
  public:
    void add(const CertifiedCase& c, const EngineSays& engine, const oracle::CertifiedOracle& oracle) {
        kinds_[static_cast<std::size_t>(c.kind)].add(engine, oracle);
        (c.onset ? onset_ : elsewhere_).add(engine, oracle);
        if (c.farOrigin) {
            farOrigin_.add(engine, oracle);
        }
        if (c.kind != CaseKind::DomainFace) {
            ordinary_.add(engine, oracle);
        }
    }

    void print() const {
        for (std::size_t kind = 0; kind < kCaseKinds; ++kind) {
            std::cout << std::setw(14) << toString(static_cast<CaseKind>(kind)) << kinds_[kind] << "\n";
        }
        std::cout << "  near contact" << onset_ << "\n     elsewhere" << elsewhere_ << "\n    far origin" << farOrigin_
                  << "\n no domain-face" << ordinary_ << "\n";
    }

    [[nodiscard]] const Share& ordinary() const { return ordinary_; }

  private:
    std::array<Share, kCaseKinds> kinds_;
    Share onset_;
    Share elsewhere_;
    Share farOrigin_;
    Share ordinary_;
};

/// False: no answer, and there will be none for other cases.
bool runCase(cpu::Detector& detector, std::uint64_t seed, std::uint64_t number, const CertifiedCase& c, Shares& tally) {
    const Result<oracle::CertifiedOracle> oracle = oracle::certifiedOracle(c.scene.pair());
    const Result<EngineSays> engine = askEngine(detector, c);
    if (!oracle.ok() || !engine.ok()) {
        ADD_FAILURE() << "seed " << seed << ", case " << number << ": "
                      << (oracle.ok() ? engine.error().text : oracle.error().text);
        return false;
    }
    EXPECT_EQ(complaints(*engine, *oracle, countCells(c)), "")
        << "VOXTACT_TEST_SEED=" << seed << " VOXTACT_TEST_CASE=" << number << ", a case of kind " << toString(c.kind);
    tally.add(c, *engine, *oracle);
    return true;
}

void describe(cpu::Detector& detector, const CertifiedCase& c) {
    const Result<oracle::CertifiedOracle> oracle = oracle::certifiedOracle(c.scene.pair());
    const Result<EngineSays> engine = askEngine(detector, c);
    if (!oracle.ok() || !engine.ok()) {
        return;
    }
    std::cout << toString(c.kind) << "; the engine says: hit " << engine->pair.hit << ", possible "
              << engine->pair.possible << ", count " << engine->pair.count << " (" << toString(engine->pair.exactness)
              << ")\n";
    for (const TouchedTriangle& touched : engine->triangles) {
        std::cout << "  triangle " << touched.triangle << ": " << touched.count << "\n";
    }
    std::cout << "the oracle says: " << toString(oracle->certainty) << "\n";
    const std::vector<CellCount> cells = countCells(c);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto [x, y, z] = oracle->triangles[i].witness;
        std::cout << "  triangle " << i << ": " << toString(oracle->triangles[i].certainty) << ", " << cells[i].certain
                  << " to " << cells[i].possible << " cells, witness " << x << " " << y << " " << z << "\n";
    }
}

class Certified : public testing::TestWithParam<std::size_t> {};

TEST_P(Certified, AgainstTheOracle) {
    const std::uint64_t seed = testSeed();
    Result<cpu::Detector> detector =
        cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.triangles = true}});
    ASSERT_TRUE(detector.ok()) << detector.error().text;
    Shares tally;
    if (const std::optional<std::uint64_t> wanted = wantedCase()) {
        if (GetParam() == 0) {
            const CertifiedCase c = makeCertifiedCase(seed, *wanted);
            describe(*detector, c);
            runCase(*detector, seed, *wanted, c, tally);
        }
        return;
    }
    std::uint64_t number = GetParam() * kMostCasesInPart;
    for (std::size_t triangles = 0; triangles < kTriangles / kParts; ++number) {
        const CertifiedCase c = makeCertifiedCase(seed, number);
        triangles += c.scene.mesh.indices.size() / 3;
        ASSERT_TRUE(runCase(*detector, seed, number, c, tally));
        ASSERT_FALSE(HasFailure());
    }
    tally.print();
    const Share& share = tally.ordinary();
    EXPECT_GT(share.hits, share.cases / 10) << "a test that hits nothing proves nothing";
    EXPECT_GT(share.cases - share.hits, share.cases / 10);
    EXPECT_LE(static_cast<double>(share.possible), kMostPossible * static_cast<double>(share.cases));
}

TEST(CertifiedYesNo, IsTheVerdictOfTheCount) {
    constexpr std::uint64_t kCases = 6000;
    const std::uint64_t seed = testSeed();
    cpu::Detector count = take(
        cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.triangles = true}}));
    cpu::Detector yesNo =
        take(cpu::Detector::create({.threads = 1, .stopAtFirst = true, .projection = Projection::Certified}));
    std::size_t hits = 0;
    for (std::uint64_t number = 0; number < kCases && !testing::Test::HasFailure(); ++number) {
        const CertifiedCase c = makeCertifiedCase(seed, number);
        const PairAnswer all = take(askEngine(count, c)).pair;
        const PairAnswer first = take(askEngine(yesNo, c)).pair;
        EXPECT_EQ(first.hit, all.hit) << "seed " << seed << ", case " << number << ", " << toString(c.kind);
        EXPECT_EQ(first.possible, all.possible) << "seed " << seed << ", case " << number << ", " << toString(c.kind);
        EXPECT_EQ(first.count, all.hit ? 1U : 0U);
        hits += all.hit ? 1U : 0U;
    }
    EXPECT_GT(hits, kCases / 10);
}

/// Without triangles; voxel space is world space.
CertifiedCase byteBlock(std::uint32_t side, const VoxelFunction& value) {
    Grid grid;
    grid.size = {side, side, side};
    CertifiedCase c = makeCertifiedCase(0, 0);
    c.scene.mesh = {};
    c.scene.volume = makeVolume<std::uint8_t>(grid, ScalarType::UInt8, value);
    c.scene.points = {{0, 0}, {100, 1}};
    c.scene.domain = {0, 255};
    c.scene.tableSize = kDefaultTableSize;
    c.scene.world_from_object = identity();
    c.scene.threshold = 0.5;
    return c;
}

/// The elements are doubles; what a float cannot hold must not end in a certain answer that is wrong.
TEST(CertifiedExtremes, APoseBeyondFloatsIsNotCalledACertainMiss) {
    cpu::Detector detector = take(
        cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.triangles = true}}));
    for (const double scale : {1e30, 3e38, 1e39, 1e44, 1e60, 1e300}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE("scale " + std::to_string(std::log10(scale)) + ", axis " + std::to_string(axis));
            CertifiedCase c = byteBlock(8, [](auto...) { return 200.0; });
            c.scene.world_from_object[5 * axis] = scale;
            c.scene.world_from_object[12 + axis] = 1;
            Vec3 corners[3] = {{1, 2, 2}, {5, 2, 3}, {3, 5, 5}};
            for (Vec3& corner : corners) {
                corner[axis] = 0;
            }
            addTriangle(c.scene.mesh, corners[0], corners[1], corners[2]);
            const oracle::CertifiedOracle oracle = take(oracle::certifiedOracle(c.scene.pair()));
            EXPECT_EQ(oracle.certainty, Certainty::Certain);
            EXPECT_EQ(complaints(take(askEngine(detector, c)), oracle, {}), "");
        }
    }
}

/// A voxel that is far from all others, as what stands for no data may be, costs certainty about itself alone.
TEST(CertifiedExtremes, AnOutlierDoesNotSpoilItsBrick) {
    const std::uint64_t seed = testSeed();
    cpu::Detector detector = take(
        cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.triangles = true}}));
    std::uint64_t hits = 0;
    for (std::uint64_t number = 0; number < randomCases(300, 30); ++number) {
        const CertifiedCase usual = outlierCase(seed + number, 10, false);
        const PairAnswer plain = take(askEngine(detector, usual)).pair;
        hits += plain.hit ? 1U : 0U;
        // A cell that a triangle grazes, within rounding, counts or does not, depending on what is known around it.
        CellCount cells;
        for (const CellCount& of : countCells(usual)) {
            cells.certain += of.certain;
            cells.possible += of.possible;
        }
        for (const double outlier : {-1e5, 1e7, -1e20, -3.4e38, 3.4e38}) {
            SCOPED_TRACE("VOXTACT_TEST_SEED=" + std::to_string(seed) + ", case " + std::to_string(number) + ", " +
                         std::to_string(outlier));
            const PairAnswer found = take(askEngine(detector, outlierCase(seed + number, outlier, false))).pair;
            EXPECT_GE(found.count, std::min(plain.count, cells.certain));
            EXPECT_LE(found.count, cells.possible);
            if ((plain.hit && cells.certain > 0) || cells.possible == 0) {
                EXPECT_EQ(found.possible, plain.possible);
            }
            const CertifiedCase near = outlierCase(seed + number, outlier, true);
            EXPECT_EQ(complaints(take(askEngine(detector, near)), take(oracle::certifiedOracle(near.scene.pair())),
                                 countCells(near)),
                      "");
        }
    }
    EXPECT_GT(hits, 5U);
}

TEST(CertifiedExtremes, WhatDependsOnDenormalsIsPossible) {
    cpu::Detector detector = take(
        cpu::Detector::create({.threads = 1, .projection = Projection::Certified, .outputs = {.triangles = true}}));
    for (const DenormalScene& denormal : denormalScenes()) {
        SCOPED_TRACE(denormal.name);
        const oracle::CertifiedOracle oracle = take(oracle::certifiedOracle(denormal.scene.scene.pair()));
        EXPECT_EQ(oracle.certainty, Certainty::Certain);
        const EngineSays says = take(askEngine(detector, denormal.scene));
        EXPECT_EQ(complaints(says, oracle, {}), "");
        EXPECT_EQ(says.pair.hit, denormal.decided);
        EXPECT_EQ(says.pair.possible, !denormal.decided);
    }
    for (const double scale : {1.0, 0x1p-90, 0x1p90, 0x1p110}) {
        EXPECT_TRUE(take(askEngine(detector, scaledTriangle(scale))).pair.hit) << scale;
    }
}

/// The vertex that proves the touch is a corner of the fragment's last piece, and the first one, where opacities are
/// too small to tell from nothing, has more pieces than are examined.
TEST(CertifiedYesNo, IsTheVerdictOfTheCountWhereAFragmentHasTooManyPieces) {
    CertifiedCase c = byteBlock(2, [](auto, auto y, auto) { return y == 0 ? 0.0 : 255.0; });
    c.scene.points = {{100, 0}, {100, 1e-6}};
    c.scene.domain = {-156, 411};
    c.scene.tableSize = 2;
    c.scene.threshold = 1e-30;
    addTriangle(c.scene.mesh, {0.1, 0.1, 0.5}, {1.4, 0.1, 0.5}, {0.1, 0.9, 0.5});
    constexpr double kResolution = 1.0 / 512;
    cpu::Detector count = take(cpu::Detector::create({.threads = 1,
                                                      .projection = Projection::Certified,
                                                      .outputs = {.triangles = true},
                                                      .resolution = kResolution}));
    cpu::Detector yesNo = take(cpu::Detector::create(
        {.threads = 1, .stopAtFirst = true, .projection = Projection::Certified, .resolution = kResolution}));
    const PairAnswer all = take(askEngine(count, c)).pair;
    const PairAnswer first = take(askEngine(yesNo, c)).pair;
    EXPECT_EQ(first.hit, all.hit);
    EXPECT_EQ(first.possible, all.possible);
}

INSTANTIATE_TEST_SUITE_P(Parts, Certified, testing::Range<std::size_t>(0, kParts));

/// What an honest engine says of a pair whose triangles the oracle finds to be: certain, none, undecided.
struct Trial {
    oracle::CertifiedOracle oracle{Certainty::Certain,
                                   {{Certainty::Certain, {}, false}, {}, {Certainty::Undecided, {}, false}}};
    std::vector<CellCount> cells{{3, 4}, {0, 0}, {0, 2}};
    EngineSays engine{{.hit = true, .count = 5, .method = CountingMethod::Cpu, .projection = Projection::Certified},
                      {{.pair = 0, .triangle = 0, .count = 4}, {.pair = 0, .triangle = 2, .count = 1}}};

    [[nodiscard]] std::string verdict() const { return complaints(engine, oracle, cells); }
};

TEST(CertifiedJudge, AcceptsWhatIsRight) {
    Trial trial;
    EXPECT_EQ(trial.verdict(), "");
    trial.engine.triangles = {{.pair = 0, .triangle = 0, .count = 3}};
    trial.engine.pair.count = 3;
    EXPECT_EQ(trial.verdict(), "");
    // Too few are right where the count is a lower bound, and none where contact is possible.
    trial.engine.pair.exactness = Exactness::LowerBound;
    trial.engine.triangles = {{.pair = 0, .triangle = 0, .count = 1}};
    trial.engine.pair.count = 1;
    EXPECT_EQ(trial.verdict(), "");
    trial.engine.triangles = {};
    trial.engine.pair.count = 0;
    trial.engine.pair.hit = false;
    trial.engine.pair.possible = true;
    EXPECT_EQ(trial.verdict(), "");
    // Without a contact, possible is allowed.
    trial.oracle = {Certainty::None, {{}, {}, {}}};
    trial.cells = {{}, {}, {}};
    EXPECT_EQ(trial.verdict(), "");
}

TEST(CertifiedJudge, ComplainsOfWrongPairs) {
    Trial missed;
    missed.engine.triangles = {};
    missed.engine.pair.count = 0;
    missed.engine.pair.hit = false;
    EXPECT_THAT(missed.verdict(), HasSubstr("certain contact is missed"));

    Trial invented;
    invented.oracle = {Certainty::None, {{}, {}, {}}};
    EXPECT_THAT(invented.verdict(), HasSubstr("beyond doubt no contact"));

    Trial unsure;
    unsure.engine.pair.possible = true;
    EXPECT_THAT(unsure.verdict(), HasSubstr("both a hit and possible"));
    EXPECT_THAT(unsure.verdict(), HasSubstr("an exact count"));

    Trial silent;
    silent.engine.pair.hit = false;
    EXPECT_THAT(silent.verdict(), HasSubstr("hit is 0 with a count of 5"));

    Trial other;
    other.engine.pair.projection = Projection::View;
    EXPECT_THAT(other.verdict(), HasSubstr("the projection is view"));
}

TEST(CertifiedJudge, ComplainsOfWrongTriangles) {
    Trial invented;
    invented.engine.triangles[1].triangle = 1;
    EXPECT_THAT(invented.verdict(), HasSubstr("triangle 1 is listed"));

    Trial missed;
    missed.engine.triangles = {{.pair = 0, .triangle = 2, .count = 2}};
    missed.engine.pair.count = 2;
    missed.cells.clear();
    EXPECT_THAT(missed.verdict(), HasSubstr("triangle 0 certainly touches"));

    Trial outside;
    outside.engine.triangles[1].triangle = 3;
    EXPECT_THAT(outside.verdict(), HasSubstr("the list has triangle 3"));

    Trial unordered;
    std::swap(unordered.engine.triangles[0], unordered.engine.triangles[1]);
    EXPECT_THAT(unordered.verdict(), HasSubstr("triangle 0 after 2"));

    Trial idle;
    idle.engine.triangles[1].count = 0;
    EXPECT_THAT(idle.verdict(), HasSubstr("triangle 2 of pair 0, 0 times"));

    Trial sum;
    sum.engine.pair.count = 6;
    EXPECT_THAT(sum.verdict(), HasSubstr("that of the triangles 5"));
}

TEST(CertifiedJudge, ComplainsOfWrongCounts) {
    Trial few;
    few.engine.triangles[0].count = 2;
    few.engine.pair.count = 3;
    EXPECT_THAT(few.verdict(), HasSubstr("triangle 0 has a count of 2 (exact), it touches in 3 to 4"));
    few.engine.pair.exactness = Exactness::LowerBound;
    EXPECT_EQ(few.verdict(), "");

    Trial many;
    many.engine.triangles[0].count = 5;
    many.engine.pair.count = 6;
    many.engine.pair.exactness = Exactness::LowerBound;
    EXPECT_THAT(many.verdict(), HasSubstr("triangle 0 has a count of 5 (lower bound)"));
}

/// An engine that finds what the oracle is certain of.
EngineSays honest(const oracle::CertifiedOracle& oracle, const std::vector<CellCount>& cells) {
    EngineSays out{{.method = CountingMethod::Cpu, .projection = Projection::Certified}, {}};
    for (std::uint32_t triangle = 0; triangle < cells.size(); ++triangle) {
        if (cells[triangle].certain > 0) {
            const auto count = static_cast<std::uint32_t>(cells[triangle].certain);
            out.triangles.push_back({.pair = 0, .triangle = triangle, .count = count});
            out.pair.count += count;
        } else if (oracle.triangles[triangle].certainty != Certainty::None) {
            out.pair.exactness = Exactness::LowerBound;
            out.pair.possible = true;
        }
    }
    out.pair.hit = out.pair.count > 0;
    out.pair.possible = out.pair.possible && !out.pair.hit;
    return out;
}

TEST(CertifiedJudge, NoticesWhatIsForgedInRandomCases) {
    const std::uint64_t seed = testSeed();
    std::size_t forgedTriangles = 0;
    std::size_t forgedPairs = 0;
    for (std::uint64_t number = 0; number < 1000; ++number) {
        SCOPED_TRACE("case " + std::to_string(number));
        const CertifiedCase c = makeCertifiedCase(seed, number);
        const oracle::CertifiedOracle oracle = oracle::certifiedOracle(c.scene.pair()).value();
        const std::vector<CellCount> cells = countCells(c);
        const EngineSays good = honest(oracle, cells);
        EXPECT_EQ(complaints(good, oracle, cells), "");
        if (oracle.certainty == Certainty::Certain) {
            EngineSays none = good;
            none.pair.hit = none.pair.possible = false;
            none.pair.count = 0;
            none.triangles.clear();
            EXPECT_NE(complaints(none, oracle, cells), "");
            ++forgedPairs;
        }
        for (std::uint32_t triangle = 0; triangle < cells.size(); ++triangle) {
            if (oracle.triangles[triangle].certainty == Certainty::None) {
                EngineSays more = good;
                more.triangles = {{.pair = 0, .triangle = triangle, .count = 1}};
                more.pair.count = 1;
                more.pair.hit = true;
                more.pair.possible = false;
                EXPECT_NE(complaints(more, oracle, {}), "");
                ++forgedTriangles;
            }
        }
    }
    EXPECT_GT(forgedPairs, 100U);
    EXPECT_GT(forgedTriangles, 100U);
}

} // namespace
} // namespace voxtact::test
