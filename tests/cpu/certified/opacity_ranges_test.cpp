// SPDX-License-Identifier: MIT
// What opacities a range of entry coordinates has, against the table's piecewise linear opacity in double: "may" is
// never false for what is, "certainly" never true for what is not, to the last bit of the threshold.
#include "core/transfer/table_extremes.h"
#include "opacity_ranges.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace voxtact::test {
namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

struct Table {
    std::vector<float> opacities;
    TableExtremes extremes;
    float threshold = 0.5F;

    explicit Table(std::vector<float> entries) : opacities(std::move(entries)), extremes(opacities) {}

    [[nodiscard]] shader::OpacityTable view() const {
        return {static_cast<int>(opacities.size()), static_cast<int>(extremes.levels()), threshold,
                extremes.values().data()};
    }
    /// The real opacity at a coordinate, clamped to the table. Nothing here rounds by more than 2^-52.
    [[nodiscard]] double at(double x) const {
        const double last = static_cast<double>(opacities.size()) - 1;
        const double place = std::clamp(x, 0.0, last);
        const auto first = static_cast<std::size_t>(place);
        const std::size_t second = std::min(first + 1, opacities.size() - 1);
        const double below = opacities[first];
        return below + (place - static_cast<double>(first)) * (static_cast<double>(opacities[second]) - below);
    }
    /// The least and the greatest opacity between two coordinates.
    [[nodiscard]] std::pair<double, double> between(float lo, float hi) const {
        std::pair<double, double> out = std::minmax(at(lo), at(hi));
        for (std::size_t entry = 0; entry < opacities.size(); ++entry) {
            if (static_cast<double>(entry) >= lo && static_cast<double>(entry) <= hi) {
                out.first = std::min<double>(out.first, opacities[entry]);
                out.second = std::max<double>(out.second, opacities[entry]);
            }
        }
        return out;
    }
};

/// The float at or below a double, and that at or above.
float roundedDown(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) > value ? std::nextafter(nearest, -kFloatInfinity) : nearest;
}
float roundedUp(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) < value ? std::nextafter(nearest, kFloatInfinity) : nearest;
}

/// Thresholds next to the very opacity: interpolation in float falls on the wrong side of many, and OPACITY_ERROR is
/// what keeps each question on its own.
TEST(OpacityRanges, KnowWhereInterpolationRounds) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t below = 0;
    std::size_t above = 0;
    for (int round = 0; round < 20000; ++round) {
        const auto draw = [&] { return static_cast<float>(uniform(random, 0, 1)); };
        Table table({draw(), draw()});
        const float x = draw();
        const double real = table.at(x);
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        table.threshold = roundedDown(real);
        below += shader::opacityAt(table.view(), x) < table.threshold ? 1U : 0U;
        ASSERT_TRUE(shader::mayBeOpaque(table.view(), x, x));
        table.threshold = roundedUp(real);
        if (real < static_cast<double>(table.threshold)) {
            above += shader::opacityAt(table.view(), x) >= table.threshold ? 1U : 0U;
            ASSERT_FALSE(shader::certainlyAllOpaque(table.view(), x, x));
            ASSERT_FALSE(shader::certainlySomeOpaque(table.view(), x, x));
        }
    }
    EXPECT_GT(below, 100U) << "interpolation that is never too low asks nothing of the margin";
    EXPECT_GT(above, 100U);
}

/// Random tables with plateaus, spikes and gaps; thresholds of entries, beside them and anywhere.
Table randomTable(std::mt19937_64& random) {
    std::vector<float> entries(static_cast<std::size_t>(uniform(random, 1, 40)));
    for (float& entry : entries) {
        const double kind = uniform(random, 0, 1);
        entry = kind < 0.5 ? 0.0F : (kind < 0.7 ? 0.25F : static_cast<float>(uniform(random, 0, 1)));
    }
    Table table(std::move(entries));
    const float entry =
        table.opacities[static_cast<std::size_t>(uniform(random, 0, static_cast<double>(table.opacities.size())))];
    const double kind = uniform(random, 0, 1);
    table.threshold = kind < 0.3   ? entry
                      : kind < 0.5 ? std::nextafter(entry, 2.0F)
                      : kind < 0.7 ? std::nextafter(entry, 0.0F)
                                   : static_cast<float>(uniform(random, 0, 1));
    return table;
}

