// SPDX-License-Identifier: MIT
#pragma once

#include "bench/compare/compare.h"
#include "cli/options/shared_options.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

struct CompareOptions {
    lab::CompareSettings settings;
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    std::uint32_t number = 128;
    std::uint64_t seed = 1;
    std::optional<std::uint32_t> onlyPose;
    bool sweepsGiven = false;
    bool localize = false; ///< which triangles touch, instead of how many fragments survive
    DeviceChoice device;
    OutputOptions output;
    std::filesystem::path report;
    bool progress = false;
};

/// Adds every option of `voxtact compare`.
void addCompareOptions(CLI::App& parser, CompareOptions& options);

} // namespace voxtact::app
