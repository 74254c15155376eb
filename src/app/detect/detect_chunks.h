// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/run_facts.h"
#include "app/detect/pair_engine.h"
#include "app/options/output_paths.h"

namespace voxtact::app {

/// Refuses what a run in chunks cannot have: what is about all of the run, or about one process.
[[nodiscard]] Result<void> checkDetectChunks(const DetectOptions& options);

/// What such a run is, but the engine's share of it. `reads`: all files that the options name.
[[nodiscard]] Result<RunFacts> detectRunFacts(const CLI::App& parser, const DetectOptions& options,
                                              const std::vector<NamedPath>& reads);

/// Who answered the chunks that are in the folder of a run; nothing where there is none yet. Whoever goes on with it
/// must answer by the same.
[[nodiscard]] std::optional<CountingMethod> methodOfRun(const ChunkOptions& options);

/// The run in chunks, by an engine.
[[nodiscard]] Outcome answerChunks(const DetectOptions& options, DetectInputs& inputs, RunFacts facts,
                                   PairEngine& engine, std::vector<std::string>& notes);

} // namespace voxtact::app
