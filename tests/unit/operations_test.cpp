// SPDX-License-Identifier: MIT
// The inputs of the arithmetic self-test find what drivers are known to do: here the host plays such a driver.
#include "device/detector/arithmetic_check.h"
#include "exact/operations.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>

namespace voxtact {
namespace {

constexpr std::size_t kSets = 100'000;

float of(std::uint32_t word) {
    return std::bit_cast<float>(word);
}
std::uint32_t bits(float value) {
    return std::bit_cast<std::uint32_t>(value);
}
float moderate(std::uint32_t word) {
    return shader::operationModerate(word);
}

using Answer = std::function<std::uint32_t(const std::uint32_t* in, std::uint32_t right)>;

/// How many results of an operation are noticed where `wrong` gives the low words.
std::size_t noticed(int operation, const Answer& wrong) {
    static const std::vector<std::uint32_t> inputs = operationInputs(kSets);
    std::vector<std::uint32_t> results(kSets * OPERATION_RESULTS);
    for (std::size_t set = 0; set < kSets; ++set) {
        const std::uint32_t* in = inputs.data() + set * OPERATION_INPUTS;
        std::uint32_t& low = results[set * OPERATION_RESULTS];
        shader::operate(operation, in[0], in[1], in[2], in[3], low, results[set * OPERATION_RESULTS + 1]);
        low = wrong(in, low);
    }
    return operationFaults(operation, inputs, results).count;
}

TEST(Operations, WhatIsRightIsNotComplainedOf) {
    for (int operation = 0; operation < OPERATION_COUNT; ++operation) {
        EXPECT_EQ(noticed(operation, [](const std::uint32_t*, std::uint32_t right) { return right; }), 0U)
            << operationName(operation);
    }
}

TEST(Operations, OneWrongBitIsNoticed) {
    for (int operation = 0; operation < OPERATION_COUNT; ++operation) {
        EXPECT_GT(noticed(operation, [](const std::uint32_t*, std::uint32_t right) { return right ^ 1U; }), kSets / 4)
            << operationName(operation);
    }
}

TEST(Operations, ContractionIsNoticed) {
    const auto fused = [](const std::uint32_t* in, std::uint32_t) {
        return bits(std::fma(moderate(in[0]), moderate(in[1]), moderate(in[2])));
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_MULTIPLY_ADD, fused), 1000U);
    const auto fusedAway = [](const std::uint32_t* in, std::uint32_t) {
        return bits(std::fma(-moderate(in[0]), moderate(in[1]), moderate(in[2])));
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_MULTIPLY_SUBTRACT, fusedAway), 1000U);
}

TEST(Operations, AnotherOrderOfASumIsNoticed) {
    const auto backwards = [](const std::uint32_t* in, std::uint32_t) {
        return bits(moderate(in[0]) + (moderate(in[1]) + moderate(in[2])));
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_SUM_IN_ORDER, backwards), 1000U);
}

TEST(Operations, RoundingTowardsZeroIsNoticed) {
    const auto cut = [](double exact) {
        const auto near = static_cast<float>(exact);
        return bits(std::abs(static_cast<double>(near)) > std::abs(exact) ? std::nextafter(near, 0.0F) : near);
    };
    const auto product = [&](const std::uint32_t* in, std::uint32_t) {
        return cut(static_cast<double>(moderate(in[0])) * moderate(in[1]));
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_MULTIPLY, product), 1000U);
    const auto converted = [&](const std::uint32_t* in, std::uint32_t) {
        return cut(static_cast<double>(static_cast<std::int32_t>(in[0])));
    };
    EXPECT_GT(noticed(OPERATION_INT_TO_FLOAT, converted), 1000U);
}

TEST(Operations, TiesAwayFromZeroAreNoticed) {
    const auto away = [](const std::uint32_t* in, std::uint32_t right) {
        const double exact = static_cast<double>(moderate(in[0])) * moderate(in[1]);
        const auto near = static_cast<float>(exact);
        const float other = std::nextafter(near, static_cast<double>(near) < exact ? INFINITY : -INFINITY);
        const double error = exact - static_cast<double>(near);
        const bool tie = error != 0 && std::abs(static_cast<double>(other) - exact) == std::abs(error);
        return tie ? bits(std::abs(other) > std::abs(near) ? other : near) : right;
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_MULTIPLY, away), 10U);
}

