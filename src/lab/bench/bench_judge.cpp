// SPDX-License-Identifier: MIT
#include "lab/bench/bench_run.h"

namespace voxtact::lab {

std::string judgeEngine(std::span<const PairAnswer> certified, std::span<const PairAnswer> answers, BenchRow& row) {
    std::string disagreement;
    for (std::size_t i = 0; i < certified.size(); ++i) {
        const PairAnswer& truth = certified[i];
        const PairAnswer& answer = answers[i];
        const bool none = !truth.hit && !truth.possible;
        row.contacts += truth.hit ? 1 : 0;
        row.untouched += none ? 1 : 0;
        row.missed += truth.hit && !answer.hit ? 1 : 0;
        row.wrong += none && answer.hit ? 1 : 0;
        const std::uint64_t expected = row.engine.question == "yes/no" ? (truth.hit ? 1 : 0) : truth.count;
        if (row.engine.certified && disagreement.empty() &&
            (answer.hit != truth.hit || answer.possible != truth.possible || answer.count != expected)) {
            disagreement = row.mesh + ", poses " + row.poses + ", pose " + std::to_string(i) + ": " + row.engine.name +
                           " " + row.engine.question + " says " + std::to_string(answer.count) + ", it must be " +
                           std::to_string(expected);
        }
    }
    return disagreement;
}

} // namespace voxtact::lab
