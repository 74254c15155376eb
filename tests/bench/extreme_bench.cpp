// SPDX-License-Identifier: MIT
// A million adversarial cases of the certified answer against the judge of quad_judge.h. Prints how many answers are
// certain and right, possible, and wrong, and the seed; fails where one is wrong. VOXTACT_TEST_SEED repeats a run,
// VOXTACT_BENCH_CASES says how many.
#include "cpu/judges/extreme_cases.h"
#include "support/scenes.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

int main() {
    using namespace voxtact::test;
    const std::uint64_t seed = testSeed();
    const char* text = std::getenv("VOXTACT_BENCH_CASES");
    const std::uint64_t cases = text == nullptr ? 1000000 : std::strtoull(text, nullptr, 10);
    const auto start = std::chrono::steady_clock::now();
    const unsigned threads = std::max(1U, std::thread::hardware_concurrency());
    std::vector<ExtremeTally> tallies(threads);
    std::vector<std::thread> running;
    for (unsigned thread = 0; thread < threads; ++thread) {
        running.emplace_back([&, thread] {
            ExtremeTrial trial;
            for (std::uint64_t number = thread; number < cases; number += threads) {
                trial.run(seed, number);
            }
            tallies[thread] = trial.tally();
        });
    }
    ExtremeTally all;
    for (unsigned thread = 0; thread < threads; ++thread) {
        running[thread].join();
        const ExtremeTally& tally = tallies[thread];
        all.touches += tally.touches;
        all.none += tally.none;
        all.possible += tally.possible;
        all.unjudged += tally.unjudged;
        all.wrong += tally.wrong;
        for (const std::string& complaint : tally.complaints) {
            std::printf("%s\n", complaint.c_str());
        }
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    std::printf("%llu adversarial cases in %.0f s: certain and right %llu yes, %llu no; possible %llu (%.2f %%); the "
                "judge does not know %llu; wrong %llu\n",
                static_cast<unsigned long long>(cases), spent.count(), static_cast<unsigned long long>(all.touches),
                static_cast<unsigned long long>(all.none), static_cast<unsigned long long>(all.possible),
                100.0 * static_cast<double>(all.possible) / static_cast<double>(cases),
                static_cast<unsigned long long>(all.unjudged), static_cast<unsigned long long>(all.wrong));
    return all.wrong == 0 ? 0 : 1;
}
