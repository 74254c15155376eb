// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace voxtact::view {

/// Progress and result of reading on another thread.
struct Loading {
    std::string step;            ///< current step
    std::optional<double> share; ///< of the step, 0..1
    double seconds = 0;          ///< since it began
    double longestFrame = 0;     ///< ms, from one frame to the next since then
    std::uint64_t frames = 0;    ///< since then
};

} // namespace voxtact::view
