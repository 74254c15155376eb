// SPDX-License-Identifier: MIT
// How things are timed: in which order, how often, and what ends it.
#include "bench/compare/compare.h"
#include "bench/measure/rounds.h"
#include "vulkan/timestamps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace voxtact::test {
namespace {

using lab::kNoLimit;
using lab::Rounds;
using lab::takeRounds;
using lab::Timed;
using lab::Turn;
using testing::ElementsAre;

/// Things that say when they are taken: "a1" is the first one in round 1, "b2-" the second in round 2, backwards.
class RoundsTest : public testing::Test {
  protected:
    Timed thing(char name, double milliseconds, double limit = kNoLimit) {
        return {.take = [this, name, milliseconds](const Turn& turn) -> Result<double> {
                    taken_.push_back(name + std::to_string(turn.round) + (turn.backwards ? "-" : ""));
                    return milliseconds;
                },
                .limit = limit};
    }
    std::uint64_t take(std::vector<Timed> things, const Rounds& rounds) {
        const Result<std::uint64_t> count = takeRounds(things, rounds);
        EXPECT_TRUE(count.ok());
        return count.ok() ? *count : 0;
    }

    std::vector<std::string> taken_;
};

TEST(TimestampsTest, MayWrapAndNotGoBackwards) {
    EXPECT_EQ(ticksBetween(5, 12, 64), 7U);
    EXPECT_EQ(ticksBetween(5, 5, 64), 0U);
    EXPECT_EQ(ticksBetween(12, 5, 64), std::nullopt);
    const std::uint64_t last = (std::uint64_t{1} << 36U) - 1;
    EXPECT_EQ(ticksBetween(last - 2, 4, 36), 7U) << "it has wrapped";
    EXPECT_EQ(ticksBetween(4, last - 2, 36), std::nullopt);
}

TEST(SampleSizeTest, IsWhatTheSlowestCanDo) {
    // 10 batches of 5 ms fit in 50 ms; 50 of 1 ms are 5 times those; one that is not timed does not count.
    const auto size = lab::sampleSize(std::vector<double>{5, 1, kNoLimit}, 50, 1000);
    EXPECT_EQ(size.batches, 10U);
    EXPECT_THAT(size.passes, ElementsAre(1, 5, 0));
    const auto slow = lab::sampleSize(std::vector<double>{500, 1}, 50, 1000);
    EXPECT_EQ(slow.batches, 1U) << "one at least";
    EXPECT_THAT(slow.passes, ElementsAre(1, 50));
    const auto still = lab::sampleSize(std::vector<double>{0, 0.01}, 50, 8);
    EXPECT_EQ(still.batches, 8U) << "no more than there are";
    EXPECT_THAT(still.passes, ElementsAre(1, 1));
}

TEST_F(RoundsTest, EachIsTakenOnceARound) {
    std::uint64_t steps = 0;
    EXPECT_EQ(take({thing('a', 1), thing('b', 1)},
                   {.repeats = 2, .step = [&steps](std::uint64_t passed) { steps += passed; }}),
              2U);
    EXPECT_THAT(taken_, ElementsAre("a1", "b1", "a2", "b2"));
    EXPECT_EQ(steps, 2U);
}

TEST_F(RoundsTest, TheWarmUpIsNoRound) {
    // What it takes is not counted: both samples of 4 ms fit.
    EXPECT_EQ(take({thing('a', 4, 8)}, {.repeats = 3, .warmUp = true}), 2U);
    EXPECT_THAT(taken_, ElementsAre("a0", "a1", "a2"));
}

TEST_F(RoundsTest, WhatTakesTooLongIsLeftOut) {
    EXPECT_EQ(take({thing('a', kNoLimit), thing('b', 5, 12), thing('c', 20, 12)}, {.repeats = 4, .warmUp = true}), 2U);
    EXPECT_THAT(taken_, ElementsAre("a0", "b0", "c0", "b1", "c1", "b2")) << "one sample at least, and none beyond";
}

TEST_F(RoundsTest, APoseThatComesAgainIsTakenTheOtherWayRound) {
    // Two poses: rounds 1 and 3 have the first one, 2 and 4 the second.
    take({thing('a', 1), thing('b', 1)}, {.repeats = 4, .cycle = 2});
    EXPECT_THAT(taken_, ElementsAre("b1-", "a1-", "a2", "b2", "a3", "b3", "b4-", "a4-"));
}

TEST_F(RoundsTest, NoRoundBeginsThatWouldNotFit) {
    std::uint64_t steps = 0;
    EXPECT_EQ(
        take({thing('a', 1)}, {.repeats = 3, .limit = -1, .step = [&steps](std::uint64_t passed) { steps += passed; }}),
        1U);
    EXPECT_THAT(taken_, ElementsAre("a1")) << "one at least";
    EXPECT_EQ(steps, 3U) << "progress ends";
}

// Rounds in which there is nothing to do are not gone through one by one: these would take minutes.
TEST_F(RoundsTest, NoRoundIsGoneThroughInVain) {
    constexpr std::uint32_t kMany = 4'000'000'000;
    std::uint64_t calls = 0;
    std::uint64_t steps = 0;
    const auto step = [&](std::uint64_t passed) {
        ++calls;
        steps += passed;
    };
    EXPECT_EQ(take({thing('a', 1)}, {.repeats = kMany, .limit = -1, .step = step}), 1U);
    EXPECT_EQ(steps, kMany);
    EXPECT_EQ(take({thing('b', 5, 12)}, {.repeats = kMany, .warmUp = true, .step = step}), 2U);
    EXPECT_EQ(steps, kMany + std::uint64_t{kMany} + 1);
    EXPECT_LE(calls, 10U);
    EXPECT_THAT(taken_, ElementsAre("a1", "b0", "b1", "b2"));
}

TEST_F(RoundsTest, AFailedCheckEndsIt) {
    EXPECT_EQ(take({thing('a', 1), thing('b', 1)}, {.repeats = 3, .stop = [this] { return taken_.size() == 3; }}), 2U);
    EXPECT_THAT(taken_, ElementsAre("a1", "b1", "a2"));
}

TEST_F(RoundsTest, AnErrorEndsIt) {
    std::vector<Timed> things{thing('a', 1), thing('b', 1)};
    things[0].take = [](const Turn&) -> Result<double> { return Error{ErrorCode::File, 0, "no"}; };
    const Result<std::uint64_t> count = takeRounds(things, {.repeats = 3});
    ASSERT_FALSE(count.ok());
    EXPECT_EQ(count.error().text, "no");
    EXPECT_TRUE(taken_.empty());
}

} // namespace
} // namespace voxtact::test
