// SPDX-License-Identifier: MIT
// Certain answers of adversarial cases against a judge of its own (quad_judge.h). A million of them:
// voxtact_extreme_bench.
#include "extreme_cases.h"

#include "engine_fixture.h"

#include <cstdlib>
#include <iostream>

namespace voxtact::test {
namespace {

TEST(Extreme, NoCertainAnswerIsWrong) {
    const std::uint64_t seed = testSeed();
    constexpr std::uint64_t kCases = 10000;
    ExtremeTrial trial;
    std::uint64_t first = 0;
    std::uint64_t last = kCases;
    if (const char* one = std::getenv("VOXTACT_TEST_CASE"); one != nullptr) {
        first = std::strtoull(one, nullptr, 10);
        last = first + 1;
    }
    for (std::uint64_t number = first; number < last; ++number) {
        trial.run(seed, number);
    }
    const ExtremeTally& tally = trial.tally();
    std::cout << tally.touches << " touch, " << tally.none << " do not, " << tally.possible << " possible, "
              << tally.unjudged << " that the judge does not know, " << tally.wrong << " wrong\n";
    for (const std::string& complaint : tally.complaints) {
        ADD_FAILURE() << complaint;
    }
    EXPECT_EQ(tally.wrong, 0U);
    if (last - first == kCases) {
        // Else the cases are not what they are meant to be.
        EXPECT_GT(tally.touches, kCases / 5);
        EXPECT_GT(tally.none, kCases / 5);
        EXPECT_LT(tally.possible, kCases / 5);
        EXPECT_LT(tally.unjudged, kCases / 20);
    }
}

} // namespace
} // namespace voxtact::test
