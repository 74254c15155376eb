// SPDX-License-Identifier: MIT
#pragma once

#include "lab/engines/scene.h"
#include "lab/paper/paper.h"
#include "lab/paper/paper_result.h"

namespace voxtact::lab {

/// One of the paper's scenes, in host memory.
struct PaperInput {
    PaperScene facts;
    Scene scene;
};

/// Replaces the poses of the scene by the first `count` random ones that touch, as the host counts in its view. `name`
/// is for the error where there are too few.
[[nodiscard]] Result<void> chooseTouching(std::uint32_t count, std::uint64_t seed, const std::string& name,
                                          Scene& scene);

/// v1s1, v1s2, v2s1, v2s2: each with poses of which all touch, as the host counts, and the camera of both picture and
/// detection.
[[nodiscard]] Result<std::vector<PaperInput>> loadPaperScenes(const PaperSettings& settings);

} // namespace voxtact::lab
