// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare/compare_verify.h"

namespace voxtact::lab {

/// A measurement that is repeated: what, by whom, and where its samples go.
struct Point {
    Engine* engine = nullptr;
    Work work;
    Feeding feeding{};
    Series series;
    double spent = 0; ///< ms
    bool finished = false;
};

[[nodiscard]] Point makePoint(Sweep sweep, Engine& engine, const Work& work, Mode mode, std::uint32_t batch);
/// A point an engine: all the pairs in one submission.
void addPoints(Sweep sweep, const Engines& engines, const Work& work, std::vector<Point>& points);

/// The counts of a point agree before it is timed: adds the verdicts that failed. `where` says which point it is.
[[nodiscard]] Result<void> verifyPoint(const Engines& engines, const Work& work, std::span<const std::uint32_t> poses,
                                       const std::string& where, Sweep sweep, CompareResult& result);

/// The warm-up, then rounds. Each point has its share of the time and takes samples as long as they fit, one at least.
[[nodiscard]] Result<void> measure(std::vector<Point>& points, const CompareSettings& settings, CompareResult& result,
                                   const std::function<void()>& step);
/// The series of points that were measured, in the order of mode and batch.
void collect(std::vector<Point>& points, CompareResult& result);
/// Measures and collects points whose counts were verified; nothing where one failed and the run is not to go on.
[[nodiscard]] Result<void> measureVerified(std::vector<Point>& points, const CompareSettings& settings,
                                           CompareResult& result, const std::function<void()>& step);

} // namespace voxtact::lab
