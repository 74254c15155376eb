// SPDX-License-Identifier: MIT
// What bench --latency makes of ticks: who must answer what, the way of the mesh, the quantiles.
#include "bench/engine_bench/parts.h"
#include "bench/measure/numbers.h"
#include "cli/make/poses.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace voxtact::test {
namespace {

using lab::BenchMode;
using lab::BenchResult;
using lab::BenchRow;
using lab::EngineFacts;
using lab::judgePose;
using lab::PoseTruth;
using testing::HasSubstr;
using testing::Not;

PairAnswer answer(std::uint64_t count, CountingMethod method, bool possible = false) {
    return {.hit = count > 0, .possible = possible, .count = count, .method = method};
}

EngineFacts facts(const char* name, const char* question, bool certified) {
    return {.name = name, .projection = certified ? "certified" : "view", .question = question, .certified = certified};
}

PoseTruth truth(std::uint64_t certified, std::uint64_t view, bool possible = false) {
    return {answer(certified, CountingMethod::Cpu, possible), answer(view, CountingMethod::Cpu)};
}

TEST(TickJudgeTest, CertifiedAnswersAreTheHosts) {
    PoseTruth must = truth(3, 0);
    EXPECT_EQ(judgePose(facts("compute", "count", true), answer(3, CountingMethod::Compute), must), "");
    EXPECT_EQ(judgePose(facts("compute", "yes/no", true), answer(1, CountingMethod::Compute), must), "");
    EXPECT_EQ(judgePose(facts("compute", "count", true), answer(2, CountingMethod::Compute), must),
              "compute certified count says 2; expected: 3");
    EXPECT_EQ(judgePose(facts("compute", "yes/no", true), answer(3, CountingMethod::Compute), must),
              "compute certified yes/no says 3; expected: 1");
    PoseTruth perhaps = truth(0, 0, true);
    EXPECT_EQ(judgePose(facts("cpu", "yes/no", true), answer(0, CountingMethod::Cpu, true), perhaps), "");
    EXPECT_EQ(judgePose(facts("cpu", "yes/no", true), answer(0, CountingMethod::Cpu), perhaps),
              "cpu certified yes/no says 0; expected: possible");
}

TEST(TickJudgeTest, ACountThatIsALowerBoundIsComparedAllTheSame) {
    // The certified count of a pair with undecided cells is a lower bound, and still everybody's.
    PoseTruth must = truth(3, 0);
    must.certified.exactness = Exactness::LowerBound;
    PairAnswer other = answer(2, CountingMethod::Compute);
    other.exactness = Exactness::LowerBound;
    EXPECT_NE(judgePose(facts("compute", "count", true), other, must), "");
}

TEST(TickJudgeTest, TheRasteriserAgreesWithItselfAndComputeWithTheHost) {
    PoseTruth must = truth(9, 100);
    EXPECT_EQ(judgePose(facts("query", "count", false), answer(101, CountingMethod::Query), must), "") << "rounding";
    EXPECT_EQ(judgePose(facts("atomic", "count", false), answer(101, CountingMethod::Atomic), must), "");
    EXPECT_EQ(judgePose(facts("atomic", "count", false), answer(100, CountingMethod::Atomic), must),
              "atomic view count says 100; expected: 101");
    EXPECT_EQ(judgePose(facts("query-any", "count", false), answer(1, CountingMethod::QueryAny), must), "");
    EXPECT_EQ(judgePose(facts("query-any", "count", false), answer(0, CountingMethod::QueryAny), must),
              "query-any view count says no hit where cpu counts 100: more than the rounding of a rasteriser explains");
    EXPECT_EQ(judgePose(facts("compute", "count", false), answer(100, CountingMethod::Compute), must), "");
    EXPECT_EQ(judgePose(facts("compute", "count", false), answer(101, CountingMethod::Compute), must),
              "compute view count says 101; expected: 100");
}

TEST(TickJudgeTest, ARasteriserThatIsWrongAltogetherIsNoRounding) {
    const EngineFacts query = facts("query", "count", false);
    const auto says = [&](std::uint64_t count, std::uint64_t host) {
        PoseTruth must = truth(9, host);
        return judgePose(query, answer(count, CountingMethod::Query), must);
    };
    EXPECT_EQ(says(0, 1000), "query view count says 0 where cpu counts 1000: more than the rounding of a rasteriser "
                             "explains");
    EXPECT_EQ(says(0, lab::kRoundedFragments), "") << "a sliver";
    EXPECT_EQ(says(lab::kRoundedFragments, 0), "") << "a sliver";
    EXPECT_NE(says(lab::kRoundedFragments + 1, 0), "");
    EXPECT_EQ(says(1564, 1000), "");
    EXPECT_NE(says(1565, 1000), "");
    EXPECT_EQ(says(436, 1000), "");
    EXPECT_NE(says(435, 1000), "");
    PoseTruth must = truth(9, 1000);
    PairAnswer empty = answer(1000, CountingMethod::Query);
    empty.hit = false;
    EXPECT_NE(judgePose(query, empty, must), "") << "survivors and no hit";
}

TEST(MovingPosesTest, StrokesGoInAndOutWithoutAJump) {
    const MeshData mesh = makeRectangle({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    Grid grid = unitGrid(64);
    grid.spacing = {1, 1, 1};
    const Vec3 middle = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    const auto away = [&](const Mat4& pose) {
        const Vec3 centre = transformPoint(pose, {0, 0, 0});
        return std::hypot(centre[0] - middle[0], centre[1] - middle[1], centre[2] - middle[2]);
    };
    // What touches is a ball of 20 voxels, as far as its middle's distance from the mesh's tells.
    const auto touches = [&](const Mat4& pose) -> Result<bool> { return away(pose) < 20; };
    const auto poses = movingPoses(grid, mesh.view(), 3 * kTicksPerStroke + 7, 3, touches);
    ASSERT_TRUE(poses.ok()) << poses.error().text;
    ASSERT_EQ(poses->size(), 3U * kTicksPerStroke + 7);
    for (std::uint32_t stroke = 0; stroke < 3; ++stroke) {
        const auto at = [&](std::uint32_t tick) { return away((*poses)[stroke * kTicksPerStroke + tick]); };
        EXPECT_NEAR(at(0) - at(125), 12, 1e-9) << "from 10 voxels outside of the onset to 2 inside";
        EXPECT_LT(at(125), 20) << "it touches there";
        EXPECT_GT(at(0), 20);
        EXPECT_NEAR(at(250), at(0), 1e-9) << "and back";
    }
    // The way between two strokes is the longest: the diameter and 20 voxels in 250 ticks.
    for (std::size_t i = 1; i < poses->size(); ++i) {
        const Vec3 one = transformPoint((*poses)[i - 1], {0, 0, 0});
        const Vec3 other = transformPoint((*poses)[i], {0, 0, 0});
        EXPECT_LT(std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]), 0.3) << "tick " << i;
    }
    EXPECT_FALSE(movingPoses(grid, mesh.view(), 10, 3, [](const Mat4&) { return Result<bool>(false); }).ok());
}

TEST(QuantileTest, AreBetweenTheNearestRanks) {
    std::vector<double> samples;
    for (int i = 1000; i >= 0; --i) {
        samples.push_back(i);
    }
    EXPECT_DOUBLE_EQ(lab::quantileOf(samples, 0.5), 500);
    EXPECT_DOUBLE_EQ(lab::quantileOf(samples, 0.99), 990);
    EXPECT_DOUBLE_EQ(lab::quantileOf(samples, 0.999), 999);
    EXPECT_DOUBLE_EQ(lab::quantileOf(samples, 1), 1000);
    EXPECT_DOUBLE_EQ(lab::quantileOf({1, 2}, 0.25), 1.25);
}

BenchRow row(EngineFacts engine, std::size_t ticks) {
    return {.mesh = "m", .triangles = 12, .engine = std::move(engine), .wall = std::vector<double>(ticks, 0.005)};
}

TEST(LatencyOutputTest, AQuantileNeedsATickBeyondIt) {
    BenchResult result;
    for (const std::size_t ticks : {99U, 100U, 1000U}) {
        result.rows.push_back(row(facts("compute", "count", true), ticks));
        result.rows.back().engine.threads = 0;
    }
    std::ostringstream out;
    writeBench(out, io::Format::Json, {.mode = BenchMode::Latency, .number = 1000}, result);
    const auto rows = nlohmann::json::parse(out.str())["rows"];
    EXPECT_TRUE(rows[0]["p99_us"].is_null());
    EXPECT_EQ(rows[1]["p99_us"], 5);
    EXPECT_TRUE(rows[1]["p99_9_us"].is_null());
    EXPECT_EQ(rows[2]["p99_9_us"], 5);
    EXPECT_EQ(rows[2]["max_us"], 5);
    EXPECT_THAT(out.str(), HasSubstr("fewer than 1000 ticks"));
    result.rows.erase(result.rows.begin(), result.rows.begin() + 2);
    std::ostringstream whole;
    writeBench(whole, io::Format::Csv, {.mode = BenchMode::Latency, .number = 1000}, result);
    EXPECT_THAT(whole.str(), Not(HasSubstr("fewer than")));
}

TEST(LatencyOutputTest, SentencesSayOfHowManyTicksTheyAre) {
    BenchResult result;
    result.rows.push_back(row(facts("cpu", "count", true), 500));
    result.rows.back().touching = 258;
    result.rows.push_back(row(facts("compute", "count", true), 10));
    result.rows.back().engine.threads = 0;
    result.rows.back().engine.awaited = "polled";
    result.rows.back().engine.recorded = "once";
    result.rows.push_back(row({.name = "empty submit", .threads = 0}, 500));
    std::ostringstream out;
    writeBench(out, io::Format::Json, {.mode = BenchMode::Latency, .number = 500}, result);
    EXPECT_THAT(out.str(), HasSubstr("cpu on 1 thread: p50 5.00 us, p99 5.00 us (500 ticks, 258 of them touch); "
                                     "compute, polled, recorded once: p50 5.00 us (10 ticks, 0 of them touch)"));
    EXPECT_THAT(out.str(), HasSubstr("these rows have only poses without contact"));
    EXPECT_THAT(out.str(), HasSubstr("all answers are no: compute, polled, recorded once (certified count)\""));
    result.rows[1].touching = 3;
    std::ostringstream other;
    writeBench(other, io::Format::Json, {.mode = BenchMode::Latency, .number = 500}, result);
    EXPECT_THAT(other.str(), Not(HasSubstr("these rows have only poses without contact")));
}

} // namespace
} // namespace voxtact::test
