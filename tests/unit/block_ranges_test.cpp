// SPDX-License-Identifier: MIT
// Ranges of a block of memory, against a map of its bytes.
#include "vulkan/memory/block_ranges.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

namespace voxtact {
namespace {

TEST(BlockRanges, TakesTheSmallestRangeThatHasRoom) {
    BlockRanges block(100);
    ASSERT_EQ(block.take(30, 1), 0U);
    ASSERT_EQ(block.take(10, 1), 30U);
    ASSERT_EQ(block.take(20, 1), 40U);
    ASSERT_EQ(block.take(40, 1), 60U);
    EXPECT_EQ(block.take(1, 1), std::nullopt);
    block.giveBack(0);
    block.giveBack(40);
    EXPECT_EQ(block.take(15, 1), 40U) << "20 bytes are free there, 30 at the beginning";
    EXPECT_EQ(block.take(31, 1), std::nullopt) << "35 bytes are free, but not in a row";
}

TEST(BlockRanges, AlignsAndKeepsWhatIsBefore) {
    BlockRanges block(1024);
    ASSERT_EQ(block.take(10, 1), 0U);
    ASSERT_EQ(block.take(100, 256), 256U);
    EXPECT_EQ(block.take(246, 1), 10U) << "what was skipped is free";
    EXPECT_EQ(block.take(512, 512), 512U);
    EXPECT_EQ(block.take(1, 1024), std::nullopt);
}

TEST(BlockRanges, IsWholeAgainInWhateverOrderRangesComeBack) {
    std::mt19937 random(7);
    constexpr std::uint64_t kSize = 4096;
    for (int round = 0; round < 20; ++round) {
        BlockRanges block(kSize);
        std::map<std::uint64_t, std::uint64_t> taken; // ends by begins
        for (int step = 0; step < 2000; ++step) {
            if (random() % 3 != 0) {
                const std::uint64_t size = 1 + random() % 200;
                const std::uint64_t alignment = std::uint64_t{1} << (random() % 8);
                const auto begin = block.take(size, alignment);
                if (!begin) {
                    continue;
                }
                ASSERT_EQ(*begin % alignment, 0U);
                ASSERT_LE(*begin + size, kSize);
                const auto next = taken.upper_bound(*begin);
                ASSERT_TRUE(next == taken.end() || next->first >= *begin + size);
                ASSERT_TRUE(next == taken.begin() || std::prev(next)->second <= *begin);
                taken[*begin] = *begin + size;
            } else if (!taken.empty()) {
                const auto which = std::next(taken.begin(), static_cast<std::ptrdiff_t>(random() % taken.size()));
                block.giveBack(which->first);
                taken.erase(which);
            }
            ASSERT_EQ(block.empty(), taken.empty());
        }
        while (!taken.empty()) {
            block.giveBack(taken.begin()->first);
            taken.erase(taken.begin());
        }
        EXPECT_TRUE(block.empty());
        EXPECT_EQ(block.take(kSize, kSize), 0U);
    }
}

} // namespace
} // namespace voxtact
