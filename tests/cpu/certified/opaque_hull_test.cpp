// SPDX-License-Identifier: MIT
// What two comparisons say of a range of entry coordinates, against the look-ups that they stand for.
#include "cpu/certified/opaque_hull.h"

#include "certified_cell.h"
#include "core/transfer/table_extremes.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace voxtact::test {
namespace {

using cpu::OpaqueHull;

/// Steps, ramps and peaks; entries at the threshold, and so near to it that rounding decides.
std::vector<float> drawnTable(std::mt19937_64& random, float threshold) {
    std::vector<float> table(2 + below(random, 40));
    const auto kind = below(random, 4);
    const std::size_t from = below(random, table.size());
    const std::size_t to = from + below(random, table.size() - from);
    const double near = chance(random, 0.5) ? 0.2 : 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double at = static_cast<double>(i) / static_cast<double>(table.size());
        const bool within = i >= from && i <= to;
        const double opacity = kind == 0   ? at
                               : kind == 1 ? 1 - at
                               : kind == 2 ? (within ? 1 : 0)
                                           : uniform(random, 0, 1);
        table[i] = static_cast<float>(opacity);
        if (chance(random, near)) {
            const auto steps = static_cast<int>(below(random, 21)) - 10;
            table[i] = threshold + static_cast<float>(steps) * 6e-8F;
        }
    }
    return table;
}

struct Range {
    float lo = 0;
    float hi = 0;
};

/// Often with an end next to a place of the hull, or at an entry.
Range drawnRange(std::mt19937_64& random, const OpaqueHull& hull, std::size_t entries) {
    const auto place = [&] {
        switch (below(random, 4)) {
        case 0:
            return static_cast<float>(uniform(random, -2, static_cast<double>(entries) + 1));
        case 1:
            return static_cast<float>(below(random, entries));
        default: {
            const std::array<float, 4> ends{hull.bounds.first, hull.bounds.last, hull.bounds.allFirst,
                                            hull.bounds.allLast};
            const float end = ends[below(random, ends.size())];
            return std::isfinite(end) ? std::nextafter(end, chance(random, 0.5) ? -1e9F : 1e9F) : 0.0F;
        }
        }
    };
    const float one = place();
    const float other = chance(random, 0.3) ? one : place();
    return {std::min(one, other), std::max(one, other)};
}

TEST(OpaqueHullTest, SaysWhatTheTableSaysOfARangeAndItsParts) {
    std::mt19937_64 random(testSeed());
    std::size_t none = 0;
    std::size_t all = 0;
    std::size_t whole = 0;
    for (int round = 0; round < 4000 && !HasFailure(); ++round) {
        const float threshold = chance(random, 0.1) ? 1e-39F : static_cast<float>(uniform(random, 0.01, 1));
        const TableExtremes extremes(drawnTable(random, threshold));
        const auto entries = static_cast<std::size_t>(extremes.values().size()) / (2 * extremes.levels());
        const shader::OpacityTable table{static_cast<int>(entries), static_cast<int>(extremes.levels()), threshold,
                                         extremes.values().data()};
        const OpaqueHull hull = cpu::opaqueHullOf(table);
        shader::OpacityTable bounded = table;
        bounded.bounds = hull.bounds;
        const cpu::OpacityLook look{bounded, hull.whole};
        whole += hull.whole ? 1 : 0;
        for (int i = 0; i < 50; ++i) {
            const Range range = drawnRange(random, hull, entries);
            const float middle = range.lo + (range.hi - range.lo) / 2;
            const float error = chance(random, 0.5) ? 1e-3F : 0;
            EXPECT_TRUE(look.mayBeOpaque(range.lo, range.hi, error) ||
                        !shader::certifiedMayBeOpaque(table, range.lo, range.hi, error))
                << range.lo << " to " << range.hi << ", error " << error << ", round " << round;
            constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
            for (const Range& part : {Range{kNone, range.hi}, {range.lo, kNone}, {kNone, kNone}}) {
                EXPECT_EQ(shader::mayBeOpaque(bounded, part.lo, part.hi), shader::mayBeOpaque(table, part.lo, part.hi))
                    << part.lo << " to " << part.hi << ", round " << round;
            }
            for (const Range& part : {range, {range.lo, middle}, {middle, range.hi}, {middle, middle}}) {
                const bool may = shader::mayBeOpaque(table, part.lo, part.hi);
                EXPECT_EQ(shader::mayBeOpaque(bounded, part.lo, part.hi), may) << part.lo << " to " << part.hi;
                EXPECT_EQ(shader::certainlyAllOpaque(bounded, part.lo, part.hi),
                          shader::certainlyAllOpaque(table, part.lo, part.hi))
                    << part.lo << " to " << part.hi << ", round " << round;
                EXPECT_EQ(shader::certainlySomeOpaque(bounded, part.lo, part.hi),
                          shader::certainlySomeOpaque(table, part.lo, part.hi))
                    << part.lo << " to " << part.hi << ", round " << round;
                if (range.hi < hull.bounds.first || range.lo > hull.bounds.last) {
                    EXPECT_FALSE(may) << part.lo << " to " << part.hi << ", round " << round;
                    ++none;
                }
                if (range.lo >= hull.bounds.allFirst && range.hi <= hull.bounds.allLast) {
                    EXPECT_TRUE(shader::certainlyAllOpaque(table, part.lo, part.hi))
                        << part.lo << " to " << part.hi << ", round " << round;
                    ++all;
                }
                // No more than an entry is said to be that is not.
                if (hull.whole && part.hi >= hull.bounds.first + 1 && part.lo <= hull.bounds.last - 1) {
                    EXPECT_TRUE(may) << part.lo << " to " << part.hi << ", round " << round;
                }
            }
        }
    }
    EXPECT_GT(none, 1000U);
    EXPECT_GT(all, 1000U);
    EXPECT_GT(whole, 500U);
}

TEST(OpaqueHullTest, OfARampIsFromTheThresholdOn) {
    std::vector<float> ramp(101);
    for (std::size_t i = 0; i < ramp.size(); ++i) {
        ramp[i] = static_cast<float>(i) / 100;
    }
    const TableExtremes extremes(ramp);
    const shader::OpacityTable table{101, static_cast<int>(extremes.levels()), 0.255F, extremes.values().data()};
    const OpaqueHull hull = cpu::opaqueHullOf(table);
    EXPECT_TRUE(hull.whole);
    EXPECT_NEAR(hull.bounds.first, 25.5, 1e-3);
    EXPECT_NEAR(hull.bounds.allFirst, 25.5, 1e-3);
    EXPECT_EQ(hull.bounds.last, shader::OpacityBounds::kInfinity);
    EXPECT_EQ(hull.bounds.allLast, shader::OpacityBounds::kInfinity);
}

} // namespace
} // namespace voxtact::test
