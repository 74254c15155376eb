// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/shared_options.h"
#include "lab/bench/batches.h"
#include "lab/bench/latency.h"
#include "lab/paper/paper.h"

#include <string>
#include <vector>

namespace voxtact::app {

struct BenchOptions {
    bool certified = false; ///< one of the five is meant
    bool outputs = false;
    bool latency = false;
    bool batches = false;
    bool paper = false;
    lab::BenchSettings settings;          ///< of --certified and --outputs
    lab::LatencySettings latencySettings; ///< of --latency
    lab::BatchesSettings batchesSettings; ///< of --batches
    lab::PaperSettings paperSettings;     ///< of --paper
    std::vector<std::string> volumes;     ///< none: the mode's own scene
    MeshOptions meshes;                   ///< the same
    TransferFunctionOptions transferFunction;
    DeviceChoice device;
    OutputOptions output;
    bool progress = false;
    std::filesystem::path report; ///< paper
};

/// --certified and --outputs: engines side by side, checked and timed.
[[nodiscard]] Outcome runBenchEngines(const BenchOptions& options, const CLI::App& parser);
/// --latency: what a loop waits for one answer.
[[nodiscard]] Outcome runLatency(const BenchOptions& options, const CLI::App& parser);
/// --batches: what a batch costs by its size.
[[nodiscard]] Outcome runBatches(const BenchOptions& options, const CLI::App& parser);
/// --paper
[[nodiscard]] Outcome runPaper(const BenchOptions& options, const CLI::App& parser);

} // namespace voxtact::app
