// SPDX-License-Identifier: MIT
#pragma once

#include "app/bench.h"

namespace voxtact::app {

/// Unless told otherwise: every pose is timed, and there are samples enough for an interval of 95 %.
inline constexpr std::uint32_t kPaperPoses = 7; ///< of a scene
inline constexpr std::uint32_t kPaperRepetitions = 7;

/// `voxtact bench --paper`.
[[nodiscard]] Outcome runPaper(const BenchOptions& options);

} // namespace voxtact::app
