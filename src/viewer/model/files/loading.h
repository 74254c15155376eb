// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace voxtact::view {

/// What is read and made on another thread, to be shown instead; and, when it is there, how that went.
struct Loading {
    std::string step;            ///< what is done
    std::optional<double> share; ///< of the step, 0..1
    double seconds = 0;          ///< since it began
    double longestFrame = 0;     ///< ms, from one frame to the next since then
    std::uint64_t frames = 0;    ///< since then
};

} // namespace voxtact::view
