// SPDX-License-Identifier: MIT
#pragma once

#include "app/bench.h"

namespace voxtact::app {

/// Unless told otherwise: every pose is timed, and there are samples enough for an interval with one or two of them
/// outside. On lavapipe, where a frame takes a second, that is a matter of minutes.
inline constexpr std::uint32_t kPaperPoses = 8; ///< of a scene
inline constexpr std::uint32_t kPaperRepetitions = 9;

/// `voxtact bench --paper`.
[[nodiscard]] Outcome runPaper(const BenchOptions& options);

} // namespace voxtact::app
