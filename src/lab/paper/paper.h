// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare/compare_settings.h"
#include "lab/measure/machine.h"
#include "lab/paper/paper_result.h"
#include "voxtact/render.h"

#include <filesystem>

namespace voxtact::lab {

/// What `voxtact bench --paper` measures. Unless told otherwise every pose is timed, and there are samples enough for
/// an interval of 95 %.
struct PaperSettings {
    std::uint32_t poses = 7; ///< of a scene
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 7;
    std::filesystem::path data; ///< a folder with the files of the scenes; empty: builtins
    std::uint32_t scale = 1;    ///< the sides of its builtin volumes are divided by it
    bool noSweeps = false;      ///< the tables alone
    VkExtent2D size{512, 512};  ///< of frames
    double timeLimit = 240;     ///< seconds for all samples: fewer than `repetitions` are taken where they do not fit
    Loaders load;
    /// From the front of a volume; deep enough for `also`, a box in world space.
    std::function<Mat4(const Grid& grid, const Box& also, const VkExtent2D& size)> camera;
    /// The box of a box at a pose.
    std::function<Box(const Box& object, const Mat4& world_from_object)> worldBox;
    std::vector<ColourPoint> colours; ///< of the pictures
};

/// The paper's tables and sweeps. `result` has the provenance of its machine.
[[nodiscard]] Result<void> measurePaper(const PaperSettings& settings, const Session& session, const Steps& steps,
                                        PaperResult& result);

} // namespace voxtact::lab
