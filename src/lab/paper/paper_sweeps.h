// SPDX-License-Identifier: MIT
#pragma once

#include "lab/measure/machine.h"
#include "lab/paper/paper.h"
#include "lab/paper/paper_result.h"

#include <functional>

namespace voxtact::lab {

/// Rounds of progress that runPaperSweeps() reports.
[[nodiscard]] std::uint64_t paperSweepSteps(const PaperSettings& settings);

/// What grows from point to point, which triangles touch, and the making of the pre-integrated table. `v1s1` is the
/// first scene, with the numbers of its poses; its mesh is the builtin scalpel. Fills `series`, `polygons`,
/// `polygonTriangles`, `polygonPoses` and `integration` of `result`, and adds to its notes. Where methods disagree it
/// fills `disagreement`, unless there is one already, and goes no further. The samples are cut to fit in `seconds`.
[[nodiscard]] Result<void> runPaperSweeps(const Session& session, const PaperSettings& settings, double seconds,
                                          const Scene& v1s1, PaperResult& result, const Steps& steps);

} // namespace voxtact::lab
