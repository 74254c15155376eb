// SPDX-License-Identifier: MIT
#pragma once

#include "app/paper_scenes.h"

namespace voxtact::app {

/// Adds the rows of a scene: a line of the paper's tables for each method that the device can do, and `cpu`. The counts
/// of every pose are verified first, and those of every frame that is timed; where one is wrong,
/// PaperResult::disagreement says so and no time is taken any more. Adds the scene too.
///
/// A round takes of each method a frame without detection, the detection alone, and a frame with it, next to each
/// other, so that what else the machine does falls on all alike; the next round takes them the other way round.
[[nodiscard]] Result<void> measurePaperScene(const Session& session, const BenchOptions& options,
                                             const PaperInput& input, PaperResult& result,
                                             const std::function<void()>& step);

/// Steps of a scene.
[[nodiscard]] std::uint64_t paperSceneSteps(const BenchOptions& options);

/// What detection costs of what rendering does, percent: the paper's way to say it, by their times alone. A sample each
/// round; none where one of the two is not known.
[[nodiscard]] std::vector<double> collisionPercent(const PaperColumns& columns);
/// What detection adds to a frame, percent of the frame without it. A sample each round, of the two frames of it.
[[nodiscard]] std::vector<double> overheadPercent(const PaperColumns& columns);

} // namespace voxtact::app
