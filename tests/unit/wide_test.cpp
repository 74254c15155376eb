// SPDX-License-Identifier: MIT
// Quotients of double precision and conversions by integers, as shaders have them, against the processor's.
#include "exact/wide_integers.h"

#include "support/scenes.h"
#include "support/special.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace voxtact::test {
namespace {

namespace soft = shader::integers;

soft::Wide wide(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    return soft::wideBits(static_cast<std::uint32_t>(bits >> 32U), static_cast<std::uint32_t>(bits));
}

double number(soft::Wide value) {
    return std::bit_cast<double>(std::uint64_t{value.high} << 32U | value.low);
}

bool same(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

const std::array kSpecial{0.0,
                          1.0,
                          1.5,
                          std::nextafter(1.0, 2.0),
                          std::nextafter(1.0, 0.0),
                          std::numeric_limits<double>::min(),
                          std::numeric_limits<double>::denorm_min(),
                          std::numeric_limits<double>::max(),
                          0x1.fffffffffffffp-1023,
                          0x1p-1060,
                          0x1p53,
                          0x1.0000000000001p53,
                          0x1p-126,
                          0x1p-149,
                          0x1p-150,
                          0x1.8p-150,
                          0x1.fffffefffffffp127,
                          0x1.ffffffp127,
                          0x1.000001p0,
                          0x1.000003p0,
                          kInfinity,
                          std::numeric_limits<double>::quiet_NaN()};

/// Of every kind: any bits, few bits, whole numbers, those near to `other`, and special ones.
double randomNumber(std::mt19937_64& random, double other) {
    switch (random() % 6) {
    case 0:
        return std::bit_cast<double>(random());
    case 1: // exponents that meet
        return std::bit_cast<double>((random() & 0x800fffffffffffffU) | (std::uint64_t{990} + random() % 70) << 52U);
    case 2: // ties
        return std::bit_cast<double>((random() & 0xffffffff80000000U) | (random() % 2) << 28U | random() % 2);
    case 3:
        return static_cast<double>(static_cast<std::int64_t>(random() % 2001) - 1000);
    case 4:
        return std::bit_cast<double>(std::bit_cast<std::uint64_t>(other) ^ (random() % 4) ^ (random() % 2) << 63U);
    default:
        return (random() % 2 == 0 ? 1 : -1) * kSpecial[random() % kSpecial.size()];
    }
}

void expectSame(double a, double b) {
    const auto [x, y] = std::pair(wide(a), wide(b));
    const std::string which = std::to_string(a) + ", " + std::to_string(b) + " (" +
                              std::to_string(std::bit_cast<std::uint64_t>(a)) + ", " +
                              std::to_string(std::bit_cast<std::uint64_t>(b)) + ")";
    EXPECT_TRUE(same(number(soft::wideDivide(x, y)), a / b)) << "quotient of " << which;
    const float narrow = static_cast<float>(a);
    const std::uint32_t bits = soft::wideToFloatBits(x);
    EXPECT_TRUE(std::isnan(narrow) ? std::isnan(std::bit_cast<float>(bits))
                                   : std::bit_cast<std::uint32_t>(narrow) == bits)
        << "float of " << which;
    const auto any = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(b));
    EXPECT_TRUE(same(number(soft::wideOfFloatBits(any)), static_cast<double>(std::bit_cast<float>(any)))) << any;
}

TEST(Wide, IsTheProcessorsDoublePrecision) {
    std::mt19937_64 random(testSeed());
    for (const double a : kSpecial) {
        for (const double b : kSpecial) {
            for (const double sign : {1.0, -1.0}) {
                expectSame(a, sign * b);
                expectSame(-a, sign * b);
            }
        }
    }
    for (std::size_t i = 0; i < randomCases(20'000'000, 20) && !HasFailure(); ++i) {
        const double a = randomNumber(random, 1);
        expectSame(a, randomNumber(random, a));
    }
}

} // namespace
} // namespace voxtact::test
