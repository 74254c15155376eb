// SPDX-License-Identifier: MIT
#pragma once

#include "app/shared_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxtact::app {

struct BenchOptions {
    bool certified = false;           ///< the mode: --certified
    std::vector<std::string> volumes; ///< none: the mode's own scene
    MeshOptions meshes;               ///< the same
    TransferFunctionOptions transferFunction;
    std::uint32_t poses = 256;
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 7;
    DeviceChoice device;
    OutputOptions output;
    bool progress = false;
    std::string command; ///< what reproduces the run
};

/// `voxtact bench --certified`.
[[nodiscard]] Outcome runBenchCertified(const BenchOptions& options);

} // namespace voxtact::app