TEST(Operations, ALongRoundedTwiceIsNoticed) {
    const auto twice = [](const std::uint32_t* in, std::uint32_t) {
        const auto high = static_cast<float>(static_cast<std::int32_t>(in[1]) >> 15);
        return bits(high * 0x1p32F + static_cast<float>(in[0]));
    };
    EXPECT_GT(noticed(OPERATION_LONG_TO_FLOAT, twice), 10U);
}

TEST(Operations, ComparisonsThatForgetNaNAreNoticed) {
    const auto turned = [](const std::uint32_t* in, std::uint32_t) {
        const float a = of(in[0]);
        const float b = of(in[1]);
        return (a < b ? 1U : 0U) | (a <= b ? 2U : 0U) | (a == b ? 4U : 0U) | (a >= b ? 8U : 0U) | (a > b ? 16U : 0U) |
               (a >= b ? 32U : 0U); // !(a < b), turned round
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_COMPARE_SPECIAL, turned), 100U);
    const auto finite = [](const std::uint32_t* in, std::uint32_t right) {
        return std::isfinite(of(in[0])) && std::isfinite(of(in[1])) ? right : 0U;
    };
    EXPECT_GT(noticed(OPERATION_FLOAT_SPECIAL_ADD, finite), 1000U);
}

TEST(Operations, DoublesThatForgetNaNAndInfinityAreNoticed) {
    const auto any = [](const std::uint32_t* words) { return shader::operationAnyWide(words[0], words[1]); };
    const auto saturated = [&](const std::uint32_t* in, std::uint32_t right) {
        const bool finite = std::isfinite(any(in)) && std::isfinite(any(in + 2));
        return finite && std::isinf(any(in) * any(in + 2)) ? 0xffffffffU : right;
    };
    EXPECT_GT(noticed(OPERATION_WIDE_SPECIAL_MULTIPLY, saturated), 100U);
    const auto ordered = [&](const std::uint32_t* in, std::uint32_t) {
        const bool less = any(in) < any(in + 2);
        return less ? 1U : 2U;
    };
    EXPECT_GT(noticed(OPERATION_WIDE_SPECIAL_COMPARE, ordered), 1000U);
    const auto largest = [&](const std::uint32_t* in, std::uint32_t right) {
        return std::isinf(any(in)) || std::isinf(any(in + 2)) ? 0xffffffffU : right;
    };
    EXPECT_GT(noticed(OPERATION_WIDE_SPECIAL_ADD, largest), 1000U);
}

/// Nothing rests on denormals, so a device that takes them for zero is right.
TEST(Operations, FlushedDenormalsAreAllowed) {
    const auto flushed = [](float value) { return std::fpclassify(value) == FP_SUBNORMAL ? value * 0.0F : value; };
    const auto product = [&](const std::uint32_t* in, std::uint32_t) {
        return bits(flushed(flushed(of(in[0])) * flushed(of(in[1]))));
    };
    EXPECT_EQ(noticed(OPERATION_FLOAT_SPECIAL_MULTIPLY, product), 0U);
    const auto sum = [&](const std::uint32_t* in, std::uint32_t) {
        return bits(flushed(flushed(of(in[0])) + flushed(of(in[1]))));
    };
    EXPECT_EQ(noticed(OPERATION_FLOAT_SPECIAL_ADD, sum), 0U);
}

TEST(Operations, MistakesOfIntegersAreNoticed) {
    const auto logical = [](const std::uint32_t* in, std::uint32_t) { return in[0] >> (in[1] & 31U); };
    EXPECT_GT(noticed(OPERATION_INT_SHIFT, logical), 1000U);
    const auto narrow = [](const std::uint32_t* in, std::uint32_t right) { return in[1] == 0 ? right : in[0]; };
    EXPECT_GT(noticed(OPERATION_LONG_SUM, narrow), 1000U);
    const auto unsignedOne = [](const std::uint32_t* in, std::uint32_t) { return bits(static_cast<float>(in[0])); };
    EXPECT_GT(noticed(OPERATION_INT_TO_FLOAT, unsignedOne), 1000U);
}

} // namespace
} // namespace voxtact
