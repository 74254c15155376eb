// SPDX-License-Identifier: MIT
// Where the median of a distribution is, from samples: the sign test, with binomial numbers worked out by hand.
#include "bench/measure/numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace voxtact::test {
namespace {

using lab::MedianInterval;
using lab::medianInterval;

/// 1, 2, ..., count, the last first.
std::vector<double> descending(std::size_t count) {
    std::vector<double> samples(count);
    std::iota(samples.rbegin(), samples.rend(), 1.0);
    return samples;
}

void expectInterval(std::size_t count, double confidence, double low, double high, double reached) {
    const std::optional<MedianInterval> interval = medianInterval(descending(count), confidence);
    ASSERT_TRUE(interval.has_value()) << count;
    EXPECT_EQ(interval->low, low) << count;
    EXPECT_EQ(interval->high, high) << count;
    EXPECT_NEAR(interval->confidence, reached, 1e-12) << count;
}

TEST(MedianInterval, ConfidencesAreBinomial) {
    // All six above the median, or all below: 2/64.
    expectInterval(6, 0.95, 1, 6, 1 - 2.0 / 64);
    expectInterval(8, 0.95, 1, 8, 1 - 2.0 / 256);
    // At most one of nine: (1 + 9)/512 on each side.
    expectInterval(9, 0.95, 2, 8, 1 - 20.0 / 512);
    expectInterval(9, 0.99, 1, 9, 1 - 2.0 / 512);
    // At most three of fifteen: 1 + 15 + 105 + 455.
    expectInterval(15, 0.95, 4, 12, 1 - 2.0 * 576 / 32768);
    expectInterval(3, 0.75, 1, 3, 0.75);
    // Four of seven are in the middle: of 0.5, [3, 5] has 1 - 2 * 29/128.
    expectInterval(7, 0.5, 3, 5, 1 - 58.0 / 128);
}

TEST(MedianInterval, TooFewSamplesHaveNone) {
    for (std::size_t count = 0; count < 6; ++count) {
        EXPECT_FALSE(medianInterval(descending(count), 0.95)) << count;
    }
    EXPECT_FALSE(medianInterval(descending(6), 0.97));
    EXPECT_FALSE(medianInterval({3}, 0));
}

TEST(MedianInterval, ManySamplesAreNearTheNormalDistribution) {
    // 0.5 n -+ 1.96 sqrt(n) / 2.
    const std::optional<MedianInterval> interval = medianInterval(descending(10000), 0.95);
    ASSERT_TRUE(interval.has_value());
    EXPECT_NEAR(interval->low, 5000 - 98, 2);
    EXPECT_NEAR(interval->high, 5000 + 99, 2);
    EXPECT_NEAR(interval->confidence, 0.95, 0.002);
    EXPECT_GE(interval->confidence, 0.95);
}

TEST(MedianInterval, HasTheMedianAsOftenAsItSays) {
    const unsigned seed = std::random_device()();
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    // As lopsided as times are; its median is ln 2.
    std::exponential_distribution<double> times(1);
    constexpr int kTrials = 20000;
    int inside = 0;
    double confidence = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> samples(9);
        std::ranges::generate(samples, [&] { return times(random); });
        const std::optional<MedianInterval> interval = medianInterval(samples, 0.95);
        ASSERT_TRUE(interval.has_value());
        confidence = interval->confidence;
        inside += interval->low <= std::log(2.0) && std::log(2.0) <= interval->high ? 1 : 0;
    }
    // Six standard deviations.
    const double deviation = std::sqrt(confidence * (1 - confidence) / kTrials);
    EXPECT_NEAR(static_cast<double>(inside) / kTrials, confidence, 6 * deviation);
}

} // namespace
} // namespace voxtact::test
