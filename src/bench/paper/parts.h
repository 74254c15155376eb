// SPDX-License-Identifier: MIT
#pragma once

#include "bench/paper/paper.h"

/// The parts of a run of measurePaper().
namespace voxtact::lab {

/// A measurement under way.
struct PaperRun {
    const device::Session& session;
    const PaperSettings& settings;
    const Steps& steps;
    PaperResult& result;

    /// The first is the result's.
    void disagree(const std::string& how) const { result.disagreement = agrees() ? how : result.disagreement; }
    [[nodiscard]] bool agrees() const { return result.disagreement.empty(); }
    /// Once.
    void note(const std::string& text) const;
};

/// One of the paper's scenes, in host memory.
struct PaperInput {
    PaperScene facts;
    Scene scene;
};

/// v1s1, v1s2, v2s1, v2s2: each with poses of which all touch, as the host counts, and the camera of both picture and
/// detection.
[[nodiscard]] Result<std::vector<PaperInput>> loadPaperScenes(const PaperSettings& settings);
/// Replaces the poses of the scene by the first `count` random ones that touch, as the host counts in its view. `name`
/// is for the error where there are too few.
[[nodiscard]] Result<void> chooseTouching(std::uint32_t count, std::uint64_t seed, const std::string& name,
                                          Scene& scene);

/// Adds the rows of a scene: a line of the paper's tables for each method that the device can do, and `cpu`. The counts
/// of every pose are verified first, and those of every frame that is timed; where one is wrong,
/// PaperResult::disagreement says so and no time is taken any more. Adds the scene too.
///
/// A round takes of each method the detection alone and a frame with it, next to each other, and in their middle one
/// frame without; the next round takes them the other way round. There are `settings.repetitions` rounds, fewer where
/// they do not fit in `seconds`, at least one; the notes say so.
[[nodiscard]] Result<void> measurePaperScene(const PaperRun& run, double seconds, const PaperInput& input);
[[nodiscard]] std::uint64_t paperSceneSteps(const PaperSettings& settings);

} // namespace voxtact::lab
