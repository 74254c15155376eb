// SPDX-License-Identifier: MIT
#include "lab/measure/rounds.h"

#include "core/base/try.h"
#include "lab/measure/stopwatch.h"

namespace voxtact::lab {

namespace {

Result<void> takeTurn(Timed& thing, const Turn& turn) {
    const double next = turn.round > 1 ? thing.spent / static_cast<double>(turn.round - 1) : 0;
    thing.finished = thing.finished || thing.spent + next > thing.limit;
    if (thing.finished) {
        return {};
    }
    const Result<double> took = thing.take(turn);
    VOXTACT_TRY(took);
    thing.finished = *took == kNoLimit;
    thing.spent += turn.round > 0 ? *took : 0;
    return {};
}

} // namespace

Result<std::uint64_t> takeRounds(std::span<Timed> things, const Rounds& rounds) {
    const auto stopped = [&] { return rounds.stop && rounds.stop(); };
    std::uint64_t taken = 0;
    Stopwatch watch;
    for (std::uint64_t round = rounds.warmUp ? 0 : 1; round <= rounds.repeats && !stopped(); ++round) {
        const double spent = watch.milliseconds();
        if (taken == 0 || spent + spent / static_cast<double>(taken) <= rounds.limit) {
            const std::uint64_t again = rounds.cycle == 0 ? 0 : (round + rounds.cycle - 1) / rounds.cycle;
            const Turn turn{round, rounds.cycle > 0 && (round + again) % 2 == 0};
            for (std::size_t i = 0; i < things.size() && !stopped(); ++i) {
                VOXTACT_TRY(takeTurn(things[turn.backwards ? things.size() - 1 - i : i], turn));
            }
            taken = round;
            watch = round == 0 ? Stopwatch() : watch;
        }
        if (rounds.step) {
            rounds.step();
        }
    }
    return taken;
}

} // namespace voxtact::lab