float randomCoordinate(std::mt19937_64& random, const Table& table) {
    const double size = static_cast<double>(table.opacities.size());
    const double kind = uniform(random, 0, 1);
    const double place = uniform(random, -3, size + 3);
    const auto whole = static_cast<float>(std::floor(place));
    return kind < 0.3    ? whole
           : kind < 0.4  ? std::nextafter(whole, kFloatInfinity)
           : kind < 0.5  ? std::nextafter(whole, -kFloatInfinity)
           : kind < 0.55 ? static_cast<float>(1e9 * uniform(random, -1, 1))
                         : static_cast<float>(place);
}

TEST(OpacityRanges, AreNeverWrongAndSeldomUnsure) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    std::size_t unsure = 0;
    std::size_t some = 0;
    constexpr std::size_t kRounds = 40000;
    for (std::size_t round = 0; round < kRounds; ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
        const Table table = randomTable(random);
        const float first = randomCoordinate(random, table);
        const float second = randomCoordinate(random, table);
        const float lo = std::min(first, second);
        const float hi = std::max(first, second);
        const auto [least, greatest] = table.between(lo, hi);
        const double threshold = table.threshold;
        const bool may = shader::mayBeOpaque(table.view(), lo, hi);
        const bool certain = shader::certainlySomeOpaque(table.view(), lo, hi);
        const bool all = shader::certainlyAllOpaque(table.view(), lo, hi);
        ASSERT_TRUE(may || greatest < threshold);
        ASSERT_TRUE(!certain || greatest >= threshold);
        ASSERT_TRUE(!all || least >= threshold);
        ASSERT_FALSE(shader::certainlyAllOpaque(table.view(), std::nextafter(hi, kFloatInfinity), lo))
            << "an empty range";
        ASSERT_FALSE(shader::certainlySomeOpaque(table.view(), std::nextafter(hi, kFloatInfinity), lo));
        unsure += may != certain ? 1U : 0U;
        some += certain ? 1U : 0U;
        if (certain) {
            const float opaque = shader::opaqueBetween(table.view(), lo, hi);
            ASSERT_GE(opaque, lo);
            ASSERT_LE(opaque, hi);
            ASSERT_GE(table.at(opaque), threshold);
        }
    }
    EXPECT_GT(some, kRounds / 10);
    EXPECT_LT(unsure, kRounds / 10);
}

TEST(OpacityRanges, NotANumberMayBeAnythingAndIsNeverCertain) {
    constexpr float kFloatNan = std::numeric_limits<float>::quiet_NaN();
    const Table table({0, 1, 0});
    for (const auto& [lo, hi] : {std::pair{kFloatNan, 2.0F}, {0.0F, kFloatNan}, {kFloatNan, kFloatNan}}) {
        EXPECT_TRUE(shader::mayBeOpaque(table.view(), lo, hi));
        EXPECT_FALSE(shader::certainlyAllOpaque(table.view(), lo, hi));
        EXPECT_FALSE(shader::certainlySomeOpaque(table.view(), lo, hi));
    }
    EXPECT_TRUE(shader::mayBeOpaque(table.view(), -kFloatInfinity, kFloatInfinity));
    EXPECT_TRUE(shader::certainlySomeOpaque(table.view(), -kFloatInfinity, kFloatInfinity));
    EXPECT_EQ(shader::opaqueBetween(table.view(), -kFloatInfinity, kFloatInfinity), 1.0F);
}

} // namespace
} // namespace voxtact::test
