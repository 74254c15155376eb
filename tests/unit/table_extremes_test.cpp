// SPDX-License-Identifier: MIT
#include "core/transfer/table_extremes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

TEST(TableExtremesTest, OfEveryRun) {
    std::mt19937_64 random(testSeed());
    for (std::uint32_t size = 1; size <= 70; ++size) {
        std::vector<float> table(size);
        for (float& entry : table) {
            entry = static_cast<float>(uniform(random, 0, 1));
        }
        const TableExtremes extremes(table);
        ASSERT_EQ(extremes.levels(), static_cast<std::uint32_t>(std::floor(std::log2(size))) + 1);
        ASSERT_EQ(extremes.values().size(), std::size_t{2} * extremes.levels() * size);
        EXPECT_TRUE(std::equal(table.begin(), table.end(), extremes.values().begin()));
        for (std::uint32_t first = 0; first < size; ++first) {
            for (std::uint32_t last = first; last < size; ++last) {
                const auto [least, greatest] = std::minmax_element(table.begin() + first, table.begin() + last + 1);
                ASSERT_EQ(extremes.greatest(first, last), *greatest) << size << ": " << first << " to " << last;
                ASSERT_EQ(extremes.least(first, last), *least) << size << ": " << first << " to " << last;
            }
        }
    }
}

TEST(TableExtremesTest, ANaNIsNeverOpaqueAndNeverCertain) {
    const std::vector<float> table{1, std::numeric_limits<float>::quiet_NaN(), 0.5F};
    const TableExtremes extremes(table);
    EXPECT_EQ(extremes.greatest(0, 2), 1);
    EXPECT_EQ(extremes.least(0, 2), -std::numeric_limits<float>::infinity());
    EXPECT_EQ(extremes.greatest(1, 1), -std::numeric_limits<float>::infinity());
    EXPECT_EQ(extremes.least(2, 2), 0.5F);
}

TEST(TableExtremesTest, OfNoTable) {
    EXPECT_EQ(TableExtremes().levels(), 0U);
    EXPECT_TRUE(TableExtremes().values().empty());
}

} // namespace
} // namespace voxtact::test
