// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare/compare_verify.h"

namespace voxtact::lab {

/// Times one sweep and adds its series to `result`: a warm-up of everything, then rounds that take a sample of every
/// point in turn, so that what else the machine does falls on all alike.
[[nodiscard]] Result<void> timeBatches(const CompareSettings& settings, const Engines& engines, const Work& work,
                                       CompareResult& result, const std::function<void()>& step);
/// Builtin meshes of several sizes; another mesh is told in the notes. Verifies the counts of each point first.
[[nodiscard]] Result<void> timeTriangles(const Session& session, const CompareSettings& settings, const Scene& scene,
                                         const Engines& engines, CompareResult& result,
                                         const std::function<void()>& step);
/// Viewports of several sizes.
[[nodiscard]] Result<void> timeFragments(const Session& session, const CompareSettings& settings, const Scene& scene,
                                         const Engines& engines, CompareResult& result,
                                         const std::function<void()>& step);

/// A builtin volume of half to twice as many voxels a side; another volume is told in the notes, and so are sizes that
/// the device or the builtin cannot have. Mesh, poses, camera and transfer function stay. Verifies as above.
[[nodiscard]] Result<void> timeVoxels(const Session& session, const CompareSettings& settings, const Scene& scene,
                                      const Engines& engines, CompareResult& result, const std::function<void()>& step);

/// Steps that a sweep calls `step` for.
[[nodiscard]] std::uint64_t stepsOf(Sweep sweep, std::uint32_t repeats) noexcept;

} // namespace voxtact::lab
