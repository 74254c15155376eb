// SPDX-License-Identifier: MIT
#pragma once

#include "lab/paper/paper_scenes.h"

namespace voxtact::lab {

/// Adds the rows of a scene: a line of the paper's tables for each method that the device can do, and `cpu`. The counts
/// of every pose are verified first, and those of every frame that is timed; where one is wrong,
/// PaperResult::disagreement says so and no time is taken any more. Adds the scene too.
///
/// A round takes of each method a frame without detection, the detection alone, and a frame with it, next to each
/// other, so that what else the machine does falls on all alike; the next round takes them the other way round. There
/// are `settings.repetitions` rounds, fewer where they do not fit in `seconds`, at least one; the notes say so.
[[nodiscard]] Result<void> measurePaperScene(const Session& session, const PaperSettings& settings, double seconds,
                                             const PaperInput& input, PaperResult& result,
                                             const std::function<void()>& step);

/// Steps of a scene.
[[nodiscard]] std::uint64_t paperSceneSteps(const PaperSettings& settings);

} // namespace voxtact::lab
