// SPDX-License-Identifier: MIT
#pragma once

#include "bench/compare/agreement.h"
#include "bench/engine_bench/bench.h"
#include "bench/measure/rounds.h"

/// The parts of a run of bench().
namespace voxtact::lab {

/// Inputs of the measurement of one mesh.
struct BenchRun {
    const BenchSettings& settings;
    Work work; ///< without poses
    const Engines& engines;
    double limit; ///< ms of the samples of all engines
    const std::function<void(std::uint64_t)>& step;
    BenchResult& result;

    /// A row for an engine; returns its number.
    [[nodiscard]] std::size_t addRow(const Engine& engine, const char* poses, std::size_t pairs) const;
    /// Takes rounds of things until one of their answers is wrong.
    [[nodiscard]] Result<void> time(std::vector<Timed>& things, Rounds rounds) const;
};

[[nodiscard]] Result<void> benchPoses(const BenchRun& run); ///< of certified and outputs
[[nodiscard]] Result<void> benchTicks(const BenchRun& run);
[[nodiscard]] Result<void> benchBatches(const BenchRun& run);
/// Rounds of all ticks.
[[nodiscard]] std::uint32_t tickRounds(std::uint32_t ticks);
/// Returns 1, 10, 100, ... and `most`.
[[nodiscard]] std::vector<std::uint32_t> batchSizes(std::uint32_t most);

/// Returns an engine's answer whether the mesh touches at a pose.
[[nodiscard]] std::function<Result<bool>(const Mat4& pose)> touchesBy(const Engine& engine, const Work& work);

/// Counts missed and false touches in `row`. Returns the pose of a forbidden difference, or empty.
[[nodiscard]] std::string judgeEngine(std::span<const PairAnswer> certified, std::span<const PairAnswer> answers,
                                      BenchRow& row);

/// The expected answer at a pose.
struct PoseTruth {
    PairAnswer certified; ///< by the host: in the projection certified
    PairAnswer view;      ///< the same in the view: the count
    /// In the view by the device's rasteriser, all of whose methods must count the same: nothing until one has.
    std::optional<PairAnswer> raster{};
};

/// Returns the error of an answer, or empty; `truth` takes the rasteriser's count from the first raster method.
/// Certified answers must equal the host's; raster methods must agree with each other, and nearly with the host in the
/// view.
[[nodiscard]] std::string judgePose(const EngineFacts& engine, const PairAnswer& answer, PoseTruth& truth);

} // namespace voxtact::lab
