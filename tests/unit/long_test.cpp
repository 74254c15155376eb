// SPDX-License-Identifier: MIT
// 64-bit integers by two words, as shaders have them, against the processor's.
#include "exact/exact.h"
#include "exact/long.h"
#include "exact/long_words.h"

#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

namespace voxtact::test {
namespace {

namespace pairs = shader::words;

pairs::Long wordsOf(std::int64_t value) {
    return pairs::longOf(static_cast<std::int32_t>(value >> 32), static_cast<std::uint32_t>(value));
}

std::int64_t longNumber(pairs::Long value) {
    return shader::longOf(value.high, value.low);
}

constexpr std::int64_t kMost = std::int64_t{1} << 49; ///< that longToFloat() takes

/// Whole numbers of any size up to 2^49, many of them at ties of floats or a little off.
std::int64_t randomLong(std::mt19937_64& random) {
    const unsigned shift = 14 + static_cast<unsigned>(random() % 50);
    const auto size = static_cast<std::int64_t>(random() >> shift);
    const unsigned kept = static_cast<unsigned>(random() % 49);
    const std::int64_t cut = (size >> kept << kept) + (kept == 0 ? 0 : std::int64_t{1} << (kept - 1U));
    const std::int64_t off = static_cast<std::int64_t>(random() % 3) - 1;
    const std::int64_t chosen = std::min(random() % 2 == 0 ? size : cut + off, kMost);
    return random() % 2 == 0 ? chosen : -chosen;
}

void expectSameLong(std::int64_t value) {
    EXPECT_EQ(longNumber(wordsOf(value)), value);
    EXPECT_EQ(pairs::longIsNegative(wordsOf(value)), value < 0) << value;
    EXPECT_EQ(pairs::longToFloat(wordsOf(value)), static_cast<float>(value)) << value;
    EXPECT_EQ(pairs::longHigh(wordsOf(value)), shader::longHigh(value)) << value;
    EXPECT_EQ(pairs::longLow(wordsOf(value)), shader::longLow(value)) << value;
}

TEST(Long, IsTheProcessorsWholeNumbers) {
    for (unsigned bit = 0; bit <= 49; ++bit) {
        for (const std::int64_t off : {-1, 0, 1}) {
            const std::int64_t value = std::min((std::int64_t{1} << bit) + off, kMost);
            expectSameLong(value);
            expectSameLong(-value);
        }
    }
    std::mt19937_64 random(testSeed());
    for (std::size_t i = 0; i < randomCases(20'000'000, 20) && !HasFailure(); ++i) {
        const std::int64_t a = randomLong(random);
        // Some have the low words of `a`.
        const std::int64_t b = i % 4 == 0 ? a + (randomLong(random) >> 20 << 32) : randomLong(random);
        expectSameLong(a);
        EXPECT_EQ(longNumber(pairs::longDifference(wordsOf(a), wordsOf(b))), shader::longDifference(a, b))
            << a << ' ' << b;
        const auto small =
            i % 4 == 0 ? static_cast<std::int32_t>(random() % 3) - 1 : static_cast<std::int32_t>(random());
        EXPECT_EQ(longNumber(pairs::longSum(wordsOf(a), small)), shader::longSum(a, small)) << a << ' ' << small;
    }
}

TEST(Long, ProductsAreOfAllInts) {
    constexpr std::array kSpecial{std::numeric_limits<std::int32_t>::min(), -(1 << 24), -1, 0, 1, 65535, 65536, 1 << 24,
                                  std::numeric_limits<std::int32_t>::max()};
    for (const std::int32_t a : kSpecial) {
        for (const std::int32_t b : kSpecial) {
            EXPECT_EQ(longNumber(pairs::longProduct(a, b)), shader::longProduct(a, b)) << a << ' ' << b;
        }
    }
    std::mt19937_64 random(testSeed());
    for (std::size_t i = 0; i < randomCases(20'000'000, 20) && !HasFailure(); ++i) {
        const auto a = static_cast<std::int32_t>(random());
        const auto b = static_cast<std::int32_t>(random());
        EXPECT_EQ(longNumber(pairs::longProduct(a, b)), shader::longProduct(a, b)) << a << ' ' << b;
    }
}

/// The sums and differences of edge functions: each coordinate within EXACT_FARTHEST_SUBPIXEL.
TEST(Long, EdgeFunctionsFit) {
    constexpr auto kFarthest = static_cast<std::int32_t>(EXACT_FARTHEST_SUBPIXEL);
    for (const std::int32_t x : {-kFarthest, kFarthest}) {
        for (const std::int32_t y : {-kFarthest, kFarthest}) {
            const std::int64_t edge =
                shader::longDifference(shader::longProduct(2 * x, 2 * y), shader::longProduct(-2 * x, 2 * y));
            EXPECT_LE(std::abs(edge), kMost);
            expectSameLong(edge);
        }
    }
}

} // namespace
} // namespace voxtact::test
