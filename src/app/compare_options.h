// SPDX-License-Identifier: MIT
#pragma once

#include "app/shared_options.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// What grows from point to point; each is a chart of the report.
enum class Sweep { Batch, Triangles, Fragments, Voxels };
inline constexpr std::array<Sweep, 4> kSweeps{Sweep::Batch, Sweep::Triangles, Sweep::Fragments, Sweep::Voxels};
[[nodiscard]] const char* toString(Sweep sweep) noexcept;

struct CompareOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view;
    std::vector<CountingMethod> methods; ///< empty: every one
    std::uint32_t count = 128;
    std::uint64_t seed = 1;
    std::optional<std::uint32_t> onlyPose;
    std::uint32_t oraclePoses = 32;
    std::vector<Sweep> sweeps;
    bool sweepsGiven = false;
    std::uint32_t repeats = 7;
    double timeLimit = 15; ///< seconds, of each sweep
    bool keepGoing = false;
    bool localize = false; ///< which triangles touch, instead of how many fragments survive
    DeviceChoice device;
    OutputOptions output;
    std::filesystem::path report;
    bool progress = false;
    std::string command; ///< what reproduces the run

    [[nodiscard]] bool wants(CountingMethod method) const;
};

/// Adds every option of `voxtact compare`.
void addCompareOptions(CLI::App& parser, CompareOptions& options);
/// The command line that gives the same run, quoted for a shell; without the options in `without`.
[[nodiscard]] std::string commandLine(const CLI::App& parser, const std::vector<std::string>& without = {});

} // namespace voxtact::app
