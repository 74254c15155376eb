// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engine_bench/bench.h"
#include "bench/paper/paper.h"
#include "cli/options/shared_options.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// Adds the command `bench`.
[[nodiscard]] Command addBench(CLI::App& program);
/// Adds the command `compare`.
[[nodiscard]] Command addCompare(CLI::App& program);

struct BenchOptions {
    std::optional<lab::BenchMode> mode; ///< none: --paper
    lab::BenchSettings settings;        ///< of the others
    lab::PaperSettings paperSettings;   ///< of --paper
    std::vector<std::string> volumes;   ///< none: the mode's own scene
    MeshOptions meshes;                 ///< the same
    TransferFunctionOptions transferFunction;
    DeviceChoice device;
    OutputOptions output;
    bool progress = false;
    std::filesystem::path report; ///< paper
};

/// All but --paper: engines side by side, checked and timed.
[[nodiscard]] Outcome runBenchEngines(const BenchOptions& options, const CLI::App& parser);
/// --paper
[[nodiscard]] Outcome runPaper(const BenchOptions& options, const CLI::App& parser);

} // namespace voxtact::app
