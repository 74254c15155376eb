// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/infinity.h"
#include "voxtact/error.h"

#include <cstdint>
#include <functional>
#include <span>

namespace voxtact::lab {

inline constexpr double kNoLimit = kInfinity;

/// A turn of something that is timed.
struct Turn {
    std::uint64_t round = 0; ///< from 1; 0: the warm-up, of which no time is kept
    bool backwards = false;  ///< the round is taken from its last to its first
};

/// Something that is timed: an engine with its work, a frame, a pass.
struct Timed {
    /// Runs once, checks the result, and stores the sample. Returns the sample's ms; kNoLimit for a warm-up that is too
    /// slow to be timed.
    std::function<Result<double>(const Turn& turn)> take;
    /// ms of its samples, of which there is one at least: it is left out once another would not fit.
    double limit = kNoLimit;
    double spent = 0; ///< ms of its samples so far
    bool finished = false;
};

/// Times things in rounds: a sample of each in turn, so that other load affects all alike.
struct Rounds {
    std::uint32_t repeats = 1;
    bool warmUp = false;     ///< a round before the others
    double limit = kNoLimit; ///< ms of the rounds, of which there is one at least: fewer are taken where another
                             ///< would not fit
    /// Rounds after which the things are what they were, poses for example. Every other round is taken backwards, and
    /// so that the same one comes the other way round next time. 0: no round is.
    std::uint64_t cycle = 0;
    std::function<void(std::uint64_t rounds)> step{}; ///< number of rounds since, taken or not
    std::function<bool()> stop{}; ///< called before each sample: true ends the rounds, after a failed check
};

/// Takes rounds of verified things until no sample is left. Returns the number of rounds, without the warm-up.
[[nodiscard]] Result<std::uint64_t> takeRounds(std::span<Timed> things, const Rounds& rounds);

} // namespace voxtact::lab
