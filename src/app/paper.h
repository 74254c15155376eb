// SPDX-License-Identifier: MIT
#pragma once

#include "app/bench.h"

namespace voxtact::app {

/// Unless told otherwise: every pose is timed, and there are samples enough for an interval of 95 %. On lavapipe on two cores, where a frame takes half a second, the whole is over in five minutes.
inline constexpr std::uint32_t kPaperPoses = 7; ///< of a scene
inline constexpr std::uint32_t kPaperRepetitions = 7;

/// `voxtact bench --paper`.
[[nodiscard]] Outcome runPaper(const BenchOptions& options);

} // namespace voxtact::app
