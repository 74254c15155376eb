// SPDX-License-Identifier: MIT
#pragma once

#include "app/shared_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxtact::app {

/// What `voxtact bench` can measure.
enum class BenchMode {
    Certified, ///< the certified answer beside the view and FCL
    Outputs,   ///< what each projection and each output costs beside the bare count
};

struct BenchOptions {
    bool certified = false; ///< one of the three is meant
    bool outputs = false;
    bool paper = false; ///< runPaper()
    BenchMode mode = BenchMode::Certified;
    std::vector<std::string> volumes; ///< none: the mode's own scene
    MeshOptions meshes;               ///< the same
    TransferFunctionOptions transferFunction;
    std::uint32_t poses = 256;
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 7;
    DeviceChoice device;
    OutputOptions output;
    bool progress = false;
    std::filesystem::path data;   ///< paper: a folder with the files of the scenes; empty: builtins
    std::uint32_t scale = 1;      ///< paper: the sides of its builtin volumes are divided by it
    bool noSweeps = false;        ///< paper: the tables alone
    VkExtent2D size{512, 512};    ///< paper: of frames
    std::filesystem::path report; ///< paper
    std::string command;          ///< what reproduces the run
};

/// The modes: engines side by side, checked and timed.
[[nodiscard]] Outcome runBenchEngines(const BenchOptions& options);

} // namespace voxtact::app
