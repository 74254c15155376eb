// SPDX-License-Identifier: MIT
#include "bench/measure/rounds.h"

#include "bench/measure/stopwatch.h"
#include "core/base/try.h"

namespace voxtact::lab {

namespace {

bool isStopped(const Rounds& rounds) {
    return rounds.stop && rounds.stop();
}

/// Returns true if the sample was taken.
Result<bool> takeTurn(Timed& thing, const Turn& turn) {
    const double next = turn.round > 1 ? thing.spent / static_cast<double>(turn.round - 1) : 0;
    thing.finished = thing.finished || thing.spent + next > thing.limit;
    if (thing.finished) {
        return false;
    }
    const Result<double> took = thing.take(turn);
    VOXTACT_TRY(took);
    thing.finished = *took == kNoLimit;
    thing.spent += turn.round > 0 ? *took : 0;
    return true;
}

/// Returns true if any sample was taken.
Result<bool> takeRound(std::span<Timed> things, const Rounds& rounds, std::uint64_t round) {
    const std::uint64_t again = rounds.cycle == 0 ? 0 : (round + rounds.cycle - 1) / rounds.cycle;
    const Turn turn{round, rounds.cycle > 0 && (round + again) % 2 == 0};
    bool any = false;
    for (std::size_t i = 0; i < things.size() && !isStopped(rounds); ++i) {
        const Result<bool> taken = takeTurn(things[turn.backwards ? things.size() - 1 - i : i], turn);
        VOXTACT_TRY(taken);
        any = any || *taken;
    }
    return any;
}

} // namespace

Result<std::uint64_t> takeRounds(std::span<Timed> things, const Rounds& rounds) {
    const auto step = [&](std::uint64_t passed) {
        if (rounds.step && passed > 0) {
            rounds.step(passed);
        }
    };
    std::uint64_t taken = 0;
    Stopwatch watch;
    std::uint64_t round = rounds.warmUp ? 0 : 1;
    for (; round <= rounds.repeats && !isStopped(rounds); ++round) {
        const double spent = watch.milliseconds();
        if (taken > 0 && spent + spent / static_cast<double>(taken) > rounds.limit) {
            break;
        }
        const Result<bool> any = takeRound(things, rounds, round);
        VOXTACT_TRY(any);
        if (!*any) {
            break;
        }
        taken = round;
        watch = round == 0 ? Stopwatch() : watch;
        step(1);
    }
    if (!isStopped(rounds)) {
        step(rounds.repeats + std::uint64_t{1} - round);
    }
    return taken;
}

} // namespace voxtact::lab
